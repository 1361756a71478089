// jamscope inspect: what a file of snapshots holds, whether it is valid, what it lacks.
#pragma once
#include <string>

#include "apps/jamscope/stored_run.hpp"
#include "libjam/snapshot/inspect.hpp"

namespace jamscope {

struct InspectOptions {
  InputOptions input;
  bool json = false;
  bool quiet = false;
};

// Looks at one file of snapshots, damaged or not, or at foreign data through their map; prints to standard output.
// Returns 0, or 3 where something is damaged; throws like open_stored_run for foreign data.
int inspect(const InspectOptions& options);

std::string inspection_text(const jam::FileReport& report);
std::string inspection_json(const jam::FileReport& report);

}  // namespace jamscope
