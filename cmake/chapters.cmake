# topple_chapter(NAME [IN FOLDER] [USES chapter...] [PRIVATE_LIBRARIES target...])
# One folder of src/ is one library; a chapter sees only the chapters it names.
find_package(PkgConfig REQUIRED)

add_library(topple_options INTERFACE)
# Same bits on every machine: no fused multiply-add behind our back, no reassociation.
target_compile_options(topple_options INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor
  # Designated initialisers name what differs from the default; the rest is meant to be left out.
  -Wno-missing-field-initializers)
# g++ 12 sees overlapping copies in "text" + string where there are none (GCC bug 105651, gone in 13).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(topple_options INTERFACE -Wno-restrict)
endif()
# clang dislikes what libstdc++ 12's own stable_sort uses.
target_compile_options(topple_options INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
if(TOPPLE_WERROR)
  target_compile_options(topple_options INTERFACE -Werror)
endif()

set(TOPPLE_CHAPTERS "" CACHE INTERNAL "")

function(topple_chapter name)
  cmake_parse_arguments(CHAPTER "" "IN" "USES;PRIVATE_LIBRARIES" ${ARGN})
  set(folder ${PROJECT_SOURCE_DIR}/src/${CHAPTER_IN}/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  add_library(topple_${name} STATIC ${sources})
  add_library(topple::${name} ALIAS topple_${name})
  set_target_properties(topple_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(topple_${name} PUBLIC cxx_std_23)
  target_include_directories(topple_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(topple_${name} PRIVATE $<BUILD_INTERFACE:topple_options>)
  target_compile_definitions(topple_${name} PRIVATE TOPPLE_VERSION="${PROJECT_VERSION}")
  foreach(used ${CHAPTER_USES})
    target_link_libraries(topple_${name} PUBLIC topple_${used})
  endforeach()
  foreach(library ${CHAPTER_PRIVATE_LIBRARIES})
    if(library STREQUAL "tomlplusplus")
      target_compile_definitions(topple_${name} PRIVATE TOML_EXCEPTIONS=0)
      if(TOPPLE_WASM)
        # The machine's own headers must not be seen, but toml++ is nothing but headers.
        file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/headers)
        file(CREATE_LINK /usr/include/toml++ ${PROJECT_BINARY_DIR}/headers/toml++ SYMBOLIC)
        target_include_directories(topple_${name} SYSTEM PRIVATE ${PROJECT_BINARY_DIR}/headers)
        target_compile_options(topple_${name} PRIVATE -include ${PROJECT_SOURCE_DIR}/studio/engine/closed_files.h)
      endif()
    elseif(library STREQUAL "hdf5")
      find_package(HDF5 REQUIRED COMPONENTS C)
      target_link_libraries(topple_${name} PRIVATE hdf5::hdf5)
    elseif(library STREQUAL "stb")
      # Nothing but headers.
      find_path(STB_INCLUDE stb/stb_image.h REQUIRED)
      target_include_directories(topple_${name} SYSTEM PRIVATE ${STB_INCLUDE})
    elseif(library STREQUAL "cairo")
      pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo cairo-pdf cairo-svg)
      target_link_libraries(topple_${name} PRIVATE PkgConfig::CAIRO)
    elseif(library STREQUAL "threads")
      find_package(Threads REQUIRED)
      target_link_libraries(topple_${name} PRIVATE Threads::Threads)
    endif()
  endforeach()
  if(NOT name MATCHES "^(export|validation)$")
    # The core throws nothing, so that the same source serves the page.
    target_compile_options(topple_${name} PRIVATE -fno-exceptions)
  endif()
  set(TOPPLE_CHAPTERS ${TOPPLE_CHAPTERS} topple_${name} CACHE INTERNAL "")
endfunction()
