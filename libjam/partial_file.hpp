// Part of an analysis: what was found in some frames of a run in a row, before anything is made of it in time. Parts of one run put together end
// to end give the analysis of the whole, byte for byte, wherever it was cut: events are found when all frames are there.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "libjam/analysis.hpp"

namespace jam {

struct PartialAnalysis {
  RunInfo run;
  Criteria criteria;
  std::uint64_t first_frame = 0;  // of the run
  std::vector<ExaminedFrame> frames;  // by add_frame(); the first has ExaminedFrame::flow of all of them
  Series series;  // the rows that came with these frames
  std::size_t loaded = 0;  // grains in ExaminedFrame::loaded of all frames
  std::vector<std::string> inputs, command_line;  // where the frames were read from, and by which command; of joined parts, those of the first
};

// The next frame. Of the loaded grains of all frames the part keeps a few times LoadedGrains::most, the strongest: more than the whole analysis will, so
// that neither where a run is cut nor how long it is makes a difference to it. The sums of the flow go to the first frame, which is exact.
void add_frame(PartialAnalysis& part, ExaminedFrame frame);

// Throws DataError naming the file, the place and what was expected.
void write_partial(const std::filesystem::path& path, const PartialAnalysis& part);
PartialAnalysis read_partial(const std::filesystem::path& path);

// Parts of one run and one set of criteria, in any order, without gaps or overlaps; throws DataError where they are not. `names` says what to call
// them.
PartialAnalysis joined(std::vector<PartialAnalysis> parts, const std::vector<std::string>& names);

// The whole analysis of the frames that a part has.
Analysis finish(const PartialAnalysis& part);

}  // namespace jam
