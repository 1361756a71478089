// How much of its friction each particle contact uses: the tangential force over the limit mu P of its friction. P is the repulsive part of
// the elastic normal force F: with the work of adhesion W between the two materials, the pull-off force F_c = 3/2 pi W R* of JKR theory and
// R* = R_i R_j/(R_i + R_j),
//
//   P = F + 2 F_c + 2 sqrt(F_c (F + F_c))        (Thornton, J. Phys. D 24, 1942, 1991, Eq. 15; EDEM's limit)
//
// which is 4 E* a^3/(3 R*) on the branch of stable contacts, and F itself (Coulomb's limit) without adhesion, where pulling contacts have
// none. Whether a contact slides is what its source recorded (sliding_share.hpp): other laws have other limits, such as mu (F + 2 F_c).
// NaN where the source does not know the tangential force, the materials or their friction, and where there is no limit.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// N, P of an elastic force and a pull-off force.
inline double repulsive_part(double force, double pull_off) {
  return force + 2 * pull_off + 2 * std::sqrt(std::max(pull_off * (force + pull_off), 0.0));
}

// [C]
inline std::vector<double> mobilisation(const ContactGraph& graph, const RunInfo& run) {
  const Snapshot& s = graph.snapshot();
  std::vector<double> used(s.pp.size(), std::numeric_limits<double>::quiet_NaN());
  if (!present(s.pp.tangential_force, s.pp.size())) return used;
  const bool one_material = run.interactions.size() == 1, materials = present(s.particles.material, s.particles.size());
  if (!one_material && (!materials || run.interactions.empty())) return used;
  for (std::size_t c = 0; c < used.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    const Interaction& between = one_material ? run.interactions[0][0] : run.interactions[s.particles.material[a]][s.particles.material[b]];
    const double ra = s.particles.radius[a], rb = s.particles.radius[b];
    const double pull_off = 1.5 * std::numbers::pi * between.work_of_adhesion * ra * rb / (ra + rb);
    const double limit = between.friction * repulsive_part(s.pp.normal_force[c], pull_off);
    if (limit > 0) used[c] = s.pp.tangential_force[c].cast<double>().norm() / limit;
  }
  return used;
}

// Mean over the contacts that have one; NaN where none has.
inline double mean_mobilisation(const std::vector<double>& used) {
  double sum = 0, count = 0;
  for (const double u : used)
    if (!std::isnan(u)) sum += u, count += 1;
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace jam
