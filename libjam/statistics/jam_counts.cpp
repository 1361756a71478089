#include "libjam/statistics/jam_counts.hpp"

#include <limits>

namespace jam {

std::vector<std::uint32_t> jammed_histogram(std::span<const JamFrame> frames) {
  std::vector<std::uint32_t> histogram;
  for (const JamFrame& frame : frames) {
    if (frame.jammed.size() >= histogram.size()) histogram.resize(frame.jammed.size() + 1, 0);
    ++histogram[frame.jammed.size()];
  }
  return histogram;
}

double jammed_in_gap_share(std::span<const JamFrame> frames) {
  std::size_t samples = 0, in_gap = 0;
  for (const JamFrame& frame : frames) {
    samples += frame.jammed.size();
    for (const JammedSample& sample : frame.jammed) in_gap += sample.in_gap;
  }
  return samples > 0 ? static_cast<double>(in_gap) / static_cast<double>(samples)
                     : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jam
