#include "libjam/graph/force_chains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using hand_made::vessel_wall;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr float radius = 0.5e-3f;
Vec3f at(double x, double y, double z = 0) { return Vec3f(float(x), float(y), float(z)) * 2 * radius; }  // in diameters

std::vector<Load> loads(const ContactGraph& graph) {
  return particle_loads(particle_stress(graph, sphere_volumes(graph.snapshot())));
}
std::vector<ForceChain> chains(const Snapshot& s, const ChainRules& rules = {}) {
  const ContactGraph graph(s, hand_made_run().walls);
  return force_chains(graph, loads(graph), rules);
}

// Matrices made from their principal values and a turn. The direction of a value that others come near is known the less, the nearer
// they come; where they agree there is none.
TEST(ParticleLoads, AreTheSmallestPrincipalStressAndItsDirection) {
  std::mt19937 random(1);
  const auto uniform = [&] { return double(random()) / 4294967296.0 - 0.5; };
  const Vec3 values[] = {{-3, 1, 2},   {-3, -2, -1},       {-3, 0, 0},         {-3, -3 * (1 - 1e-3), 5}, {-3, -3 * (1 - 1e-7), 5},
                         {-3, -3, 5},  {-3, -1e-9, 1e-9},  {-1e6, 1, 2},       {2, 3, 4},                {-1, -1, -1},
                         {-3, 8, 8},   {-2e-12, 0, 1e-12}, {-1, -0.97, -0.95}, {0, 0, 5}, {0, 3, 5}};
  for (const Vec3& value : values)
    for (int repeat = 0; repeat < 50; ++repeat) {
      const double w = uniform(), x = uniform(), y = uniform(), z = uniform();
      const Eigen::Matrix3d turn = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
      const Eigen::Matrix3d turned = turn * value.asDiagonal() * turn.transpose();
      const std::vector<Eigen::Matrix3d> stress{(turned + turned.transpose()) / 2};
      const Load load = particle_loads(stress)[0];
      const double size = value.cwiseAbs().maxCoeff(), gap = value[1] - value[0];
      EXPECT_NEAR(load.pressure, std::max(-value[0], 0.0), 1e-14 * size);
      if (value[0] == 0) {
        EXPECT_EQ(load.pressure, 0);  // and not a rounding
      }
      if (value[0] >= 0 || gap == 0) {
        EXPECT_EQ(load.direction.norm(), 0);
      } else {
        EXPECT_NEAR(std::abs(load.direction.dot(turn.col(0))), 1, 1e-15 + std::pow(2e-15 * size / gap, 2)) << value.transpose();
        EXPECT_NEAR(load.direction.cross(turn.col(0)).norm(), 0, 1e-14 * size / gap);
      }
    }
}

// A grain between two others on the z axis: each contact gives -R F in zz.
TEST(ParticleStress, OfAGrainPressedBetweenTwoIsTheirForcesTimesTheirArms) {
  const Snapshot s =
      Network().grain(1, at(0, 0, 0)).grain(2, at(0, 0, 1)).grain(3, at(0, 0, 2)).touch(1, 2, 6).touch(2, 3, 6).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<Eigen::Matrix3d> stress = particle_stress(graph, sphere_volumes(s));
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(double{radius}, 3);
  EXPECT_NEAR(stress[1](2, 2), -2 * 6 * double{radius} / volume, 1e-6 * 6 * radius / volume);
  EXPECT_NEAR(stress[0](2, 2), 0.5 * stress[1](2, 2), 1e-9 * std::abs(stress[1](2, 2)));
  EXPECT_EQ(stress[1](0, 0), 0);
  EXPECT_EQ(stress[1](0, 2), 0);
  const std::vector<Load> load = particle_loads(stress);
  EXPECT_DOUBLE_EQ(load[1].pressure, -stress[1](2, 2));
  EXPECT_NEAR(std::abs(load[1].direction.z()), 1, 1e-12);
}

// The contact point divides the branch in the ratio of the radii.
TEST(ParticleStress, SharesABranchInTheRatioOfTheRadii) {
  const Snapshot s = Network().grain(1, Vec3f(0, 0, 0), 1e-3f).grain(2, Vec3f(0, 0, 4e-3f), 3e-3f).touch(1, 2, 1).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<Eigen::Matrix3d> stress = particle_stress(graph, std::vector<double>{1, 1});
  EXPECT_NEAR(stress[0](2, 2), -1e-3, 1e-9);
  EXPECT_NEAR(stress[1](2, 2), -3e-3, 1e-9);
}

TEST(ParticleStress, FrictionAndWallsCountAndAdhesionPulls) {
  Snapshot s = Network().grain(1, at(0, 0)).grain(2, at(1, 0)).touch(1, 2, -2).press(1, vessel_wall, 5).snapshot();
  s.pp.tangential_force = {Vec3f(0, 3, 0)};
  s.pw.normal = {Vec3f(-1, 0, 0)};
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<Eigen::Matrix3d> stress = particle_stress(graph, std::vector<double>{1, 1});
  const double r = radius;
  // Grain 1: pulled by 2 towards +x at +x, pressed by 5 towards +x at -x; friction of 3 along y at +x.
  EXPECT_NEAR(stress[0](0, 0), 2 * r - 5 * r, 1e-9);
  EXPECT_NEAR(stress[0](0, 1), 0.5 * 3 * r, 1e-9);
  EXPECT_NEAR(stress[0](1, 0), 0.5 * 3 * r, 1e-9);
  EXPECT_NEAR(stress[1](0, 0), 2 * r, 1e-9);
  EXPECT_NEAR(stress[1](0, 1), 0.5 * 3 * r, 1e-9);  // force and arm are both opposite
  // A wall of which the source knows only the force has no direction.
  Snapshot blind = s;
  blind.pw.normal.clear();
  const ContactGraph without(blind, hand_made_run().walls);
  EXPECT_NEAR(particle_stress(without, std::vector<double>{1, 1})[0](0, 0), 2 * r, 1e-9);
}

TEST(ParticleLoads, HaveNoDirectionWherePrincipalStressesAreEqualAndNoneInTension) {
  Eigen::Matrix3d equal = -Eigen::Matrix3d::Identity(), pulled = Eigen::Vector3d(1, 2, 3).asDiagonal();
  const std::vector<Load> load = particle_loads(std::vector<Eigen::Matrix3d>{equal, pulled, Eigen::Matrix3d::Zero()});
  EXPECT_EQ(load[0].pressure, 1);
  EXPECT_EQ(load[0].direction, Vec3::Zero());
  EXPECT_EQ(load[1].pressure, 0);
  EXPECT_EQ(load[2].pressure, 0);
}

// A column of six between blade and vessel that carries 10 N, leant on by four grains that carry 1 N.
Snapshot column() {
  Network network;
  for (int k = 0; k < 6; ++k) network.grain(ParticleId(k + 1), at(0, 0, k));
  for (int k = 0; k < 5; ++k) network.touch(ParticleId(k + 1), ParticleId(k + 2), 10);
  for (int k = 1; k < 5; ++k) network.grain(ParticleId(20 + k), at(1, 0, k)).touch(ParticleId(k + 1), ParticleId(20 + k), 1);
  Snapshot s = network.press(1, blade_wall, 10).press(6, vessel_wall, 10).snapshot();
  s.pw.normal = {Vec3f(0, 0, -1), Vec3f(0, 0, 1)};
  return s;
}

TEST(ForceChains, FollowAColumnFromWallToWall) {
  const std::vector<ForceChain> found = chains(column());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].particles, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(found[0].links, 5u);
  EXPECT_NEAR(found[0].contour, 5e-3, 1e-8);
  EXPECT_NEAR(found[0].end_to_end, 5e-3, 1e-8);
  EXPECT_TRUE(found[0].at_blade);
  EXPECT_TRUE(found[0].at_vessel);
  ChainRules branching;
  branching.branching = true;
  EXPECT_THAT(chains(column(), branching)[0].particles, ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(ForceChains, NeedAMeanLoadAnAngleAndThreeParticles) {
  ChainRules heavy;
  heavy.level = 2;  // nobody carries twice the mean
  EXPECT_THAT(chains(column(), heavy), IsEmpty());
  ChainRules longer;
  longer.least = 7;
  EXPECT_THAT(chains(column(), longer), IsEmpty());

  // A zigzag: in the middle the load lies along x, and each branch is off it by 30 degrees.
  const double c = std::cos(std::numbers::pi / 6), d = std::sin(std::numbers::pi / 6);
  Network zigzag;
  for (int k = 0; k < 5; ++k) zigzag.grain(ParticleId(k + 1), at(k * c, k % 2 ? d : 0)).grain(ParticleId(30 + k), at(0, 9 + k));
  for (int k = 0; k < 4; ++k) zigzag.touch(ParticleId(k + 1), ParticleId(k + 2), 10).touch(ParticleId(30 + k), ParticleId(31 + k), 0.1f);
  ChainRules narrow;
  narrow.angle = 0.99 * std::numbers::pi / 6;
  ChainRules wide;
  wide.angle = 1.01 * std::numbers::pi / 6;
  wide.level = narrow.level = 0.5;
  ASSERT_EQ(chains(zigzag.snapshot(), wide).size(), 1u);
  EXPECT_THAT(chains(zigzag.snapshot(), wide)[0].particles, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(chains(zigzag.snapshot(), narrow), IsEmpty());
}

// Two branches ahead of grain 3: a linear chain takes the one that deviates less, a branching one takes both.
TEST(ForceChains, BranchOnlyWhereTheyMay) {
  Network fork;
  fork.grain(1, at(-2, 0)).grain(2, at(-1, 0)).grain(3, at(0, 0));
  const double a = 0.2, b = -0.45;  // rad
  fork.grain(4, at(std::cos(a), std::sin(a))).grain(5, at(2 * std::cos(a), 2 * std::sin(a)));
  fork.grain(6, at(std::cos(b), std::sin(b))).grain(7, at(2 * std::cos(b), 2 * std::sin(b)));
  fork.touch(1, 2, 10).touch(2, 3, 10).touch(3, 4, 5).touch(4, 5, 5).touch(3, 6, 5).touch(6, 7, 5);
  ChainRules rules;
  rules.level = 0.1;
  const std::vector<ForceChain> linear = chains(fork.snapshot(), rules);
  ASSERT_EQ(linear.size(), 1u);
  EXPECT_THAT(linear[0].particles, ElementsAre(0, 1, 2, 3, 4));
  rules.branching = true;
  const std::vector<ForceChain> whole = chains(fork.snapshot(), rules);
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].particles.size(), 7u);
  EXPECT_EQ(whole[0].links, 6u);
}

// Every chain of a random network keeps its rules, no link that both ends want is missing, and another order of the particles gives
// the same chains.
TEST(ForceChains, KeepTheirRulesWhateverTheOrder) {
  std::size_t seen = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Snapshot s = random_network(seed, 60, 150);
    const ContactGraph graph(s, hand_made_run().walls);
    const std::vector<Load> load = loads(graph);
    double mean = 0, compressed = 0;
    for (const Load& l : load) {
      mean += l.pressure;
      compressed += l.pressure > 0;
    }
    mean /= compressed;
    std::set<std::set<ParticleId>> names, other_names;
    for (const ForceChain& chain : force_chains(graph, load)) {
      ++seen;
      std::set<ParticleId> members;
      for (std::size_t k = 0; k < chain.particles.size(); ++k) {
        const auto v = chain.particles[k];
        members.insert(s.particles.id[v]);
        EXPECT_GT(load[v].pressure, mean);
        if (k == 0) continue;
        const auto u = chain.particles[k - 1];
        const Vec3 branch = (s.particles.position[v] - s.particles.position[u]).cast<double>().normalized();
        EXPECT_GE(std::abs(branch.dot(load[u].direction)), std::sqrt(0.5) - 1e-12);
        EXPECT_GE(std::abs(branch.dot(load[v].direction)), std::sqrt(0.5) - 1e-12);
      }
      EXPECT_EQ(members.size(), chain.particles.size());
      EXPECT_GE(members.size(), 3u);
      names.insert(members);
    }
    const std::vector<ParticleId> ids = hand_made::shuffled_ids(seed, 60);
    const Snapshot other = hand_made::relabelled(s, ids);
    const ContactGraph other_graph(other, hand_made_run().walls);
    std::map<ParticleId, ParticleId> original;
    for (std::size_t r = 0; r < 60; ++r) original[ids[r]] = s.particles.id[r];
    for (const ForceChain& chain : force_chains(other_graph, loads(other_graph))) {
      std::set<ParticleId> members;
      for (const auto v : chain.particles) members.insert(original.at(other.particles.id[v]));
      other_names.insert(members);
    }
    EXPECT_EQ(names, other_names);
  }
  EXPECT_GT(seen, 66u);  // random networks rarely line up: a chain in every sixth of them at least
}

}  // namespace
}  // namespace jam
