// jamscope bench: how fast this machine steps a case, and where the time goes.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/console.hpp"

namespace jamscope {

struct BenchOptions {
  std::string case_path;
  std::vector<std::string> overrides;  // "key=value", see read_case_file
  std::string bed_cache;               // folder of settled beds, or empty
  int threads = 1;
  // Whatever the case says, not both: every contact at every step; contacts at their own rate.
  bool uniform = false, at_own_rate = false;
  double seconds = 10;   // s of wall time, measured
  double warm_up = 2;    // s of wall time before that
  std::optional<double> beads;  // the bed as deep as so many grains make it
  bool json = false;
  bool quiet = false;
  LogFormat log_format = LogFormat::text;
};

// Prints to standard output. Throws like the libraries, and UsageError. Nothing is stored but the settled bed.
int bench(const BenchOptions& options);

}  // namespace jamscope
