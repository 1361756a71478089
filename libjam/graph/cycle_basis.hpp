// Lengths of the cycles of a minimum cycle basis: the shortest cycles from which all others are made by adding contacts modulo two. In a
// packing they are the loops that grains close around pores (Tordesillas et al., Phys. Rev. E 81, 011302, 2010). The basis is not
// unique, but how many cycles of each length it has is. Every contact counts, walls close nothing.
//
// Of each particle and each contact near it the cycle through both along shortest paths (Horton, SIAM J. Comput. 16, 358, 1987), the
// shortest first, kept where it is independent of those before. Cycles longer than `longest` are not looked for, which changes nothing in the
// counts of the others.
#pragma once
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// [longest + 1] how many cycles of each length the basis has; 0 for lengths below 3.
std::vector<std::size_t> basis_cycle_counts(const ContactGraph& graph, std::size_t longest);

}  // namespace jam
