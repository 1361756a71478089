#include "libjam/events/jam_frame.hpp"

#include <algorithm>

namespace jam {

double sampling_interval(std::span<const JamFrame> frames) {
  if (frames.size() < 2) return 0;
  std::vector<double> distance(frames.size() - 1);
  for (std::size_t k = 0; k < distance.size(); ++k) distance[k] = frames[k + 1].time - frames[k].time;
  const auto middle = distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2);
  std::nth_element(distance.begin(), middle, distance.end());
  if (distance.size() % 2 == 1) return *middle;
  return (*std::max_element(distance.begin(), middle) + *middle) / 2;
}

bool gap_before(std::span<const JamFrame> frames, std::size_t k, double sampling_interval) {
  return frames[k].time - frames[k - 1].time > 1.5 * sampling_interval;
}

}  // namespace jam
