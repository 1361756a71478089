// Persistent homology of the force network (Kramar, Goullet, Kondic and Mischaikow, Physica D 283, 37, 2014): the contacts enter from the
// strongest to the weakest; parts and loops of the network are born at one force and die at a smaller one.
//
// The value of a contact is its repulsive normal force, of a particle the largest of its contacts, of a triangle of contacts the
// smallest of its three. Only repulsive contacts (f > 0) enter, and particles that have one; walls are not part of it. Who is born and
// dies at the same force is left out.
//
//   components          dimension 0: parts of the network. When two meet, the one born at the smaller force dies (elder rule)
//   loops               dimension 1 of the graph: each contact that closes a loop bears one, and none dies
//   loops_not_filled    dimension 1 of the flag complex: triangles are filled in, so that only loops of four and more remain; one dies
//                       when triangles fill it
//
// Time of sorting the contacts, and for loops_not_filled of reducing the boundaries of the triangles (Edelsbrunner, Letscher and
// Zomorodian, Discrete Comput. Geom. 28, 511, 2002), most of which come in pairs with their own weakest contact.
#pragma once
#include <vector>

#include "libjam/graph/ranked_contacts.hpp"

namespace jam {

struct PersistencePair {
  double birth = 0, death = 0;  // N, birth > death >= 0; death is 0 for what is there when all contacts are in
  double persistence() const { return birth - death; }
  friend auto operator<=>(const PersistencePair&, const PersistencePair&) = default;
};
using PersistenceDiagram = std::vector<PersistencePair>;  // by birth, then death, descending

// `ranked` = contacts_by_force(graph).
PersistenceDiagram persistence_of_components(const ContactGraph& graph, const RankedContacts& ranked);
PersistenceDiagram persistence_of_loops(const ContactGraph& graph, const RankedContacts& ranked);
PersistenceDiagram persistence_of_loops_not_filled(const ContactGraph& graph, const RankedContacts& ranked);

// Betti number: how many of them are there with all contacts of force >= `force` in, for force > 0.
std::size_t betti_number(const PersistenceDiagram& diagram, double force);

// N, sum of birth - death.
double total_persistence(const PersistenceDiagram& diagram);

}  // namespace jam
