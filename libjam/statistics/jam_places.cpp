#include "libjam/statistics/jam_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Largest distance between the empirical distribution of sorted values in [0, 1] and the even one.
double distance_from_even(std::span<const double> sorted) {
  double distance = 0;
  const double n = double(sorted.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) distance = std::max({distance, sorted[k] - double(k) / n, double(k + 1) / n - sorted[k]});
  return distance;
}

// Probability of a distance as large, of n even values: Kolmogorov's limit with Stephens' correction for finite n (J. R. Stat. Soc. B 32, 115, 1970).
double probability_of(double distance, double n) {
  const double scaled = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
  if (scaled < 0.2) return 1;  // but for 1e-12
  double sum = 0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2 * k * k * scaled * scaled);
  return sum;
}

// Between the two nearest by straight line.
double quantile(std::span<const double> sorted, double share) {
  const double place = share * double(sorted.size() - 1);
  const auto low = std::size_t(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - double(low)) * (sorted[high] - sorted[low]);
}

}  // namespace

JamPlaces jam_places(std::span<const Track> tracks, const Gap& gap) {
  std::vector<double> height, speed;
  for (const Track& track : tracks) {
    const Track::Point* peak = nullptr;
    for (const Track::Point& point : track.points) {
      if (peak == nullptr || point.compressive_force > peak->compressive_force) peak = &point;
      if (std::isfinite(point.speed_over_tip)) speed.push_back(double{point.speed_over_tip});
    }
    if (peak == nullptr || !(gap.z_high > gap.z_low)) continue;
    const double along = (double{peak->from_blade.z()} - gap.z_low) / (gap.z_high - gap.z_low);
    if (along >= 0 && along <= 1) height.push_back(along);
  }
  std::sort(height.begin(), height.end());
  std::sort(speed.begin(), speed.end());
  JamPlaces places{height.size(), nan, nan, nan, nan, nan, nan, nan};
  if (!height.empty())
    places.even_p = probability_of(distance_from_even(height), double(height.size()));
  if (speed.empty()) return places;
  places.lower_quartile = quantile(speed, 0.25);
  places.median = quantile(speed, 0.5);
  places.upper_quartile = quantile(speed, 0.75);
  const auto below = [&](double limit) { return double(std::lower_bound(speed.begin(), speed.end(), limit) - speed.begin()) / double(speed.size()); };
  places.slow = below(0.25);
  places.fast = 1 - below(0.75);
  places.between = 1 - places.slow - places.fast;
  return places;
}

}  // namespace jam
