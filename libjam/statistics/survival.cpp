#include "libjam/statistics/survival.hpp"

#include <algorithm>
#include <limits>

namespace jam {

std::vector<SurvivalClass> survival_classes(std::span<const JamEvent> events, std::span<const double> upper_bounds,
                                            double sampling_interval, double observed_time) {
  std::vector<SurvivalClass> classes(upper_bounds.size() + 1);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    classes[k].low = k > 0 ? upper_bounds[k - 1] : 0.0;
    classes[k].high = k < upper_bounds.size() ? upper_bounds[k] : std::numeric_limits<double>::infinity();
  }
  for (const JamEvent& event : events) {
    const double time = event.survival_time + 1e-3 * sampling_interval;
    const auto bound = std::upper_bound(upper_bounds.begin(), upper_bounds.end(), time);
    SurvivalClass& its_class = classes[static_cast<std::size_t>(bound - upper_bounds.begin())];
    ++its_class.events;
    its_class.share_of_jam_time += event.survival_time;
  }
  const double total = jammed_time(events);
  for (SurvivalClass& c : classes) {
    c.frequency = observed_time > 0 ? c.events / observed_time : 0.0;
    c.share_of_jam_time = total > 0 ? c.share_of_jam_time / total : 0.0;
  }
  return classes;
}

double jammed_time(std::span<const JamEvent> events) {
  double sum = 0;
  for (const JamEvent& event : events) sum += event.survival_time;
  return sum;
}

}  // namespace jam
