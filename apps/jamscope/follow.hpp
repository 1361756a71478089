// jamscope follow: the whole way of some grains through a stored run, before, in and after their jams, and what they touch.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/stored_run.hpp"

namespace jamscope {

enum class FollowOf { path, contacts };

struct FollowOptions {
  InputOptions input;
  std::vector<std::uint32_t> particles;  // ids; or
  std::optional<std::size_t> jam;        // the members of this jam of the global stream, counted from 0 as in events.csv
  std::string results;                   // folder with the jam.h5 that has it; empty: that of the input
  std::string frames;                    // A:B; empty: all, of a jam those from `around` before it to as many after it
  FollowOf of = FollowOf::path;
  std::vector<std::string> overrides;    // of the criteria
  bool quiet = false;
};

// Prints a table, CSV with units, to standard output: one row for each frame and grain, or for each contact of it. Throws UsageError for a grain
// that is in none of the frames, a jam that is not there, and like the libraries.
int follow(const FollowOptions& options);

}  // namespace jamscope
