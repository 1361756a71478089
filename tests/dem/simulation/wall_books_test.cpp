#include "libdem/simulation/wall_books.hpp"

#include <gtest/gtest.h>

namespace dem {
namespace {

// Two chunks of grains: contacts of the first with walls 0 and 1, of the second with wall 1.
WallContacts contacts() {
  WallContacts walls;
  walls.chunk.resize(3);
  walls.chunk[1].wall = walls.chunk[2].wall = 1;
  walls.chunk_begin = {0, 2, 3};
  return walls;
}

void press(WallContacts::Chunk& chunk, double force, double stride = 1) {
  chunk.load = {Vec3(force, 0, 0), Vec3(0, 0, 2 * force)};
  chunk.share = {stride * chunk.load.force, stride * chunk.load.torque};
  chunk.share_of_label[1] = chunk.share;
}

const std::vector<std::uint32_t> both{0, 1}, second{1};

std::vector<WallPose> poses() {
  std::vector<WallPose> poses(2);
  poses[1].velocity = Vec3(-3, 0, 0);
  poses[1].angular_velocity = Vec3(0, 0, 0.5);
  return poses;
}

// Loads at the steps 1 to 4; at the second and the fourth not all contacts are evaluated.
TEST(WallBooks, MeansAreOverAllStepsAndExtremesOverThoseAtWhichAllIsThere) {
  WallContacts walls = contacts();
  WallBooks books(2);
  const double step = 0.25;
  press(walls.chunk[0], 1, 2);
  press(walls.chunk[1], 10, 2);
  press(walls.chunk[2], 5);
  books.record(walls, both, true, poses(), step);
  EXPECT_EQ(books.loads()[0].force.x(), 1);
  EXPECT_EQ(books.loads()[1].force.x(), 15);
  press(walls.chunk[2], 7);
  books.record(walls, second, false, poses(), step);
  EXPECT_EQ(books.loads()[1].force.x(), 15) << "of the last evaluation of all contacts";
  press(walls.chunk[0], 2, 2);
  press(walls.chunk[1], -4, 2);
  press(walls.chunk[2], 6);
  books.record(walls, both, true, poses(), step);
  press(walls.chunk[2], 8);
  books.record(walls, second, false, poses(), step);

  const std::vector<Window::Load> means = books.means(4);
  EXPECT_EQ(means[0].force.x(), (2.0 + 0 + 4 + 0) / 4);
  EXPECT_EQ(means[1].force.x(), (25.0 + 7 - 2 + 8) / 4);
  EXPECT_EQ(means[1].torque.z(), 2 * means[1].force.x());
  EXPECT_EQ(means[1].of_label[1].force.x(), means[1].force.x());
  EXPECT_EQ(means[1].force_max.x(), 15);
  EXPECT_EQ(means[1].force_min.x(), 2);
  EXPECT_EQ(means[1].torque_max.z(), 30);
  // -(F v + T w) = 3 F - 0.5 * 2 F: W; a wall that rests gives none.
  EXPECT_EQ(means[1].power, 2 * means[1].force.x());
  EXPECT_EQ(means[0].power, 0);
  // By the trapezoid rule from no power at the beginning.
  EXPECT_EQ(books.work[1], step * 2 * (0.5 * 25 + 0.5 * (25 + 7) + 0.5 * (7 - 2) + 0.5 * (-2 + 8)));
  EXPECT_EQ(books.last_power[1], 16);
  EXPECT_EQ(books.work[0], 0);
}

TEST(WallBooks, AWindowWithoutStepsIsZeroAndWorkOutlivesWindows) {
  WallContacts walls = contacts();
  WallBooks books(2);
  press(walls.chunk[1], 4);
  books.sum(walls, both, true);
  books.begin_work(poses());
  EXPECT_EQ(books.last_power[1], 8);
  books.record(walls, both, true, poses(), 1);
  EXPECT_EQ(books.work[1], 8);
  books.begin_window();
  EXPECT_EQ(books.work[1], 8);
  for (const Window::Load& load : books.means(0)) {
    EXPECT_TRUE(load.force.isZero(0) && load.torque.isZero(0) && load.force_min.isZero(0) && load.force_max.isZero(0));
    EXPECT_EQ(load.power, 0);
  }
}

}  // namespace
}  // namespace dem
