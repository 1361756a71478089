#include "libjam/statistics/flow_energy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::vessel_wall;

// The blade moves down at u and turns at omega against constant load: a force F up and a torque T about -z on it.
// Paper's Eq. 7 with dh = u dt and u / omega = R tan(alpha): energy = (T / (R tan alpha) + F) h = (T omega + F u) t.
constexpr double u = 21.8e-3, omega = 21.2, F = 40, T = 2, duration = 0.5;

Snapshot under_constant_load(double time) {
  Snapshot s;
  s.time = time;
  s.walls.resize(3);
  WallState& blade = s.walls[blade_wall];
  blade.position = Vec3(0, 0, -u * time);
  blade.velocity = Vec3(0, 0, -u);
  blade.angular_velocity = Vec3(0, 0, omega);
  blade.force = Vec3(3, -2, F);  // sideways forces do no work
  blade.torque = Vec3(0.1, 0.2, -T);
  // The vessel is loaded too, and might even move: not the blade's work.
  s.walls[vessel_wall] = blade;
  return s;
}

TEST(FlowEnergyTest, UnderConstantLoadIsThatOfThePapersEquation) {
  const auto walls = hand_made_run().walls;
  std::vector<double> time, power;
  for (int k = 0; k <= 250; ++k) {
    const Snapshot s = under_constant_load(duration * k / 250);
    time.push_back(s.time);
    power.push_back(power_from_wall_loads(s, walls));
  }
  const FlowEnergy flow = flow_energy_from_frames(time, power, "frames");
  const double radius = 11.75e-3, tan_alpha = u / (omega * radius), height = u * duration;
  const double paper = (T / (radius * tan_alpha) + F) * height;
  // The trapezoid rule is exact for a constant: rounding of 250 additions.
  EXPECT_NEAR(flow.total, paper, 1e-12 * paper);
  EXPECT_EQ(flow.source, "frames");
  ASSERT_EQ(flow.energy.size(), 251u);
  EXPECT_EQ(flow.energy.front(), 0);
  EXPECT_EQ(flow.energy.back(), flow.total);
  EXPECT_NEAR(flow.energy[125], paper / 2, 1e-12 * paper);
}

TEST(FlowEnergyTest, TrapezoidIsExactForALinearPowerOnUnevenFrames) {
  const std::vector<double> time{0, 0.1, 0.4, 1.0}, power{1, 1.2, 1.8, 3.0};  // 1 + 2 t
  const FlowEnergy flow = flow_energy_from_frames(time, power, "frames");
  EXPECT_NEAR(flow.total, 2.0, 1e-15);  // rounding of three additions
  EXPECT_EQ(flow_energy_from_frames({}, {}, "frames").total, 0);
}

TEST(FlowEnergyTest, SeriesAddsMeanPowerTimesWindow) {
  const auto walls = hand_made_run().walls;
  Series series;
  series.time = {0.1, 0.2, 0.4};
  series.step = {1, 2, 4};
  series.walls.resize(3);
  series.walls[blade_wall].power = {10, 20, 5};
  series.walls[vessel_wall].power = {1e6, 1e6, 1e6};
  ASSERT_TRUE(series_has_power(series, walls));
  const FlowEnergy flow = flow_energy_from_series(series, walls, 0.0);
  EXPECT_EQ(flow.source, "series");
  EXPECT_NEAR(flow.energy[0], 1.0, 1e-15);  // the first window is as long as the second
  EXPECT_NEAR(flow.total, 1.0 + 2.0 + 1.0, 1e-15);
}

TEST(FlowEnergyTest, ASingleRowOfSeriesBeginsWithTheRecord) {
  Series series;
  series.time = {0.5};
  series.step = {1};
  series.walls.resize(3);
  series.walls[blade_wall].power = {10};
  EXPECT_NEAR(flow_energy_from_series(series, hand_made_run().walls, 0.2).total, 3.0, 1e-15);
}

TEST(FlowEnergyTest, SeriesNeedsThePowerOfEveryBlade) {
  auto walls = hand_made_run().walls;
  Series series;
  EXPECT_FALSE(series_has_power(series, walls));
  series.time = {0.1, 0.2};
  EXPECT_FALSE(series_has_power(series, walls));
  series.walls.resize(3);
  EXPECT_FALSE(series_has_power(series, walls));
  series.walls[blade_wall].power = {1, 2};
  EXPECT_TRUE(series_has_power(series, walls));
  walls[vessel_wall].role = WallRole::blade;
  EXPECT_FALSE(series_has_power(series, walls));
}

//          blade tip
//             |          the tip at (0, -R, 0) runs towards +x and pushes the grain in front of it
//            (1) -> +x
Snapshot pushed_grain() {
  Snapshot s = Network().grain(1, Vec3f(0.5e-3f, -0.01f, 0), 0.5e-3f).press(1, blade_wall, 50).snapshot();
  s.walls[blade_wall].angular_velocity = Vec3(0, 0, omega);
  s.pw.normal = {Vec3f(-1, 0, 0)};
  s.pw.point = {Vec3f(0, -0.01f, 0)};
  return s;
}

TEST(FlowEnergyTest, PowerFromContactsIsForceTimesSpeedOfTheContactPoint) {
  const auto walls = hand_made_run().walls;
  const Snapshot s = pushed_grain();
  // Positions are single precision: 1e-7 relative.
  EXPECT_NEAR(power_from_wall_contacts(s, walls), 50 * omega * 0.01, 1e-6);

  Snapshot with_friction = s;
  with_friction.pw.tangential_force = {Vec3f(0, 0, 7)};
  with_friction.walls[blade_wall].velocity = Vec3(0, 0, -u);
  EXPECT_NEAR(power_from_wall_contacts(with_friction, walls), 50 * omega * 0.01 - 7 * u, 1e-6);
}

TEST(FlowEnergyTest, PowerFromContactsNeedsOnlyPointOrNormal) {
  const auto walls = hand_made_run().walls;
  const double expected = power_from_wall_contacts(pushed_grain(), walls);
  Snapshot s = pushed_grain();
  s.pw.normal.clear();
  EXPECT_NEAR(power_from_wall_contacts(s, walls), expected, 1e-6);
  s = pushed_grain();
  s.pw.point.clear();
  EXPECT_NEAR(power_from_wall_contacts(s, walls), expected, 1e-6);
  s.pw.normal.clear();
  EXPECT_TRUE(std::isnan(power_from_wall_contacts(s, walls)));
}

TEST(FlowEnergyTest, ContactsAndWallLoadsGiveTheSamePower) {
  // A grain at an odd place, the blade moving and turning about an odd axis: force and torque on the wall follow from
  // the contact, and so must the power.
  const auto walls = hand_made_run().walls;
  Snapshot s = Network().grain(1, Vec3f(2e-3f, -5e-3f, 4e-3f), 0.5e-3f).press(1, blade_wall, 50).snapshot();
  const Vec3f normal = Vec3f(1, 2, -2) / 3;
  s.pw.normal = {normal};
  s.pw.point = {s.particles.position[0] + 0.5e-3f * normal};
  s.pw.tangential_force = {Vec3f(2, 0, 1)};
  WallState& blade = s.walls[blade_wall];
  blade.position = Vec3(1e-3, 2e-3, 3e-3);
  blade.velocity = Vec3(0.1, -0.2, 0.3);
  blade.angular_velocity = Vec3(3, -20, 11);
  blade.force = (50 * normal - s.pw.tangential_force[0]).cast<double>();
  blade.torque = (s.pw.point[0].cast<double>() - blade.position).cross(blade.force);
  // Single-precision unit normal times 50 N at some 0.5 m/s.
  EXPECT_NEAR(power_from_wall_contacts(s, walls), power_from_wall_loads(s, walls), 1e-5);
}

}  // namespace
}  // namespace jam
