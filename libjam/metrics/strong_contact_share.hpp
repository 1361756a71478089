// Share of the repulsive particle contacts that are stronger than their mean, f > <f> (Radjai et al., PRL 77, 274,
// 1996). Walls and adhesive contacts are left out. NaN where nothing is compressed.
#pragma once
#include "libjam/graph/mean_repulsive_force.hpp"

namespace jam {

inline double strong_contact_share(const ContactGraph& graph) {
  const ParticleContacts& contacts = graph.snapshot().pp;
  const double mean = mean_repulsive_force(graph);
  std::size_t strong = 0, repulsive = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double force = repulsive_force(contacts, c);
    strong += force > mean;
    repulsive += force > 0;
  }
  return repulsive > 0 ? static_cast<double>(strong) / static_cast<double>(repulsive) : mean;
}

}  // namespace jam
