# Run by CTest: BUILD (the project's build folder), SOURCE (its source tree), EXAMPLE, RIG, COMPILER, SIM (whether the
# program flies) and WORK are given.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
function(must)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGV}: ${status}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# `./run build` builds all that is installed.
must(ninja -C ${BUILD} -t commands product)
cmake_policy(SET CMP0009 NEW)
file(GLOB_RECURSE scripts ${BUILD}/cmake_install.cmake)
foreach(script IN LISTS scripts)
  file(STRINGS ${script} lines REGEX "\"${BUILD}/[^\"]*[.](so|a|gz)\"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE ".*\"${BUILD}/([^\"]*)\".*" "\\1" file "${line}")
    if(NOT output MATCHES "[ /]${file}[ \"\n]")
      message(FATAL_ERROR "./run build does not build ${file}, which is installed")
    endif()
  endforeach()
endforeach()

must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
must(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
     -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Release -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
must(${CMAKE_COMMAND} --build ${WORK}/build)
# Who names no component is told of both all the same.
file(WRITE ${WORK}/nameless/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(nameless LANGUAGES CXX)
find_package(understory REQUIRED)
if(NOT understory_perception_FOUND OR NOT understory_estimation_FOUND)
  message(FATAL_ERROR \"components that are there are not told\")
endif()
")
must(${CMAKE_COMMAND} -S ${WORK}/nameless -B ${WORK}/nameless/build -D CMAKE_PREFIX_PATH=${WORK}/prefix)
# Parts of one's own, built against the installed headers.
if(SIM)
  must(${CMAKE_COMMAND} -S ${EXAMPLES} -B ${WORK}/parts -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
       -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Release -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
  must(${CMAKE_COMMAND} --build ${WORK}/parts)
endif()
# A program of one's own around a flight.
if(SIM)
  must(${CMAKE_COMMAND} -S ${EXAMPLES}/closed_loop -B ${WORK}/loop -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
       -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Release -D "CMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
  must(${CMAKE_COMMAND} --build ${WORK}/loop)
  must(${WORK}/loop/closed_loop ${WORK}/prefix/share/understory 1003)
  if(NOT output MATCHES "goal")
    message(FATAL_ERROR "the closed loop lost its flight: ${output}")
  endif()
endif()
# The installed program finds its module of picture codecs and its data wherever the prefix was moved to, from any
# folder, and knows nothing of the source tree.
file(RENAME ${WORK}/prefix ${WORK}/moved)
must(${WORK}/moved/bin/understory rig long --out ${WORK}/rig.svg)
if(NOT EXISTS ${WORK}/rig.svg)
  message(FATAL_ERROR "the installed program drew no rig: ${output}")
endif()
if(SIM)
  file(WRITE ${WORK}/brief.yaml "forest: {length_m: 10}\n")
  must(${CMAKE_COMMAND} -E chdir ${WORK} ${WORK}/moved/bin/understory fly clear --with brief.yaml --video --out flight)
  if(NOT EXISTS ${WORK}/flight/flight.mp4)
    message(FATAL_ERROR "the installed program filmed no flight: ${output}")
  endif()
endif()
if(SIM)
  must(${WORK}/moved/bin/understory plugin ${WORK}/parts/edge_detector.so ${WORK}/parts/compass_source.so)
  file(WRITE ${WORK}/mine.yaml "plugins: [{file: parts/swerve_planner.so}, {file: parts/slalom_course.so}]
course: slalom
autopilot: {method: swerve}
perception: {detector: true_depth}
forest: {length_m: 20}
")
  must(${CMAKE_COMMAND} -E chdir ${WORK} ${WORK}/moved/bin/understory fly mine.yaml --out mine)
endif()
if(PYTHON)
  set(ENV{PYTHONPATH} ${WORK}/moved/lib/python3/dist-packages)
  file(WRITE ${WORK}/installed.py "import understory
print(understory.Flight('clear', set={'forest.length_m': 10}).run()['outcome'], understory.commands.program())
")
  must(${PYTHON} -B ${WORK}/installed.py)
  if(NOT output MATCHES "goal ${WORK}/moved/bin/understory")
    message(FATAL_ERROR "the installed Python module did not fly: ${output}")
  endif()
  must(${WORK}/moved/bin/understory fly forest --with ${WORK}/brief.yaml --plugin ${EXAMPLES}/python/swerve_planner.py
       --set autopilot.method=python_swerve --out ${WORK}/python_flight)
  unset(ENV{PYTHONPATH})
endif()
file(STRINGS ${WORK}/moved/bin/understory paths REGEX "${SOURCE}/(models|scenarios|perception|sim|planning|estimation)")
if(paths)
  message(FATAL_ERROR "the installed program names the source tree: ${paths}")
endif()
# Two gray pictures of the rig's size, written by hand: the simplest image format there is.
string(REPEAT "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!?" 1410 pixels)
string(SUBSTRING "${pixels}" 0 90240 pixels)
foreach(side left right)
  file(WRITE ${WORK}/${side}.pgm "P5\n376 240\n255\n${pixels}")
endforeach()
function(expect_words words)
  if(NOT output MATCHES "${words}")
    message(FATAL_ERROR "expected ${words}, the example said: ${output}")
  endif()
endfunction()
must(${WORK}/build/example ${RIG} ${WORK}/left.pgm ${WORK}/right.pgm)
expect_words("looking 10.14 m ahead: [0-9]+ hits, [0-9]+ points")
# A rectified recording, as `understory record` writes it, of a camera without distortion.
set(offset_0 0)
set(offset_1 -0.3)
foreach(camera 0 1)
  file(WRITE ${WORK}/recorded/mav0/cam${camera}/sensor.yaml "sensor_type: camera
T_BS: {rows: 4, cols: 4, data: [0, 0, 1, 0, -1, 0, 0, ${offset_${camera}}, 0, -1, 0, 0, 0, 0, 0, 1]}
resolution: [376, 240]
camera_model: pinhole
intrinsics: [380, 380, 188, 120]
distortion_model: radial-tangential
distortion_coefficients: [0, 0, 0, 0]
rectification: [1, 0, 0, 0, 1, 0, 0, 0, 1]
rectified_intrinsics: [380, 188, 120]
")
  file(WRITE ${WORK}/recorded/mav0/cam${camera}/data.csv "#timestamp [ns],filename\n100,100.pgm\n")
  file(WRITE ${WORK}/recorded/mav0/cam${camera}/data/100.pgm "P5\n376 240\n255\n${pixels}")
endforeach()
must(${WORK}/build/example ${WORK}/recorded ${WORK}/recorded)
expect_words("looking [0-9.]+ m ahead: [0-9]+ hits, [0-9]+ points")
