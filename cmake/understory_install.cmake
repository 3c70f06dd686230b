# What is installed, in three components: the program with its data; a CMake package with what runs on an aircraft, what
# plug-ins need, and the whole testbed, find_package(understory COMPONENTS perception estimation plugin simulation); the
# Python module. docs/example and docs/examples use the second from outside the tree; tests/package builds them, runs the
# program from a prefix that was moved, and flies the plug-ins.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# The program looks for its data below share/understory of the prefix that it lies in, and for its module of picture
# codecs along its run path.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS understory)
install(TARGETS understory_picture_codecs LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/understory)
if(UNDERSTORY_SIM)
  install(TARGETS understory_evolution LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/understory)
endif()
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/understory)
install(DIRECTORY scenarios/library DESTINATION ${CMAKE_INSTALL_DATADIR}/understory/scenarios)
install(FILES scenarios/report/page/built/page.html
        DESTINATION ${CMAKE_INSTALL_DATADIR}/understory/scenarios/report/page/built)

# A sanitized program may not run where it is built: no pages of it.
if(NOT UNDERSTORY_SANITIZE)
  set(manual ${PROJECT_BINARY_DIR}/understory.1.gz)
  set(completion ${PROJECT_BINARY_DIR}/completion/understory)
  add_custom_command(OUTPUT ${manual} ${completion} DEPENDS understory VERBATIM
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/completion
    COMMAND sh -ec "$<TARGET_FILE:understory> manual | gzip -9n >${manual}"
    COMMAND sh -ec "$<TARGET_FILE:understory> completion bash >${completion}")
  add_custom_target(program_pages ALL DEPENDS ${manual} ${completion})
  install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()

# One target a component: the readers come with the detector.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/understory)
set_target_properties(perception_io PROPERTIES EXPORT_NAME perception)
set_target_properties(perception PROPERTIES EXPORT_NAME detection)
set_target_properties(understory_plugin PROPERTIES EXPORT_NAME plugin)
install(TARGETS understory_plugin understory_options understory_settings opencv_core_parts opencv_file_parts perception_types pushbroom_kernel perception
                picture_codecs perception_text perception_io estimation_types estimation
        EXPORT understory-targets)
install(EXPORT understory-targets NAMESPACE understory:: DESTINATION ${package_folder})
# The whole testbed, with what it links: a set of its own, so that an aircraft's program needs none of it.
if(UNDERSTORY_SIM AND NOT UNDERSTORY_SANITIZE)
  set_target_properties(scenarios PROPERTIES EXPORT_NAME simulation)
  install(TARGETS scenarios scenarios_files scenarios_flight_computer scenarios_pages scenarios_pictures scenarios_rig
                  scenarios_scenario scenarios_truth autopilot planning planning_types sim sim_types ompl_only
          EXPORT understory-simulation-targets)
  install(EXPORT understory-simulation-targets NAMESPACE understory:: DESTINATION ${package_folder})
  install(FILES cmake/understory_mujoco.cmake DESTINATION ${package_folder})
endif()
install(DIRECTORY perception estimation planning sim scenarios DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/understory
        FILES_MATCHING PATTERN "*.hpp" PATTERN node_modules EXCLUDE PATTERN python EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/plugin_headers/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/understory/plugin)
foreach(folder understory understory/plugin)
  install(FILES ${PROJECT_BINARY_DIR}/generated/understory_header_hash.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
endforeach()
install(FILES cmake/understory_plugin.cmake DESTINATION ${package_folder})
configure_package_config_file(cmake/understory-config.cmake.in understory-config.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(understory-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/understory-config.cmake ${PROJECT_BINARY_DIR}/understory-config-version.cmake
        DESTINATION ${package_folder})

# Debian's folder for all versions of Python 3. Elsewhere than in /usr it goes into PYTHONPATH.
if(understory_has_python)
  set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME python)
  install(TARGETS python_module LIBRARY DESTINATION ${python_packages})
  install(TARGETS understory_python LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/understory)
  install(DIRECTORY scenarios/python/understory DESTINATION ${python_packages} FILES_MATCHING PATTERN "*.py" PATTERN py.typed
          PATTERN __pycache__ EXCLUDE)
  install(FILES ${PROJECT_BINARY_DIR}/python/_understory.pyi DESTINATION ${python_packages} OPTIONAL)
endif()

# All that is installed: what `./run build` and `./run fly` build.
add_custom_target(product)
foreach(part understory program_pages python_module understory_python)
  if(TARGET ${part})
    add_dependencies(product ${part})
  endif()
endforeach()
