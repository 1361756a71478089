#include "libjam/statistics/blade_load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace jam {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::Pointwise;

std::vector<Wall> blade_and_vessel() {
  std::vector<Wall> walls(2);
  walls[0].role = WallRole::vessel;
  walls[1].role = WallRole::blade;
  return walls;
}

// 2 s in windows of 1 ms: a force that grows as 10 t N, and one pulse of 40 N for 0.1 ms of the window at 1.2 s, which in the mean is 4 N more.
Series pulse() {
  Series s;
  s.walls.resize(2);
  Series::WallSeries& blade = s.walls[1];
  for (int k = 1; k <= 2000; ++k) {
    const double t = 1e-3 * k, slow = -10 * t;
    const bool now = k == 1200;
    s.time.push_back(t);
    s.step.push_back(std::uint64_t(k) * 1000);
    blade.force.push_back(Vec3(7, 7, slow - (now ? 4.0 : 0.0)));
    blade.force_min.push_back(Vec3(-9, -9, slow - (now ? 40.0 : 0.0)));
    blade.force_max.push_back(Vec3(9, 9, slow));
    blade.torque.push_back(Vec3(0, 0, 0.5));
    blade.torque_min.push_back(Vec3(0, 0, 0.25));
    blade.torque_max.push_back(Vec3(0, 0, 0.75));
  }
  return s;
}

TEST(BladeLoad, SlowInstrumentsShowAShareOfAPulse) {
  const std::vector<FrameLoad> frames{{0.5, -5, 0.5}, {1.0, -10, 0.6}};
  const BladeLoad load = blade_load(pulse(), blade_and_vessel(), frames);
  EXPECT_NEAR(load.force.every_step, 52, 1e-12);       // at 1.2 s: 12 + 40
  EXPECT_NEAR(load.force.windows, 20, 1e-12);          // at the end
  EXPECT_NEAR(load.force.frames, 10, 1e-12);
  EXPECT_NEAR(load.force.filtered, 10 * 1.9805, 1e-9);  // the mean of the last 40 windows
  EXPECT_NEAR(load.force.median, 10.005, 1e-9);
  EXPECT_EQ(load.force.trend, 1);
  ASSERT_EQ(load.force.medians.size(), 20u);
  EXPECT_NEAR(load.force.medians[0], 10 * 0.0505, 1e-12);
  EXPECT_NEAR(load.torque.every_step, 0.75, 1e-15);
  EXPECT_NEAR(load.torque.frames, 0.6, 1e-15);
  EXPECT_EQ(load.torque.trend, 0);  // no two differ
  EXPECT_THAT(load.torque.medians, Each(DoubleNear(0.5, 1e-15)));
}

// Windows in which a grain is jammed make the peaks: without them the median is that of the rest.
TEST(BladeLoad, MediansLeaveOutWindowsWithAJam) {
  Series s = pulse();
  for (std::size_t k = 0; k < s.size(); ++k) s.largest_compressive_force.push_back(k % 100 < 90 && k < 1900 ? 25 : 15);
  s.largest_compressive_force[1950] = 20;  // not above
  const BladeLoad all = blade_load(s, blade_and_vessel(), {}), rest = blade_load(s, blade_and_vessel(), {}, 20);
  EXPECT_NEAR(all.force.medians[0], 10 * 0.0505, 1e-12);
  EXPECT_NEAR(rest.force.medians[0], 10 * 0.0955, 1e-12);  // windows 91 to 100
  EXPECT_EQ(rest.force.medians[19], all.force.medians[19]);
  EXPECT_EQ(rest.force.median, all.force.median);
  EXPECT_TRUE(std::isnan(blade_load(s, blade_and_vessel(), {}, 10).force.medians[3]));
  s.largest_compressive_force.clear();
  EXPECT_EQ(blade_load(s, blade_and_vessel(), {}, 20).force.medians, all.force.medians);
}

TEST(BladeLoad, IsUnknownWithoutABladeOrItsLoads) {
  std::vector<Wall> none = blade_and_vessel();
  none[1].role = WallRole::other;
  Series bare = pulse();
  bare.walls[1] = {};
  const BladeLoad unknown[] = {blade_load(pulse(), none, {}), blade_load(bare, blade_and_vessel(), {}), blade_load({}, blade_and_vessel(), {})};
  for (const BladeLoad& load : unknown) EXPECT_TRUE(std::isnan(load.force.windows) && std::isnan(load.torque.every_step) && std::isnan(load.force.median));
}

TEST(KendallTau, CountsPairs) {
  EXPECT_EQ(kendall_tau(std::vector<double>{1, 2, 3, 4}), 1);
  EXPECT_EQ(kendall_tau(std::vector<double>{4, 3, 2, 1}), -1);
  EXPECT_DOUBLE_EQ(kendall_tau(std::vector<double>{1, 3, 2, 4}), 4.0 / 6);  // five pairs grow, one falls
  EXPECT_TRUE(std::isnan(kendall_tau(std::vector<double>{1})));
}

TEST(PowerLawFit, FindsTheExponentAndSaysHowWellItFits) {
  std::vector<double> time, energy, stairs;
  for (int k = 1; k <= 4000; ++k) {
    time.push_back(5e-4 * k);
    energy.push_back(3 * std::pow(time.back(), 1.7));
    stairs.push_back(k < 3000 ? 1.0 : 100.0);
  }
  const PowerLaw exact = power_law(time, energy);
  EXPECT_NEAR(exact.exponent, 1.7, 1e-4);  // straight lines between the points
  EXPECT_NEAR(exact.determination, 1, 1e-6);
  EXPECT_LT(power_law(time, stairs).determination, 0.6);
  energy.assign(energy.size(), -1.0);
  EXPECT_TRUE(std::isnan(power_law(time, energy).exponent));
  EXPECT_TRUE(std::isnan(power_law({}, {}).exponent));
}

}  // namespace
}  // namespace jam
