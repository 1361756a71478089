#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "libjam/results_file.hpp"
#include "libjam/statistics/rates.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

// A folder with the results of a record of 2 s in which jams of these durations, s, began every 50 ms.
std::string record(const Scratch& scratch, const std::string& name, const std::vector<double>& durations, bool every_step = true) {
  const std::filesystem::path folder = scratch / name;
  std::filesystem::create_directories(folder);
  jam::Analysis a;
  a.frames.resize(2);
  a.frames[1].time = 2;
  a.loaded.count.resize(2);
  a.blade.resize(2);
  a.observed_time = 2;
  a.sampling_interval = 2e-3;
  if (every_step) {
    a.every_step.resize(3);
    for (std::size_t k = 0; k < durations.size(); ++k) {
      jam::StepJam jam;
      jam.start = 0.05 * double(k + 1);
      jam.duration = durations[k];
      jam.end = jam.start + durations[k];
      jam.peak_force = 20 + double(k);
      jam.work = 1e-3;
      jam.members = {jam::ParticleId(k)};
      a.every_step[0].jams.push_back(jam);
    }
  }
  jam::write_results(folder / "jam.h5", a, jam::RunInfo{});
  return folder.string();
}

TEST(Compare, ShowsRunsSideBySideAndTestsThem) {
  const Scratch scratch;
  const std::string fast = record(scratch, "fast", {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 7e-3, 8e-3, 9e-3, 10e-3, 11e-3, 12e-3, 13e-3});
  const std::string slow = record(scratch, "slow", {20e-3, 21e-3, 22e-3, 23e-3});
  const Outcome outcome = run_program("compare " + fast + " " + slow + " --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const auto value = [&](std::size_t run, const char* name, const char* what = "value") { return json["runs"][run]["quantities"][name][what].get<double>(); };
  EXPECT_EQ(value(0, "jams"), 13);
  EXPECT_EQ(value(0, "rate"), 6.5);
  EXPECT_DOUBLE_EQ(value(1, "rate", "low"), jam::poisson_rate(4, 2).low);
  EXPECT_DOUBLE_EQ(value(0, "half end within"), 7);
  EXPECT_DOUBLE_EQ(value(1, "longest"), 23);
  EXPECT_DOUBLE_EQ(value(0, "jammed time over record"), 100 * 91e-3 / 2);
  EXPECT_DOUBLE_EQ(value(0, "work of walls on jammed grains"), 13);
  EXPECT_DOUBLE_EQ(value(0, "median of peak forces"), 26);
  // 13 against 4 of 17 coins.
  EXPECT_NEAR(json["tests"][0]["same_rate_p"].get<double>(), jam::same_rate_probability(13, 2, 4, 2), 1e-12);
  EXPECT_LT(json["tests"][0]["log_rank_p"].get<double>(), 0.01);
  EXPECT_DOUBLE_EQ(json["mean_rate"]["value"].get<double>(), 4.25);
  const Outcome text = run_program("compare " + fast + "/ " + slow + "/jam.h5 " + slow);
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("rate, 1/s"));
  EXPECT_THAT(text.out, HasSubstr("all 3 runs"));
}

TEST(Compare, JudgesGroupsOfRunsBySeeds) {
  const Scratch scratch;
  std::vector<std::string> first, second;
  for (int seed = 0; seed < 4; ++seed) {
    first.push_back(record(scratch, fmt::format("first_{}", seed), std::vector<double>(std::size_t(5 + seed), 1e-3 * (seed + 1))));
    second.push_back(record(scratch, fmt::format("second_{}", seed), std::vector<double>(std::size_t(15 + seed), 1e-3 * (seed + 1.5))));
  }
  const Outcome outcome = run_program(fmt::format("compare {} --against {} --json", fmt::join(first, " "), fmt::join(second, " ")));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["groups"][1].size(), 4U);
  const auto& rate = json["quantities"]["rate of jams"];
  EXPECT_DOUBLE_EQ(rate["first"].get<double>(), (5 + 6 + 7 + 8) / 8.0);
  EXPECT_DOUBLE_EQ(rate["second"].get<double>(), (15 + 16 + 17 + 18) / 8.0);
  EXPECT_DOUBLE_EQ(rate["p"].get<double>(), 2.0 / 70);
  EXPECT_GT(rate["seen_factor"].get<double>(), 1);
  EXPECT_LT(rate["seen_factor"].get<double>(), 5);
  const auto& durations = json["quantities"]["durations of jams, median"];
  EXPECT_GT(durations["p"].get<double>(), 0.05);
  EXPECT_GT(durations["distance"].get<double>(), 0.1);
  EXPECT_TRUE(json["quantities"]["torque of the blade at frames, median"].contains("unit"));
  const Outcome text = run_program(fmt::format("compare {} --against {}", fmt::join(first, " "), second[0]));
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("rate of jams, 1/s"));
  EXPECT_THAT(text.out, HasSubstr("4 runs against 1 are few"));

  // In pairs: of 16 ways to swap, this one and its mirror image are the farthest apart.
  const std::string pairs = fmt::format("compare {} --against {} --paired", fmt::join(first, " "), fmt::join(second, " "));
  const Outcome paired = run_program(pairs + " --json");
  ASSERT_EQ(paired.code, 0) << paired.err;
  EXPECT_DOUBLE_EQ(nlohmann::json::parse(paired.out)["quantities"]["rate of jams"]["p"].get<double>(), 2.0 / 16);
  EXPECT_THAT(run_program(pairs).out, HasSubstr("4 pairs are few"));
  const Outcome odd = run_program(fmt::format("compare {} --against {} --paired", fmt::join(first, " "), second[0]));
  EXPECT_EQ(odd.code, 2);
  EXPECT_THAT(odd.err, HasSubstr("4 runs against 1"));
  const Outcome alone = run_program("compare " + first[0] + " --paired");
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--against"));
}

TEST(Compare, SaysWhatIsWrong) {
  const Scratch scratch;
  const std::string old = record(scratch, "old", {}, false);
  const Outcome outcome = run_program("compare " + old);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("--by frame"));
  EXPECT_EQ(run_program("compare " + old + " --by frame").code, 0);
  EXPECT_EQ(run_program("compare no_such_folder").code, 3);
  EXPECT_EQ(run_program("compare " + old + " --stream grain").code, 2);
  EXPECT_EQ(run_program("compare").code, 2);
}

}  // namespace
}  // namespace jamscope
