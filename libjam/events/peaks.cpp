#include "libjam/events/peaks.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace jam {

std::vector<Peak> peaks(std::span<const double> series) {
  const std::size_t n = series.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return series[a] > series[b]; });
  // Stretches above the level: known by their ends, which know the other end and the peak.
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> other(n, none), peak(n, none);
  std::vector<Peak> found;
  const auto older = [&](std::size_t a, std::size_t b) { return series[a] > series[b] || (series[a] == series[b] && a < b); };
  const auto die = [&](std::size_t at, double level) {
    if (series[at] > level) found.push_back({at, series[at], level});
  };
  for (const std::size_t k : order) {
    std::size_t first = k, last = k, top = k;
    if (k > 0 && other[k - 1] != none) {
      first = other[k - 1];
      top = peak[k - 1];
    }
    if (k + 1 < n && other[k + 1] != none) {
      last = other[k + 1];
      const std::size_t right = peak[k + 1];
      if (top == k) {
        top = right;
      } else {
        const bool left_is_older = older(top, right);
        die(left_is_older ? right : top, series[k]);
        top = left_is_older ? top : right;
      }
    }
    other[first] = last;
    other[last] = first;
    peak[first] = peak[last] = top;
  }
  if (n > 0) found.push_back({peak[0], series[peak[0]], series[order.back()]});
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.birth != b.birth ? a.birth > b.birth : a.at < b.at; });
  return found;
}

std::vector<std::size_t> counts_above(std::span<const Peak> peaks, std::span<const double> thresholds) {
  std::vector<double> births, deaths;
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    births.push_back(peaks[k].birth);
    if (k > 0) deaths.push_back(peaks[k].death);  // the highest is above every threshold below it
  }
  std::sort(births.begin(), births.end());
  std::sort(deaths.begin(), deaths.end());
  std::vector<std::size_t> counts;
  for (const double t : thresholds) {
    const auto born = births.end() - std::upper_bound(births.begin(), births.end(), t);
    const auto dead = deaths.end() - std::upper_bound(deaths.begin(), deaths.end(), t);
    counts.push_back(std::size_t(born - dead));
  }
  return counts;
}

}  // namespace jam
