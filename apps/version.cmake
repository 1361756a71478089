# Writes OUTPUT, which defines what apps/jamscope/version.hpp declares. It is run by every build, as a commit asks for no new configuration:
#   cmake -DSOURCE=folder of the source -DVERSION=0.1.0 -DOUTPUT=version.cpp -P version.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
# Left alone where nothing has changed, so that nothing is compiled or linked for it.
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "apps/jamscope/version.hpp"
namespace jamscope {
const char* const version = "@VERSION@";
const char* const commit = "@commit@";
}  // namespace jamscope
]])
