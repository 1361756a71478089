// Fabric tensor of the particle contacts: how their directions are spread (Oda, Soils Found. 12, 17, 1972; Kanatani, Int. J. Eng.
// Sci. 22, 149, 1984). With n the unit vector between the centres of the two particles and weights w,
//
//   Phi = sum w n (x) n / sum w,      D = 15/2 (Phi - I/3),      anisotropy = sqrt(3/2 D:D)
//
// D is the deviator of the second-order distribution of directions; the anisotropy is 0 where directions are equally frequent, and
// for directions spread about an axis the coefficient a of 1 + a (3 cos^2 - 1)/2 in the probability. Weights: 1 for each contact, whatever
// its force, or the repulsive normal force. Strong contacts press with more than the mean of those that press, weak ones press with
// no more than it (Radjai et al., PRL 80, 61, 1998). Walls are left out. NaN where there is no such contact.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "libjam/graph/mean_repulsive_force.hpp"

namespace jam {

// weight(c) >= 0 of contact c. Contacts of particles with one centre have no direction and are left out.
template <class Weight>
Eigen::Matrix3d fabric_tensor(const ContactGraph& graph, Weight weight) {
  const Snapshot& s = graph.snapshot();
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0, total = 0;
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const double w = weight(c);
    const Vec3 branch = s.particles.position[s.pp.row[c][1]].cast<double>() - s.particles.position[s.pp.row[c][0]].cast<double>();
    const double square = branch.squaredNorm();
    if (!(w > 0) || !(square > 0)) continue;
    const Vec3 weighted = w / square * branch;
    xx += weighted.x() * branch.x(), yy += weighted.y() * branch.y(), zz += weighted.z() * branch.z();
    xy += weighted.x() * branch.y(), xz += weighted.x() * branch.z(), yz += weighted.y() * branch.z();
    total += w;
  }
  Eigen::Matrix3d sum;
  sum << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return sum / (total > 0 ? total : std::numeric_limits<double>::quiet_NaN());
}

inline double anisotropy(const Eigen::Matrix3d& fabric) {
  const Eigen::Matrix3d deviator = 7.5 * (fabric - Eigen::Matrix3d::Identity() / 3);
  return std::sqrt(1.5 * deviator.squaredNorm());
}

inline double fabric_anisotropy(const ContactGraph& graph) {
  return anisotropy(fabric_tensor(graph, [](std::size_t) { return 1.0; }));
}
inline double force_fabric_anisotropy(const ContactGraph& graph) {
  return anisotropy(fabric_tensor(graph, [&](std::size_t c) { return repulsive_force(graph.snapshot().pp, c); }));
}
inline double strong_fabric_anisotropy(const ContactGraph& graph) {
  const double mean = mean_repulsive_force(graph);
  return anisotropy(fabric_tensor(graph, [&](std::size_t c) { return repulsive_force(graph.snapshot().pp, c) > mean ? 1.0 : 0.0; }));
}
inline double weak_fabric_anisotropy(const ContactGraph& graph) {
  const double mean = mean_repulsive_force(graph);
  return anisotropy(fabric_tensor(graph, [&](std::size_t c) {
    const double force = repulsive_force(graph.snapshot().pp, c);
    return force > 0 && force <= mean ? 1.0 : 0.0;
  }));
}

}  // namespace jam
