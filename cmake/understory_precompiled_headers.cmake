# What most files include, read once for all of them (docs/decisions/016). Every file includes what it uses all the
# same: the preset tsan builds the stack without (CMAKE_DISABLE_PRECOMPILE_HEADERS).
set(common_headers
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <numbers> <optional>
  <random> <span> <sstream> <stdexcept> <string> <string_view> <utility> <vector> <Eigen/Geometry> <fmt/format.h> <opencv2/core.hpp>)

# precompiled_headers(NAME LIBRARIES target ... HEADERS <header> ...): a target whose headers others take over.
function(precompiled_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 precompiled "" "" "LIBRARIES;HEADERS")
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled_headers.cpp)
  target_link_libraries(${name} PRIVATE understory_settings ${precompiled_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${precompiled_HEADERS})
endfunction()

# take_common_headers(FOLDER EXCEPT target ...): every library of the folder but those named.
function(take_common_headers folder)
  cmake_parse_arguments(PARSE_ARGV 1 take "" "" "EXCEPT")
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(REMOVE_ITEM targets "" ${take_EXCEPT})
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      target_precompile_headers(${target} REUSE_FROM understory_headers)
    endif()
  endforeach()
endfunction()

precompiled_headers(understory_headers LIBRARIES Eigen3::Eigen opencv_core_parts HEADERS ${common_headers})
