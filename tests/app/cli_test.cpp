#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string cases = std::string(JAMSCOPE_DATA_DIR) + "/cases/";

TEST(CommandLine, HelpAndVersionSucceed) {
  const Outcome help = run_program("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("check"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes"));
  const Outcome version = run_program("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("jamscope [0-9]+\\.[0-9]+\\.[0-9]+ \\(.+\\)\n"));
}

TEST(CommandLine, EveryListedCommandHasHelpWithAnExample) {
  std::istringstream help(run_program("--help").out);
  std::string line;
  int commands = 0;
  while (std::getline(help, line) && line != "Subcommands:") {
  }
  while (std::getline(help, line) && !line.empty()) {
    std::string name;
    std::istringstream(line) >> name;
    const Outcome outcome = run_program(name + " --help");
    EXPECT_EQ(outcome.code, 0) << name;
    EXPECT_THAT(outcome.out, HasSubstr("Example")) << name;
    EXPECT_THAT(outcome.out, HasSubstr("jamscope " + name)) << name;
    ++commands;
  }
  EXPECT_GE(commands, 1);
}

TEST(CommandLine, WrongUsageExitsWith2AndOneMessage) {
  const Outcome unknown = run_program("chek");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "error: unknown command 'chek'; did you mean 'check'?\n");
  EXPECT_EQ(run_program("").code, 2);
  const Outcome missing = run_program("check");
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.err, "error: CASE is required\nsee: jamscope check --help\n");
  EXPECT_EQ(missing.out, "");
  EXPECT_EQ(run_program("check --no-such-option " + cases + "ft4_quick.toml").code, 2);
}

TEST(CommandLine, CaseErrorsExitWith2) {
  const Outcome none = run_program("check no_such_case.toml");
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.err, "error: no_such_case.toml: cannot be read: no such file\n");
  const Outcome bad = run_program("check " + cases + "ft4_quick.toml --set bed.depht='4 mm'");
  EXPECT_EQ(bad.code, 2);
  EXPECT_EQ(bad.err, "error: --set bed.depht: unknown key 'depht' in [bed]; did you mean 'depth'?\n");
}

TEST(CommandLine, SetTakesOneValueAndLeavesTheCaseFileAlone) {
  const Outcome outcome =
      run_program("check --set bed.depth='4 mm' --set bed.seed=5 " + cases + "ft4_quick.toml --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  // 4 mm of 25 mm bore at a solid fraction of 0.6.
  EXPECT_NEAR(json["derived"]["bed"]["grains"].get<double>(), 2733.5, 0.5);
}

TEST(Check, PrintsTheNumbersOfThePaper) {
  const auto has = [](const std::string& text, const std::string& pattern) {
    EXPECT_THAT(text, testing::ContainsRegex(pattern));
  };
  const Outcome a = run_program("check " + cases + "ft4_a_down.toml");
  EXPECT_EQ(a.code, 0);
  EXPECT_EQ(a.err, "");
  has(a.out, "axial velocity u +-21\\.8 mm/s +downward");
  has(a.out, "angular velocity omega +21\\.2 rad/s counter-clockwise");
  has(a.out, "Bond number +58\\.8 ");
  has(a.out, "Cohesion number +0\\.00023 ");
  has(a.out, "step +50 ns +12\\.7 % of the smallest grain's Rayleigh time");
  has(a.out, "33 167 at solid fraction 0\\.56 to 37 905 at 0\\.64");
  const Outcome c = run_program("check " + cases + "ft4_c_down.toml");
  has(c.out, "Bond number +3\\.71 ");
  has(c.out, "Cohesion number +0\\.00023 ");
  const Outcome up = run_program("check " + cases + "ft4_a_up.toml");
  has(up.out, "axial velocity u +21\\.8 mm/s +upward");
  has(up.out, "angular velocity omega +21\\.2 rad/s clockwise");
}

TEST(Check, WarningsStandInTheTextAndDoNotFail) {
  const Outcome outcome = run_program("check " + cases + "ft4_a_down.toml --set run.step='1e-7 s'");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("warning: --set run.step: 'step' = 1e-07 s is 25.3 %"));
}

}  // namespace
}  // namespace jamscope
