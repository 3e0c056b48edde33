# The contact solver's inner loops for four numbers at once: one unit compiled for AVX2, chosen when a run begins (src/model/rigid/lanes.h).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(rigid ${PROJECT_SOURCE_DIR}/src/model/rigid)
  set_source_files_properties(${rigid}/lanes_4.cpp PROPERTIES COMPILE_OPTIONS -mavx2)
  set_source_files_properties(${rigid}/lane_kernels.cpp PROPERTIES COMPILE_DEFINITIONS TOPPLE_FOUR_LANES)
endif()
