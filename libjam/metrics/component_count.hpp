// Number of connected components of the contact network, single particles included (the zeroth Betti number). Walls
// join nothing.
#pragma once
#include "libjam/graph/components.hpp"

namespace jam {

inline double component_count(const ContactGraph& graph) {
  return static_cast<double>(connected_components(graph).size.size());
}

}  // namespace jam
