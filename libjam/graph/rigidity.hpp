// Rigidity of the network to first order: which motions of the particles leave all contacts as they are, and which contact forces balance
// by themselves.
//
// Each particle moves and turns: 6 N degrees of freedom. A contact that sticks forbids its two surfaces any relative velocity (3 rows of
// the rigidity matrix), one that slides only along its normal (1 row: at its Coulomb limit friction answers with a given force, not with a
// constraint). Walls stand still and hold what touches them. Every recorded contact counts, adhesive ones included; where the source knows
// no sliding, all stick.
//
//   rows            constraints
//   zero_modes      6 N - rank: motions that no contact resists, those of the whole as a rigid body included
//   self_stresses   rows - rank: independent sets of contact forces in balance without any load
//
// Rows less rank and degrees of freedom less rank give Calladine's count (Int. J. Solids Struct. 14, 161, 1978). The pebble game counts
// right only in generic networks in two dimensions; here the rank is that of the matrix. Three spheres that touch each other have
// three motions beyond the rigid ones, four in a tetrahedron none.
//
// The rank is the number of eigenvalues of R^T R above 1e-12 of its largest diagonal entry, counted by the signs of a sparse LDL^T
// factorisation (Sylvester's law of inertia); turns are measured by the mean radius times their angle. Particles with a single sticking
// contact are taken off first: they add its three rows to the rank. Minutes for 35,000 particles.
#pragma once
#include <cstdint>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Rigidity {
  std::size_t degrees_of_freedom = 0, rows = 0, rank = 0;
  std::size_t zero_modes() const { return degrees_of_freedom - rank; }
  std::size_t self_stresses() const { return rows - rank; }
};

// Contacts with walls whose direction the source does not know (neither point nor normal) are left out.
Rigidity rigidity(const ContactGraph& graph);

// Coordination at which constraints and degrees of freedom are as many: Z = (d + 1) + 2 n_m/d in d = 3 dimensions with n_m =
// `sliding_per_particle` sliding contacts per particle, each of which takes one constraint away (the Coulomb equality). 4 where none slides.
inline double isostatic_coordination(double sliding_per_particle) {
  return 4 + 2 * sliding_per_particle / 3;
}

}  // namespace jam
