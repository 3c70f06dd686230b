# Debian packages of what understory_install.cmake installs: `cmake --workflow --preset package` builds and packs
# understory (the program, its models and scenarios) and libunderstory-dev.
set(CPACK_PACKAGE_NAME understory)
set(CPACK_PACKAGE_VENDOR "the Understory developers")
set(CPACK_PACKAGE_CONTACT "The Understory developers <understory@example.org>")
set(CPACK_PACKAGE_HOMEPAGE_URL "")
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program development)
if(understory_has_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME understory)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# CPack puts the project's description, the synopsis, before these.
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Flies a simulated delta wing through forests on its own stereo vision,
headless, on a CPU, the same way every time: single flights, recordings,
campaigns with statistics, a gate for continuous integration, and the
detector on recorded images.")
# What is linked, and what is opened at run time: OSMesa draws everywhere, EGL where a GPU is.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS libosmesa6)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libegl1, libgl1-mesa-dri")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libunderstory-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Static libraries, headers and CMake configuration of the pushbroom stereo
detector with its readers, and of the error-state filter, as they run on an
aircraft, and the headers for plug-ins:
find_package(understory COMPONENTS perception estimation plugin); and the
whole testbed for programs of one's own: COMPONENTS simulation.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libopencv-dev, libyaml-cpp-dev, libpugixml-dev, libfmt-dev, libpng-dev, libtbb-dev, libhwy-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libmujoco-dev, libompl-dev, libzstd-dev, nlohmann-json3-dev")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-understory)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Flights, parts and Gymnasium environments in Python:
import understory; and plug-ins in Python for the program understory.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "understory (= ${PROJECT_VERSION}-1), python3-numpy, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-opencv, python3-matplotlib, python3-pandas")

# Debian asks for a copyright file and a changelog in each package.
file(READ LICENSE license)
string(REGEX REPLACE "^.*reserved\\.\n+" "" license "${license}")
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(STRIP "${license}" license)
string(REGEX REPLACE "\n" "\n " license " ${license}")
configure_file(cmake/debian/copyright.in debian/copyright @ONLY)
configure_file(cmake/debian/changelog.in debian/changelog @ONLY)
set(pages ${PROJECT_BINARY_DIR}/debian)
add_custom_command(OUTPUT ${pages}/changelog.gz ${pages}/changelog.Debian.gz VERBATIM
  DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${pages}/changelog
  COMMAND sh -ec "gzip -9n <${PROJECT_SOURCE_DIR}/CHANGELOG.md >${pages}/changelog.gz"
  COMMAND sh -ec "gzip -9n <${pages}/changelog >${pages}/changelog.Debian.gz")
add_custom_target(debian_pages ALL DEPENDS ${pages}/changelog.gz ${pages}/changelog.Debian.gz)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} key)
  install(FILES ${pages}/copyright ${pages}/changelog.gz ${pages}/changelog.Debian.gz COMPONENT ${component}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME})
endforeach()
# The module of picture codecs calls OpenCV and the C++ library, and no function of libc itself.
file(CONFIGURE OUTPUT ${pages}/lintian-overrides
     CONTENT "understory: library-not-linked-against-libc *understory_picture_codecs.so*\n")
install(FILES ${pages}/lintian-overrides COMPONENT program RENAME understory
        DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides)
include(CPack)
