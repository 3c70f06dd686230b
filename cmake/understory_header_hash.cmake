# Copies the headers that a plug-in sees, plugin.hpp and all that it includes, into a folder of their own: a plug-in that
# includes another one does not compile. Writes a header with the version and their hash: a plug-in that was built
# against others is refused.
#   cmake -DSOURCE=... -DVERSION=... -DCOPIES=FOLDER -DOUTPUT=... -P cmake/understory_header_hash.cmake
cmake_minimum_required(VERSION 3.25)
set(seen scenarios/scenario/plugin.hpp)
set(left ${seen})
while(left)
  list(POP_FRONT left header)
  file(STRINGS ${SOURCE}/${header} lines REGEX "^#include \"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" included "${line}")
    if(NOT included IN_LIST seen AND NOT included STREQUAL "understory_header_hash.hpp")
      list(APPEND seen ${included})
      list(APPEND left ${included})
    endif()
  endforeach()
endwhile()
list(SORT seen)
set(all "")
foreach(header IN LISTS seen)
  file(SHA256 ${SOURCE}/${header} hash)
  string(APPEND all "${header} ${hash}\n")
  configure_file(${SOURCE}/${header} ${COPIES}/${header} COPYONLY)
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "#pragma once

// Written by the build.
#define UNDERSTORY_HEADER_VERSION \"@VERSION@\"
#define UNDERSTORY_HEADER_HASH \"@hash@\"
")
