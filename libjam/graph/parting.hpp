// Contacts and particles that hold the network together alone: without a parting contact (a bridge of graph theory, a word that here
// is taken by the paths from blade to vessel) its component falls in two, without a parting particle (an articulation point) in two or
// more. Every contact counts, whatever its force; walls join nothing. Takes time in proportion to the contacts (Boost.Graph's
// biconnected components, after Hopcroft and Tarjan, Commun. ACM 16, 372, 1973).
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Parting {
  std::vector<std::uint8_t> contact;   // [C] 1 for a parting contact
  std::vector<std::uint8_t> particle;  // [N] 1 for a parting particle
};
Parting parting(const ContactGraph& graph);

}  // namespace jam
