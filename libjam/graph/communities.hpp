// Communities of the force network under the geographical null model (Bassett, Owens, Porter, Manning and Daniels, Soft Matter 11, 2731,
// 2015): groups of particles whose contacts carry more than the average. The partition c is sought that has the largest
//
//   Q = sum over contacts (i, j) with c_i = c_j of (f_ij - gamma <f>)
//
// with the repulsive normal force f (0 for an adhesive contact, which counts as a contact all the same), its mean <f> over the repulsive
// contacts, and the resolution gamma. Only who touches can belong together, so the null model is the contact network itself. Divided by
// the sum of all f, Q is the modularity, at most 1.
//
// The largest Q cannot be found for certain in any useful time. This is the search of Traag, Waltman and van Eck (Sci. Rep. 9, 5233, 2019,
// "Leiden": local moves, refinement, aggregation, again and again until nothing improves) without its dice: particles are visited in
// eight orders that follow from the network and its forces alone, and the best partition is taken, so that neither the order of the
// particles nor the number of threads changes it. Every community is connected.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Communities {
  std::vector<std::uint32_t> label;  // [N], the largest community is 0, ties by their smallest row
  std::vector<std::uint32_t> size;   // [K], descending
  double quality = 0;                // N, Q
  double modularity = 0;             // Q over the sum of all repulsive forces; NaN without any
};

Communities communities(const ContactGraph& graph, double resolution = 1);

// Q of any partition, N.
double community_quality(const ContactGraph& graph, std::span<const std::uint32_t> label, double resolution = 1);

}  // namespace jam
