#include "libjam/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "libjam/errors.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/results_file.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using hand_made::vessel_wall;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Ten frames, 2 ms apart:
//
//   frame              0  1  2  3  4  5  6  7  8  9
//   (1)  blade|1|wall  .  x  x  .  .  .  .  .  .  .     hands over to the pair without a free frame
//   (2)(3) bridge      .  .  .  x  x  .  .  .  .  .
//   (4)  blade|4       .  .  .  .  .  .  .  x  .  .     pressed by the blade and by (5), away from the wall: no bridge
std::vector<Snapshot> story() {
  std::vector<Snapshot> frames;
  for (int k = 0; k < 10; ++k) {
    Network network(0.002 * k);
    for (const ParticleId id : {1u, 2u, 3u}) network.grain(id, Vec3f(0.0105f, 0.001f * static_cast<float>(id), 0));
    network.grain(4, Vec3f(0.005f, 0, 0)).grain(5, Vec3f(0.004f, 0, 0));
    if (k == 1 || k == 2) network.press(1, blade_wall, 40.0f * static_cast<float>(k)).press(1, vessel_wall, 40);
    if (k == 3 || k == 4) network.press(2, blade_wall, 30).touch(2, 3, 30).press(3, vessel_wall, 30);
    if (k == 7) network.press(4, blade_wall, 15).touch(4, 5, 15);
    Snapshot snapshot = network.snapshot();
    snapshot.step = static_cast<std::uint64_t>(1000 * k);
    snapshot.walls[blade_wall].velocity = Vec3(0, 0, -0.02);
    snapshot.walls[blade_wall].force = Vec3(0, 0, 50);
    frames.push_back(snapshot);
  }
  return frames;
}

Analysis analyze(const std::vector<Snapshot>& frames, const RunInfo& info = hand_made_run(),
                 const Series& series = {}) {
  Pipeline pipeline(info, Criteria{});
  for (const Snapshot& frame : frames) pipeline.add(frame);
  return pipeline.finish(series);
}

TEST(PipelineTest, TellsTheStoryOfTheRun) {
  const Analysis a = analyze(story());
  EXPECT_NEAR(a.sampling_interval, 0.002, 1e-15);
  EXPECT_NEAR(a.observed_time, 0.020, 1e-15);

  ASSERT_EQ(a.events.size(), 2u);
  EXPECT_THAT(a.events[0].members, ElementsAre(1, 2, 3));
  EXPECT_EQ(a.events[0].first_frame, 1u);
  EXPECT_EQ(a.events[0].last_frame, 4u);
  EXPECT_TRUE(a.events[0].bridged);
  EXPECT_EQ(a.events[0].peak_force, 120);
  EXPECT_EQ(a.events[0].peak_particle, 1u);
  EXPECT_TRUE(a.events[0].peak_in_gap);
  EXPECT_THAT(a.events[1].members, ElementsAre(4));
  EXPECT_FALSE(a.events[1].bridged);
  EXPECT_FALSE(a.events[1].peak_in_gap);

  ASSERT_EQ(a.tracks.size(), 4u);
  ASSERT_EQ(a.clusters.size(), 5u);
  EXPECT_THAT(a.clusters[2].members, ElementsAre(2, 3));
  EXPECT_EQ(a.clusters[2].frame, 3u);
  EXPECT_TRUE(a.clusters[2].bridges);
  EXPECT_FALSE(a.clusters[4].bridges);

  EXPECT_EQ(a.jammed_histogram, (std::vector<std::uint32_t>{5, 3, 2}));
  EXPECT_NEAR(a.jammed_in_gap_share, 6.0 / 7.0, 1e-15);
  EXPECT_NEAR(a.jammed_time, 0.010, 1e-15);
  EXPECT_NEAR(a.jam_frequency, 100, 1e-9);
  EXPECT_EQ(a.survival_classes.at(0).events, 2u);  // 8 ms and 2 ms
  EXPECT_THAT(a.notes, Contains(HasSubstr("flow energy")));
}

TEST(PipelineTest, SummarizesEachFrame) {
  const Analysis a = analyze(story());
  ASSERT_EQ(a.frames.size(), 10u);
  const FrameSummary& free = a.frames[0];
  EXPECT_EQ(free.particles, 5u);
  EXPECT_EQ(free.coordination, 0);
  EXPECT_EQ(free.largest_compressive_force, 0);
  EXPECT_EQ(free.largest_particle, 1u);  // all equal: the smallest id
  const FrameSummary& pair = a.frames[3];
  EXPECT_EQ(pair.step, 3000u);
  EXPECT_EQ(pair.particle_contacts, 1u);
  EXPECT_EQ(pair.wall_contacts, 2u);
  EXPECT_DOUBLE_EQ(pair.coordination, 2.0 / 5.0);
  EXPECT_DOUBLE_EQ(pair.coordination_with_walls, 4.0 / 5.0);
  EXPECT_EQ(pair.largest_compressive_force, 60);
  EXPECT_EQ(pair.largest_particle, 2u);
  EXPECT_DOUBLE_EQ(pair.mean_compressive_force, 24);
  EXPECT_EQ(pair.jammed, 2u);
  EXPECT_EQ(pair.jammed_in_gap, 2u);
  EXPECT_EQ(pair.bridges, 1u);
  EXPECT_EQ(pair.largest_bridge, 2u);
  EXPECT_EQ(a.frames[7].jammed, 1u);
  EXPECT_EQ(a.frames[7].jammed_in_gap, 0u);
  EXPECT_EQ(a.frames[7].bridges, 0u);
}

TEST(PipelineTest, RecordsTheMetricsAskedForAndThoseOfLowCostOtherwise) {
  const auto frames = story();
  std::size_t low = 0;
  for (const Metric& metric : metrics()) low += metric.cost == Cost::low;
  EXPECT_EQ(analyze(frames).metrics.size(), low);
  Criteria criteria;
  criteria.metrics = {"bridge_conductance", "coordination", "bridge_conductance"};
  Pipeline pipeline(hand_made_run(), criteria);
  for (const Snapshot& frame : frames) pipeline.add(frame);
  const Analysis a = pipeline.finish({});
  ASSERT_EQ(a.metrics.size(), 2u);
  EXPECT_EQ(a.metrics[0].name, "coordination");  // in the order of the table, each once
  EXPECT_EQ(a.metrics[1].name, "bridge_conductance");
  EXPECT_EQ(a.metrics[1].unit, "N");
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(a.metrics[0].values.at(k), a.frames[k].coordination);
  criteria.metrics = {"no_such_metric"};
  EXPECT_THROW(Pipeline(hand_made_run(), criteria), CriteriaError);
}

TEST(PipelineTest, CountsEventsWhileTheRunGoesOnAndCanBeFinishedAtAnyTime) {
  Pipeline pipeline(hand_made_run(), Criteria{});
  const auto frames = story();
  const std::vector<std::size_t> events_after{0, 1, 1, 1, 1, 1, 1, 2, 2, 2};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(pipeline.add(frames[k]).jammed, analyze(frames).frames[k].jammed);
    EXPECT_EQ(pipeline.frames(), k + 1);
    EXPECT_EQ(pipeline.events_so_far(), events_after[k]);
    EXPECT_EQ(pipeline.finish({}).events.size(), events_after[k]);
  }
  EXPECT_TRUE(Pipeline(hand_made_run(), Criteria{}).finish({}).frames.empty());
}

TEST(PipelineTest, FlowEnergyComesFromTheBestSourceThereIs) {
  const double expected = 50 * 0.02 * 0.018;  // 50 N against 20 mm/s for nine intervals
  EXPECT_EQ(analyze(story()).flow_energy.source, "frames");
  EXPECT_NEAR(analyze(story()).flow_energy.total, expected, 1e-15);

  Series series;
  series.time = {0.009, 0.018};
  series.step = {4500, 9000};
  series.walls.resize(3);
  series.walls[blade_wall].power = {3, 5};
  const Analysis from_series = analyze(story(), hand_made_run(), series);
  EXPECT_EQ(from_series.flow_energy.source, "series");
  EXPECT_NEAR(from_series.flow_energy.total, 8 * 0.009, 1e-15);

  RunInfo info = hand_made_run();
  info.wall_loads_known = false;
  const Analysis nothing_known = analyze(story(), info);
  EXPECT_EQ(nothing_known.flow_energy.source, "none");
  EXPECT_THAT(nothing_known.flow_energy.power, IsEmpty());
  EXPECT_THAT(nothing_known.notes, Contains(HasSubstr("neither point nor normal")));

  auto frames = story();
  for (Snapshot& frame : frames) frame.pw.normal.assign(frame.pw.size(), Vec3f(0, 0, 1));
  const Analysis from_contacts = analyze(frames, info);
  EXPECT_EQ(from_contacts.flow_energy.source, "contacts");
  // Repulsion pushes the blade up with 40, 80, 30, 30 and 15 N; every frame stands for one interval.
  EXPECT_NEAR(from_contacts.flow_energy.total, (40 + 80 + 30 + 30 + 15) * 0.02 * 0.002, 1e-15);
  EXPECT_THAT(from_contacts.notes, Contains(HasSubstr("tangential")));

  for (Snapshot& frame : frames) frame.walls[blade_wall].velocity.setZero();
  EXPECT_THAT(analyze(frames).notes, Contains(HasSubstr("velocity of the blade is zero")));
}

TEST(PipelineTest, SaysWhatItCouldNotCompute) {
  RunInfo info = hand_made_run();
  info.gap = {};
  const Analysis a = analyze(story(), info);
  EXPECT_TRUE(std::isnan(a.jammed_in_gap_share));
  EXPECT_THAT(a.notes, Contains(HasSubstr("gap between blade tip and vessel is not known")));

  auto frames = story();
  EXPECT_THAT(analyze({frames[0]}).notes, Contains(HasSubstr("fewer than two frames")));
  frames.erase(frames.begin() + 3);
  const Analysis cut = analyze(frames);
  EXPECT_THAT(cut.notes, Contains(HasSubstr("frames are missing in 1 places")));
  EXPECT_THAT(cut.notes, Contains(HasSubstr("2 of 3 events are cut off")));

  frames = story();
  frames[3].pw.flags = {0, contact_recovered};
  EXPECT_THAT(analyze(frames).notes, Contains(HasSubstr("1 contacts with walls are not in the source")));
}

// Grains that turn with the blade in most frames, and stand in one that has no velocities.
TEST(PipelineTest, AddsUpTheFlowPatternOfAllFramesAndSaysWhyThereIsNone) {
  std::vector<Snapshot> frames;
  for (unsigned k = 0; k < 5; ++k) {
    Snapshot s = random_network(k, 2000, 10);
    s.time = 0.002 * k;
    s.walls[blade_wall].angular_velocity = Vec3(0, 0, 20);
    for (const Vec3f& at : s.particles.position)
      if (k != 3) s.particles.velocity.push_back(Vec3f(-20 * at.y(), 20 * at.x(), 0));
    frames.push_back(s);
  }
  const Analysis a = analyze(frames);
  FlowSums sums;
  for (const Snapshot& s : frames) add(sums, flow_sums(s, hand_made_run(), Criteria{}));
  const std::vector<FlowBin> pattern = flow_pattern(sums, hand_made_run().gap);
  ASSERT_EQ(a.flow_pattern.size(), FlowBin::count);
  std::size_t known = 0;
  for (std::size_t b = 0; b < FlowBin::count; ++b) {
    EXPECT_EQ(a.flow_pattern[b].samples, pattern[b].samples);
    if (pattern[b].samples < FlowBin::least_samples) continue;
    ++known;
    EXPECT_EQ(a.flow_pattern[b].azimuthal, pattern[b].azimuthal);
    EXPECT_GE(a.flow_pattern[b].azimuthal, pattern[b].radius_low / 0.010);
    EXPECT_LE(a.flow_pattern[b].azimuthal, pattern[b].radius_high / 0.010);
  }
  EXPECT_GT(known, 10u);
  for (const std::string& note : a.notes) EXPECT_THAT(note, Not(HasSubstr("no flow pattern")));

  EXPECT_TRUE(analyze(story()).flow_pattern.empty());
  EXPECT_THAT(analyze(story()).notes, Contains("no flow pattern around the blade: it does not turn about the vertical in any frame"));
  EXPECT_THAT(analyze({frames[3]}).notes, Contains("no flow pattern around the blade: the source has no velocities of particles"));
  EXPECT_THAT(analyze({}).notes, Contains("no flow pattern around the blade: there are no frames"));
  RunInfo info = hand_made_run();
  info.gap.vessel_radius = 0;
  EXPECT_THAT(analyze(frames, info).notes, Contains("no flow pattern around the blade: the radii of its tip and of the vessel and its height are not all known"));
}

TEST(PipelineTest, RefusesFramesThatDoNotFitAndStaysAsItWas) {
  Pipeline pipeline(hand_made_run(), Criteria{});
  auto frames = story();
  pipeline.add(frames[1]);
  EXPECT_THROW(pipeline.add(frames[1]), DataError);
  EXPECT_THROW(pipeline.add(frames[0]), DataError);
  frames[2].time = std::nan("");
  EXPECT_THROW(pipeline.add(frames[2]), DataError);
  frames[3].walls.pop_back();
  EXPECT_THROW(pipeline.add(frames[3]), DataError);
  frames[4].pp.row[0] = {0, 5};
  EXPECT_THROW(pipeline.add(frames[4]), DataError);
  frames[5].particles.id[1] = 1;
  EXPECT_THROW(pipeline.add(frames[5]), DataError);
  frames[7].pw.wall[0] = 3;
  EXPECT_THROW(pipeline.add(frames[7]), DataError);
  frames[8].particles.radius.pop_back();
  EXPECT_THROW(pipeline.add(frames[8]), DataError);
  EXPECT_EQ(pipeline.frames(), 1u);
  EXPECT_EQ(pipeline.finish({}).frames.size(), 1u);
}

TEST(PipelineTest, RefusesARunWithoutBladeOrVessel) {
  RunInfo info = hand_made_run();
  info.walls[blade_wall].role = WallRole::other;
  EXPECT_THROW(Pipeline(info, Criteria{}), CriteriaError);
}

TEST(PipelineTest, GivesTheSameBytesForTheSameSnapshots) {
  std::vector<Snapshot> frames;
  for (unsigned k = 0; k < 30; ++k) {
    frames.push_back(random_network(k, 40, 60));
    frames.back().time = 0.002 * k;
  }
  const std::string first = events_csv(analyze(frames));
  EXPECT_EQ(first, events_csv(analyze(frames)));
  EXPECT_THAT(first, HasSubstr("\nparticle,"));
}

TEST(PipelineTest, EventsDoNotDependOnTheIdsOfTheParticles) {
  std::vector<Snapshot> frames, other_frames;
  const auto new_id = hand_made::shuffled_ids(3, 40);
  for (unsigned k = 0; k < 30; ++k) {
    frames.push_back(random_network(k, 40, 30));
    if (k % 4 == 3) frames.back() = hand_made::unloaded(frames.back());
    frames.back().time = 0.002 * k;
    other_frames.push_back(hand_made::relabelled(frames.back(), new_id));
  }
  const Analysis a = analyze(frames), b = analyze(other_frames);
  ASSERT_EQ(a.events.size(), 8u);
  ASSERT_EQ(b.events.size(), 8u);
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].first_frame, b.events[k].first_frame);
    EXPECT_EQ(a.events[k].samples, b.events[k].samples);
    EXPECT_EQ(a.events[k].peak_force, b.events[k].peak_force);
    EXPECT_EQ(a.events[k].bridged, b.events[k].bridged);
    EXPECT_EQ(a.events[k].members.size(), b.events[k].members.size());
  }
  EXPECT_EQ(a.tracks.size(), b.tracks.size());
  EXPECT_EQ(a.jammed_histogram, b.jammed_histogram);
  EXPECT_EQ(a.jammed_in_gap_share, b.jammed_in_gap_share);
}

}  // namespace
}  // namespace jam
