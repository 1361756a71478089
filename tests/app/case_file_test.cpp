#include "apps/jamscope/case_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "apps/jamscope/toml_reader.hpp"
#include "libdem/case/automatic_step.hpp"
#include "libdem/case/derived.hpp"
#include "libdem/errors.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

// Line numbers matter to the tests below.
const std::string good = R"([case]
name = "small"
[material.glass]
density = "2500 kg/m3"
young = "63 GPa"
poisson = 0.2
[material.steel]
density = "7800 kg/m3"
young = "210 GPa"
poisson = 0.3
[interaction.glass-glass]
restitution = 0.9
friction = 0.5
rolling_friction = 0.01
work_of_adhesion = "0.274 J/m2"
[interaction.steel-glass]
restitution = 0.9
friction = 0.3
[vessel]
material = "glass"
diameter = "25 mm"
[blade]
material = "steel"
kind = "twisted"
diameter = "23.5 mm"
start_height = "52 mm"
[motion]
tip_speed = "250 mm/s"
helix_angle = "-5 deg"
rotation = "counter-clockwise"
[bed]
material = "glass"
mean_diameter = "0.925 mm"
size_low = 0.8
size_high = 1.2
depth = "52 mm"
[run]
duration = "2 s"
step = "5e-8 s"
[output]
frame_interval = "2 ms"
series_interval = "0.1 ms"
checkpoint_interval = "20 ms"
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at == std::string::npos) return text;
  return text.replace(at, from.size(), to);
}

std::string message(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_case_text(text, "case.toml", overrides);
  } catch (const dem::CaseError& error) {
    return error.what();
  }
  return "accepted";
}

std::string message_after(const std::string& from, const std::string& to) {
  return message(replaced(from, to));
}
std::string message_with(const std::string& override) {
  return message(good, {override});
}

TEST(CaseFile, ReadsEveryKeyIntoSiUnits) {
  const CaseFile file = read_case_text(good + R"([analysis]
measure = "max"
jam_force = "10 N"
bridge_contact_share = 0.2
gap_margin = 1
survival_classes = ["5 ms", "10 ms"]
)",
                                       "case.toml");
  const dem::Case& c = file.physics;
  EXPECT_EQ(c.name, "small");
  ASSERT_EQ(c.materials.size(), 2u);
  EXPECT_EQ(c.materials[0].name, "glass");
  EXPECT_EQ(c.materials[0].density, 2500);
  EXPECT_EQ(c.materials[1].young, 210e9);
  EXPECT_EQ(c.materials[1].poisson, 0.3);
  EXPECT_EQ(c.interactions[0][0].restitution, 0.9);
  EXPECT_EQ(c.interactions[0][0].rolling_friction, 0.01);
  EXPECT_EQ(c.interactions[0][0].work_of_adhesion, 0.274);
  EXPECT_EQ(c.interactions[0][1].friction, 0.3);  // written as steel-glass
  EXPECT_EQ(c.interactions[1][0].friction, 0.3);
  EXPECT_EQ(c.vessel.diameter, 25e-3);
  EXPECT_EQ(std::get<dem::TwistedBlade>(c.blade.shape).diameter, 23.5e-3);
  EXPECT_EQ(std::get<dem::TwistedBlade>(c.blade.shape).height, 6e-3);  // default
  EXPECT_EQ(c.blade.start_height, 52e-3);
  EXPECT_EQ(c.motion.tip_speed, 0.25);
  EXPECT_NEAR(c.motion.helix_angle, -0.0872664625997165, 1e-16);
  EXPECT_FALSE(c.motion.clockwise);
  EXPECT_EQ(c.bed.mean_diameter, 0.925e-3);
  EXPECT_EQ(c.bed.seed, 1u);
  EXPECT_EQ(c.duration, 2);
  EXPECT_EQ(c.step, 5e-8);
  EXPECT_EQ(c.gravity, dem::Vec3(0, 0, -9.81));
  EXPECT_EQ(c.output.frame_interval, 2e-3);
  EXPECT_EQ(file.criteria.measure, jam::CompressiveMeasure::max);
  EXPECT_EQ(file.criteria.jam_force, 10);
  EXPECT_EQ(file.criteria.bridge_contact_share, 0.2);
  EXPECT_EQ(file.criteria.gap_margin, 1);
  EXPECT_EQ(file.criteria.survival_classes, (std::vector<double>{5e-3, 10e-3}));
  EXPECT_TRUE(file.warnings.empty());
}

TEST(CaseFile, AnAutomaticStepFollowsFromTheContactsAndDividesEveryInterval) {
  const std::string text = replaced("\"5e-8 s\"", "\"auto\"");
  const dem::Case c = read_case_text(text, "case.toml").physics;
  const dem::StepChoice choice = dem::choose_steps(c);
  const double longest = c.step * double(1U << c.levels);
  EXPECT_TRUE(c.automatic_step);
  EXPECT_GT(c.levels, 0);
  EXPECT_LE(c.step, choice.stiffest * (1 + 1e-12));
  EXPECT_GT(2 * c.step, 0.5 * choice.stiffest);
  EXPECT_LE(longest, choice.softest * (1 + 1e-12));
  for (const double interval : {c.duration, c.output.frame_interval, c.output.series_interval, c.output.checkpoint_interval})
    EXPECT_NEAR(interval / longest, std::round(interval / longest), 1e-6);
  // Half the accuracy number is half the steps, but for whole numbers.
  const dem::Case fine = read_case_text(text, "case.toml", {"run.accuracy=0.1"}).physics;
  EXPECT_NEAR(dem::choose_steps(fine).stiffest, 0.5 * choice.stiffest, 1e-12 * choice.stiffest);
  EXPECT_LE(fine.step, 0.5 * choice.stiffest);

  EXPECT_THAT(message(text, {"run.levels=3"}), HasSubstr("'levels' follow from step = \"auto\""));
  EXPECT_THAT(message(text, {"run.accuracy=0.7"}), HasSubstr("must lie above 0 and be at most 0.5"));
  EXPECT_THAT(message(replaced("\"5e-8 s\"", "\"automatic\"")), HasSubstr("got 'automatic', which does not begin with a number, or \"auto\""));
  // Too short to be divided, too long to be counted: an error, not a step.
  EXPECT_THAT(message(text, {"run.duration=1e-13 s"}), HasSubstr("'duration' must be a whole number of steps"));
  EXPECT_NE(message(text, {"run.duration=1e30 s"}), "");
  EXPECT_THAT(message(good, {"run.levels=11"}), HasSubstr("must be at most 10"));
  EXPECT_THAT(message(good, {"run.levels=7"}), HasSubstr("after which all contacts meet"));
}

TEST(CaseFile, ReadsABladeFromAMeshFileBesideTheCase) {
  std::string text = replaced("kind = \"twisted\"\ndiameter = \"23.5 mm\"",
                              "kind = \"stl\"\nfile = \"../blades/b.stl\"\nfile_unit = \"mm\"");
  const CaseFile file = read_case_text(text, "some/where/case.toml");
  EXPECT_EQ(std::get<dem::MeshFile>(file.physics.blade.shape).path, "some/blades/b.stl");
  EXPECT_EQ(std::get<dem::MeshFile>(file.physics.blade.shape).scale, 1e-3);
}

TEST(CaseFile, UnknownKeysAreErrorsThatNameTheNearestKnownOne) {
  EXPECT_EQ(message_after("young = \"63 GPa\"", "yuong = \"63 GPa\""),
            "case.toml:5:1: unknown key 'yuong' in [material.glass]; did you mean 'young'?");
  EXPECT_EQ(message_after("[vessel]", "[vesel]"), "case.toml:19:2: unknown table 'vesel'; did you mean 'vessel'?");
  EXPECT_EQ(message_after("[run]", "[run]\ncolour = 1"),
            "case.toml:38:1: unknown key 'colour' in [run]; known: duration, step, levels, accuracy, gravity");
  EXPECT_EQ(message(good + "[analysis]\njam_forces = \"2 N\"\n"),
            "case.toml:45:1: unknown key 'jam_forces' in [analysis]; did you mean 'jam_force'?");
  // A twisted blade has no file.
  EXPECT_THAT(message_after("kind = \"twisted\"", "kind = \"twisted\"\nfile = \"b.stl\""),
              HasSubstr("case.toml:25:1: unknown key 'file' in [blade]"));
}

TEST(CaseFile, MissingKeysAndTablesAreErrors) {
  EXPECT_EQ(message_after("depth = \"52 mm\"\n", ""), "case.toml:31:2: missing key 'depth' in [bed]");
  EXPECT_EQ(message_after("[vessel]\nmaterial = \"glass\"\ndiameter = \"25 mm\"\n", ""),
            "case.toml: missing table [vessel]");
  EXPECT_THAT(message(""), HasSubstr("case.toml: missing table [material]"));
}

TEST(CaseFile, EveryPairThatCanTouchMustBeGiven) {
  EXPECT_EQ(message_after("[interaction.steel-glass]", "[interaction.steel-steel]"),
            "case.toml:11:2: missing table [interaction.glass-steel]: grains of glass touch the blade of steel");
}

TEST(CaseFile, RepeatedKeysAndBrokenTomlAreErrors) {
  EXPECT_THAT(message_after("depth = \"52 mm\"", "depth = \"52 mm\"\ndepth = \"5 mm\""), HasSubstr("case.toml:37:"));
  EXPECT_THAT(message_after("depth = \"52 mm\"", "depth = 52 mm"), HasSubstr("case.toml:36:"));
  EXPECT_THAT(message("\xff\xfe\x00garbage"), HasSubstr("case.toml:1:1: "));
  EXPECT_THAT(message("a = " + std::string(100000, '[')), HasSubstr("case.toml:1:"));
  EXPECT_EQ(message_after("[vessel]", "[interaction.glass-steel]\nrestitution = 0.9\nfriction = 0.3\n[vessel]"),
            "case.toml:19:14: [interaction.glass-steel] was given before, as [interaction.steel-glass]");
}

TEST(CaseFile, WrongUnitsAndTypesAreErrors) {
  EXPECT_EQ(message_after("\"63 GPa\"", "\"63 mm\""),
            "case.toml:5:9: 'young' wants a pressure (Pa), got '63 mm' (a length)");
  EXPECT_EQ(message_after("\"63 GPa\"", "63e9"),
            "case.toml:5:9: 'young' wants a pressure with its unit, for example \"63 GPa\", got the plain number "
            "63000000000");
  EXPECT_EQ(message_after("poisson = 0.2", "poisson = \"0.2\""),
            "case.toml:6:11: 'poisson' wants a plain number, got the text '0.2'");
  EXPECT_EQ(message_after("poisson = 0.2", "poisson = nan"),
            "case.toml:6:11: 'poisson' wants a plain number, got the plain number nan");
  EXPECT_EQ(message_after("rotation = \"counter-clockwise\"", "rotation = \"left\""),
            "case.toml:30:12: 'rotation' wants 'clockwise' or 'counter-clockwise', got 'left'");
  EXPECT_EQ(message_after("name = \"small\"", "name = 1979-05-27"),
            "case.toml:2:8: 'name' wants a text in quotes, got a date or time");
  EXPECT_EQ(message_after("[bed]", "[bed]\nseed = -3"),
            "case.toml:32:8: 'seed' wants a whole number that is not negative, got the plain number -3");
  EXPECT_EQ(message_after("[vessel]\nmaterial = \"glass\"\ndiameter = \"25 mm\"\n", "[[vessel]]\n"),
            "case.toml:19:1: 'vessel' wants a table, got a list");
  EXPECT_EQ(message(good + "[analysis]\nsurvival_classes = [\"10 ms\", 20]\n"),
            "case.toml:45:20: 'survival_classes' wants a list like [\"2 ms\"], got the plain number 20");
  EXPECT_EQ(message_after("kind = \"twisted\"\ndiameter = \"23.5 mm\"",
                          "kind = \"stl\"\nfile = \"b.stl\"\nfile_unit = \"second\""),
            "case.toml:26:13: 'file_unit' wants a unit of length, for example \"mm\"; got 'second'");
}

TEST(CaseFile, UnknownMaterialsNameTheNearestKnownOne) {
  EXPECT_EQ(message_after("[bed]\nmaterial = \"glass\"", "[bed]\nmaterial = \"glas\""),
            "case.toml:32:12: unknown material 'glas'; did you mean 'glass'?");
  EXPECT_EQ(message_after("[interaction.steel-glass]", "[interaction.stele-glass]"),
            "case.toml:16:14: unknown material 'stele'; did you mean 'steel'?");
  EXPECT_THAT(message_after("[interaction.steel-glass]", "[interaction.steel]"),
              HasSubstr("case.toml:16:14: 'steel' names no pair, expected [interaction.ONE-OTHER]"));
}

TEST(CaseFile, ValuesOutOfRangeAreErrorsAtTheirValue) {
  EXPECT_EQ(message_after("poisson = 0.2", "poisson = 0.7"), "case.toml:6:11: 'poisson' must lie in [0, 0.5], got 0.7");
  EXPECT_EQ(message_after("depth = \"52 mm\"", "depth = \"-52 mm\""),
            "case.toml:36:9: 'depth' must be positive, got -0.052 m");
  EXPECT_EQ(message_after("[interaction.steel-glass]\nrestitution = 0.9", "[interaction.steel-glass]\nrestitution = 2"),
            "case.toml:17:15: 'restitution' must lie in (0, 1], got 2");
  EXPECT_EQ(message(good + "[analysis]\njam_force = \"0 N\"\nsurvival_classes = [\"20 ms\", \"10 ms\"]\n"),
            "case.toml:45:13: 'jam_force' must be positive, got 0 N\n"
            "case.toml:46:20: 'survival_classes' must be positive and rising, got 0.01 s after 0.02 s");
  // A default that does not fit is laid to its table.
  EXPECT_EQ(message_after("diameter = \"23.5 mm\"", "diameter = \"4 mm\""),
            "case.toml:22:2: 'shaft_diameter' must be smaller than blade.diameter = 0.004 m, got 0.005 m");
}

TEST(CaseFile, AllProblemsAreReportedInTheOrderOfTheFile) {
  std::string text = replaced("\"63 GPa\"", "\"63 mm\"");
  text.replace(text.find("tip_speed"), 9, "tip_sped");
  EXPECT_EQ(message(text),
            "case.toml:5:9: 'young' wants a pressure (Pa), got '63 mm' (a length)\n"
            "case.toml:28:1: unknown key 'tip_sped' in [motion]; did you mean 'tip_speed'?");
}

TEST(CaseFile, OverridesReplaceAndAddKeys) {
  const CaseFile file = read_case_text(good, "case.toml",
                                       {"bed.depth=40 mm", "bed.seed=7", "motion.rotation='clockwise'",
                                        "analysis.jam_force=5 N", "blade.start_height=50 mm"});
  EXPECT_EQ(file.physics.bed.depth, 40e-3);
  EXPECT_EQ(file.physics.bed.seed, 7u);
  EXPECT_TRUE(file.physics.motion.clockwise);
  EXPECT_EQ(file.criteria.jam_force, 5);
  // The text that is kept is the case that was run.
  const CaseFile again = read_case_text(file.text, "again.toml");
  EXPECT_EQ(again.physics.bed.depth, 40e-3);
  EXPECT_EQ(again.criteria.jam_force, 5);
  EXPECT_EQ(again.physics.bed.mean_diameter, file.physics.bed.mean_diameter);
  EXPECT_EQ(again.physics.step, file.physics.step);
  // Without overrides it is the file itself.
  EXPECT_EQ(read_case_text(good, "case.toml").text, good);
}

TEST(CaseFile, ErrorsInOverridesAreLaidToTheOverride) {
  EXPECT_EQ(message_with("bed.depht=4 mm"), "--set bed.depht: unknown key 'depht' in [bed]; did you mean 'depth'?");
  EXPECT_EQ(message_with("bedd.depth=4 mm"), "--set bedd.depth: unknown table 'bedd'; did you mean 'bed'?");
  EXPECT_EQ(message_with("bed.depth=4 s"), "--set bed.depth: 'depth' wants a length (m), got '4 s' (a time)");
  EXPECT_EQ(message_with("bed.depth=4"),
            "--set bed.depth: 'depth' wants a length with its unit, for example \"0.925 mm\", got the plain number 4");
  EXPECT_EQ(message_with("bed.depth=0 mm"), "--set bed.depth: 'depth' must be positive, got 0 m");
  EXPECT_EQ(message_with("bed.depth"), "--set bed.depth: expected KEY=VALUE, for example --set bed.depth=\"4 mm\"");
  EXPECT_EQ(message_with("=4"), "--set =4: expected KEY=VALUE, for example --set bed.depth=\"4 mm\"");
  EXPECT_EQ(message_with("bed..depth=4"),
            "--set bed..depth=4: expected KEY=VALUE, for example --set bed.depth=\"4 mm\"");
  EXPECT_EQ(message_with("bed.depth.x=4"), "--set bed.depth.x: 'depth' is a value, not a table");
  EXPECT_EQ(message_with("bed=4"), "--set bed: 'bed' wants a table, got the plain number 4");
  // Not a way to smuggle in a second key.
  EXPECT_THAT(message_with("bed.depth='4 mm'\nseed=3"), HasSubstr("--set bed.depth: 'depth' wants a length"));
}

TEST(CaseFile, WarningsCarryPlaces) {
  const CaseFile file = read_case_text(replaced("\"5e-8 s\"", "\"1e-7 s\""), "case.toml");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_THAT(file.warnings[0], HasSubstr("case.toml:39:8: 'step' = 1e-07 s is 25.3 % of the smallest grain's"));
}

TEST(CaseFile, FilesThatCannotBeReadAreErrors) {
  const auto message_for = [](const std::string& path) -> std::string {
    try {
      read_case_file(path);
    } catch (const dem::CaseError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message_for("no/such/case.toml"), "no/such/case.toml: cannot be read: no such file");
  EXPECT_EQ(message_for(JAMSCOPE_DATA_DIR), std::string(JAMSCOPE_DATA_DIR) + ": is a folder, expected a TOML file");
}

TEST(CaseFile, CriteriaFilesHoldTheAnalysisTableAlone) {
  jam::Criteria base;
  base.gap_margin = 2;
  const jam::Criteria c = read_criteria_text("[analysis]\njam_force = \"3 N\"\n", "c.toml", base, {"measure=max"});
  EXPECT_EQ(c.jam_force, 3);
  EXPECT_EQ(c.gap_margin, 2);
  EXPECT_EQ(c.measure, jam::CompressiveMeasure::max);
  EXPECT_EQ(read_criteria_text("", "c.toml", base, {"analysis.jam_force=4 N"}).jam_force, 4);
  EXPECT_THROW(read_criteria_text("jam_force = \"3 N\"\n", "c.toml", base), dem::CaseError);
}

TEST(Suggestion, FindsSlipsOfTheFingerOnly) {
  const std::vector<std::string> keys{"depth", "seed", "mean_diameter"};
  EXPECT_EQ(nearest("depht", keys), "depth");  // neighbours swapped
  EXPECT_EQ(nearest("Seed", keys), "seed");
  EXPECT_EQ(nearest("mean_diametre", keys), "mean_diameter");
  EXPECT_EQ(nearest("colour", keys), "");
  EXPECT_EQ(nearest(std::string(100000, 'x'), keys), "");
}

// ---- shipped cases -------------------------------------------------------------------------------------------------

std::vector<std::string> shipped_cases() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(JAMSCOPE_DATA_DIR) + "/cases"))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

class ShippedCase : public testing::TestWithParam<std::string> {};

TEST_P(ShippedCase, ReadsWithoutErrorsOrWarnings) {
  const CaseFile file = read_case_file(GetParam());
  EXPECT_THAT(file.warnings, testing::IsEmpty());
  EXPECT_EQ(file.physics.name, std::filesystem::path(GetParam()).stem().string());
}

INSTANTIATE_TEST_SUITE_P(All, ShippedCase, testing::ValuesIn(shipped_cases()),
                         [](const auto& row) { return std::filesystem::path(row.param).stem().string(); });

CaseFile shipped(const std::string& name) {
  return read_case_file(std::string(JAMSCOPE_DATA_DIR) + "/cases/" + name + ".toml");
}

TEST(PaperCases, GiveTheNumbersOfThePaper) {
  // u, omega, Bond and cohesion numbers to the digits that the paper prints; half a unit of the last digit.
  const dem::Derived a = dem::derive(shipped("ft4_a_down").physics);
  EXPECT_NEAR(a.axial_velocity, -21.8e-3, 0.05e-3);
  EXPECT_NEAR(a.angular_velocity, 21.2, 0.05);
  EXPECT_NEAR(a.bond, 58.8, 0.05);
  EXPECT_NEAR(a.cohesion, 2.3e-4, 0.05e-4);
  EXPECT_NEAR(a.step_over_rayleigh_smallest, 0.127, 0.0005);
  EXPECT_GT(a.grains_loose, 33e3);
  EXPECT_LT(a.grains_dense, 38e3);
  const dem::Derived b = dem::derive(shipped("ft4_b_down").physics);
  EXPECT_NEAR(b.bond, 58.8, 0.05);
  EXPECT_NEAR(b.cohesion, 2.3e-2, 0.05e-2);
  const dem::Derived c = dem::derive(shipped("ft4_c_down").physics);
  EXPECT_NEAR(c.bond, 3.7, 0.05);
  EXPECT_NEAR(c.cohesion, 2.3e-4, 0.05e-4);
}

TEST(PaperCases, UpwardRunsMirrorTheDownwardOnes) {
  for (const char* test : {"a", "b", "c"}) {
    const dem::Case down = shipped(std::string("ft4_") + test + "_down").physics;
    const dem::Case up = shipped(std::string("ft4_") + test + "_up").physics;
    EXPECT_EQ(up.motion.helix_angle, -down.motion.helix_angle);
    EXPECT_NE(up.motion.clockwise, down.motion.clockwise);
    // Starts where the other ends; the case file gives a micrometre.
    EXPECT_NEAR(up.blade.start_height, dem::derive(down).end_height, 1e-6);
    EXPECT_EQ(up.materials[0].young, down.materials[0].young);
    EXPECT_EQ(up.interactions[0][0].work_of_adhesion, down.interactions[0][0].work_of_adhesion);
  }
}

}  // namespace
}  // namespace jamscope
