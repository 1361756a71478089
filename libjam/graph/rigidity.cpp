#include "libjam/graph/rigidity.hpp"

#include <iostream>  // MetisSupport forgets it

#include <Eigen/MetisSupport>
#include <Eigen/SparseCholesky>
#include <vector>

#include "libjam/graph/wall_touch.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
using Block = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor, 3, 6>;

bool slides(const std::vector<std::uint8_t>& flags, std::size_t contacts, std::size_t c) {
  return present(flags, contacts) && (flags[c] & contact_sliding) != 0;
}

// Velocity of the surface at `arm` from the centre of a particle as a function of its six velocities (turns by `scale` each), in the
// directions that the contact constrains: its normal and, where it sticks, two at right angles.
Block constraint(const Vec3& normal, const Vec3& arm, double scale, bool sliding) {
  Eigen::Matrix<double, 3, 6> velocity;
  velocity.leftCols<3>().setIdentity();
  velocity.rightCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;  // omega x arm
  velocity.rightCols<3>() /= scale;
  Eigen::Matrix3d directions;
  const Vec3 aside = normal.unitOrthogonal();
  directions << normal.transpose(), aside.transpose(), normal.cross(aside).transpose();
  return directions.topRows(sliding ? 1 : 3) * velocity;
}

// The constraints of a contact on its particles; b == a for walls.
struct Constraint {
  Vertex a, b;
  Block on_a, on_b;
  bool wall() const { return a == b; }
};

std::vector<Constraint> constraints(const ContactGraph& graph) {
  const Snapshot& s = graph.snapshot();
  double scale = 0;
  for (const float radius : s.particles.radius) scale += radius;
  scale /= double(std::max<std::size_t>(s.particles.size(), 1));
  const auto centre = [&](Vertex v) { return Vec3(s.particles.position[v].cast<double>()); };
  std::vector<Constraint> all;
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    const Vec3 branch = centre(b) - centre(a);
    if (!(branch.norm() > 0)) continue;
    const double ra = s.particles.radius[a], rb = s.particles.radius[b];
    const Vec3 normal = branch.normalized(), arm_a = ra / (ra + rb) * branch, arm_b = arm_a - branch;
    const bool sliding = slides(s.pp.flags, s.pp.size(), c);
    all.push_back({a, b, constraint(normal, arm_a, scale, sliding), Block(-constraint(normal, arm_b, scale, sliding))});
  }
  for (std::size_t c = 0; c < s.pw.size(); ++c)
    if (const auto touch = wall_touch(s, c)) {
      const Vertex a = s.pw.row[c];
      all.push_back({a, a, constraint(touch->normal, touch->arm, scale, slides(s.pw.flags, s.pw.size(), c)), {}});
    }
  return all;
}

std::size_t rank_of(const std::vector<Constraint>& all, const std::vector<std::uint8_t>& left, std::size_t particles) {
  std::vector<int> place(particles, -1);
  int n = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (left[k])
      for (const Vertex v : {all[k].a, all[k].b})
        if (place[v] < 0) place[v] = n++;
  if (n == 0) return 0;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, const Eigen::Matrix<double, 6, 6>& block) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (6 * row + i >= 6 * column + j) entries.emplace_back(6 * row + i, 6 * column + j, block(i, j));
  };
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!left[k]) continue;
    const Constraint& c = all[k];
    add(place[c.a], place[c.a], c.on_a.transpose() * c.on_a);
    if (c.wall()) continue;
    add(place[c.b], place[c.b], c.on_b.transpose() * c.on_b);
    if (place[c.a] > place[c.b]) {
      add(place[c.a], place[c.b], c.on_a.transpose() * c.on_b);
    } else {
      add(place[c.b], place[c.a], c.on_b.transpose() * c.on_a);
    }
  }
  Eigen::SparseMatrix<double> matrix(6 * n, 6 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const double zero = 1e-12 * Eigen::VectorXd(matrix.diagonal()).maxCoeff();
  // Nested dissection leaves half the entries of Eigen's own ordering in the factors of a packing, and takes half the time.
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::MetisOrdering<int>> factors;
  // A pivot of exactly zero stops it; with another shift it is none.
  for (double shift = zero; shift < 2 * zero; shift *= 1.1) {
    factors.setShift(-shift);
    factors.compute(matrix);
    if (factors.info() == Eigen::Success) break;
  }
  return std::size_t((factors.vectorD().array() > 0).count());
}

}  // namespace

Rigidity rigidity(const ContactGraph& graph) {
  const std::size_t n = graph.vertex_count();
  const std::vector<Constraint> all = constraints(graph);
  Rigidity found;
  found.degrees_of_freedom = 6 * n;
  for (const Constraint& c : all) found.rows += std::size_t(c.on_a.rows());

  // Whoever hangs on one contact falls off with it, and perhaps the next then hangs on one.
  std::vector<std::vector<std::uint32_t>> of(n);
  for (std::uint32_t k = 0; k < all.size(); ++k) {
    of[all[k].a].push_back(k);
    if (!all[k].wall()) of[all[k].b].push_back(k);
  }
  std::vector<std::size_t> holds(n);
  std::vector<Vertex> single;
  for (Vertex v = 0; v < n; ++v) {
    holds[v] = of[v].size();
    if (holds[v] == 1) single.push_back(v);
  }
  std::vector<std::uint8_t> left(all.size(), 1);
  for (std::size_t s = 0; s < single.size(); ++s) {
    const Vertex v = single[s];
    if (holds[v] != 1) continue;  // its partner took the contact along
    for (const std::uint32_t k : of[v]) {
      if (!left[k]) continue;
      left[k] = 0;
      found.rank += std::size_t(all[k].on_a.rows());
      holds[v] = 0;
      const Vertex partner = all[k].a == v ? all[k].b : all[k].a;
      if (!all[k].wall() && --holds[partner] == 1) single.push_back(partner);
    }
  }
  found.rank += rank_of(all, left, n);
  return found;
}

}  // namespace jam
