#include "libjam/results_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "libjam/errors.hpp"
#include "libjam/snapshot/hdf5.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::hand_made_run;
using hand_made::random_network;
using ::testing::HasSubstr;

class ResultsFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("jamscope_results_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "jam.h5";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_, path_;
};

Analysis busy_analysis() {
  Criteria criteria;
  criteria.measure = CompressiveMeasure::signed_;
  criteria.jam_force = 12.5;
  criteria.end_force = 11.5;
  criteria.hold_off = 1e-4;
  criteria.metrics = {"bridge_strength", "fabric_anisotropy", "coordination", "bridge_strength"};
  Pipeline pipeline(hand_made_run(), criteria);
  for (unsigned k = 0; k < 20; ++k) {
    Snapshot frame = random_network(k, 40, 12);
    if (k % 3 == 2) frame = hand_made::unloaded(frame);
    for (const std::uint32_t row : frame.pw.row) frame.pw.point.push_back(frame.particles.position[row] + Vec3f(0.5e-3f, 0, float(row) * 1e-4f));
    frame.time = 0.002 * k;
    frame.walls[hand_made::blade_wall].velocity = Vec3(0, 0, -0.02);
    frame.walls[hand_made::blade_wall].force = Vec3(0, 0, 1.0 / (k + 1));
    pipeline.add(frame);
  }
  Analysis analysis = pipeline.finish({});
  StepJam jam;
  jam.start = 0.001, jam.end = 0.002, jam.duration = 0.0010001, jam.open_at_end = true, jam.peak_force = 31, jam.peak_time = 0.0015;
  jam.peak_particle = 7, jam.site = 3, jam.impulse = 0.02, jam.work = 1e-5, jam.path = 2e-4, jam.turned = 0.3, jam.stays = 2, jam.members = {7, 9};
  analysis.every_step = {{{jam, jam}, {}}, {{}, {}}, {{jam}, {}}};
  analysis.contact_life = {{1e-6, 2e-6, {3, 4, 1.0}, {0, 2, std::nan("")}}, {2e-6, 4e-6, {5, 6, 0.75}, {7, 8, 0.5}}};
  analysis.flow_pattern = {{0, 1e-3, -2e-3, 0, 150, 0.5, -0.125, 1e-3}, {1e-3, 2e-3, -2e-3, 0, 7, std::nan(""), std::nan(""), std::nan("")}};
  return analysis;
}

// NaN equals NaN here: the same bits must come back.
bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_same_metrics(const Analysis& a, const Analysis& b) {
  ASSERT_EQ(a.metrics.size(), b.metrics.size());
  EXPECT_EQ(a.criteria.metrics, b.criteria.metrics);
  for (std::size_t k = 0; k < a.metrics.size(); ++k) {
    EXPECT_EQ(a.metrics[k].name, b.metrics[k].name);
    EXPECT_EQ(a.metrics[k].unit, b.metrics[k].unit);
    EXPECT_TRUE(std::equal(a.metrics[k].values.begin(), a.metrics[k].values.end(), b.metrics[k].values.begin(), b.metrics[k].values.end(), same));
  }
}

void expect_same_event(const JamEvent& a, const JamEvent& b) {
  EXPECT_EQ(a.first_frame, b.first_frame);
  EXPECT_EQ(a.last_frame, b.last_frame);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.survival_time, b.survival_time);
  EXPECT_EQ(a.shortest, b.shortest);
  EXPECT_EQ(a.longest, b.longest);
  EXPECT_EQ(a.open_at_start, b.open_at_start);
  EXPECT_EQ(a.open_at_end, b.open_at_end);
  EXPECT_EQ(a.peak_force, b.peak_force);
  EXPECT_EQ(a.peak_time, b.peak_time);
  EXPECT_TRUE(same(a.least_gap, b.least_gap));
  EXPECT_EQ(a.peak_particle, b.peak_particle);
  EXPECT_EQ(a.peak_in_gap, b.peak_in_gap);
  EXPECT_EQ(a.bridged, b.bridged);
  EXPECT_EQ(a.members, b.members);
}

void expect_same(const Analysis& a, const Analysis& b) {
  EXPECT_EQ(a.criteria.measure, b.criteria.measure);
  EXPECT_EQ(a.criteria.jam_force, b.criteria.jam_force);
  EXPECT_EQ(a.criteria.bridge_contact_share, b.criteria.bridge_contact_share);
  EXPECT_EQ(a.criteria.gap_margin, b.criteria.gap_margin);
  EXPECT_EQ(a.criteria.survival_classes, b.criteria.survival_classes);
  EXPECT_EQ(a.observed_time, b.observed_time);
  EXPECT_EQ(a.sampling_interval, b.sampling_interval);
  EXPECT_EQ(a.jammed_time, b.jammed_time);
  EXPECT_EQ(a.jam_frequency, b.jam_frequency);
  EXPECT_TRUE(same(a.jammed_in_gap_share, b.jammed_in_gap_share));
  EXPECT_EQ(a.jammed_histogram, b.jammed_histogram);
  EXPECT_EQ(a.notes, b.notes);

  expect_same_metrics(a, b);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    EXPECT_EQ(a.frames[k].time, b.frames[k].time);
    EXPECT_EQ(a.frames[k].step, b.frames[k].step);
    EXPECT_EQ(a.frames[k].particles, b.frames[k].particles);
    EXPECT_EQ(a.frames[k].particle_contacts, b.frames[k].particle_contacts);
    EXPECT_EQ(a.frames[k].wall_contacts, b.frames[k].wall_contacts);
    EXPECT_EQ(a.frames[k].coordination, b.frames[k].coordination);
    EXPECT_EQ(a.frames[k].coordination_with_walls, b.frames[k].coordination_with_walls);
    EXPECT_EQ(a.frames[k].largest_compressive_force, b.frames[k].largest_compressive_force);
    EXPECT_EQ(a.frames[k].mean_compressive_force, b.frames[k].mean_compressive_force);
    EXPECT_EQ(a.frames[k].largest_particle, b.frames[k].largest_particle);
    EXPECT_EQ(a.frames[k].jammed, b.frames[k].jammed);
    EXPECT_EQ(a.frames[k].jammed_in_gap, b.frames[k].jammed_in_gap);
    EXPECT_EQ(a.frames[k].bridges, b.frames[k].bridges);
    EXPECT_EQ(a.frames[k].largest_bridge, b.frames[k].largest_bridge);
  }
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  for (std::size_t k = 0; k < a.clusters.size(); ++k) {
    EXPECT_EQ(a.clusters[k].frame, b.clusters[k].frame);
    EXPECT_EQ(a.clusters[k].members, b.clusters[k].members);
    EXPECT_EQ(a.clusters[k].bridges, b.clusters[k].bridges);
    EXPECT_EQ(a.clusters[k].blade_force, b.clusters[k].blade_force);
    EXPECT_EQ(a.clusters[k].vessel_force, b.clusters[k].vessel_force);
    EXPECT_EQ(a.clusters[k].largest_compressive_force, b.clusters[k].largest_compressive_force);
    EXPECT_EQ(a.clusters[k].in_gap, b.clusters[k].in_gap);
  }
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) expect_same_event(a.events[k], b.events[k]);
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  for (std::size_t k = 0; k < a.tracks.size(); ++k) {
    EXPECT_EQ(a.tracks[k].particle, b.tracks[k].particle);
    expect_same_event(a.tracks[k].event, b.tracks[k].event);
    ASSERT_EQ(a.tracks[k].points.size(), b.tracks[k].points.size());
    for (std::size_t p = 0; p < a.tracks[k].points.size(); ++p) {
      const Track::Point &one = a.tracks[k].points[p], &two = b.tracks[k].points[p];
      EXPECT_EQ(one.frame, two.frame);
      EXPECT_EQ(one.position, two.position);
      EXPECT_EQ(one.from_blade, two.from_blade);
      EXPECT_EQ(one.pushed_by, two.pushed_by);
      EXPECT_EQ(one.in_gap, two.in_gap);
      EXPECT_EQ(one.bridged, two.bridged);
      EXPECT_TRUE(same(one.least_gap, two.least_gap));
      EXPECT_TRUE(one.velocity.array().isNaN().all() && two.velocity.array().isNaN().all());
      EXPECT_EQ(one.compressive_force, two.compressive_force);
    }
  }
  ASSERT_EQ(a.survival_classes.size(), b.survival_classes.size());
  for (std::size_t k = 0; k < a.survival_classes.size(); ++k) {
    EXPECT_EQ(a.survival_classes[k].low, b.survival_classes[k].low);
    EXPECT_EQ(a.survival_classes[k].high, b.survival_classes[k].high);
    EXPECT_EQ(a.survival_classes[k].events, b.survival_classes[k].events);
    EXPECT_EQ(a.survival_classes[k].frequency, b.survival_classes[k].frequency);
    EXPECT_EQ(a.survival_classes[k].share_of_jam_time, b.survival_classes[k].share_of_jam_time);
  }
  EXPECT_EQ(a.flow_energy.source, b.flow_energy.source);
  EXPECT_EQ(a.flow_energy.time, b.flow_energy.time);
  EXPECT_EQ(a.flow_energy.power, b.flow_energy.power);
  EXPECT_EQ(a.flow_energy.energy, b.flow_energy.energy);
  EXPECT_EQ(a.flow_energy.total, b.flow_energy.total);
  EXPECT_EQ(events_csv(a), events_csv(b));
  EXPECT_EQ(a.lineage.identity, b.lineage.identity);
  ASSERT_EQ(a.lineage.links.size(), b.lineage.links.size());
  for (std::size_t k = 0; k < a.lineage.links.size(); ++k) {
    EXPECT_EQ(a.lineage.links[k].from, b.lineage.links[k].from);
    EXPECT_EQ(a.lineage.links[k].to, b.lineage.links[k].to);
    EXPECT_EQ(a.lineage.links[k].shared, b.lineage.links[k].shared);
  }
  ASSERT_EQ(a.every_step.size(), b.every_step.size());
  EXPECT_EQ(step_jams_csv(a), step_jams_csv(b));
  EXPECT_EQ(a.criteria.end_force, b.criteria.end_force);
  EXPECT_EQ(a.criteria.hold_off, b.criteria.hold_off);
  EXPECT_EQ(a.criteria.shortest_jam, b.criteria.shortest_jam);
  ASSERT_EQ(a.flow_pattern.size(), b.flow_pattern.size());
  for (std::size_t k = 0; k < a.flow_pattern.size(); ++k) {
    EXPECT_EQ(a.flow_pattern[k].samples, b.flow_pattern[k].samples);
    for (const auto member : {&FlowBin::radius_low, &FlowBin::radius_high, &FlowBin::height_low, &FlowBin::height_high, &FlowBin::azimuthal, &FlowBin::radial,
                              &FlowBin::vertical})
      EXPECT_TRUE(same(a.flow_pattern[k].*member, b.flow_pattern[k].*member));
  }
  ASSERT_EQ(a.contact_life.size(), b.contact_life.size());
  for (std::size_t k = 0; k < a.contact_life.size(); ++k) {
    EXPECT_EQ(a.contact_life[k].from, b.contact_life[k].from);
    EXPECT_EQ(a.contact_life[k].to, b.contact_life[k].to);
    for (const auto kind : {&ContactLife::particles, &ContactLife::walls}) {
      EXPECT_EQ((a.contact_life[k].*kind).ended, (b.contact_life[k].*kind).ended);
      EXPECT_EQ((a.contact_life[k].*kind).alive, (b.contact_life[k].*kind).alive);
      EXPECT_TRUE(same((a.contact_life[k].*kind).together, (b.contact_life[k].*kind).together));
    }
  }
}

TEST_F(ResultsFileTest, GivesBackTheSameAnalysisBitByBit) {
  const Analysis analysis = busy_analysis();
  // What is compared must be there.
  ASSERT_GT(analysis.events.size(), 1u);
  ASSERT_GT(analysis.tracks.size(), analysis.events.size());
  ASSERT_FALSE(analysis.notes.empty());
  ASSERT_GT(analysis.lineage.links.size(), 5u);
  ASSERT_EQ(analysis.flow_energy.source, "frames");
  write_results(path_, analysis, hand_made_run());
  expect_same(analysis, read_results(path_));
}

TEST_F(ResultsFileTest, HoldsAnAnalysisWithoutAnything) {
  const Analysis analysis = Pipeline(hand_made_run(), Criteria{}).finish({});
  write_results(path_, analysis, hand_made_run());
  expect_same(analysis, read_results(path_));
}

// A file of schema 2.0 has no flow pattern.
TEST_F(ResultsFileTest, ReadsFilesOfAnEarlierMinorVersion) {
  Analysis analysis = busy_analysis();
  analysis.flow_pattern.clear();
  write_results(path_, analysis, hand_made_run());
  {
    h5::File file = h5::File::open_update(path_);
    ASSERT_FALSE(file.exists("/flow_pattern"));
    EXPECT_EQ((file.attribute<std::array<std::uint32_t, 2>>("/", "schema_version")), (std::array<std::uint32_t, 2>{2, 1}));
    file.set_attribute("/", "schema_version", std::array<std::uint32_t, 2>{2, 0});
    file.close();
  }
  expect_same(analysis, read_results(path_));
}

TEST_F(ResultsFileTest, SaysWhichRunItBelongsTo) {
  RunInfo info = hand_made_run();
  info.case_sha256 = "abc123";
  info.seed = 42;
  write_results(path_, busy_analysis(), info);
  const auto file = h5::File::open(path_);
  EXPECT_EQ(file.attribute<std::string>("/", "format"), "jamscope-analysis");
  EXPECT_EQ(file.attribute<std::string>("/", "case_sha256"), "abc123");
  EXPECT_EQ(file.attribute<std::uint64_t>("/", "seed"), 42u);
}

void expect_unit_and_doc(const h5::File& file, const std::string& group) {
  for (const std::string& child : file.children(group)) {
    const std::string name = group == "/" ? "/" + child : group + "/" + child;
    if (file.is_group(name)) {
      expect_unit_and_doc(file, name);
      continue;
    }
    EXPECT_TRUE(file.has_attribute(name, "doc") && !file.attribute<std::string>(name, "doc").empty()) << name;
    if (file.layout(name).type != h5::Type::text) {
      EXPECT_TRUE(file.has_attribute(name, "unit") && !file.attribute<std::string>(name, "unit").empty()) << name;
    }
  }
}

TEST_F(ResultsFileTest, EveryDatasetHasAUnitAndADoc) {
  write_results(path_, busy_analysis(), hand_made_run());
  expect_unit_and_doc(h5::File::open(path_), "/");
}

TEST_F(ResultsFileTest, RefusesOtherFiles) {
  EXPECT_THROW(read_results(folder_ / "missing.h5"), DataError);
  std::ofstream(path_) << "not HDF5";
  EXPECT_THROW(read_results(path_), DataError);
  h5::File::create(path_).close();
  EXPECT_THROW(read_results(path_), DataError);
}

// A result file whose dataset `name` is replaced by other rows.
template <class T>
std::string refusal_with(const std::filesystem::path& path, const std::string& name, const std::vector<T>& rows) {
  const Analysis analysis = busy_analysis();
  write_results(path, analysis, hand_made_run());
  {
    h5::File file = h5::File::open_update(path);
    file.write_rows(name, 0, rows);
    file.close();
  }
  try {
    read_results(path);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST_F(ResultsFileTest, RefusesMembersAndFramesThatAreNotThere) {
  EXPECT_THAT(refusal_with<std::uint64_t>(path_, "/events/member_start", {1}), HasSubstr("/events/member_start"));
  EXPECT_THAT(refusal_with<std::uint64_t>(path_, "/events/member_count", {~std::uint64_t{0}}), HasSubstr("end to end"));
  EXPECT_THAT(refusal_with<std::uint32_t>(path_, "/clusters/frame", {20}), HasSubstr("names frame 20"));
  EXPECT_THAT(refusal_with<std::uint32_t>(path_, "/tracks/points/frame", {77}), HasSubstr("names frame 77"));
}

}  // namespace
}  // namespace jam
