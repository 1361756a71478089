// Part of an analysis: what was found in some frames of a run in a row, before anything is made of it in time. Parts of one run put together end
// to end give the analysis of the whole, byte for byte, wherever it was cut: events are found when all frames are there.
#pragma once
#include <filesystem>
#include <vector>

#include "libjam/analysis.hpp"

namespace jam {

struct PartialAnalysis {
  RunInfo run;
  Criteria criteria;
  std::uint64_t first_frame = 0;  // of the run
  std::vector<ExaminedFrame> frames;
  Series series;  // the rows that came with these frames
};

// Throws DataError naming the file, the place and what was expected.
void write_partial(const std::filesystem::path& path, const PartialAnalysis& part);
PartialAnalysis read_partial(const std::filesystem::path& path);

// Parts of one run and one set of criteria, in any order, without gaps or overlaps; throws DataError where they are not. `names` says what to call
// them.
PartialAnalysis joined(std::vector<PartialAnalysis> parts, const std::vector<std::string>& names);

// The whole analysis of the frames that a part has.
Analysis finish(const PartialAnalysis& part);

}  // namespace jam
