// The largest core number of the contact network, its degeneracy (libjam/graph/core_numbers.hpp). NaN without particles.
#pragma once
#include <algorithm>
#include <limits>

#include "libjam/graph/core_numbers.hpp"

namespace jam {

inline double largest_core_number(const ContactGraph& graph) {
  const std::vector<std::uint32_t> core = core_numbers(graph);
  return core.empty() ? std::numeric_limits<double>::quiet_NaN() : double(*std::max_element(core.begin(), core.end()));
}

}  // namespace jam
