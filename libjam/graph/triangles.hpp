// Triangles: three particles that touch each other in pairs, the shortest loops of a contact network. Every contact counts,
// whatever its force. Takes time in proportion to the contacts times their particles' number of partners.
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// [N] in how many triangles each particle is.
std::vector<std::uint32_t> triangles(const ContactGraph& graph);

}  // namespace jam
