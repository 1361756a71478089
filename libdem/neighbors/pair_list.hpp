// Which pairs of grains may touch before the list is built again: a Verlet list from a grid of cells.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// Pairs (i, j), i < j, whose surfaces are less than `skin` apart, sorted by i, then j, in compressed rows: the pairs of i are
// [begin[i], begin[i+1]).
struct PairList {
  std::vector<std::uint32_t> begin;          // [N+1]
  std::vector<std::uint32_t> first, second;  // [P] i and j
  std::size_t size() const { return first.size(); }
};

// Every pair once, independent of the number of threads. Cost O(N). Positions must be finite (the guards of the simulation
// see to that).
PairList build_pair_list(const std::vector<Vec3>& position, const std::vector<double>& radius, double skin);

}  // namespace dem
