// analyze, inspect and metrics on a small file written here.
#include "apps/jamscope/stored_run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/outputs.hpp"
#include "libdem/errors.hpp"
#include "libjam/results_file.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

jam::RunInfo sample_info() {
  jam::RunInfo info;
  info.creator = "test";
  info.case_toml =
      "[case]\nname = \"small\"\ndescription = \"two grains\"\n[analysis]\njam_force = \"10 N\"\n[bed]\nseed = 1\n";
  info.dt = 1e-3;
  info.materials = {{"glass", 2500, 63e9, 0.2}};
  jam::Wall blade, vessel;
  blade.name = "blade";
  blade.kind = "plane";
  blade.role = jam::WallRole::blade;
  blade.axis = jam::Vec3::UnitX();
  vessel.name = "vessel";
  vessel.kind = "cylinder";
  vessel.role = jam::WallRole::vessel;
  vessel.radius = 12.5e-3;
  info.walls = {blade, vessel};
  info.gap = {11.75e-3, 12.5e-3, -3e-3, 3e-3};
  info.wall_loads_known = false;
  return info;
}

// Two grains that do not touch each other; the first one sits between blade and vessel and carries `force` from both.
jam::Snapshot sample_frame(int frame, float force) {
  jam::Snapshot s;
  s.time = 2e-3 * frame;
  s.step = 2 * static_cast<std::uint64_t>(frame);
  s.particles.id = {0, 1};
  s.particles.position = {{0.0121f, 0, 0}, {0, 0, 0}};
  s.particles.radius = {4e-4f, 4e-4f};
  s.pw.row = {0, 0};
  s.pw.wall = {0, 1};
  s.pw.normal_force = {force, force};
  s.walls.resize(2);
  return s;
}

// Five frames, the middle two above 2 * 15 N.
void write_sample(const std::string& path) {
  jam::SnapshotWriter writer = jam::SnapshotWriter::create(path, sample_info());
  for (int frame = 0; frame < 5; ++frame) writer.append(sample_frame(frame, frame == 2 || frame == 3 ? 15.f : 1.f));
}

TEST(Analyze, FindsTheJamAndWritesAllResults) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  const Outcome outcome = run_program("analyze " + (scratch / "run.h5") + " -o " + (scratch / "jams"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 jam above 10 N"));  // the threshold is that of the stored case
  for (const char* name : {"jam.h5", "events.csv", "summary.json", "report.html"})
    EXPECT_GT(std::filesystem::file_size(scratch / (std::string("jams/") + name)), 0u) << name;
  const auto summary = nlohmann::json::parse(text_of(scratch / "jams/summary.json"));
  EXPECT_EQ(summary["run"]["name"], "small");
  EXPECT_EQ(summary["run"]["creator"], "test");
  EXPECT_EQ(summary["run"]["results_by"]["inputs"][0], scratch / "run.h5");
  EXPECT_EQ(summary["run"]["results_by"]["command_line"][0], "jamscope");  // and not where it lay
  EXPECT_EQ(summary["analysis"]["criteria"]["jam_force_N"], 10);
  EXPECT_EQ(summary["analysis"]["jams"]["events"], 1);
  EXPECT_EQ(summary["analysis"]["first_events"][0]["samples"], 2);
  EXPECT_EQ(summary["analysis"]["first_events"][0]["peak_force_N"], 30);
  EXPECT_EQ(summary["analysis"]["frames_by_jammed_particles"], (std::vector<int>{3, 2}));
}

TEST(Analyze, TheAnalysisPartDependsOnTheDataAlone) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  ASSERT_EQ(run_program("analyze " + (scratch / "run.h5") + " -o " + (scratch / "b") + " --log-format jsonl").code, 0);
  const auto analysis = [&](const std::string& folder) {
    const std::string text = text_of(scratch / (folder + "/summary.json"));
    return text.substr(text.find("\"analysis\""));
  };
  EXPECT_EQ(analysis("a"), analysis("b"));
  EXPECT_EQ(text_of(scratch / "a/events.csv"), text_of(scratch / "b/events.csv"));
}

TEST(Analyze, CriteriaComeFromFileAndCommandLine) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  std::ofstream(scratch / "c.toml") << "[analysis]\njam_force = \"1 N\"\n";
  const std::string run = "analyze " + (scratch / "run.h5");
  EXPECT_THAT(run_program(run + " -o " + (scratch / "a") + " --criteria " + (scratch / "c.toml")).out,
              HasSubstr("1 jam above 1 N"));
  EXPECT_THAT(run_program(run + " -o " + (scratch / "b") + " --set jam_force='100 N'").out,
              HasSubstr("no jams above 100 N"));
  const Outcome bad = run_program(run + " -o " + (scratch / "d") + " --set jam_forces='100 N'");
  EXPECT_EQ(bad.code, 2);
  EXPECT_EQ(bad.err,
            "error: --set analysis.jam_forces: unknown key 'jam_forces' in [analysis]; did you mean 'jam_force'?\n");
  EXPECT_FALSE(std::filesystem::exists(scratch / "d"));
}

TEST(Analyze, DoesNotOverwriteUnlessTold) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  const std::string run = "analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "jams");
  ASSERT_EQ(run_program(run).code, 0);
  std::ofstream(scratch / "jams/notes.txt") << "mine";
  const Outcome again = run_program(run);
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err, "error: " + (scratch / "jams") +
                           " is not empty: choose another folder, or --overwrite to replace the results in it\n");
  EXPECT_EQ(run_program(run + " --overwrite").code, 0);
  EXPECT_EQ(text_of(scratch / "jams/notes.txt"), "mine");  // other files are left alone
  std::ofstream(scratch / "file") << "x";
  EXPECT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "file")).code, 2);
}

TEST(Analyze, UnreadableDataExitsWith3AndMakesNoFolder) {
  const Scratch scratch;
  EXPECT_EQ(run_program("analyze " + (scratch / "none.h5") + " -o " + (scratch / "jams")).code, 3);
  std::ofstream(scratch / "junk.h5") << "not a file of snapshots";
  const Outcome junk = run_program("analyze " + (scratch / "junk.h5") + " -o " + (scratch / "jams"));
  EXPECT_EQ(junk.code, 3);
  EXPECT_THAT(junk.err, HasSubstr("error: " + (scratch / "junk.h5")));
  EXPECT_EQ(run_program("analyze " + std::string(JAMSCOPE_DATA_DIR) + " -o " + (scratch / "jams")).code, 3);
  EXPECT_FALSE(std::filesystem::exists(scratch / "jams"));
}

TEST(Analyze, RolesCanBeGivenByName) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  const std::string run = "analyze " + (scratch / "run.h5") + " -o " + (scratch / "jams");
  const Outcome unknown = run_program(run + " --blade blad");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "error: the data have no wall 'blad'; did you mean 'blade'?\n");
  EXPECT_EQ(run_program(run + " --blade vessel").code, 2);  // leaves no vessel
  EXPECT_EQ(run_program(run + " --blade vessel --vessel blade").code, 0);
}

TEST(AssignRole, MovesTheRole) {
  std::vector<jam::Wall> walls = sample_info().walls;
  assign_role(walls, "vessel", jam::WallRole::blade);
  EXPECT_EQ(walls[0].role, jam::WallRole::other);
  EXPECT_EQ(walls[1].role, jam::WallRole::blade);
  EXPECT_THROW(assign_role(walls, "lid", jam::WallRole::blade), UsageError);
}

TEST(Inspect, SaysWhatIsInAFileAndWhatIsNot) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  const Outcome text = run_program("inspect " + (scratch / "run.h5"));
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("frames      5\n"));
  EXPECT_THAT(text.out, HasSubstr("case        small: two grains\n"));
  EXPECT_THAT(text.out, HasSubstr("blade: plane, role blade"));
  EXPECT_THAT(text.out, HasSubstr("verdict     valid"));
  const auto json = nlohmann::json::parse(run_program("inspect --json " + (scratch / "run.h5")).out);
  EXPECT_EQ(json["valid"], true);
  EXPECT_EQ(json["wall_contacts"]["max"], 2);
  EXPECT_EQ(json["frames"], 5);
  EXPECT_THAT(json["absent"].get<std::vector<std::string>>(), testing::Contains(HasSubstr("particles/velocity")));
}

TEST(Inspect, DamagedAndForeignFilesExitWith3AndSayWhy) {
  const Scratch scratch;
  std::ofstream(scratch / "junk") << "not a file of snapshots";
  const Outcome junk = run_program("inspect " + (scratch / "junk"));
  EXPECT_EQ(junk.code, 3);
  EXPECT_THAT(junk.out, HasSubstr("verdict     not valid"));
  EXPECT_EQ(run_program("inspect " + (scratch / "none")).code, 3);
  write_sample(scratch / "run.h5");
  std::filesystem::resize_file(scratch / "run.h5", std::filesystem::file_size(scratch / "run.h5") / 2);
  const Outcome cut = run_program("inspect " + (scratch / "run.h5"));
  EXPECT_EQ(cut.code, 3);
  EXPECT_THAT(cut.out, HasSubstr("damaged"));
}

TEST(Inspect, ReadsForeignDataThroughTheirMap) {
  const std::string formats = std::string(JAMSCOPE_DATA_DIR) + "/formats/";
  const Outcome outcome = run_program("inspect --json " + formats + "liggghts.particles.dump.xz " + formats +
                                      "liggghts.pair.local.xz " + formats + "liggghts.wall.local.xz " + formats +
                                      "liggghts.blade.txt.xz --map " + JAMSCOPE_DATA_DIR + "/maps/liggghts.toml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_GT(json["frames"].get<int>(), 0);
  EXPECT_GT(json["particle_contacts"]["max"].get<int>(), 0);
}

TEST(Metrics, AreATableOfFrames) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  const Outcome csv = run_program("metrics " + (scratch / "run.h5") + " --metric coordination_with_walls,coordination");
  EXPECT_EQ(csv.code, 0) << csv.err;
  EXPECT_THAT(csv.out, testing::StartsWith("frame,time [s],coordination_with_walls [1],coordination [1]\n0,0,1,0\n"));
  const Outcome one = run_program("metrics --frame 3 --format json --metric coordination " + (scratch / "run.h5"));
  const auto json = nlohmann::json::parse(one.out);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["frame"], 3);
  EXPECT_EQ(json[0]["coordination"], 0);
  const Outcome grains = run_program("metrics --frame 3 --of particles --metric contacts,core_number " + (scratch / "run.h5"));
  EXPECT_EQ(grains.code, 0) << grains.err;
  EXPECT_EQ(grains.out.find("frame,time [s],id,contacts [1],core_number [1]\n3,"), 0u) << grains.out;
  // No two of its grains touch; those of a dump do.
  const Outcome contacts = run_program("metrics --frame 3 --of contacts --metric relative_force " + (scratch / "run.h5"));
  EXPECT_EQ(contacts.code, 0) << contacts.err;
  EXPECT_EQ(contacts.out, "frame,time [s],id_1,id_2,relative_force [1]\n");
  const std::string formats = JAMSCOPE_DATA_DIR "/formats/";
  const Outcome touching = run_program("metrics --frame 0 --of contacts --format json " + formats + "liggghts.particles.dump.xz " + formats +
                                       "liggghts.pair.local.xz " + formats + "liggghts.wall.local.xz " + formats +
                                       "liggghts.blade.txt.xz --map " + JAMSCOPE_DATA_DIR + "/maps/liggghts.toml");
  EXPECT_EQ(touching.code, 0) << touching.err;
  const nlohmann::json links = nlohmann::json::parse(touching.out);
  ASSERT_FALSE(links.empty());
  EXPECT_LT(links[0]["id_1"].get<int>(), links[0]["id_2"].get<int>());
  EXPECT_TRUE(links[0].contains("relative_force"));
  const Outcome unknown = run_program("metrics --metric cordination " + (scratch / "run.h5"));
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "error: unknown metric 'cordination'; did you mean 'coordination'?\n");
  EXPECT_EQ(run_program("metrics --frame 5 " + (scratch / "run.h5")).code, 2);
}

TEST(Metrics, OfEveryKindAreTheSameForAnyNumberOfThreadsAndSayWhereTheyAreNotDefined) {
  const std::string formats = JAMSCOPE_DATA_DIR "/formats/";
  const std::string dump = formats + "lammps.particles.dump.xz " + formats + "lammps.pair.local.xz " + formats +
                           "lammps.wall.dump.xz --map " + JAMSCOPE_DATA_DIR + "/maps/lammps.toml";
  for (const std::string of : {"frames", "changes", "particles", "contacts"}) {
    const Outcome one = run_program("metrics " + dump + " --all --threads 1 --of " + of);
    const Outcome three = run_program("metrics " + dump + " --all --threads 3 --of " + of);
    EXPECT_EQ(one.code, 0) << one.err;
    EXPECT_EQ(one.out, three.out);
    EXPECT_GT(std::count(one.out.begin(), one.out.end(), '\n'), 1) << of;
    if (one.out.find("nan") != std::string::npos) {
      EXPECT_THAT(one.err, testing::HasSubstr(" has no value in ")) << of;
    }
  }
  EXPECT_EQ(run_program("metrics " + dump + " --all --metric coordination").code, 2);
  const Outcome wrong = run_program("metrics " + dump + " --of change");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--of: 'change' is no choice; did you mean 'changes'?"));
}

TEST(Analyze, IsTheSameForAnyNumberOfThreads) {
  const Scratch scratch;
  write_sample(scratch / "run.h5");
  std::string first;
  for (const std::string threads : {"1", "3"}) {
    const std::string out = scratch / ("jams" + threads);
    EXPECT_EQ(run_program("analyze " + (scratch / "run.h5") + " -o " + out + " --threads " + threads).code, 0);
    const jam::Analysis analysis = jam::read_results(out + "/jam.h5");
    EXPECT_FALSE(analysis.metrics.empty());
    std::string text = jam::events_csv(analysis);
    for (const jam::RecordedMetric& metric : analysis.metrics)
      for (const double value : metric.values) text += fmt::format("{} {}\n", metric.name, value);
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
  }
  const Outcome unknown = run_program("analyze " + (scratch / "run.h5") + " -o " + (scratch / "x") + " --set metrics='[\"cordination\"]'");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, testing::HasSubstr("did you mean 'coordination'?"));
}

TEST(Summary, NumbersThatDoNotExistAreNull) {
  const auto summary = nlohmann::json::parse(summary_json({}, {}, {}, {}));
  EXPECT_TRUE(summary["analysis"]["jams"]["mean_survival_time_s"].is_null());
  EXPECT_EQ(summary["analysis"]["frames"], 0);
  EXPECT_FALSE(summary["run"].contains("case_sha256"));
  EXPECT_FALSE(summary["analysis"].contains("flow_pattern"));
}

// Layer by layer, ring by ring, component by component; null where a bin was rarely visited.
TEST(Summary, HasTheFlowPatternAsOneList) {
  jam::Analysis analysis;
  const double nan = std::nan("");
  for (std::size_t b = 0; b < jam::FlowBin::count; ++b) {
    const auto ring = double(b % jam::FlowBin::rings), layer = double(b / jam::FlowBin::rings), speed = double(b);
    analysis.flow_pattern.push_back({ring, ring + 1, 2 * layer - 6, 2 * layer - 4, 200, speed, speed + 0.25, speed + 0.5});
  }
  analysis.flow_pattern[1] = {1, 2, -6, -4, 99, nan, nan, nan};
  const auto flow = nlohmann::json::parse(summary_json({}, analysis, {}, {}))["analysis"]["flow_pattern"];
  EXPECT_EQ(flow["radius_m"], (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(flow["height_m"], (std::vector<double>{-6, -4, -2, 0, 2, 4, 6, 8, 10, 12}));
  EXPECT_EQ(flow["least_samples"], 100);
  ASSERT_EQ(flow["samples"].size(), jam::FlowBin::count);
  EXPECT_EQ(flow["samples"][1], 99);
  ASSERT_EQ(flow["speed_over_tip"].size(), 3 * jam::FlowBin::count);
  for (std::size_t b = 0; b < jam::FlowBin::count; ++b)
    for (std::size_t c = 0; c < 3; ++c) {
      const nlohmann::json expected = b == 1 ? nlohmann::json() : nlohmann::json(double(b) + 0.25 * double(c));
      EXPECT_EQ(flow["speed_over_tip"][3 * b + c], expected) << b << " " << c;
    }
}

}  // namespace
}  // namespace jamscope
