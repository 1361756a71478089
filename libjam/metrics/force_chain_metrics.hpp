// Linear force chains of the frame (libjam/graph/force_chains.hpp) by the usual rules: above the mean, within 45 degrees, three particles
// and more. Loads are stresses per volume of the sphere.
//
//   force_chain_count        chains
//   force_chain_share        share of all particles that are in one; NaN without particles
//   mean_force_chain_length  particles of a chain in the mean; NaN without chains
//   bridging_force_chains    chains of which one particle is pressed by the blade and one by the vessel
#pragma once
#include <algorithm>
#include <limits>

#include "libjam/graph/force_chains.hpp"

namespace jam {

inline double particles_in(const std::vector<ForceChain>& chains) {
  double sum = 0;
  for (const ForceChain& chain : chains) sum += double(chain.particles.size());
  return sum;
}
inline double force_chain_share(const ContactGraph& graph, const std::vector<ForceChain>& chains) {
  if (graph.vertex_count() == 0) return std::numeric_limits<double>::quiet_NaN();
  return particles_in(chains) / double(graph.vertex_count());
}
inline double mean_force_chain_length(const std::vector<ForceChain>& chains) {
  return chains.empty() ? std::numeric_limits<double>::quiet_NaN() : particles_in(chains) / double(chains.size());
}
inline double bridging_force_chains(const std::vector<ForceChain>& chains) {
  return double(std::count_if(chains.begin(), chains.end(), [](const ForceChain& c) { return c.at_blade && c.at_vessel; }));
}

}  // namespace jam
