// An order of places in which neighbours in space are neighbours in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// Rows of `position` so that each `group` of them, counted from the first, is a compact box: the places are cut in two across their longest
// extent, each half likewise, and so on; as long as there are several groups between whole ones, nearly equal in number. Either side of the
// first cut across an axis comes from its far end up to the cut, so that two threads that take half of the groups each come to what they
// share last. Costs as much as a sort. Positions must be finite. The order does not depend on that of `position` unless places are equal.
std::vector<std::uint32_t> spatial_order(const std::vector<Vec3>& position, std::size_t group);

}  // namespace dem
