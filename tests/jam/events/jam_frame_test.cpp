#include "libjam/events/jam_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libjam/jamming/compressive_force.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::vessel_wall;

// A blade a quarter turned, at (1, 2, 3) mm, that turns at 20 rad/s and sinks at 0.1 m/s.
BladePose blade_at(double time) {
  BladePose blade;
  blade.time = time;
  blade.position = Vec3(1e-3, 2e-3, 3e-3);
  blade.velocity = Vec3(0, 0, -0.1);
  blade.angular_velocity = Vec3(0, 0, 20);
  blade.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ());
  return blade;
}

TEST(BladePose, SeesPlacesFromTheBladeAsItTurnsAndMoves) {
  const std::vector<BladePose> poses{blade_at(0.0)};
  // What lies along y in the vessel lies along the x of a blade that has turned a quarter.
  const Vec3 now = in_blade_frame(poses, 0, Vec3(1e-3, 12e-3, 3e-3));
  EXPECT_NEAR((now - Vec3(10e-3, 0, 0)).norm(), 0, 1e-15);
  // 5 ms later it has turned by 0.1 rad more and sunk by 0.5 mm.
  const Vec3 later = in_blade_frame(poses, 5e-3, Vec3(1e-3, 12e-3, 3e-3));
  EXPECT_NEAR((later - Vec3(10e-3 * std::cos(0.1), -10e-3 * std::sin(0.1), 0.5e-3)).norm(), 0, 1e-15);
  EXPECT_EQ(in_blade_frame({}, 1, Vec3(1, 2, 3)), Vec3(1, 2, 3));
}

TEST(BladePose, TipGoesRoundAndAlong) {
  EXPECT_NEAR(tip_speed(blade_at(0), 10e-3), std::hypot(0.2, 0.1), 1e-15);
}

TEST(JamFrame, SaysOfAGrainWhereItIsAndWhatItDoes) {
  Snapshot s = Network().grain(7, Vec3f(1e-3f, 12e-3f, 3e-3f)).press(7, blade_wall, 30).press(7, vessel_wall, -3).touch(7, 9, 2).touch(7, 11, -1).snapshot();
  s.particles.velocity = {Vec3f(0.1f, 0, 0), Vec3f::Zero(), Vec3f::Zero()};
  s.particles.angular_velocity = {Vec3f(0, 5, 0), Vec3f::Zero(), Vec3f::Zero()};
  RunInfo info = hand_made_run();
  info.gap.tip_radius = 10e-3;
  const ContactGraph graph(s, info.walls);
  const JammedSample sample = sample_of(graph, 0, 32, info, blade_at(0), {});
  EXPECT_EQ(sample.particle, 7u);
  EXPECT_NEAR((sample.from_blade - Vec3f(10e-3f, 0, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR(sample.speed_over_tip, 0.1 / std::hypot(0.2, 0.1), 1e-6);
  EXPECT_EQ(sample.angular_velocity, Vec3f(0, 5, 0));
  EXPECT_EQ(sample.pushed_by, 2u);  // what only adheres does not push
  EXPECT_EQ(sample.compressive_force, 32);
  EXPECT_TRUE(std::isnan(sample.least_gap));

  info.gap.tip_radius = 0;  // not known
  s.particles.velocity.clear();
  s.particles.angular_velocity.clear();
  const JammedSample less = sample_of(graph, 0, 32, info, blade_at(0), {});
  EXPECT_TRUE(std::isnan(less.speed_over_tip) && std::isnan(less.velocity.x()) && std::isnan(less.angular_velocity.z()));
}

TEST(JamFrame, KeepsThoseThatNearlyJamWhereTheCriteriaAskForThem) {
  const Snapshot s = Network().press(1, blade_wall, 30).touch(2, 3, 17).touch(4, 5, 12).snapshot();
  const RunInfo info = hand_made_run();
  const ContactGraph graph(s, info.walls);
  const auto nearly = [&](const Criteria& criteria) {
    const auto force = compressive_forces(graph, criteria.measure);
    const auto jammed = jammed_particles(graph, force, info, criteria);
    const JamFrame frame = jam_frame(graph, force, jammed, jam_clusters(graph, jammed, criteria, 0), info, {}, criteria);
    EXPECT_EQ(frame.jammed.size(), 1u);
    std::vector<ParticleId> ids;
    for (const JammedSample& sample : frame.nearly) ids.push_back(sample.particle);
    return ids;
  };
  EXPECT_THAT(nearly({}), testing::IsEmpty());
  EXPECT_THAT(nearly({.end_force = 15.0}), testing::ElementsAre(2, 3));
  EXPECT_THAT(nearly({.end_force = 10.0}), testing::ElementsAre(2, 3, 4, 5));
}

}  // namespace
}  // namespace jam
