// jamscope simulate: the run, its analysis in place, and its results.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/console.hpp"

namespace jamscope {

struct SimulateOptions {
  std::string case_path;
  std::string output;  // folder
  int threads = 1;
  bool resume = false;                 // continue from the last checkpoint in `output`
  std::optional<double> until;         // s, stop there instead of at the case's duration
  std::vector<std::string> overrides;  // "key=value", see read_case_file
  std::string bed_cache;               // folder of settled beds, or empty
  bool quiet = false;
  LogFormat log_format = LogFormat::text;
  bool overwrite = false;  // `output` may hold an earlier run
  std::vector<std::string> command_line;
};

// Returns the exit code: 0 when the end (or `until`, or a stop signal after its checkpoint) was reached. Throws like
// the libraries, and UsageError.
int simulate(const SimulateOptions& options);

}  // namespace jamscope
