// The strongest bridge between the blade and the vessel, without any threshold: of all paths of contacts that lead from a blade
// through particles to the vessel, the one whose weakest contact is the strongest. Contacts with the two walls are part of the
// path; adhesion carries no load, so only repulsive contacts count. It is where blade and vessel come together when contacts are added
// from the strongest to the weakest (maximum spanning tree, Hu, Oper. Res. 9, 898, 1961). Takes the time of sorting the contacts.
#pragma once
#include <vector>

#include "libjam/graph/ranked_contacts.hpp"

namespace jam {

struct WidestPath {
  double strength = 0;                          // N, normal force of its weakest contact; 0 where no path carries load
  std::vector<ContactGraph::Vertex> particles;  // from the blade to the vessel; of the shortest such, the one of smallest rows
};
// `ranked` = contacts_by_force(graph).
WidestPath widest_path(const ContactGraph& graph, const RankedContacts& ranked);

}  // namespace jam
