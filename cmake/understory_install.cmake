# What runs on an aircraft, as a CMake package: find_package(understory COMPONENTS perception estimation).
# docs/example uses it from outside the tree; tests/package builds that.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# One target a component: the readers come with the detector.
set_target_properties(perception_io PROPERTIES EXPORT_NAME perception)
set_target_properties(perception PROPERTIES EXPORT_NAME detection)
install(TARGETS understory_settings opencv_core_parts opencv_file_parts perception_types pushbroom_kernel perception
                picture_codecs perception_io estimation_types estimation
        EXPORT understory-targets)
install(TARGETS understory)
install(TARGETS understory_picture_codecs LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/understory)
install(EXPORT understory-targets NAMESPACE understory:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/understory)
install(DIRECTORY perception estimation DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/understory
        FILES_MATCHING PATTERN "*.hpp")
configure_package_config_file(cmake/understory-config.cmake.in understory-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/understory)
write_basic_package_version_file(understory-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/understory-config.cmake ${PROJECT_BINARY_DIR}/understory-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/understory)
