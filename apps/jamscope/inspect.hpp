// jamscope inspect: what a file of snapshots holds, whether it is valid, what it lacks.
#pragma once
#include <string>

#include "apps/jamscope/console.hpp"
#include "apps/jamscope/stored_run.hpp"

namespace jamscope {

struct InspectOptions {
  InputOptions input;
  bool json = false;
  bool quick = false;  // read the first and last frame only
  bool quiet = false;
};

// Prints to standard output. Returns 0, or 3 where frames cannot be read; throws jam::DataError where nothing can.
int inspect(const InspectOptions& options);

}  // namespace jamscope
