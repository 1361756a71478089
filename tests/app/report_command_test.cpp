#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "libjam/snapshot/writer.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Two grains; the first sits between blade and vessel and carries `force` from both in frames 2 and 3. With a series: one window to a frame.
void write_run(const std::string& path, float force, bool with_series = false) {
  jam::RunInfo info;
  info.creator = "test";
  info.case_toml = "[case]\nname = \"<b>small</b>\"\ndescription = \"two grains\"\n[analysis]\njam_force = \"10 N\"\n[bed]\nseed = 1\n";
  info.dt = 1e-3;
  info.materials = {{"glass", 2500, 63e9, 0.2}};
  jam::Wall blade, vessel;
  blade.name = "blade";
  blade.kind = "plane";
  blade.role = jam::WallRole::blade;
  vessel.name = "vessel";
  vessel.kind = "cylinder";
  vessel.role = jam::WallRole::vessel;
  vessel.radius = 12.5e-3;
  info.walls = {blade, vessel};
  info.wall_loads_known = false;
  jam::SnapshotWriter writer = jam::SnapshotWriter::create(path, info);
  for (int frame = 0; frame < 5; ++frame) {
    jam::Snapshot s;
    s.time = 2e-3 * frame;
    s.step = std::uint64_t(2 * frame);
    s.particles.id = {0, 1};
    s.particles.position = {{0.0121f, 0, 0}, {0, 0, 0}};
    s.particles.radius = {4e-4f, 4e-4f};
    s.pw.row = {0, 0};
    s.pw.wall = {0, 1};
    s.pw.normal_force = std::vector<float>(2, frame == 2 || frame == 3 ? force : 1.f);
    s.walls.resize(2);
    jam::Series rows;
    if (with_series && frame > 0) {
      rows.time = {s.time};
      rows.step = {s.step};
      rows.largest_compressive_force = {2 * force};
      rows.jammed_count = {1};
      rows.kinetic_energy = {1e-6};
      rows.largest_overlap = {1e-3};
    }
    writer.append(s, rows);
  }
}

json runs_of(const std::string& page) {
  const std::string open = "id=\"data\">";
  const auto from = page.find(open) + open.size();
  return json::parse(page.substr(from, page.find("</script>", from) - from)).at("runs");
}

TEST(ReportProgram, BuildsThePageAgainToTheSameBytes) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15);
  ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  const std::string before = text_of(scratch / "a/report.html");
  std::filesystem::remove(scratch / "a/report.html");
  const Outcome outcome = run_program("report " + (scratch / "a"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(scratch / "a/report.html"));
  EXPECT_TRUE(text_of(scratch / "a/report.html") == before);
  const json run = runs_of(before)[0];
  EXPECT_EQ(run["scene"]["frames"].size(), 5u);
  EXPECT_EQ(run["samples"]["frames"], 5);
  EXPECT_EQ(before.find("<b>small"), std::string::npos);
}

TEST(ReportProgram, FindsTheSnapshotsBesideTheResults) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15);
  // Analysed by a name that the program later does not find from its own folder.
  ASSERT_EQ(std::system(("cd " + (scratch / "") + " && " + JAMSCOPE_PROGRAM + " analyze -q run.h5 -o a").c_str()), 0);
  ASSERT_EQ(run_program("report -q " + (scratch / "a")).code, 0);
  EXPECT_EQ(runs_of(text_of(scratch / "a/report.html"))[0]["scene"]["why"], "");
}

TEST(ReportProgram, ShowsAMergedAnalysisInSpaceWhereItsSnapshotsAreStillThere) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15);
  ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "all")).code, 0);
  const json whole = runs_of(text_of(scratch / "all/report.html"))[0];
  for (const std::string range : {"0:2", "2:"})
    ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " --partial --frames " + range + " -o " + (scratch / ("part" + range))).code, 0);
  const std::string merge = "merge -q --overwrite " + (scratch / "part0:2") + " " + (scratch / "part2:") + " -o " + (scratch / "merged");
  ASSERT_EQ(run_program(merge).code, 0);
  const std::string page = text_of(scratch / "merged/report.html");
  EXPECT_EQ(runs_of(page)[0]["scene"], whole["scene"]);
  EXPECT_EQ(runs_of(page)[0]["samples"], whole["samples"]);
  ASSERT_EQ(run_program("report -q " + (scratch / "merged")).code, 0);
  EXPECT_TRUE(text_of(scratch / "merged/report.html") == page);

  std::filesystem::remove(scratch / "run.h5");
  ASSERT_EQ(run_program(merge).code, 0);
  EXPECT_THAT(runs_of(text_of(scratch / "merged/report.html"))[0]["scene"]["why"].get<std::string>(), HasSubstr("not at hand"));
}

TEST(ReportProgram, BuildsThePageOfSomeFramesAgain) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15, true);
  ASSERT_EQ(run_program("analyze -q --frames 1:4 " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  const std::string before = text_of(scratch / "a/report.html");
  ASSERT_EQ(run_program("report -q " + (scratch / "a")).code, 0);
  EXPECT_TRUE(text_of(scratch / "a/report.html") == before);
  EXPECT_EQ(runs_of(before)[0]["scene"]["frames"].size(), 3u);
  EXPECT_EQ(runs_of(before)[0]["series"]["rows"], 3);
}

TEST(ReportProgram, SaysOnThePageThatTheSnapshotsAreGone) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15);
  ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  std::filesystem::remove(scratch / "run.h5");
  const Outcome outcome = run_program("report " + (scratch / "a"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json run = runs_of(text_of(scratch / "a/report.html"))[0];
  EXPECT_THAT(run["scene"]["why"].get<std::string>(), HasSubstr("neither beside them nor where"));
  EXPECT_TRUE(run["samples"].is_null());
  EXPECT_EQ(run["headline"]["events"], 1);
}

TEST(ReportProgram, TakesNothingFromSnapshotsOfAnotherRun) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15, true);
  ASSERT_EQ(run_program("analyze -q --frames 1:4 " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  jam::SnapshotWriter::create(scratch / "run.h5", {});
  ASSERT_EQ(run_program("report -q " + (scratch / "a")).code, 0);
  const json run = runs_of(text_of(scratch / "a/report.html"))[0];
  EXPECT_THAT(run["scene"]["why"].get<std::string>(), HasSubstr("not those of these results"));
  EXPECT_TRUE(run["series"].is_null());
}

TEST(ReportProgram, PutsSeveralRunsOnOnePage) {
  const Scratch scratch;
  write_run(scratch / "one.h5", 15);
  write_run(scratch / "two.h5", 3);
  for (const std::string name : {"one", "two"}) ASSERT_EQ(run_program("analyze -q " + (scratch / (name + ".h5")) + " -o " + (scratch / name)).code, 0);
  const Outcome outcome = run_program("report " + (scratch / "one") + " " + (scratch / "two") + " -o " + (scratch / "both.html"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = text_of(scratch / "both.html");
  const json runs = runs_of(page);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0]["name"], scratch / "one");
  EXPECT_EQ(runs[0]["headline"]["events"], 1);
  EXPECT_EQ(runs[1]["headline"]["events"], 0);
  EXPECT_NE(page.find("id=\"s0-0\""), std::string::npos);
  EXPECT_NE(page.find("id=\"s1-0\""), std::string::npos);
}

TEST(ReportProgram, WritesFiguresAsSvgAndCsv) {
  const Scratch scratch;
  write_run(scratch / "run.h5", 15);
  ASSERT_EQ(run_program("analyze -q " + (scratch / "run.h5") + " -o " + (scratch / "a")).code, 0);
  const Outcome outcome = run_program("report --figures " + (scratch / "a"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("figures in " + (scratch / "a/figures")));
  std::size_t pairs = 0;
  for (const auto& file : std::filesystem::directory_iterator(scratch / "a/figures"))
    if (file.path().extension() == ".svg") {
      ++pairs;
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(file.path()).replace_extension(".csv"))) << file.path();
      EXPECT_THAT(text_of(file.path()), testing::EndsWith("</svg>\n"));
    }
  EXPECT_GT(pairs, 8u);
  EXPECT_THAT(text_of(scratch / "a/figures/grain-force.csv"), HasSubstr("largest in the frame,0.004,30,,"));
  EXPECT_THAT(text_of(scratch / "a/figures/jammed-histogram.csv"), HasSubstr("1,2,,"));
}

TEST(ReportProgram, SaysWhatIsWrong) {
  const Scratch scratch;
  EXPECT_EQ(run_program("report " + (scratch / "nowhere")).code, 2);
  std::filesystem::create_directory(scratch / "empty");
  const Outcome empty = run_program("report " + (scratch / "empty"));
  EXPECT_EQ(empty.code, 3);
  EXPECT_THAT(empty.err, HasSubstr("jam.h5"));
}

}  // namespace
}  // namespace jamscope
