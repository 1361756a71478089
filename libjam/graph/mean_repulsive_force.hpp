// Mean normal force of the repulsive particle contacts, N: <f> over contacts with f > 0. Adhesive contacts and walls
// are left out. NaN where nothing is compressed.
#pragma once
#include <limits>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double mean_repulsive_force(const ContactGraph& graph) {
  const ParticleContacts& contacts = graph.snapshot().pp;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double force = repulsive_force(contacts, c);
    sum += force;
    count += force > 0;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jam
