// Mean stress in each particle from the forces of its contacts (Drescher and de Josselin de Jong, J. Mech. Phys. Solids 20, 337, 1972;
// Peters et al., Phys. Rev. E 72, 041307, 2005):
//
//   sigma_i = 1/V_i sum_c sym(r_ic (x) f_ic)
//
// f_ic is the whole force on the particle in contact c, adhesion and friction included where the source knows them; r_ic leads from its
// centre to the contact point, which divides the branch in the ratio of the radii and lies one radius away on a wall whose point the
// source does not know. Compression is negative. The part of r (x) f that is not symmetric is an unbalanced torque and left out.
#pragma once
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// m^3, [N] of the spheres.
std::vector<double> sphere_volumes(const Snapshot& snapshot);

// Pa, [N]. Contacts with walls whose direction the source does not know (neither point nor normal) are left out.
std::vector<Eigen::Matrix3d> particle_stress(const ContactGraph& graph, std::span<const double> volume);

// The most compressive principal stress: what a particle carries and along which line.
struct Load {
  double pressure = 0;           // Pa, > 0; 0 where nothing compresses the particle
  Vec3 direction = Vec3::Zero();  // unit, its sign means nothing; zero where the load has no direction of its own
};
// [N]. Less than 1e-12 of the largest principal stress is rounding and counts as none. Where two principal stresses are the most
// compressive within 1e-9 of each other, no direction is.
std::vector<Load> particle_loads(std::span<const Eigen::Matrix3d> stress);

}  // namespace jam
