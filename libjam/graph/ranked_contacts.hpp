// The repulsive contacts between particles from the strongest to the weakest: the order in which a force network is built up. Equal
// forces stand by their contact.
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct RankedContact {
  double force;  // N, repulsive normal force, > 0
  ContactGraph::Vertex a, b;
  std::uint32_t contact;
};
using RankedContacts = std::vector<RankedContact>;

RankedContacts contacts_by_force(const ContactGraph& graph);

}  // namespace jam
