// What joins the blade and the vessel (libjam/graph/widest_path.hpp, max_flow.hpp). All 0 where no path of repulsive contacts
// leads from one to the other.
//
//   bridge_strength                N, weakest contact of the strongest path
//   bridge_flow                    N, maximum flow with the repulsive normal forces as capacities
//   contact_disjoint_load_paths    paths that share no contact
//   particle_disjoint_load_paths   paths that share no particle
#pragma once
#include "libjam/graph/max_flow.hpp"
#include "libjam/graph/widest_path.hpp"

namespace jam {

inline double bridge_strength(const ContactGraph& graph) { return widest_path(graph).strength; }
inline double bridge_flow(const ContactGraph& graph) { return max_force_flow(graph).value; }

}  // namespace jam
