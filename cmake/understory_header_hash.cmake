# Writes a header with the version and a hash of all public headers: a plug-in that was built against others is refused.
#   cmake -DSOURCE=... -DHEADERS=a.hpp,b.hpp -DVERSION=... -DOUTPUT=... -P cmake/understory_header_hash.cmake
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" headers "${HEADERS}")
set(all "")
foreach(header IN LISTS headers)
  file(SHA256 ${header} hash)
  file(RELATIVE_PATH name ${SOURCE} ${header})
  string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "#pragma once

// Written by the build.
#define UNDERSTORY_HEADER_VERSION \"@VERSION@\"
#define UNDERSTORY_HEADER_HASH \"@hash@\"
")
