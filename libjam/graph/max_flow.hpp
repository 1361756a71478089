// How much the network can carry from the blade to the vessel. Each contact carries at most its capacity, in either direction; a
// particle passes on what it gets. The largest total equals the smallest sum of capacities whose contacts, taken away, part
// blade and vessel (Ford and Fulkerson, Can. J. Math. 8, 399, 1956). Walls are ends and not particles: nothing flows through
// a wall from one grain to the next.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct MaxFlow {
  double value = 0;                     // in the unit of the capacities
  std::vector<std::uint8_t> blade_side;  // [N] 1 where the blade still reaches: the smallest such side, which is unique
  std::vector<std::uint32_t> cut_pp, cut_pw;  // contacts of the cut, ascending: between the sides; with the wall of the other side
};

// Capacities >= 0, [C] and [W]; those of walls that are neither blade nor vessel do not matter. The cut is found with capacities
// rounded to 2^-60 of what blade or vessel are pressed with in all (minimum_cut.hpp); the value is the sum of the cut's.
MaxFlow max_flow(const ContactGraph& graph, std::span<const double> pp_capacity, std::span<const double> pw_capacity);

// Capacity: the repulsive normal force, N.
MaxFlow max_force_flow(const ContactGraph& graph);

// How many paths of repulsive contacts lead from the blade to the vessel without sharing a contact, and without sharing a
// particle (Menger, Fund. Math. 10, 96, 1927).
std::size_t contact_disjoint_load_paths(const ContactGraph& graph);
std::size_t particle_disjoint_load_paths(const ContactGraph& graph);

}  // namespace jam
