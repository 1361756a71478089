// jamscope analyze: the analysis of stored snapshots, the same as that of a running simulation.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/jamscope/console.hpp"
#include "apps/jamscope/stored_run.hpp"
#include "libjam/analysis.hpp"
#include "libjam/partial_file.hpp"

namespace jamscope {

struct AnalyzeOptions {
  InputOptions input;
  std::string output;                  // folder
  std::string criteria;                // criteria file, or empty
  std::vector<std::string> overrides;  // of criteria, "key=value"
  std::string frames;                  // "A:B": from frame A to before frame B, either may be left out; empty: all
  bool partial = false;                // write partial.h5 for `merge` and nothing else
  bool overwrite = false;
  int threads = 1;                     // frames at a time
  bool quiet = false;
  LogFormat log_format = LogFormat::text;
  std::vector<std::string> command_line;
};

// Writes the result files into options.output and prints what was found. Returns the exit code; throws like the
// libraries, and UsageError.
int analyze(const AnalyzeOptions& options);

// What is found in these frames of a stored run, up to `threads` of them examined at a time, and the rows of the series that came with them.
// `seen` is called for each frame, in order; what it throws comes out here.
jam::PartialAnalysis examine_frames(const jam::SnapshotSource& source, const jam::Pipeline& pipeline, FrameRange range, int threads,
                                    const std::function<void(const jam::FrameSummary&)>& seen);

struct MergeOptions {
  std::vector<std::string> parts;  // partial.h5 of `analyze --partial`, or folders that hold one
  std::string output;              // folder
  bool partial = false;            // write the parts as one part
  bool overwrite = false;
  bool quiet = false;
  std::vector<std::string> command_line;
};

// Puts parts of one run together and writes the result files as analyze() would have for all their frames at once.
int merge(const MergeOptions& options);

// The few lines with which analyze and simulate end.
std::string result_text(const jam::Analysis& analysis);

}  // namespace jamscope
