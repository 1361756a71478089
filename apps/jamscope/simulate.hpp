// jamscope simulate: the run, its analysis in place, and its results.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/console.hpp"
#include "apps/jamscope/host.hpp"
#include "libjam/analysis.hpp"

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

struct SimulateResult {
  bool whole = false;  // the end or `until` was reached; else it was stopped, and `resume` goes on from there
  double time = 0;     // s
  jam::RunInfo info;
  jam::Analysis analysis;
  std::string energy;  // energy_text()
};

// Called with every frame that this run records, the first one too, as soon as it is in the file; false: stop, as a signal would.
using OnFrame = std::function<bool(const std::shared_ptr<const jam::Snapshot>& frame, std::size_t number, const jam::RunInfo& info)>;

// The same with its result files, but without signals, and silent on standard output. Throws like simulate(), and Interrupted where the host
// stopped it while the bed settled.
SimulateResult run_simulation(const SimulateOptions& options, const CaseFile& file, Console& console, const Host& host = {}, const OnFrame& on_frame = {});

}  // namespace jamscope
