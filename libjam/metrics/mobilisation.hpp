// How much of its friction each particle contact uses: the tangential force over the Coulomb limit mu f of its repulsive normal force f
// (libjam/graph/contact_force.hpp), with the friction mu of the two materials. An adhesive law may allow more than mu f, so values above 1
// are possible; whether a contact slides is what its source recorded (sliding_share.hpp). NaN where the source does not know the tangential
// force, the materials or their friction, and where nothing pushes.
#pragma once
#include <limits>
#include <vector>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/contact_graph.hpp"

namespace jam {

// [C]
inline std::vector<double> mobilisation(const ContactGraph& graph, const RunInfo& run) {
  const Snapshot& s = graph.snapshot();
  std::vector<double> used(s.pp.size(), std::numeric_limits<double>::quiet_NaN());
  if (!present(s.pp.tangential_force, s.pp.size())) return used;
  const bool one_material = run.interactions.size() == 1, materials = present(s.particles.material, s.particles.size());
  if (!one_material && (!materials || run.interactions.empty())) return used;
  for (std::size_t c = 0; c < used.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    const std::size_t of_a = one_material ? 0 : s.particles.material[a], of_b = one_material ? 0 : s.particles.material[b];
    const double limit = run.interactions[of_a][of_b].friction * repulsive_force(s.pp, c);
    if (limit > 0) used[c] = s.pp.tangential_force[c].cast<double>().norm() / limit;
  }
  return used;
}

// Mean over the contacts that have one; NaN where none has.
inline double mean_mobilisation(const std::vector<double>& used) {
  double sum = 0, count = 0;
  for (const double u : used)
    if (u == u) sum += u, count += 1;
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace jam
