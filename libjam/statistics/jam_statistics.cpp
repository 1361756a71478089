#include "libjam/statistics/jam_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jam {

std::vector<Lifetime> lifetimes_of(std::span<const StepJam> jams) {
  std::vector<Lifetime> lifetimes;
  for (const StepJam& jam : jams)
    if (!jam.open_at_start) lifetimes.push_back({jam.duration, !jam.open_at_end});
  return lifetimes;
}

JamStatistics jam_statistics(std::span<const StepJam> jams, double begin, double end) {
  JamStatistics s;
  std::vector<double> starts;
  for (const StepJam& jam : jams) {
    s.jammed_time += jam.duration;
    s.longest = std::max(s.longest, jam.duration);
    if (!jam.open_at_start) starts.push_back(jam.start);
  }
  std::sort(starts.begin(), starts.end());
  const std::vector<Lifetime> lifetimes = lifetimes_of(jams);
  s.at_a_time = s.jammed_time / (end - begin);
  s.rate = poisson_rate(starts.size(), end - begin);
  s.survival = kaplan_meier(lifetimes);
  s.median = when_left(s.survival);
  s.fano = fano_factor(starts, begin, end, 20);
  s.independence = exponential_distances(starts);
  constexpr std::size_t enough = 10;
  if (lifetimes.size() < enough) return s;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Lifetime& l : lifetimes) shortest = std::min(shortest, l.time);
  for (const DurationLaw& law : duration_laws()) {
    const DurationFit fit = law.fit(lifetimes, shortest);
    s.laws.push_back({std::string(law.name), fit, 2.0 * law.parameters - 2 * fit.log_likelihood});
  }
  return s;
}

}  // namespace jam
