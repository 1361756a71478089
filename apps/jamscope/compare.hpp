// jamscope compare: the jams of several runs side by side, and whether they differ.
#pragma once
#include <string>
#include <vector>

namespace jamscope {

// Where the jams come from. Those of every step have no sampling; those of frames are what sampled data have.
enum class CompareBy { step, frame };

struct CompareOptions {
  std::vector<std::string> runs;  // folders that hold a jam.h5, or such files
  std::vector<std::string> against;  // likewise: a second group, compared with `runs` as one; none: run by run
  bool paired = false;  // run k of `against` began from the bed that run k of `runs` began from
  CompareBy by = CompareBy::step;
  std::string stream = "global";  // of every step: global, particle or site
  bool json = false;
};

// Prints to standard output. Throws UsageError, and DataError where a run cannot be read or did not watch its grains.
int compare(const CompareOptions& options);

}  // namespace jamscope
