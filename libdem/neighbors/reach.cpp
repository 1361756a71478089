#include "libdem/neighbors/reach.hpp"

#include <algorithm>

namespace dem {
namespace {

// Rows that share a reach: a cube of eight grains' edge, so that a grain that begins to move has one already where others beside it
// moved. With 64 lists lasted a third as long, with the blade in C.
constexpr std::size_t group_rows = 512;
// A group may go this much further than it went, in proportion to the furthest.
constexpr double allowance = 1.5;
constexpr double least = 0.2;  // of half the skin

}  // namespace

std::vector<double> reaches(const std::vector<double>& travelled, std::size_t n, double skin, double thinnest) {
  std::vector<double> reach(n, 0.5 * skin);
  if (travelled.empty()) return reach;
  const double furthest = *std::max_element(travelled.begin(), travelled.end());
  if (!(furthest > 0)) return reach;
  const double least_share = std::min(std::max(least, thinnest / skin), 1.0);
  for (std::size_t begin = 0; begin < n; begin += group_rows) {
    const std::size_t end = std::min(begin + group_rows, n);
    const double far = *std::max_element(travelled.begin() + std::ptrdiff_t(begin), travelled.begin() + std::ptrdiff_t(end));
    const double share = std::clamp(allowance * far / furthest, least_share, 1.0);
    std::fill(reach.begin() + std::ptrdiff_t(begin), reach.begin() + std::ptrdiff_t(end), share * 0.5 * skin);
  }
  return reach;
}

}  // namespace dem
