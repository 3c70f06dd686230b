# Writes OUTPUT, a source file that says what was built; only where that has changed, so that nothing is linked anew
# in vain. cmake -DSOURCE=... -DOUTPUT=... [-DCOMMIT=...] -P
if(NOT COMMIT)
  execute_process(COMMAND git describe --always --dirty --abbrev=10 --exclude * WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT COMMIT)
  set(COMMIT unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "scenarios/output/program.hpp"

const char* const understory::commit_of_this_build = "@COMMIT@";
]] @ONLY)
