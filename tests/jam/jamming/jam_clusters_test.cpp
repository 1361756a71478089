#include "libjam/jamming/jam_clusters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "libjam/errors.hpp"
#include "libjam/jamming/check_criteria.hpp"
#include "libjam/jamming/compressive_force.hpp"
#include "libjam/jamming/gap.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::floor_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using hand_made::vessel_wall;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Threshold 20 N, contacts above 2 N are on the load path: the defaults.
std::vector<Cluster> clusters_of(const Snapshot& snapshot, const Criteria& criteria = {}) {
  const RunInfo info = hand_made_run();
  const ContactGraph graph(snapshot, info.walls);
  const auto force = compressive_forces(graph, criteria.measure);
  return jam_clusters(graph, jammed_particles(graph, force, info, criteria), criteria, 4);
}

TEST(JamClustersTest, OneGrainBetweenBladeAndWallBridges) {
  //   blade |(1)| vessel      pinched with 30 N from both sides: compressive force 60 N
  const auto clusters = clusters_of(Network().press(1, blade_wall, 30).press(1, vessel_wall, 30).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].frame, 4u);
  EXPECT_THAT(clusters[0].members, ElementsAre(1));
  EXPECT_TRUE(clusters[0].bridges);
  EXPECT_EQ(clusters[0].blade_force, 30);
  EXPECT_EQ(clusters[0].vessel_force, 30);
  EXPECT_EQ(clusters[0].largest_compressive_force, 60);
  EXPECT_EQ(clusters[0].in_gap, 1u);
}

TEST(JamClustersTest, APinchOfJustUnderHalfTheThresholdIsNoJam) {
  //   blade |(1)| vessel      10 N + 10 N is not larger than 20 N
  EXPECT_TRUE(clusters_of(Network().press(1, blade_wall, 10).press(1, vessel_wall, 10).snapshot()).empty());
  const float above = std::nextafter(10.0f, 11.0f);
  EXPECT_EQ(clusters_of(Network().press(1, blade_wall, above).press(1, vessel_wall, 10).snapshot()).size(), 1u);
}

TEST(JamClustersTest, TwoGrainsBridgeTogether) {
  //   blade |(1)(2)| vessel
  const auto clusters =
      clusters_of(Network().press(1, blade_wall, 30).touch(1, 2, 30).press(2, vessel_wall, 29).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_THAT(clusters[0].members, ElementsAre(1, 2));
  EXPECT_TRUE(clusters[0].bridges);
  EXPECT_EQ(clusters[0].blade_force, 30);
  EXPECT_EQ(clusters[0].vessel_force, 29);
}

TEST(JamClustersTest, TheLeastGapIsBetweenTheNearestPointsThatCarryTheLoad) {
  //   blade |(1)(2)| vessel, the vessel also by a contact off the load path, nearer to the blade
  Snapshot s = Network().press(1, blade_wall, 30).touch(1, 2, 30).press(1, vessel_wall, 1).press(2, vessel_wall, 29).snapshot();
  EXPECT_TRUE(std::isnan(clusters_of(s)[0].least_gap));  // no points, no normals
  const Vec3f origin = s.particles.position[0];
  s.pw.point = {origin + Vec3f(-0.5e-3f, 0, 0), origin + Vec3f(0, 0.5e-3f, 0), origin + Vec3f(1e-3f, 0, 2e-3f)};
  EXPECT_NEAR(clusters_of(s)[0].least_gap, 2.5e-3, 1e-8);  // (1.5, 0, 2) mm; positions have seven digits
  EXPECT_TRUE(std::isnan(clusters_of(Network().press(1, blade_wall, 30).snapshot())[0].least_gap));
}

TEST(JamClustersTest, TwoJamsAtDifferentPlacesAreTwoClusters) {
  //   blade |(1)| vessel ...... blade |(8)(9)| vessel
  const auto clusters = clusters_of(Network()
                                        .press(1, blade_wall, 40)
                                        .press(1, vessel_wall, 40)
                                        .press(8, blade_wall, 30)
                                        .touch(8, 9, 30)
                                        .press(9, vessel_wall, 30)
                                        .snapshot());
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_THAT(clusters[0].members, ElementsAre(8, 9));  // the larger one first
  EXPECT_THAT(clusters[1].members, ElementsAre(1));
  EXPECT_TRUE(clusters[0].bridges);
  EXPECT_TRUE(clusters[1].bridges);
}

TEST(JamClustersTest, ClustersOfEqualSizeAreInOrderOfTheirSmallestId) {
  Network network;
  for (const ParticleId id : {7u, 3u, 5u}) network.press(id, blade_wall, 30).press(id, vessel_wall, 30);
  const auto clusters = clusters_of(network.snapshot());
  ASSERT_EQ(clusters.size(), 3u);
  EXPECT_THAT(clusters[0].members, ElementsAre(3));
  EXPECT_THAT(clusters[1].members, ElementsAre(5));
  EXPECT_THAT(clusters[2].members, ElementsAre(7));
}

TEST(JamClustersTest, AChainThatStopsShortOfTheWallIsAClusterButNoBridge) {
  //   blade |(1)(2)(3)-15 N-(4)   | vessel     (4) takes 15 N: it is not jammed, and it does not touch the wall
  const auto clusters =
      clusters_of(Network().press(1, blade_wall, 30).touch(1, 2, 30).touch(2, 3, 25).touch(3, 4, 15).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_THAT(clusters[0].members, ElementsAre(1, 2, 3));
  EXPECT_FALSE(clusters[0].bridges);
  EXPECT_EQ(clusters[0].vessel_force, 0);
}

TEST(JamClustersTest, TheFloorIsNoVesselWall) {
  //   blade |(1)| floor
  const auto clusters = clusters_of(Network().press(1, blade_wall, 30).press(1, floor_wall, 30).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_FALSE(clusters[0].bridges);
}

TEST(JamClustersTest, AnAdhesiveContactCarriesNoBridge) {
  //   blade |(1)~~(2)| vessel      ~~ pulls with 30 N; each grain is squeezed by its own neighbours (3), (4)
  const auto clusters = clusters_of(Network()
                                        .press(1, blade_wall, 30)
                                        .touch(1, 3, 15)
                                        .touch(1, 2, -30)
                                        .touch(2, 4, 15)
                                        .press(2, vessel_wall, 30)
                                        .snapshot());
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_THAT(clusters[0].members, ElementsAre(1));
  EXPECT_THAT(clusters[1].members, ElementsAre(2));
  EXPECT_FALSE(clusters[0].bridges);
  EXPECT_FALSE(clusters[1].bridges);
}

TEST(JamClustersTest, AnAdhesiveWallContactCarriesNoBridge) {
  //   blade |(1)~| vessel      the vessel holds the grain, it does not press it
  const auto clusters = clusters_of(Network().press(1, blade_wall, 30).press(1, vessel_wall, -30).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_FALSE(clusters[0].bridges);
  EXPECT_EQ(clusters[0].vessel_force, 0);
}

TEST(JamClustersTest, AWeakContactBetweenTwoJamsDoesNotWeldThem) {
  //   blade |(1)| vessel
  //          | f
  //   blade |(2)| vessel      f = share * jam_force does not join, anything more does
  const auto with_link = [](float force) {
    return Network()
        .press(1, blade_wall, 30)
        .press(1, vessel_wall, 30)
        .press(2, blade_wall, 30)
        .press(2, vessel_wall, 30)
        .touch(1, 2, force)
        .snapshot();
  };
  EXPECT_EQ(clusters_of(with_link(2.0f)).size(), 2u);
  EXPECT_EQ(clusters_of(with_link(std::nextafter(2.0f, 3.0f))).size(), 1u);
}

TEST(JamClustersTest, AWallContactOffTheLoadPathMakesNoBridge) {
  //   blade |(1)(2)| vessel      (2) leans on the vessel with 2 N only
  const auto clusters =
      clusters_of(Network().press(1, blade_wall, 30).touch(1, 2, 30).press(2, vessel_wall, 2).snapshot());
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_FALSE(clusters[0].bridges);
  EXPECT_EQ(clusters[0].vessel_force, 2);
}

TEST(JamClustersTest, DoNotDependOnTheIdsOfTheParticles) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Snapshot snapshot = random_network(seed, 60, 80);
    const auto new_id = hand_made::shuffled_ids(seed, 60);
    std::map<ParticleId, ParticleId> name;
    for (std::size_t v = 0; v < 60; ++v) name[snapshot.particles.id[v]] = new_id[v];
    using Key = std::tuple<std::vector<ParticleId>, bool, double, double, double, std::uint32_t>;
    const auto key = [](const Cluster& c) {
      return Key(c.members, c.bridges, c.blade_force, c.vessel_force, c.largest_compressive_force, c.in_gap);
    };
    std::vector<Key> renamed, other;
    for (Cluster cluster : clusters_of(snapshot)) {
      for (ParticleId& id : cluster.members) id = name[id];
      std::sort(cluster.members.begin(), cluster.members.end());
      renamed.push_back(key(cluster));
    }
    for (const Cluster& cluster : clusters_of(hand_made::relabelled(snapshot, new_id))) other.push_back(key(cluster));
    EXPECT_FALSE(other.empty());
    EXPECT_THAT(renamed, ::testing::UnorderedElementsAreArray(other));
  }
}

//            (2)
//             | 3
//   blade 5--(1)--vessel 7      (1) ~ (3) pulls with 4
Snapshot pulled_and_pushed() {
  return Network().touch(1, 2, 3).touch(1, 3, -4).press(1, blade_wall, 5).press(1, vessel_wall, 7).snapshot();
}

TEST(CompressiveForceTest, AddsWhatTheMeasureSays) {
  const Snapshot snapshot = pulled_and_pushed();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::sum), ElementsAre(15, 3, 0));
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::max), ElementsAre(7, 3, 0));
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::signed_), ElementsAre(11, 3, -4));
}

TEST(CompressiveForceTest, DampingIsPartOfTheNormalForce) {
  Snapshot snapshot = pulled_and_pushed();
  snapshot.pp.damping_force = {-5, 6};  // 3 - 5 pulls, -4 + 6 pushes
  snapshot.pw.damping_force = {1, 0};
  const ContactGraph graph(snapshot, hand_made_run().walls);
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::sum), ElementsAre(15, 0, 2));
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::max), ElementsAre(7, 0, 2));
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::signed_), ElementsAre(13, -2, 2));
}

TEST(CompressiveForceTest, ComesFromTheContactsWhateverTheSourceRecorded) {
  Snapshot snapshot = pulled_and_pushed();
  snapshot.particles.compressive_force = {1000, 1000, 1000};
  const ContactGraph graph(snapshot, hand_made_run().walls);
  EXPECT_THAT(compressive_forces(graph, CompressiveMeasure::sum), ElementsAre(15, 3, 0));
}

bool in_gap_at(const Vec3f& position, const Vec3& blade_position = Vec3::Zero(), double margin = 0.5) {
  Snapshot snapshot = Network().grain(1, position, 0.25e-3f).snapshot();
  snapshot.walls[blade_wall].position = blade_position;
  Criteria criteria;
  criteria.gap_margin = margin;
  return in_gap(snapshot, 0, hand_made_run(), criteria);
}

TEST(GapTest, BeginsAMarginInsideTheTipCircle) {
  // Tip circle 10 mm, diameter 0.5 mm: from 9.75 mm outwards; 1 um to either side of it.
  EXPECT_TRUE(in_gap_at({0, 0.009751f, 0}));
  EXPECT_FALSE(in_gap_at({0, 0.009749f, 0}));
  EXPECT_TRUE(in_gap_at({0, 0.010001f, 0}, Vec3::Zero(), 0));
  EXPECT_FALSE(in_gap_at({0, 0.009999f, 0}, Vec3::Zero(), 0));
}

TEST(GapTest, ReachesOneDiameterAboveAndBelowTheBlade) {
  EXPECT_TRUE(in_gap_at({0.0105f, 0, 0.002499f}));
  EXPECT_FALSE(in_gap_at({0.0105f, 0, 0.002501f}));
  EXPECT_TRUE(in_gap_at({0.0105f, 0, -0.002499f}));
  EXPECT_FALSE(in_gap_at({0.0105f, 0, -0.002501f}));
}

TEST(GapTest, MovesWithTheBlade) {
  EXPECT_FALSE(in_gap_at({0.0105f, 0, 0.050f}));
  EXPECT_TRUE(in_gap_at({0.0105f, 0, 0.050f}, Vec3(0, 0, 0.049)));
  EXPECT_FALSE(in_gap_at({0.0105f, 0, 0}, Vec3(0.005, 0, 0)));
}

TEST(GapTest, HoldsNothingWhereItIsNotKnown) {
  RunInfo info = hand_made_run();
  info.gap = {};
  EXPECT_FALSE(gap_known(info));
  EXPECT_FALSE(in_gap(Network().grain(1).snapshot(), 0, info, Criteria{}));
}

std::string refusal(const Criteria& criteria, const RunInfo& info) {
  try {
    check_criteria(criteria, info);
  } catch (const CriteriaError& error) {
    return error.what();
  }
  return "";
}

TEST(CriteriaTest, RefusesOptionsOutOfRangeAndSaysWhich) {
  EXPECT_EQ(refusal({}, hand_made_run()), "");
  EXPECT_THAT(refusal({.jam_force = -1}, hand_made_run()), HasSubstr("jam_force = -1"));
  EXPECT_THAT(refusal({.jam_force = std::nan("")}, hand_made_run()), HasSubstr("jam_force"));
  EXPECT_THAT(refusal({.bridge_contact_share = -0.1}, hand_made_run()), HasSubstr("bridge_contact_share = -0.1"));
  EXPECT_THAT(refusal({.gap_margin = INFINITY}, hand_made_run()), HasSubstr("gap_margin"));
  EXPECT_THAT(refusal({.survival_classes = {0.02, 0.01}}, hand_made_run()), HasSubstr("survival_classes[1] = 0.01"));
  EXPECT_THAT(refusal({.survival_classes = {0.0}}, hand_made_run()), HasSubstr("survival_classes[0]"));
}

TEST(CriteriaTest, NeedsABladeAndAVesselAndNamesTheWallsThereAre) {
  RunInfo info = hand_made_run();
  info.walls[vessel_wall].role = WallRole::other;
  EXPECT_THAT(refusal({}, info), HasSubstr("role vessel (walls: blade, vessel, floor)"));
  info.walls.clear();
  EXPECT_THAT(refusal({}, info), HasSubstr("role blade (walls: none)"));
}

}  // namespace
}  // namespace jam
