// Where along the blade's edge grains jam, and how fast they go there.
#pragma once
#include <cstddef>
#include <span>

#include "libjam/events/event.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct JamPlaces {
  // Heights of the grains' peaks along the blade, those within its height: are they spread evenly? Probability of a distance from the even
  // distribution as large as theirs (Kolmogorov and Smirnov); NaN without any, or where the blade's height is not known.
  std::size_t heights = 0;
  double even_p = 0;
  // Of all samples of jammed grains: quartiles of the speed over that of the blade's tip, and the shares slower than a quarter of it, faster than
  // three quarters, and between, where a grain goes that rolls between the tip and the wall (one half). NaN where speeds are not known.
  double lower_quartile = 0, median = 0, upper_quartile = 0;
  double slow = 0, between = 0, fast = 0;
};

JamPlaces jam_places(std::span<const Track> tracks, const Gap& gap);

}  // namespace jam
