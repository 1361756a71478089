// How far each grain may go before the lists of what may touch must be built again.
#pragma once
#include <cstddef>
#include <vector>

namespace dem {

// m, [N], for rows in the order of space (spatial_order.hpp) whose grains have travelled so far, m, while the last lists lasted: half the
// skin for the groups of rows whose grains went furthest, less in proportion where they went less, but at least a tenth of the skin, and
// half the thinnest that there may be. Without `travelled` half the skin for all. Two grains must be in a list together if their
// surfaces are less apart than the sum of their reaches; the list holds while none has gone further than its own.
std::vector<double> reaches(const std::vector<double>& travelled, std::size_t n, double skin, double thinnest);

}  // namespace dem
