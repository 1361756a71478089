#include "libjam/statistics/rates.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double uniform(std::mt19937_64& random) { return (double(random() >> 11) + 0.5) * 0x1p-53; }

// Largest distance of the empirical distribution of sorted values from the exponential one with their mean.
double distance_from_exponential(const std::vector<double>& sorted) {
  const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / double(sorted.size());
  double distance = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const double fitted = -std::expm1(-sorted[k] / mean);
    distance = std::max({distance, fitted - double(k) / double(sorted.size()), double(k + 1) / double(sorted.size()) - fitted});
  }
  return distance;
}

}  // namespace

Rate poisson_rate(std::uint64_t events, double observed_time, double confidence) {
  if (!(observed_time > 0)) return {nan, nan, nan};
  const double n = double(events), tail = (1 - confidence) / 2;
  const auto quantile = [](double degrees, double p) { return boost::math::quantile(boost::math::chi_squared(degrees), p); };
  return {n / observed_time, events == 0 ? 0.0 : quantile(2 * n, tail) / (2 * observed_time),
          quantile(2 * n + 2, 1 - tail) / (2 * observed_time)};
}

double same_rate_probability(std::uint64_t events_a, double time_a, std::uint64_t events_b, double time_b) {
  const std::uint64_t total = events_a + events_b;
  if (total == 0 || !(time_a > 0) || !(time_b > 0)) return 1;
  const boost::math::binomial law(double(total), time_a / (time_a + time_b));
  const double seen = pdf(law, double(events_a)) * (1 + 1e-7);  // equal ones, but for rounding, count
  double p = 0;
  for (std::uint64_t k = 0; k <= total; ++k)
    if (const double here = pdf(law, double(k)); here <= seen) p += here;
  return std::min(p, 1.0);
}

double fano_factor(std::span<const double> start, double begin, double end, std::size_t windows) {
  if (start.empty() || windows < 2 || !(end > begin)) return nan;
  std::vector<double> counts(windows, 0.0);
  for (const double t : start)
    if (t >= begin && t < end) ++counts[std::min(std::size_t((t - begin) / (end - begin) * double(windows)), windows - 1)];
  const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / double(windows);
  double variance = 0;
  for (const double c : counts) variance += (c - mean) * (c - mean) / double(windows - 1);
  return variance / mean;
}

Overlapping overlapping(double rate, double mean_duration) {
  const double at_a_time = rate * mean_duration;
  return {-std::expm1(-at_a_time), rate * std::exp(-at_a_time), rate > 0 ? std::expm1(at_a_time) / rate : nan};
}

IndependenceTest exponential_distances(std::span<const double> start) {
  if (start.size() < 3) return {nan, nan};
  std::vector<double> distances;
  for (std::size_t k = 1; k < start.size(); ++k) distances.push_back(start[k] - start[k - 1]);
  std::sort(distances.begin(), distances.end());
  IndependenceTest test{distance_from_exponential(distances), 0};
  constexpr int trials = 4000;
  std::mt19937_64 random(1);
  int as_far = 0;
  std::vector<double> drawn(distances.size());
  for (int trial = 0; trial < trials; ++trial) {
    for (double& d : drawn) d = -std::log(uniform(random));
    std::sort(drawn.begin(), drawn.end());
    as_far += distance_from_exponential(drawn) >= test.distance;
  }
  test.p = double(as_far + 1) / double(trials + 1);
  return test;
}

BlockMean bootstrap_mean(std::span<const double> blocks, double confidence) {
  if (blocks.empty()) return {nan, nan, nan};
  const double mean = std::accumulate(blocks.begin(), blocks.end(), 0.0) / double(blocks.size());
  if (blocks.size() < 2) return {mean, nan, nan};
  constexpr std::size_t draws = 10000;
  std::mt19937_64 random(1);
  std::vector<double> means(draws);
  for (double& m : means) {
    double sum = 0;
    for (std::size_t k = 0; k < blocks.size(); ++k) sum += blocks[random() % blocks.size()];
    m = sum / double(blocks.size());
  }
  std::sort(means.begin(), means.end());
  const double tail = (1 - confidence) / 2;
  return {mean, means[std::size_t(tail * double(draws))], means[std::size_t((1 - tail) * double(draws)) - 1]};
}

}  // namespace jam
