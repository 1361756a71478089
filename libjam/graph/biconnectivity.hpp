// Contacts and particles that hold the network together alone. Without a cut edge (which graph theory also calls a bridge, a word that
// here is taken by what joins blade and vessel) its component falls in two, without an articulation point in two or more. Every contact
// counts, whatever its force; walls join nothing. Takes time in proportion to the contacts (Boost.Graph's biconnected components, after
// Hopcroft and Tarjan, Commun. ACM 16, 372, 1973).
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Biconnectivity {
  std::vector<std::uint8_t> cut_edge;            // [C] 1 for a contact that is one
  std::vector<std::uint8_t> articulation_point;  // [N] 1 for a particle that is one
};
Biconnectivity biconnectivity(const ContactGraph& graph);

}  // namespace jam
