#include "libjam/partial_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "libjam/errors.hpp"
#include "libjam/results_file.hpp"
#include "libjam/snapshot/schema.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::hand_made_run;
using hand_made::random_network;
using ::testing::HasSubstr;

constexpr std::size_t frame_count = 50;

// A run of 50 frames, with a series of three windows to a frame and stays of particles in it, some still open at a frame. Its blade turns in all frames but
// the first two, and a frame has no velocities.
struct WholeRun {
  RunInfo info = hand_made_run();
  Criteria criteria;
  std::vector<Snapshot> frames;
  Series series;
  std::vector<std::size_t> rows;  // of the series up to and with each frame

  WholeRun() {
    info.dt = 1e-6;
    info.watch_force = 12;
    criteria.jam_force = 15;
    criteria.end_force = 12;
    criteria.hold_off = 0.002;
    std::mt19937_64 random(9);
    for (unsigned k = 0; k < frame_count; ++k) {
      Snapshot s = random_network(k, 200, 12);
      if (k % 8 == 3 || k % 8 >= 6) s = hand_made::unloaded(s);  // pauses of one frame and of two
      s.time = 0.002 * (k + 1);
      s.step = 2000 * (k + 1);
      s.walls[hand_made::blade_wall].velocity = Vec3(0, 0, -0.02);
      if (k >= 2) s.walls[hand_made::blade_wall].angular_velocity = Vec3(0, 0, 20 + 0.1 * k);
      const auto speed = [&] { return float(random() % 1000) / 3000; };
      for (std::size_t p = 0; p < s.particles.size() && k != 20; ++p) s.particles.velocity.push_back(Vec3f(speed(), speed(), speed()));
      frames.push_back(s);
      for (unsigned w = 1; w <= 3; ++w) {
        const std::uint64_t step = 2000 * k + 600 * w + (w == 3 ? 200 : 0);
        series.time.push_back(1e-6 * double(step));
        series.step.push_back(step);
        series.largest_compressive_force.push_back(float(random() % 40));
        series.jammed_count.push_back(1);
        series.kinetic_energy.push_back(1);
        series.largest_overlap.push_back(0.1);
        series.ended_pp.push_back({std::uint32_t(random() % 5), 3});
        series.ended_pw.push_back({1});
        const auto stays = std::uint32_t(random() % 3);
        series.excursion_count.push_back(stays);
        for (std::uint32_t e = 0; e < stays; ++e) {
          Excursions& x = series.excursions;
          const std::uint64_t last = step - random() % 500, first = last - std::min<std::uint64_t>(last, random() % 3000);
          x.particle.push_back(ParticleId(random() % 30));
          x.first_step.push_back(first);
          x.peak_step.push_back(first);
          x.last_step.push_back(last);
          x.peak_force.push_back(float(12 + random() % 30));
          for (auto* column : {&x.impulse, &x.work, &x.path, &x.turned}) column->push_back(float(random() % 100));
          for (auto* column : {&x.first_position, &x.peak_position, &x.last_position}) column->push_back(Vec3f(0.01F, float(random() % 3) - 1, 0));
          x.open.push_back(w == 3 && random() % 2 ? 1 : 0);
        }
      }
      rows.push_back(series.size());
    }
  }

  PartialAnalysis part(std::size_t first, std::size_t last) const {
    const Pipeline pipeline(info, criteria);
    PartialAnalysis p{info, pipeline.criteria(), first, {}, schema::rows_of(series, first == 0 ? 0 : rows[first - 1], rows[last - 1]), 0,
                      {"run " + std::to_string(first) + ".h5"}, {"jamscope", "analyze"}};
    for (std::size_t k = first; k < last; ++k) add_frame(p, pipeline.examine(frames[k], k));
    return p;
  }
};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class PartialFile : public testing::Test {
 protected:
  PartialFile() : folder_(std::filesystem::path(testing::TempDir()) / ("partial_" + std::to_string(getpid()))) { std::filesystem::create_directories(folder_); }
  ~PartialFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(PartialFile, SaysWhereItsFramesWereReadFrom) {
  const WholeRun run;
  for (const std::size_t first : {0, 7}) write_partial(folder_ / (std::to_string(first) + ".h5"), run.part(first, first + 7));
  const PartialAnalysis both = joined({read_partial(folder_ / "7.h5"), read_partial(folder_ / "0.h5")}, {"second", "first"});
  EXPECT_THAT(both.inputs, testing::ElementsAre("run 0.h5"));
  EXPECT_THAT(both.command_line, testing::ElementsAre("jamscope", "analyze"));
}

// The run cut into 1 to 50 parts, each through a file; neighbours are joined in a random order, each time through a file again: the results file is
// the same byte for byte, and it is that of a pipeline that saw all frames.
TEST_F(PartialFile, AnyCuttingGivesTheSameBytes) {
  const WholeRun run;
  Pipeline pipeline(run.info, run.criteria);
  for (const Snapshot& s : run.frames) pipeline.add(s);
  const Analysis at_once = pipeline.finish(run.series);
  ASSERT_GT(at_once.events.size(), 5u);
  ASSERT_GT(at_once.every_step.at(1).jams.size(), 5u);
  ASSERT_FALSE(at_once.contact_life.empty());
  const auto known = std::count_if(at_once.flow_pattern.begin(), at_once.flow_pattern.end(), [](const FlowBin& bin) { return std::isfinite(bin.azimuthal); });
  ASSERT_GT(known, 10);
  write_results(folder_ / "whole.h5", at_once, run.info);
  const std::string whole = bytes_of(folder_ / "whole.h5");
  std::mt19937_64 random(4);
  for (const std::size_t cuts : {0, 1, 2, 5, 17, 49}) {
    std::vector<std::size_t> at{0, frame_count};
    while (at.size() < cuts + 2) {
      const std::size_t cut = 1 + random() % (frame_count - 1);
      if (std::find(at.begin(), at.end(), cut) == at.end()) at.push_back(cut);
    }
    std::sort(at.begin(), at.end());
    std::vector<PartialAnalysis> parts;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      write_partial(folder_ / "part.h5", run.part(at[k], at[k + 1]));
      parts.push_back(read_partial(folder_ / "part.h5"));
    }
    while (parts.size() > 1) {
      const std::size_t k = random() % (parts.size() - 1);
      write_partial(folder_ / "part.h5", joined({parts[k + 1], parts[k]}, {"right", "left"}));
      parts[k] = read_partial(folder_ / "part.h5");
      parts.erase(parts.begin() + std::ptrdiff_t(k) + 1);
    }
    const Analysis glued = finish(parts[0]);
    EXPECT_EQ(events_csv(glued), events_csv(at_once));
    EXPECT_EQ(step_jams_csv(glued), step_jams_csv(at_once));
    write_results(folder_ / "glued.h5", glued, run.info);
    EXPECT_EQ(bytes_of(folder_ / "glued.h5"), whole) << cuts << " cuts";
  }
}

// However many grains are under load, a part keeps some, and the analysis the strongest of all frames, cut or not.
TEST(PartialAnalysisOfManyLoads, KeepsTheStrongest) {
  constexpr std::size_t grains = 90'000, frames = 20;  // 1.8 million
  std::mt19937_64 random(3);
  std::vector<ExaminedFrame> all(frames);
  std::vector<double> forces;
  LoadedGrains at_once;
  for (ExaminedFrame& f : all) {
    for (std::size_t k = 0; k < grains; ++k) {
      f.loaded.push_back({ParticleId(k), double(random() >> 11) * 0x1.0p-43, Vec3f::Zero(), 0, false});
      forces.push_back(f.loaded.back().force);
    }
    at_once.add(f.loaded);
  }
  std::sort(forces.begin(), forces.end(), std::greater<>());
  PartialAnalysis left, right;
  for (std::size_t k = 0; k < frames; ++k) add_frame(k < 9 ? left : right, all[k]);
  EXPECT_LE(left.loaded, 4 * LoadedGrains::most);
  for (ExaminedFrame& f : right.frames) add_frame(left, std::move(f));
  EXPECT_LE(left.loaded, 4 * LoadedGrains::most);
  LoadedGrains glued;
  for (const ExaminedFrame& f : left.frames) glued.add(f.loaded);
  for (LoadedGrains* kept : {&at_once, &glued}) {
    kept->keep(LoadedGrains::most);
    EXPECT_EQ(kept->grains.size(), LoadedGrains::most);
    EXPECT_EQ(kept->floor, forces[LoadedGrains::most]);
  }
  EXPECT_EQ(at_once.count, glued.count);
}

// The flow takes the same room for any number of frames: the first frame of a part has the sums of all.
TEST_F(PartialFile, KeepsOneFlowForAllFrames) {
  const WholeRun run;
  const PartialAnalysis part = run.part(0, 30);
  EXPECT_EQ(part.frames[0].flow.bins.size(), FlowBin::count);  // whose own blade does not turn
  for (std::size_t k = 1; k < part.frames.size(); ++k) EXPECT_TRUE(part.frames[k].flow.bins.empty());
  PartialAnalysis broken = part;
  broken.frames[0].flow.bins.pop_back();
  write_partial(folder_ / "part.h5", broken);
  try {
    read_partial(folder_ / "part.h5");
    FAIL();
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("/partial/flow: has 53 rows, expected 54"));
  }
}

// A part by itself is the analysis of its frames.
TEST_F(PartialFile, APartFromTheMiddleStandsByItself) {
  const WholeRun run;
  write_partial(folder_ / "part.h5", run.part(10, 20));
  const Analysis part = finish(read_partial(folder_ / "part.h5"));
  EXPECT_EQ(part.frames.size(), 10u);
  write_results(folder_ / "part_results.h5", part, run.info);
  EXPECT_EQ(read_results(folder_ / "part_results.h5").clusters.size(), part.clusters.size());
}

TEST_F(PartialFile, RefusesWhatDoesNotBelongTogether) {
  const WholeRun run;
  const auto problem = [&](PartialAnalysis a, PartialAnalysis b) -> std::string {
    try {
      joined({std::move(a), std::move(b)}, {"a.h5", "b.h5"});
    } catch (const DataError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(problem(run.part(0, 5), run.part(6, 9)), HasSubstr("b.h5: begins at frame 6, expected frame 5, where a.h5 ends"));
  EXPECT_THAT(problem(run.part(0, 5), run.part(3, 9)), HasSubstr("expected frame 5"));
  PartialAnalysis other = run.part(5, 9);
  other.criteria.jam_force = 16;
  EXPECT_THAT(problem(run.part(0, 5), other), HasSubstr("other criteria"));
  other = run.part(5, 9);
  other.run.seed = 77;
  EXPECT_THAT(problem(run.part(0, 5), other), HasSubstr("another run"));
  EXPECT_EQ(problem(run.part(5, 9), run.part(0, 5)), "");
  write_results(folder_ / "results.h5", finish(run.part(0, 5)), run.info);
  EXPECT_THROW(read_partial(folder_ / "results.h5"), DataError);
  EXPECT_THROW(read_partial(folder_ / "missing.h5"), DataError);
}

}  // namespace
}  // namespace jam
