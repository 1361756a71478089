#include "libdem/geometry/walls.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "libdem/geometry/twisted_blade.hpp"

namespace dem {
namespace {

std::vector<WallTouch> touches(const Wall& wall, double time, const Vec3& centre, double reach) {
  const WallPose pose = pose_at(wall.motion, time);
  std::vector<std::uint32_t> triangles;
  candidate_parts(wall, pose, centre, reach, triangles);
  std::vector<WallTouch> out;
  std::vector<MeshTouch> scratch;
  nearest(wall, pose, centre, reach, triangles, out, scratch);
  return out;
}

Wall blade() {
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  return {"blade", 0, make_mesh_wall(make_twisted_blade(shape)), {Vec3(0, 0, 5e-3), Vec3(0, 0, -0.02), Vec3(0, 0, 20)}};
}

TEST(Walls, APlaneIsNearestStraightBelow) {
  const Wall floor{"floor", 0, Plane{Vec3(0, 0, 1), Vec3::UnitZ()}, {}};
  const auto found = touches(floor, 0, Vec3(3, 4, 1.25), 0.3);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].distance, 0.25, 1e-15);
  EXPECT_NEAR((found[0].point - Vec3(3, 4, 1)).norm(), 0, 1e-15);
  EXPECT_NEAR((found[0].normal + Vec3::UnitZ()).norm(), 0, 1e-15);
  EXPECT_TRUE(touches(floor, 0, Vec3(3, 4, 1.35), 0.3).empty());
}

TEST(Walls, ACylinderIsNearestStraightOutward) {
  const Wall vessel{"cylinder", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), 12.5}, {}};
  for (double angle = 0; angle < 6; angle += 0.7) {
    const Vec3 outward(std::cos(angle), std::sin(angle), 0);
    const auto found = touches(vessel, 0, 12.1 * outward + Vec3(0, 0, 7), 0.5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].distance, 0.4, 1e-14);
    EXPECT_NEAR((found[0].normal - outward).norm(), 0, 1e-14);
    EXPECT_NEAR((found[0].point - 12.5 * outward - Vec3(0, 0, 7)).norm(), 0, 1e-14);
  }
  EXPECT_TRUE(touches(vessel, 0, Vec3(11.9, 0, 0), 0.5).empty());
  // On the axis every direction is as near as any other: one is given.
  const auto on_axis = touches(vessel, 0, Vec3(0, 0, 3), 13);
  ASSERT_EQ(on_axis.size(), 1u);
  EXPECT_NEAR(on_axis[0].distance, 12.5, 1e-14);
  EXPECT_NEAR(on_axis[0].normal.z(), 0, 1e-15);
}

TEST(Walls, AMovingBladeIsWhereItsMotionPutsIt) {
  const Wall wall = blade();
  const double time = 0.1;
  const WallPose pose = pose_at(wall.motion, time);
  EXPECT_NEAR((pose.position - Vec3(0, 0, 3e-3)).norm(), 0, 1e-18);
  // A grain that moves along with the blade keeps its touch.
  const Vec3 beside(5e-3, 1.2e-3, 5e-3);
  const auto before = touches(wall, 0, beside, 0.6e-3);
  const Vec3 carried = pose.position + pose.rotation * (beside - wall.motion.start);
  const auto after = touches(wall, time, carried, 0.6e-3);
  ASSERT_EQ(before.size(), 1u);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(before[0].feature, after[0].feature);
  EXPECT_NEAR(before[0].distance, after[0].distance, 1e-17);
  EXPECT_NEAR((pose.rotation * before[0].normal - after[0].normal).norm(), 0, 1e-13);
}

TEST(Walls, KnowTheirInside) {
  const Wall wall = blade();
  const WallPose pose = pose_at(wall.motion, 0);
  EXPECT_TRUE(inside_material(wall, pose, Vec3(0, 0, 5e-3)));       // in the hub
  EXPECT_TRUE(inside_material(wall, pose, Vec3(8e-3, 0, 5e-3)));    // in an arm
  EXPECT_FALSE(inside_material(wall, pose, Vec3(0, 8e-3, 5e-3)));   // between the arms
  EXPECT_FALSE(inside_material(wall, pose, Vec3(12e-3, 0, 5e-3)));  // in the gap
  const Wall vessel{"cylinder", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), 12.5e-3}, {}};
  EXPECT_FALSE(inside_material(vessel, pose_at({}, 0), Vec3(12e-3, 0, 0)));
  EXPECT_TRUE(inside_material(vessel, pose_at({}, 0), Vec3(12e-3, 5e-3, 0)));
}

}  // namespace
}  // namespace dem
