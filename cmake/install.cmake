# Makes find_package(topple) work outside the tree: link topple::topple.
include(CMakePackageConfigHelpers)

add_library(topple_all INTERFACE)
set_target_properties(topple_all PROPERTIES EXPORT_NAME topple)
add_library(topple::topple ALIAS topple_all)
target_link_libraries(topple_all INTERFACE ${TOPPLE_CHAPTERS})

install(TARGETS ${TOPPLE_CHAPTERS} topple_all EXPORT topple-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/topple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT topple-targets NAMESPACE topple:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
configure_package_config_file(cmake/topple-config.cmake.in ${PROJECT_BINARY_DIR}/topple-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/topple-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/topple-config.cmake ${PROJECT_BINARY_DIR}/topple-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/topple)
install(TARGETS topple_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The page, if it was built; `topple show` finds it beside the program.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/studio/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/topple/studio OPTIONAL)
# The published measurements; `topple validate` finds them beside the program.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/validation/ DESTINATION ${CMAKE_INSTALL_DATADIR}/topple/validation)
