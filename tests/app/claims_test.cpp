// jamscope claims on small summaries written here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using nlohmann::json;

class ClaimsProgram : public ::testing::Test {
 protected:
  // Writes a summary of a run into NAME.json of the folder `runs`.
  void run(const std::string& file, const std::string& name, const json& analysis) {
    std::filesystem::create_directories(folder_ / "runs");
    std::ofstream(folder_ / ("runs/" + file + ".json")) << json{{"run", {{"name", name}}}, {"analysis", analysis}};
  }
  std::string claims(const std::string& text) {
    std::ofstream(folder_ / "claims.toml") << text;
    return "claims " + (folder_ / "runs") + " --claims " + (folder_ / "claims.toml");
  }
  json judged(const std::string& text) {
    const Outcome outcome = run_program(claims(text) + " --format json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? json::parse(outcome.out) : json();
  }
  // Of one claim with this measure and these further lines.
  json one(const std::string& measure, const std::string& of, const std::string& more) {
    return judged("[claim.it]\nnumber = 1\nsays = \"it\"\nmeasure = \"" + measure + "\"\nof = \"" + of + "\"\nrun = \"a\"\n" + more).at(0);
  }
  Scratch folder_;
};

TEST_F(ClaimsProgram, MeasuresGiveWhatTheySay) {
  run("1", "a", {{"x", 6.0}, {"list", {1.0, 4.0, 3.0, 2.0}}, {"nested", {{"y", 0.5}}}, {"rows", {{{"z", 0.25}}, {{"z", 0.75}}}}, {"unknown", nullptr}});
  run("2", "b", {{"x", 2.0}, {"list", {2.0, 2.0, 6.0, 2.0}}});
  EXPECT_EQ(one("value", "x", "high = 7.0")["value"], 6.0);
  EXPECT_EQ(one("value", "nested.y", "high = 7.0")["value"], 0.5);
  EXPECT_EQ(one("sum", "list", "first = 1\nhigh = 7.0")["value"], 9.0);
  EXPECT_EQ(one("largest_at", "list", "high = 7.0")["value"], 1.0);
  EXPECT_EQ(one("largest_at", "list", "first = 2\nhigh = 7.0")["value"], 2.0);
  EXPECT_EQ(one("rank_correlation", "list", "first = 1\nhigh = 7.0")["value"], -1.0);
  EXPECT_EQ(one("largest_difference", "rows.z", "values = [0.5, 0.8]\nhigh = 7.0")["value"], 0.25);
  const std::string b = "against_run = \"b\"\nhigh = 7.0\n";
  EXPECT_EQ(one("ratio", "x", b)["value"], 3.0);
  EXPECT_EQ(one("difference", "x", b)["value"], 4.0);
  EXPECT_EQ(one("share_above", "list", b)["value"], 0.25);
  EXPECT_EQ(one("largest_ratio", "list", b)["value"], 2.0);
  EXPECT_EQ(one("rms_difference", "list", b)["value"], std::sqrt((1 + 4 + 9) / 4.0));
  EXPECT_EQ(one("power", "x", b + "values = [9, 3]")["value"], 1.0);
}

// Runs that are not equally long are compared where both are.
TEST_F(ClaimsProgram, ListsAreComparedAtThePlacesThatBothCover) {
  run("1", "a", {{"observed_time_s", 0.6}, {"e", {1.0, 4.0, 9.0}}, {"t", {0.2, 0.4, 0.6}}, {"x", 3.0}});
  run("2", "b", {{"observed_time_s", 2.0}, {"e", {2.0, 6.0, 10.0, 30.0}}, {"t", {0.3, 0.5, 0.7, 2.0}}, {"x", 2.0}});
  const std::string b = "at = \"t\"\nagainst_run = \"b\"\nhigh = 70.0\n";
  EXPECT_DOUBLE_EQ(one("ratio", "e", b)["value"], 9.0 / 8.0);  // b at 0.6 s is halfway between 6 and 10
  EXPECT_DOUBLE_EQ(one("difference", "e", b)["value"], 1.0);
  EXPECT_DOUBLE_EQ(one("share_above", "e", b)["value"], 0.5);  // not at 0.4 s: 4 and 4; b does not know 0.2 s
  EXPECT_DOUBLE_EQ(one("largest_ratio", "e", b)["value"], 9.0 / 8.0);
  EXPECT_THAT(std::string(one("ratio", "e", b)["how"]), HasSubstr("of a, 0.6 s, against e of b, 2 s"));
  EXPECT_EQ(one("ratio", "e", "against_run = \"b\"\nhigh = 7.0")["verdict"], "not measured");  // where lists stand is not said
  EXPECT_THAT(std::string(one("ratio", "e", "at = \"x\"\nagainst_run = \"b\"\nhigh = 7.0")["how"]), HasSubstr("not the ascending places"));
  EXPECT_THAT(std::string(one("value", "x", "observed_time = \"1 s\"\nhigh = 7.0")["how"]), HasSubstr("0.6 s long, expected at least 1 s"));
  EXPECT_EQ(one("value", "x", "observed_time = \"0.5 s\"\nhigh = 7.0")["value"], 3.0);
  const Outcome refused = run_program(claims("[claim.it]\nnumber = 1\nsays = \"it\"\nof = \"x\"\nrun = \"a\"\nmeasure = \"value\"\nat = \"t\"\nlow = 1.0"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("`at` says where lists of two stand"));
}

// Places that one run does not know are left out; of vectors the squares of all components count, and one that is unknown makes the vector unknown.
TEST_F(ClaimsProgram, DifferencesLeaveOutWhatIsUnknown) {
  const json unknown;
  run("1", "a", {{"list", {1.0, unknown, 3.0, 5.0}}, {"field", {1.0, 2.0, 2.0, unknown, 9.0, 9.0, 0.0, 0.0, 4.0}}, {"sparse", {1.0, 1.0, 1.0, unknown, unknown}}});
  run("2", "b", {{"list", {2.0, 4.0, 3.0, unknown}}, {"field", {0.0, 0.0, 0.0, 7.0, 7.0, 7.0, 0.0, 0.0, 0.0}}, {"sparse", {3.0, unknown, unknown, unknown, unknown}}});
  const std::string b = "against_run = \"b\"\nhigh = 7.0\n";
  EXPECT_EQ(one("rms_difference", "list", b)["value"], std::sqrt(1 / 2.0));
  EXPECT_EQ(one("rms_difference", "field", b + "components = 3\n")["value"], std::sqrt((9 + 16) / 2.0));
  // One place of three in common is too few; so is a list that is not made of such vectors.
  for (const json& none : {one("rms_difference", "sparse", b), one("rms_difference", "list", b + "components = 3\n")}) {
    EXPECT_EQ(none["verdict"], "not measured");
    EXPECT_THAT(std::string(none["how"]), HasSubstr("at least half of the places that one run has"));
  }
  const Outcome zero = run_program(claims("[claim.it]\nnumber = 1\nsays = \"it\"\nmeasure = \"rms_difference\"\nof = \"list\"\nrun = \"a\"\ncomponents = 0\n" + b));
  EXPECT_EQ(zero.code, 2);
  EXPECT_THAT(zero.err, HasSubstr("claims.toml:7:14: components is 0"));
}

TEST_F(ClaimsProgram, VerdictsAreComputed) {
  run("1", "a", {{"x", 6.0}, {"unknown", nullptr}});
  run("2", "a", {{"x", 8.0}});
  run("3", "a", {{"x", 1.0}});
  const json within = one("value", "x", "low = 6.0\nhigh = 6.0");
  EXPECT_EQ(within["verdict"], "holds");  // the median of three
  EXPECT_EQ(within["runs"], 3);
  EXPECT_EQ(within["low"], 1.0);
  EXPECT_EQ(within["high"], 8.0);
  EXPECT_EQ(one("value", "x", "low = 6.5")["verdict"], "does not hold");
  EXPECT_EQ(one("value", "x", "high = 5.5")["verdict"], "does not hold");
  for (const char* of : {"nowhere", "unknown", "x.deeper"}) {
    const json none = one("value", of, "high = 1.0");
    EXPECT_EQ(none["verdict"], "not measured") << of;
    EXPECT_TRUE(none["value"].is_null());
  }
  EXPECT_THAT(std::string(one("ratio", "x", "against_run = \"c\"\nhigh = 1.0")["how"]), HasSubstr("no run c"));
}

TEST_F(ClaimsProgram, RefusesBrokenClaimsAndSummaries) {
  run("1", "a", {{"x", 6.0}});
  const std::string good = "[claim.it]\nnumber = 1\nsays = \"it\"\nof = \"x\"\nrun = \"a\"\n";
  const auto refused = [&](const std::string& text, const std::string& why) {
    const Outcome outcome = run_program(claims(text));
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  refused(good + "measure = \"vale\"\nlow = 1.0", "did you mean 'value'");
  refused(good + "measure = \"value\"", "holds always");
  refused(good + "measure = \"ratio\"\nlow = 1.0", "against_run is missing");
  refused(good + "measure = \"value\"\nagainst_run = \"a\"\nlow = 1.0", "takes one run");
  refused(good + "measure = \"value\"\nlow = 2.0\nhigh = 1.0", "above high");
  refused(good + "measure = \"value\"\nlow = 2.0\nlo = 1.0", "unknown key");
  refused("[claim.it]\nnumber", "claims.toml:2");
  std::ofstream(folder_ / "runs/broken.json") << "{\"run\": 3}";
  EXPECT_EQ(run_program(claims(good + "measure = \"value\"\nlow = 1.0")).code, 3);
  EXPECT_EQ(run_program("claims " + (folder_ / "nowhere") + " --claims " + (folder_ / "claims.toml")).code, 3);
}

// The claims of the paper: readable, and each measured or not with a reason, whatever runs there are.
TEST_F(ClaimsProgram, ThePapersClaimsAreThere) {
  run("1", "ft4_a_down", {{"criteria", {{"jam_force_N", 20.0}}}});
  const Outcome outcome = run_program("claims " + (folder_ / "runs") + " --claims " JAMSCOPE_DATA_DIR "/reference/paper_claims.toml --format json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json rows = json::parse(outcome.out);
  std::set<int> numbers;
  for (const json& row : rows) {
    numbers.insert(int(row["number"]));
    EXPECT_EQ(row["verdict"], row["name"] == "jam_force" ? "holds" : "not measured") << row["name"];
  }
  EXPECT_EQ(numbers.size(), 28u);
  EXPECT_EQ(*numbers.begin(), 1);
  EXPECT_EQ(*numbers.rbegin(), 28);
  for (const char* format : {"text", "markdown"})
    EXPECT_THAT(run_program("claims " + (folder_ / "runs") + " --claims " JAMSCOPE_DATA_DIR "/reference/paper_claims.toml --format " + format).out, HasSubstr("20 N"));
}

// What is not measured from the committed runs lacks a run, or the rest of one, that is still to come.
TEST_F(ClaimsProgram, TheCommittedRunsAreMeasured) {
  const Outcome outcome =
      run_program("claims " JAMSCOPE_DATA_DIR "/reference/paper --claims " JAMSCOPE_DATA_DIR "/reference/paper_claims.toml --format json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  int measured = 0;
  for (const json& row : json::parse(outcome.out)) {
    if (row["verdict"] != "not measured")
      ++measured;
    else
      EXPECT_THAT(row["how"].get<std::string>(), AnyOf(HasSubstr("no run ft4_"), HasSubstr("s long, expected at least"))) << row["name"];
  }
  EXPECT_GE(measured, 35);
}

// The same claims of runs of another blade, of records as short as they are.
TEST_F(ClaimsProgram, AreAskedOfAVariantOfTheRuns) {
  run("1", "a", {{"observed_time_s", 2.0}, {"x", 6.0}});
  run("2", "a_flat", {{"observed_time_s", 0.25}, {"x", 8.0}});
  run("3", "b_flat", {{"observed_time_s", 0.25}, {"x", 2.0}});
  const std::string text = "[claim.one]\nnumber = 1\nsays = \"it\"\nmeasure = \"value\"\nof = \"x\"\nrun = \"a\"\nobserved_time = \"0.5 s\"\nlow = 1.0\n"
                           "[claim.two]\nnumber = 2\nsays = \"both\"\nmeasure = \"ratio\"\nof = \"x\"\nrun = \"a\"\nagainst_run = \"b\"\nlow = 1.0\n";
  const auto rows = [&](const std::string& more) {
    const Outcome outcome = run_program(claims(text) + more + " --format json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? json::parse(outcome.out) : json();
  };
  const json as_is = rows(""), measured = rows(" --measured"), flat = rows(" --variant _flat"), all = rows(" --variant _flat --shortest 250ms --measured");
  EXPECT_EQ(as_is.at(0)["value"], 6.0);
  EXPECT_EQ(as_is.at(1)["verdict"], "not measured");  // there is no b
  ASSERT_EQ(measured.size(), 1u);
  EXPECT_EQ(measured.at(0)["name"], "one");
  EXPECT_THAT(std::string(flat.at(0)["how"]), HasSubstr("0.25 s long, expected at least 0.5 s"));
  EXPECT_EQ(flat.at(1)["value"], 4.0);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all.at(0)["value"], 8.0);
  EXPECT_EQ(run_program(claims(text) + " --shortest 3").code, 2);
  const Outcome misspelt = run_program(claims(text) + " --variant _flta --measured");
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("--variant _flta: no run has a name that ends so"));
}

// The tables in data/reference/paper are what the program prints of the runs beside them.
TEST_F(ClaimsProgram, TheCommittedTablesAreOfTheCommittedRuns) {
  const std::string data = JAMSCOPE_DATA_DIR;
  for (const auto& [options, table] : {std::pair{"", "claims"}, std::pair{" --variant _flat --shortest 0.04s --measured", "claims_flat_tips"},
                                       std::pair{" --variant _thin_flat --shortest 0.2s --measured", "claims_thin_flat_tips"}}) {
    const std::string asked = fmt::format("{0}/reference/paper --claims {0}/reference/paper_claims.toml{1} --format markdown", data, options);
    std::string printed = run_program("claims " + asked).out;
    for (std::size_t at; (at = printed.find(data)) != std::string::npos;) printed.replace(at, data.size(), "data");
    std::ifstream file(fmt::format("{}/reference/paper/{}.md", data, table));
    EXPECT_EQ(printed, std::string(std::istreambuf_iterator<char>(file), {})) << "after new runs or claims make it anew: data/reference/paper/README.md";
  }
}

}  // namespace
}  // namespace jamscope
