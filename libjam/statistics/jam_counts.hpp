// How many particles are jammed at a time, and where (paper, Fig. 12 and the observation that jams sit in the gap).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/events/jam_frame.hpp"

namespace jam {

// [n] = number of frames with n jammed particles; empty without frames.
std::vector<std::uint32_t> jammed_histogram(std::span<const JamFrame> frames);

// Share of all jammed particle samples (particle x frame) that sit in the gap; NaN where there are none.
double jammed_in_gap_share(std::span<const JamFrame> frames);

}  // namespace jam
