// An order of places in which neighbours in space are neighbours in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// Rows of `position` along Morton's curve through cells of the given edge (m): cells whose coordinates' bits,
// interleaved, come first, come first; within a cell by row. Costs a sort. Positions must be finite.
std::vector<std::uint32_t> spatial_order(const std::vector<Vec3>& position, double edge);

}  // namespace dem
