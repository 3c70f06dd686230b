# Every outside library, from Debian 12's packages, under one target name each.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(pugixml REQUIRED)
find_package(nanoflann REQUIRED)

find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d videoio)
add_library(opencv_core_parts INTERFACE)      # what the flight stack may use
target_include_directories(opencv_core_parts SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(opencv_core_parts INTERFACE opencv_core opencv_imgproc opencv_calib3d)
add_library(opencv_file_parts INTERFACE)      # images and videos, for readers and recorders
target_link_libraries(opencv_file_parts INTERFACE opencv_core_parts opencv_imgcodecs opencv_videoio)

find_package(ZLIB REQUIRED)  # calibrations that OpenCV packs
find_package(PNG REQUIRED)  # the pictures of recordings, without all that comes with OpenCV's

find_library(ZSTD_LIBRARY zstd REQUIRED)  # logs of flights, problems of planners

find_package(TBB REQUIRED)
find_package(hwy REQUIRED)

# OMPL_LIBRARIES also names Boost parts that nothing here calls: keep libompl alone.
find_package(ompl REQUIRED)
list(FILTER OMPL_LIBRARIES INCLUDE REGEX "libompl\\.so")
add_library(ompl_only INTERFACE)
target_include_directories(ompl_only SYSTEM INTERFACE ${OMPL_INCLUDE_DIRS})
target_link_libraries(ompl_only INTERFACE ${OMPL_LIBRARIES})

if(UNDERSTORY_SIM)
  include(understory_mujoco)

  # Tuning's optimisers. Its headers see Boost.Serialization, whose library is linked, and TBB.
  find_package(pagmo REQUIRED)
  add_library(pagmo_only INTERFACE)
  target_link_libraries(pagmo_only INTERFACE Pagmo::pagmo)

  # Logs for viewers (MCAP).
  find_package(Protobuf REQUIRED)
endif()
# Debian's Python, whatever else stands in PATH: Debian's numpy belongs to it. Without it there is no Python module.
set(understory_has_python OFF)
# Under the address sanitizer Python's tests load it first (LD_PRELOAD); the others cannot be loaded so.
if(UNDERSTORY_SIM AND UNDERSTORY_PYTHON AND (NOT UNDERSTORY_SANITIZE OR UNDERSTORY_SANITIZE MATCHES "address"))
  if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3)
  endif()
  set(PYBIND11_FINDPYTHON ON)
  find_package(Python 3.9 COMPONENTS Interpreter Development NumPy)
  find_package(pybind11 QUIET)
  if(Python_Development_FOUND AND Python_NumPy_FOUND AND pybind11_FOUND)
    set(understory_has_python ON)
  else()
    message(STATUS "The Python module is left out: it needs python3-dev, python3-numpy and pybind11-dev")
  endif()
endif()
if(UNDERSTORY_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
endif()
