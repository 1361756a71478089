// How well the network conducts from blade to vessel when each repulsive contact is a resistor of conductance equal to its normal force
// f, the two walls the ends. With the potentials u of the particles, 1 at the blade and 0 at the vessel,
//   sum_w f_vw (u_v - u_w) = 0 for every particle v,   G = sum over the blade's contacts of f (1 - u_v),
// the Laplacian of the network with its ends held. Its inverse is the effective resistance between blade and vessel (Klein and Randic,
// J. Math. Chem. 12, 81, 1993). Parallel paths add, contacts in a row add their resistances, so that G is never above the maximum flow
// (max_flow.hpp). Solved by a sparse Cholesky factorisation.
#pragma once
#include "libjam/graph/contact_graph.hpp"

namespace jam {

// N; 0 where no path of repulsive contacts leads from a blade to the vessel.
double bridge_conductance(const ContactGraph& graph);

}  // namespace jam
