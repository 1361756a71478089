// Algebraic connectivity (Fiedler, Czech. Math. J. 23, 298, 1973): the second smallest eigenvalue lambda_2 of the Laplacian
//
//   L_ij = -w_ij for partners, L_ii = sum over j of w_ij,
//
// of the largest component of the contacts with weight w > 0. It is small where the component nearly falls in two, and 0 for one that
// does; so the largest component is taken by itself. Walls are not part of it. By Lanczos iteration on the inverse (the library Spectra);
// seconds for 35,000 particles.
#pragma once
#include <span>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// In the unit of `weight` [C], or 1 where it is empty: every contact weighs 1. NaN where no two particles are joined, or where a
// thousand iterations do not bring it to 1e-12.
double algebraic_connectivity(const ContactGraph& graph, std::span<const double> weight = {});

}  // namespace jam
