// Rank of the rigidity matrix against a dense one written out contact by contact; eigenvalues of the Laplacian in closed form.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "libjam/graph/algebraic_connectivity.hpp"
#include "libjam/graph/rigidity.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;

Rigidity of(const Snapshot& s) {
  return rigidity(ContactGraph(s, hand_made_run().walls));
}

// Corners of a regular tetrahedron of touching spheres of 1/2 mm.
const Vec3f corners[] = {{0, 0, 0}, {1e-3f, 0, 0}, {0.5e-3f, 0.8660254e-3f, 0}, {0.5e-3f, 0.2886751e-3f, 0.8164966e-3f}};

Snapshot touching(unsigned grains) {
  Network network;
  for (unsigned i = 0; i < grains; ++i) network.grain(i, corners[i]);
  for (unsigned i = 0; i < grains; ++i)
    for (unsigned j = i + 1; j < grains; ++j) network.touch(i, j, 1);
  return network.snapshot();
}

// Beyond the six motions as one body: two spheres roll and spin on each other, three in a triangle have three left, four none.
TEST(Rigidity, OfFewTouchingSpheres) {
  const Rigidity one = of(touching(1)), two = of(touching(2)), three = of(touching(3)), four = of(touching(4));
  EXPECT_EQ(one.zero_modes(), 6u);
  EXPECT_EQ(two.zero_modes(), 6u + 3u);
  EXPECT_EQ(three.zero_modes(), 6u + 3u);
  EXPECT_EQ(three.self_stresses(), 0u);
  EXPECT_EQ(four.zero_modes(), 6u);
  EXPECT_EQ(four.rows, 18u);
  EXPECT_EQ(four.self_stresses(), 0u);
}

TEST(Rigidity, ContactsThatSlideHoldOnlyAlongTheirNormal) {
  Snapshot s = touching(2);
  s.pp.flags.assign(1, contact_sliding);
  EXPECT_EQ(of(s).rows, 1u);
  EXPECT_EQ(of(s).zero_modes(), 11u);
}

// One sphere stuck to a wall at one point turns about it; at two it turns about their line; three hold it.
TEST(Rigidity, WallsHold) {
  Snapshot s = Network().grain(1, Vec3f(0, 0, 0)).snapshot();
  s.walls.resize(3);
  const Vec3f normals[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::size_t left[] = {3, 1, 0}, balanced[] = {0, 1, 3};
  for (std::size_t k = 0; k < 3; ++k) {
    s.pw.row.push_back(0);
    s.pw.wall.push_back(blade_wall);
    s.pw.normal.push_back(normals[k]);
    s.pw.normal_force.push_back(1);
    EXPECT_EQ(of(s).zero_modes(), left[k]);
    EXPECT_EQ(of(s).self_stresses(), balanced[k]);
  }
}

// Columns: velocity and angular velocity of each particle. Rows: velocity of the surface of the first at the contact less that of the
// second, along x, y, z; along the normal alone where it slides.
Eigen::Index dense_rank(const Snapshot& s) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * Eigen::Index(s.pp.size()), 6 * Eigen::Index(s.particles.size()));
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    const Vec3 xa = s.particles.position[a].cast<double>() * 1e3, xb = s.particles.position[b].cast<double>() * 1e3;
    const double ra = s.particles.radius[a], rb = s.particles.radius[b];
    const Vec3 contact = xa + ra / (ra + rb) * (xb - xa);
    for (int k = 0; k < 6; ++k) {
      const Vec3 move = k < 3 ? Vec3(Vec3::Unit(k)) : Vec3(Vec3::Zero()), turn = k < 3 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(k - 3));
      Vec3 on_a = move + turn.cross(contact - xa), on_b = move + turn.cross(contact - xb);
      if (s.pp.flags[c] & contact_sliding) {
        const Vec3 n = (xb - xa).normalized();
        on_a = Vec3(n.dot(on_a), 0, 0);
        on_b = Vec3(n.dot(on_b), 0, 0);
      }
      matrix.block<3, 1>(3 * Eigen::Index(c), 6 * Eigen::Index(a) + k) = on_a;
      matrix.block<3, 1>(3 * Eigen::Index(c), 6 * Eigen::Index(b) + k) = -on_b;
    }
  }
  const Eigen::VectorXd singular = Eigen::BDCSVD<Eigen::MatrixXd>(matrix).singularValues();
  return (singular.array() > 1e-6 * singular[0]).count();
}

TEST(Rigidity, IsTheRankOfTheDenseMatrix) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Snapshot s = random_network(seed, 20, 3 * seed);
    if (s.pp.size() == 0) continue;
    for (std::size_t c = 0; c < s.pp.size(); ++c) s.pp.flags.push_back((c + seed) % 3 == 0 ? contact_sliding : 0);
    // As large as they are apart, so that no motion is much stiffer than another.
    for (float& radius : s.particles.radius) radius *= 10;
    s.pw = {};
    EXPECT_EQ(Eigen::Index(of(s).rank), dense_rank(s)) << seed;
  }
}

TEST(Rigidity, IsostaticCoordinationFallsByWhatSlides) {
  EXPECT_EQ(isostatic_coordination(0), 4);
  EXPECT_EQ(isostatic_coordination(3), 6);  // every contact of Z = 6 slides: as without friction
}

// Of n particles in a row 2 - 2 cos(pi/n), in a ring 2 - 2 cos(2 pi/n), all touching n. Above 200 by the sparse way.
TEST(AlgebraicConnectivity, OfRowsRingsAndCompleteGraphs) {
  for (const unsigned n : {2u, 5u, 150u, 300u}) {
    Network row;
    for (unsigned i = 0; i + 1 < n; ++i) row.touch(i, i + 1, 1);
    const Snapshot s = row.snapshot();
    EXPECT_NEAR(algebraic_connectivity(ContactGraph(s, hand_made_run().walls)), 2 - 2 * std::cos(std::numbers::pi / n), 1e-12) << n;
    if (n < 3) continue;
    // A smaller component beside it and a contact without weight to it change nothing.
    const Snapshot ring = row.touch(0, n - 1, 1).touch(n, n + 1, 1).touch(0, n, -1).snapshot();
    const ContactGraph graph(ring, hand_made_run().walls);
    std::vector<double> weight;
    for (const float force : ring.pp.normal_force) weight.push_back(force > 0 ? 3 : 0);
    EXPECT_NEAR(algebraic_connectivity(graph, weight), 3 * (2 - 2 * std::cos(2 * std::numbers::pi / n)), 3e-12) << n;
  }
  const Snapshot four = touching(4), one = touching(1);
  EXPECT_NEAR(algebraic_connectivity(ContactGraph(four, hand_made_run().walls)), 4, 1e-13);
  EXPECT_TRUE(std::isnan(algebraic_connectivity(ContactGraph(one, hand_made_run().walls))));
}

}  // namespace
}  // namespace jam
