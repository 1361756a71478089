#include "libdem/simulation/foresight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dem {
namespace {

constexpr double step = 1e-6;

ChunkMotion moving(double speed, double jolt) {
  ChunkMotion motion;
  motion.speed[1] = speed;
  motion.jolt[2] = jolt;
  return motion;
}

// No two grains, and no grain and wall, near each other faster than that; grains that fly at each other along a diagonal do so as fast.
TEST(Foresight, ClosingSpeedIsABoundAndCanBeReached) {
  const double root_three = std::sqrt(3.0);
  for (const double wall_speed : {0.0, 1.0, 10.0}) {
    Foresight f(step, 0, wall_speed);
    f.lay_out(2);
    f.remember(moving(1.5, 0), 0, true);
    f.remember(moving(0.5, 0), 1, true);
    const double reached = root_three * 1.5 + std::max(root_three * 1.5, wall_speed);
    EXPECT_GE(f.closing_speed(), reached);
    EXPECT_NEAR(f.closing_speed(), reached, 1e-14);
    EXPECT_EQ(f.wall_speed(), wall_speed);
    EXPECT_EQ(f.travel_until_all_due(), 0);  // all are due at every step
    f.go_on();
    f.go_on();
    EXPECT_NEAR(f.odometer, 2 * step * reached, 1e-20);
  }
}

// Between two steps at which all are due a chunk is as fast as it ever was; then as fast as it is.
TEST(Foresight, RemembersTheFastestUntilAllAreDue) {
  Foresight f(step, 3, 0);
  f.lay_out(1);
  f.remember(moving(1, 0), 0, true);
  const double one = f.closing_speed();
  f.remember(moving(2, 0), 0, false);
  f.remember(moving(0.5, 0), 0, false);
  EXPECT_NEAR(f.closing_speed(), 2 * one, 1e-14);
  f.remember(moving(0.5, 0), 0, true);
  EXPECT_NEAR(f.closing_speed(), 0.5 * one, 1e-14);
}

// A grain that goes on to speed up as it did is within what was foreseen, however it and its neighbour push.
TEST(Foresight, LooksAheadForAsLongAsTheHighestLevelWaits) {
  constexpr std::uint8_t levels = 3;
  const double speed = 1, jolt = 0.25;
  Foresight f(step, levels, 0);
  f.lay_out(2);
  f.remember(moving(speed, jolt), 0, true);
  f.remember(moving(0, 0), 1, true);
  f.look_ahead();
  const double root_three = std::sqrt(3.0);
  EXPECT_NEAR(f.until_all_due, 8 * step * 2 * root_three * (speed + jolt), 1e-18);
  EXPECT_NEAR(f.closing_jolt[0], 2 * root_three * jolt, 1e-14);
  EXPECT_EQ(f.closing_jolt[1], 0);
  EXPECT_NEAR(f.travel_until_all_due(), 2 * 8 * step * f.closing_speed(), 1e-18);
  // Grains laid out anew may be in any chunk: each takes the largest.
  f.lay_out(3);
  EXPECT_EQ(f.closing_jolt, std::vector<double>(3, f.closing_jolt[0]));
  EXPECT_EQ(f.closing_speed(), 0);
}

TEST(Foresight, BeginsWithTheGrainsThatThereAre) {
  constexpr std::size_t n = 1300;  // three chunks
  const RowChunks chunks(n);
  LargeArray<GrainRow> rows(n + chunks.count(), phantom());
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  double fastest = 0;
  for (std::size_t r = 0; r < n; ++r) {
    rows[r].motion = Vec4(draw(random), draw(random), draw(random), 1e9);  // then no part of a velocity
    fastest = std::max(fastest, rows[r].velocity().cwiseAbs().maxCoeff());
  }
  Foresight f(step, 2, 0);
  f.lay_out(chunks.count());
  f.begin(rows, chunks);
  EXPECT_NEAR(f.closing_speed(), 2 * std::sqrt(3.0) * fastest, 1e-14);
  EXPECT_NEAR(f.until_all_due, 4 * step * f.closing_speed(), 1e-18);
}

}  // namespace
}  // namespace dem
