// Share of particles that their contacts cannot hold, with friction (libjam/graph/rattlers.hpp). NaN without particles.
#pragma once
#include <limits>
#include <numeric>

#include "libjam/graph/rattlers.hpp"

namespace jam {

inline double rattler_share(const ContactGraph& graph) {
  const std::vector<std::uint8_t> loose = rattlers(graph);
  if (loose.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(loose.begin(), loose.end(), 0.0) / double(loose.size());
}

}  // namespace jam
