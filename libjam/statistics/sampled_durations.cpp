#include "libjam/statistics/sampled_durations.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// tau of a chance p = 1 - exp(-D/tau) that the next sample sees the event no more.
double mean_of(double p, double interval) { return p < 1 ? -interval / std::log1p(-p) : 0.0; }
double seen_share(double mean, double interval) { return mean > 0 ? mean / interval * -std::expm1(-interval / mean) : 0.0; }

}  // namespace

double seen_with_samples(std::uint64_t n, double duration, double interval) {
  return std::max(0.0, 1 - std::abs(duration / interval - double(n)));
}

ExponentialDurations exponential_durations(std::span<const std::uint32_t> samples, double interval, double observed_time, double confidence,
                                           std::uint64_t cut_off) {
  if (samples.empty() || !(interval > 0)) return {nan, nan, nan, nan, {nan, nan, nan}};
  const double events = double(samples.size());
  double more = 0;  // samples beyond each one's first: failures before so many successes
  for (const std::uint32_t n : samples) more += double(n) - 1;
  ExponentialDurations found;
  found.mean = mean_of(events / (events + more), interval);
  found.unseen = 1 - seen_share(found.mean, interval);
  // Clopper and Pearson's bounds of p.
  const auto mean_between = [&](double tail) {
    const double p_high = more > 0 ? boost::math::quantile(boost::math::beta_distribution(events, more), 1 - tail) : 1.0;
    const double p_low = boost::math::quantile(boost::math::beta_distribution(events, more + 1), tail);
    return std::pair(mean_of(p_high, interval), mean_of(p_low, interval));
  };
  const double outside = 1 - confidence;
  std::tie(found.low, found.high) = mean_between(outside / 2);
  const Rate seen = poisson_rate(samples.size() + cut_off, observed_time, 1 - outside / 2);
  const auto [shortest, longest] = mean_between(outside / 4);
  found.rate = {seen.value / seen_share(found.mean, interval), seen.low / seen_share(longest, interval),
                seen.high / seen_share(shortest, interval)};
  return found;
}

ExponentialDurations corrected_for_sampling(std::span<const JamEvent> events, double interval, double observed_time, double confidence) {
  std::vector<std::uint32_t> samples;
  std::uint64_t cut_off = 0;
  for (const JamEvent& e : events) {
    if (e.open_at_start) continue;
    if (e.open_at_end) {
      ++cut_off;
    } else {
      samples.push_back(e.samples);
    }
  }
  return exponential_durations(samples, interval, observed_time, confidence, cut_off);
}

}  // namespace jam
