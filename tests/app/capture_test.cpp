#include "apps/jamscope/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libjam/snapshot/reader.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::ElementsAre;

constexpr double dt = 1e-6;

jam::Snapshot frame_at(std::uint64_t step, std::size_t particles = 1) {
  jam::Snapshot s;
  s.step = step;
  s.time = double(step) * dt;
  for (std::size_t k = 0; k < particles; ++k) {
    s.particles.id.push_back(jam::ParticleId(k));
    s.particles.position.emplace_back(float(k), float(step), 0.5F);
    s.particles.radius.push_back(1e-3F);
  }
  return s;
}

jam::RunInfo info() {
  jam::RunInfo run;
  run.dt = dt;
  run.watch_force = 20;
  return run;
}

std::vector<std::uint64_t> steps_in(const std::filesystem::path& path) {
  const jam::SnapshotSource source = jam::open_jamscope_file(path);
  std::vector<std::uint64_t> steps;
  for (std::size_t k = 0; k < source.frames; ++k) steps.push_back(source.read(k).step);
  return steps;
}

// A frame every 10 steps, a jam between some of them: the frames from 30 steps before to 20 after are kept, and no others.
TEST(Capture, KeepsTheFramesAroundJams) {
  const Scratch scratch;
  Capture capture(scratch / "capture.h5", info(), {10 * dt, 30 * dt, 20 * dt, 1e9}, std::nullopt);
  for (std::uint64_t step = 10; step <= 400; step += 10) capture.offer(frame_at(step), step == 100 || step == 110 || (step >= 300 && step <= 320));
  EXPECT_THAT(steps_in(scratch / "capture.h5"),
              ElementsAre(60, 70, 80, 90, 100, 110, 120, 130, 260, 270, 280, 290, 300, 310, 320, 330, 340));
  EXPECT_EQ(capture.windows(), 2u);
  EXPECT_EQ(capture.windows_left_out(), 0u);
}

// Jams closer than before + after share their frames: each is there once.
TEST(Capture, WindowsThatMeetAreOne) {
  const Scratch scratch;
  Capture capture(scratch / "capture.h5", info(), {10 * dt, 30 * dt, 20 * dt, 1e9}, std::nullopt);
  for (std::uint64_t step = 10; step <= 200; step += 10) capture.offer(frame_at(step), step == 100 || step == 140);
  EXPECT_THAT(steps_in(scratch / "capture.h5"), ElementsAre(60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160));
}

TEST(Capture, WithoutAJamMakesNoFile) {
  const Scratch scratch;
  Capture capture(scratch / "capture.h5", info(), {10 * dt, 30 * dt, 20 * dt, 1e9}, std::nullopt);
  for (std::uint64_t step = 10; step <= 200; step += 10) capture.offer(frame_at(step), false);
  EXPECT_FALSE(std::filesystem::exists(scratch / "capture.h5"));
}

// At its limit the file grows no more, the first jam stays, and the others are counted.
TEST(Capture, StopsAtItsLimitAndCountsWhatItLeavesOut) {
  const Scratch scratch;
  Capture capture(scratch / "capture.h5", info(), {10 * dt, 30 * dt, 20 * dt, 60e3}, std::nullopt);
  for (std::uint64_t step = 10; step <= 1000; step += 10) capture.offer(frame_at(step, 2000), step % 200 == 100);
  const auto size = std::filesystem::file_size(scratch / "capture.h5");
  EXPECT_GT(size, 60e3);
  EXPECT_LT(size, 400e3);
  const auto steps = steps_in(scratch / "capture.h5");
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front(), 60u);
  EXPECT_EQ(capture.windows() + capture.windows_left_out(), 5u);
  EXPECT_GT(capture.windows_left_out(), 0u);
}

// Going on from a checkpoint drops the frames after it and writes none twice.
TEST(Capture, GoesOnFromACheckpoint) {
  const Scratch scratch;
  const dem::Capture plan{10 * dt, 30 * dt, 20 * dt, 1e9};
  {
    Capture capture(scratch / "capture.h5", info(), plan, std::nullopt);
    for (std::uint64_t step = 10; step <= 120; step += 10) capture.offer(frame_at(step), step == 100);
  }
  Capture capture(scratch / "capture.h5", info(), plan, 100);
  for (std::uint64_t step = 110; step <= 200; step += 10) capture.offer(frame_at(step), step == 110);
  EXPECT_THAT(steps_in(scratch / "capture.h5"), ElementsAre(60, 70, 80, 90, 100, 110, 120, 130));
}

}  // namespace
}  // namespace jamscope
