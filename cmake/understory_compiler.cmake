# One set of compiler settings for every target of the house.
# No -march=native and no -ffast-math: a flight must repeat bit for bit (docs/decisions/001-determinism.md).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

add_library(understory_options INTERFACE)  # what plug-ins take over, too
add_library(understory_settings INTERFACE)
target_link_libraries(understory_settings INTERFACE understory_options)
target_include_directories(understory_settings INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                           $<INSTALL_INTERFACE:include/understory>)
target_compile_features(understory_options INTERFACE cxx_std_20)
# An assertion (OpenCV's CV_Assert) names its file from the top of the tree, not where somebody built it.
target_compile_options(understory_options INTERFACE
  "$<BUILD_INTERFACE:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>")
# fmt as a shared library, which its headers must know, also in the headers that are read once for all files.
target_compile_definitions(understory_options INTERFACE $<BUILD_INTERFACE:FMT_SHARED>)
# Warnings are the project's own affair: who uses the installed package keeps theirs. Where several files are compiled
# as one (CMAKE_UNITY_BUILD), a local name may be that of a neighbour's constant, and a class may use its own file's
# types; the preset dev, which compiles each file alone, warns of the rest.
set(shadow_warnings -Wshadow)
if(CMAKE_UNITY_BUILD)
  set(shadow_warnings -Wshadow=local -Wno-subobject-linkage)
endif()
target_compile_options(understory_options INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;${shadow_warnings};-Wnon-virtual-dtor;-Werror;-ffp-contract=off>")
# Everything can be part of a shared library: the Python module holds the whole testbed.
target_compile_options(understory_options INTERFACE "$<BUILD_INTERFACE:-fPIC;-fno-semantic-interposition>")
# GCC collects its garbage only beyond 0.8 GB: a sixth of the time that a file takes.
target_compile_options(understory_options INTERFACE
  "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=200;--param=ggc-min-heapsize=800000>>")
if(UNDERSTORY_SANITIZE)
  # GCC's manual: with sanitizers on, -Wmaybe-uninitialized reports what is not so (std::regex in GCC 12).
  target_compile_options(understory_options INTERFACE
    -fsanitize=${UNDERSTORY_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(understory_options INTERFACE -fsanitize=${UNDERSTORY_SANITIZE})
  # Under a sanitizer Eigen aligns memory by hand, and frees by hand what libpagmo took from malloc. The sanitizer's
  # malloc aligns as glibc's does.
  target_compile_definitions(understory_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
