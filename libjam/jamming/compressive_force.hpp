// Compressive force of each particle, N, from its contacts, walls included. With f the whole normal force of a contact
// (damping included, > 0 repulsive):
//
//   sum      sum of max(f, 0): what EDEM calls compressive force, and the quantity the paper puts its threshold on; a
//            particle squeezed with F from two sides has 2 F
//   max      largest max(f, 0)
//   signed_  sum of f: adhesion counts against the load
//
// Always computed from the contacts, even where the source recorded Particles::compressive_force: the contacts are what
// the clusters are made of, and the two must not disagree. Sums run over particle contacts by ascending partner, then
// wall contacts by role and record, in double.
#pragma once
#include <vector>

#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/criteria.hpp"

namespace jam {

std::vector<double> compressive_forces(const ContactGraph& graph, CompressiveMeasure measure);  // [N]

}  // namespace jam
