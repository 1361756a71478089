#include "libdem/geometry/wall_motion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "libdem/errors.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using test::random_direction;
using test::uniform;

Eigen::Quaterniond random_orientation(std::mt19937_64& rng) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(rng, 0, 6), random_direction(rng)));
}

std::vector<PoseRow> random_rows(std::mt19937_64& rng) {
  std::vector<PoseRow> rows;
  double time = -0.3;
  for (int k = 0; k < 8; ++k) {
    time += uniform(rng, 0.05, 0.5);
    rows.push_back({time, random_direction(rng), random_orientation(rng)});
  }
  return rows;
}

// Velocity and angular velocity of the pose by central differences, h in s.
void expect_rates(const WallMotion& motion, double time, double tolerance) {
  const double h = 1e-5;
  const WallPose pose = pose_at(motion, time), before = pose_at(motion, time - h), after = pose_at(motion, time + h);
  EXPECT_NEAR(((after.position - before.position) / (2 * h) - pose.velocity).norm(), 0, tolerance);
  // R' R^T is the cross product with the angular velocity.
  const Eigen::Matrix3d w = (after.rotation - before.rotation) / (2 * h) * pose.rotation.transpose();
  EXPECT_NEAR((Vec3(w(2, 1), w(0, 2), w(1, 0)) - pose.angular_velocity).norm(), 0, tolerance);
  EXPECT_NEAR((pose.rotation - pose.orientation.toRotationMatrix()).norm(), 0, 1e-15);
  EXPECT_NEAR(pose.orientation.norm(), 1, 1e-14);
}

TEST(WallMotion, SteadyVelocitiesAreThoseOfThePose) {
  std::mt19937_64 rng(1);
  for (int k = 0; k < 100; ++k) {
    WallMotion motion;
    motion.start = random_direction(rng);
    motion.velocity = random_direction(rng);
    motion.angular_velocity = uniform(rng, 0, 3) * random_direction(rng);
    motion.pivot = random_direction(rng);
    motion.orientation = random_orientation(rng);
    // The differences err by (spin h)^2 / 6 times a spin of 3 and by rounding 1e-16/h.
    expect_rates(motion, uniform(rng, 0, 10), 2e-9);
  }
}

TEST(WallMotion, ThePivotMovesStraight) {
  std::mt19937_64 rng(2);
  WallMotion motion;
  motion.start = Vec3(1, 2, 3);
  motion.velocity = Vec3(0.5, 0, -0.25);
  motion.angular_velocity = Vec3(1, -2, 3);
  motion.pivot = Vec3(0.3, 0.1, -0.2);
  motion.orientation = random_orientation(rng);
  EXPECT_NEAR((pose_at(motion, 0).position - motion.start).norm(), 0, 1e-15);
  for (int k = 0; k < 50; ++k) {
    const double time = uniform(rng, 0, 20);
    const WallPose pose = pose_at(motion, time);
    const Vec3 pivot = pose.position + pose.rotation * motion.pivot;
    EXPECT_NEAR((pivot - (motion.start + motion.orientation * motion.pivot + time * motion.velocity)).norm(), 0, 1e-14);
  }
}

TEST(WallMotion, ATableGoesThroughItsRowsAtConstantVelocities) {
  std::mt19937_64 rng(3);
  for (int k = 0; k < 20; ++k) {
    const std::vector<PoseRow> rows = random_rows(rng);
    WallMotion motion;
    motion.table = std::make_shared<const PoseTable>(rows);
    for (const PoseRow& row : rows) {
      const WallPose pose = pose_at(motion, row.time);
      EXPECT_NEAR((pose.position - row.position).norm(), 0, 1e-15);
      EXPECT_NEAR((pose.rotation - row.orientation.toRotationMatrix()).norm(), 0, 1e-14);
      // Reached from before as well.
      const WallPose before = pose_at(motion, row.time - 1e-12);
      EXPECT_NEAR((before.position - row.position).norm(), 0, 1e-10);
      EXPECT_NEAR((before.rotation - row.orientation.toRotationMatrix()).norm(), 0, 1e-9);
    }
    for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
      const double share = uniform(rng, 0.1, 0.9);
      const double time = rows[r].time + share * (rows[r + 1].time - rows[r].time);
      const WallPose pose = pose_at(motion, time);
      EXPECT_NEAR((pose.position - ((1 - share) * rows[r].position + share * rows[r + 1].position)).norm(), 0, 1e-14);
      const Eigen::Quaterniond slerp = rows[r].orientation.slerp(share, rows[r + 1].orientation);
      EXPECT_NEAR((pose.rotation - slerp.toRotationMatrix()).norm(), 0, 1e-13);
      // At most half a turn in 0.05 s: a spin of 63 rad/s, so (spin h)^2 / 6 of it is 4e-6.
      expect_rates(motion, time, 1e-5);
    }
  }
}

TEST(WallMotion, BeforeAndAfterItsTableAWallRests) {
  std::mt19937_64 rng(4);
  const std::vector<PoseRow> rows = random_rows(rng);
  const PoseTable table(rows);
  const auto expect_rest = [](const WallPose& pose, const PoseRow& row) {
    EXPECT_EQ(pose.position, row.position);
    EXPECT_NEAR((pose.rotation - row.orientation.toRotationMatrix()).norm(), 0, 1e-14);
    EXPECT_EQ(pose.velocity, Vec3(Vec3::Zero()));
    EXPECT_EQ(pose.angular_velocity, Vec3(Vec3::Zero()));
  };
  expect_rest(table.at(rows.front().time - 1e-9), rows.front());
  expect_rest(table.at(-1e9), rows.front());
  expect_rest(table.at(rows.back().time), rows.back());
  expect_rest(table.at(1e9), rows.back());
  EXPECT_GT(table.at(rows.front().time).velocity.norm(), 0);
}

TEST(WallMotion, OppositeQuaternionsAreOneOrientation) {
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
  Eigen::Quaterniond opposite = quarter;
  opposite.coeffs() *= -3;  // lengths do not matter either
  const PoseTable table({{0, Vec3::Zero(), Eigen::Quaterniond::Identity()}, {2, Vec3::UnitX(), opposite}});
  EXPECT_NEAR((table.at(1).angular_velocity - Vec3(0, 0, 0.25)).norm(), 0, 1e-15);
  EXPECT_NEAR((table.at(1).velocity - Vec3(0.5, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(table.rows()[1].orientation.norm(), 1, 1e-15);
}

TEST(WallMotion, AWallCanBeStoppedWhereItIs) {
  std::mt19937_64 rng(5);
  WallMotion motion;
  motion.table = std::make_shared<const PoseTable>(random_rows(rng));
  const WallPose there = pose_at(motion, 0.7), rest = pose_at(resting_at(motion, 0.7), 1e3);
  EXPECT_EQ(rest.position, there.position);
  EXPECT_EQ(rest.rotation, there.rotation);
  EXPECT_EQ(rest.velocity, Vec3(Vec3::Zero()));
  EXPECT_EQ(rest.angular_velocity, Vec3(Vec3::Zero()));
}

TEST(WallMotion, TablesThatSayNoMotionAreRefused) {
  const auto one = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond half(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 o = Vec3::Zero();
  EXPECT_THROW(PoseTable({}), CaseError);
  EXPECT_THROW(PoseTable({{0, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{0, o, one}, {0, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{1, o, one}, {0, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{0, o, one}, {nan, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{0, Vec3(0, nan, 0), one}, {1, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{0, o, Eigen::Quaterniond(0, 0, 0, 0)}, {1, o, one}}), CaseError);
  EXPECT_THROW(PoseTable({{0, o, one}, {1, o, half}}), CaseError);
  EXPECT_NO_THROW(PoseTable({{0, o, one}, {1, o, one}}));
  WallMotion motion;
  motion.orientation = Eigen::Quaterniond(2, 0, 0, 0);
  EXPECT_THROW(validate_motion(motion), CaseError);
  motion.orientation = one;
  motion.velocity.x() = nan;
  EXPECT_THROW(validate_motion(motion), CaseError);
}

}  // namespace
}  // namespace dem
