// The quick case over 100,000 steps, as the issue of every release: its energies add up, and neither threads nor stops change a
// bit of it. Minutes, so these have the label `validation`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "apps/jamscope/checkpoint.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

class QuickCaseValidation : public testing::Test {
 protected:
  // 5 ms, 100,000 steps of 50 ns; checkpoints wherever a run is stopped and every 0.5 ms.
  std::string command(const std::string& out, const std::string& more = "") const {
    return "simulate " JAMSCOPE_DATA_DIR "/cases/ft4_quick.toml -o " + (folder_ / out) + " --bed-cache " + beds() +
           " -q --set run.duration='5 ms' --set output.checkpoint_interval='0.5 ms' --set output.energy_ledger=true " + more;
  }
  // Settled once for all tests of this process.
  static std::string beds() {
    static Scratch folder;
    return folder / "beds";
  }
  nlohmann::json energy(const std::string& out) const {
    return nlohmann::json::parse(text_of(folder_ / (out + "/summary.json"))).at("energy");
  }
  // Everything that a run goes on from, as bytes.
  std::string state_bytes(const std::string& out) const {
    const Checkpoint c = read_checkpoint(folder_ / (out + "/run.restart.h5"));
    std::string bytes = std::to_string(c.state.step) + " " + std::to_string(c.state.pairs.size()) + " " +
                        std::to_string(c.state.wall_pairs.size()) + ";";
    const auto add = [&bytes](const auto& rows) {
      bytes.append(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(rows[0]));
    };
    const dem::Particles& p = c.state.particles;
    add(p.position);
    add(p.velocity);
    add(p.angular_velocity);
    add(c.state.force);
    add(c.state.torque);
    add(c.state.ledger.wall_work);
    for (const dem::State::Pair& pair : c.state.pairs) {
      add(std::vector{pair.i, pair.j});
      add(std::vector{pair.birth_step});
      add(std::vector{pair.spring, pair.rolling});
    }
    for (const dem::State::WallPair& pair : c.state.wall_pairs) {
      add(std::vector{pair.i, pair.wall});
      add(std::vector{pair.feature, pair.birth_step});
      add(std::vector{pair.spring, pair.rolling, pair.normal});
    }
    return bytes;
  }
  Scratch folder_;
};

TEST_F(QuickCaseValidation, TheEnergyLedgerClosesOver100000Steps) {
  ASSERT_EQ(run_program(command("whole", "--threads 2")).code, 0);
  const nlohmann::json e = energy("whole");
  RecordProperty("energy", e.dump());
  std::printf("%s\n", e.dump(2).c_str());
  EXPECT_GT(e.at("work_of_wall").at("blade").get<double>(), 0);
  // All columns are exact sums of what leapfrog does, so only rounding is left: 3,000 grains' energies, some 1e-4 J together
  // (gravitational; the work is of the same size), each known to 1e-16, summed 100,000 times.
  EXPECT_LT(std::abs(e.at("residual_over_work_put_in").get<double>()), 1e-6);
  // What the finite step makes or loses is part of the picture: small, and smaller with half the step.
  ASSERT_EQ(run_program(command("half", "--threads 2 --set run.step='25 ns'")).code, 0);
  const nlohmann::json half = energy("half");
  std::printf("%s\n", half.dump(2).c_str());
  const double share = e.at("time_stepping").get<double>() / e.at("work_of_wall").at("blade").get<double>();
  const double half_share = half.at("time_stepping").get<double>() / half.at("work_of_wall").at("blade").get<double>();
  std::printf("lost by the finite step: %.3g of the blade's work at 50 ns, %.3g at 25 ns\n", share, half_share);
  EXPECT_LT(std::abs(share), 0.01);
  EXPECT_LT(std::abs(half_share), std::abs(share));
}

TEST_F(QuickCaseValidation, ThreadsAndStopsChangeNoBitOver100000Steps) {
  ASSERT_EQ(run_program(command("one", "--threads 1")).code, 0);
  const std::string expected = state_bytes("one");
  ASSERT_GT(expected.size(), 3000u * 5 * 24);
  EXPECT_THAT(expected, testing::StartsWith("100000 "));
  for (const char* threads : {"2", "3"}) {
    ASSERT_EQ(run_program(command(threads, std::string("--threads ") + threads)).code, 0);
    EXPECT_TRUE(state_bytes(threads) == expected) << threads << " threads";
  }
  // Stopped at seven arbitrary steps, each time going on with another number of threads.
  std::mt19937 random(7);
  std::vector<double> stops;
  for (int k = 0; k < 7; ++k) stops.push_back(5e-8 * double(1 + random() % 99998));
  std::sort(stops.begin(), stops.end());
  int threads = 1;
  for (const double stop : stops) {
    std::array<char, 32> until{};
    std::snprintf(until.data(), until.size(), "%.9g s", stop);
    const std::string resume = stop == stops.front() ? "" : " --resume";
    const Outcome part = run_program(
        command("parts", "--until '" + std::string(until.data()) + "' --threads " + std::to_string(threads) + resume));
    ASSERT_EQ(part.code, 0) << part.err;
    threads = threads % 3 + 1;
  }
  const Outcome rest = run_program(command("parts", "--resume --threads 2"));
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_TRUE(state_bytes("parts") == expected);
  EXPECT_EQ(energy("parts").dump(), energy("one").dump());
}

}  // namespace
}  // namespace jamscope
