// Core numbers: the largest k such that the particle belongs to the k-core, the largest part of the network in which every
// particle has at least k contacts with others of that part (Seidman, Social Networks 5, 269, 1983). Contacts with walls are not
// counted, adhesive ones are. Takes time in proportion to contacts (Batagelj and Zaversnik, arXiv:cs/0310049).
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// [N]
std::vector<std::uint32_t> core_numbers(const ContactGraph& graph);

}  // namespace jam
