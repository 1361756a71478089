#include "libjam/events/every_step.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "libjam/statistics/jam_statistics.hpp"

namespace jam {
namespace {

using ::testing::ElementsAre;

constexpr double dt = 1e-6;

void add(Excursions& e, ParticleId particle, std::uint64_t first, std::uint64_t last, float peak, Vec3f at = Vec3f::Zero(), bool open = false) {
  e.particle.push_back(particle);
  e.first_step.push_back(first);
  e.last_step.push_back(last);
  e.peak_step.push_back((first + last) / 2);
  e.peak_force.push_back(peak);
  e.impulse.push_back(peak / 2);
  e.work.push_back(0.25F);
  e.path.push_back(float(particle));
  e.turned.push_back(2);
  for (auto* column : {&e.first_position, &e.peak_position, &e.last_position}) column->push_back(at);
  e.open.push_back(open ? 1 : 0);
}

std::vector<StepJam> jams_of(const Excursions& e, JamStream stream, const Detector& detector = {}, std::uint64_t first_step = 0) {
  return step_jams(last_word(e), stream, detector, {}, Sites{}, dt, 1, first_step);
}

// A hand-over without a pause is one global jam and two of particles; two at once are one; a pause of one step parts two.
TEST(StepJams, OfTheGlobalStreamAreTheTimesWhenAnyParticleIsAbove) {
  Excursions e;
  add(e, 4, 100, 199, 30);
  add(e, 7, 150, 299, 50);
  add(e, 4, 300, 303, 25);  // the next step after 299
  add(e, 9, 305, 310, 22);  // 304 was free
  const auto global = jams_of(e, JamStream::global);
  ASSERT_EQ(global.size(), 2u);
  EXPECT_DOUBLE_EQ(global[0].start, 100e-6);
  EXPECT_DOUBLE_EQ(global[0].end, 303e-6);
  EXPECT_DOUBLE_EQ(global[0].duration, 204e-6);
  EXPECT_THAT(global[0].members, ElementsAre(4, 7));
  EXPECT_EQ(global[0].peak_force, 50);
  EXPECT_EQ(global[0].peak_particle, 7u);
  EXPECT_DOUBLE_EQ(global[0].peak_time, 224e-6);
  EXPECT_EQ(global[0].stays, 3u);
  EXPECT_DOUBLE_EQ(global[0].impulse, 15 + 25 + 12.5);
  EXPECT_DOUBLE_EQ(global[0].work, 0.75);
  EXPECT_EQ(global[0].path, 7);
  EXPECT_DOUBLE_EQ(global[1].start, 305e-6);
  EXPECT_EQ(jams_of(e, JamStream::particle).size(), 4u);
}

TEST(StepJams, BridgePausesAndLeaveOutWhatIsWeakOrShort) {
  Excursions e;
  add(e, 4, 100, 199, 30);
  add(e, 4, 210, 219, 25);  // after a pause of ten steps
  add(e, 5, 400, 404, 100);
  add(e, 6, 500, 599, 19);
  EXPECT_EQ(jams_of(e, JamStream::particle, {20, 10, 0, 0}).size(), 3u);
  const auto held = jams_of(e, JamStream::particle, {20, 10, 10e-6, 0});
  ASSERT_EQ(held.size(), 2u);
  EXPECT_DOUBLE_EQ(held[0].duration, 120e-6);
  EXPECT_EQ(jams_of(e, JamStream::particle, {20, 10, 9e-6, 0}).size(), 3u);
  EXPECT_EQ(jams_of(e, JamStream::particle, {20, 10, 10e-6, 6e-6}).size(), 1u);
  EXPECT_EQ(jams_of(e, JamStream::particle, {20, 10, 10e-6, 5e-6}).size(), 2u);
}

TEST(StepJams, KeepTheLastWordOnAStayAndSayWhatTheRecordCutsOff) {
  Excursions e;
  add(e, 4, 50, 199, 30, Vec3f::Zero(), true);
  add(e, 4, 50, 240, 35);
  add(e, 8, 700, 800, 21, Vec3f::Zero(), true);
  add(e, 8, 700, 900, 22, Vec3f::Zero(), true);
  const auto jams = jams_of(e, JamStream::particle, {}, 50);
  ASSERT_EQ(jams.size(), 2u);
  EXPECT_TRUE(jams[0].open_at_start && !jams[0].open_at_end);
  EXPECT_DOUBLE_EQ(jams[0].end, 240e-6);
  EXPECT_TRUE(!jams[1].open_at_start && jams[1].open_at_end);
  EXPECT_DOUBLE_EQ(jams[1].end, 900e-6);
  const auto lifetimes = lifetimes_of(jams);
  ASSERT_EQ(lifetimes.size(), 1u);
  EXPECT_FALSE(lifetimes[0].ended);
}

// Looks every eight steps: a stay seen at one look lasts eight steps, and one that begins at the next look goes on.
TEST(StepJams, LastFromOneLookToTheNext) {
  Excursions e;
  add(e, 1, 64, 64, 30);
  add(e, 2, 72, 80, 30);
  const auto jams = step_jams(e, JamStream::global, {}, {}, Sites{}, dt, 8, 0);
  ASSERT_EQ(jams.size(), 1u);
  EXPECT_DOUBLE_EQ(jams[0].duration, 24e-6);
  EXPECT_EQ(step_jams(e, JamStream::global, {}, {}, Sites{}, dt, 1, 0).size(), 2u);
}

// Against a signal written out step by step: which steps any particle, or each, is above; pauses filled in; runs counted.
TEST(StepJams, AreTheRunsOfASignalWrittenOut) {
  std::mt19937_64 random(12);
  for (int scene = 0; scene < 200; ++scene) {
    constexpr std::size_t steps = 300, particles = 4;
    Excursions e;
    std::vector<std::vector<int>> above(particles, std::vector<int>(steps, 0));
    for (std::uint32_t p = 0; p < particles; ++p)
      for (std::size_t t = 1 + random() % 60; t < steps - 1; t += 2 + random() % 60) {
        const std::size_t last = std::min<std::size_t>(t + random() % 30, steps - 2);
        add(e, p, t, last, 30);
        for (std::size_t k = t; k <= last; ++k) above[p][k] = 1;
        t = last;
      }
    const std::size_t pause = random() % 4, shortest = random() % 10;
    const Detector detector{20, 20, double(pause) * dt, double(shortest) * dt};
    const auto runs_of = [&](std::vector<int> signal) {
      std::size_t last = steps;
      for (std::size_t k = 0; k < steps; ++k) {
        if (!signal[k]) continue;
        if (last < k && k - last - 1 <= pause) std::fill(signal.begin() + std::ptrdiff_t(last), signal.begin() + std::ptrdiff_t(k), 1);
        last = k;
      }
      std::multiset<std::pair<std::size_t, std::size_t>> runs;
      for (std::size_t k = 0; k < steps; ++k) {
        if (!signal[k]) continue;
        std::size_t end = k;
        while (signal[end + 1]) ++end;
        if (end - k + 1 >= shortest) runs.insert({k, end});
        k = end;
      }
      return runs;
    };
    const auto found_in = [&](JamStream stream) {
      std::multiset<std::pair<std::size_t, std::size_t>> runs;
      for (const StepJam& jam : jams_of(e, stream, detector)) runs.insert({std::size_t(std::lround(jam.start / dt)), std::size_t(std::lround(jam.end / dt))});
      return runs;
    };
    std::vector<int> any(steps, 0);
    std::multiset<std::pair<std::size_t, std::size_t>> of_each;
    for (const std::vector<int>& signal : above) {
      for (std::size_t k = 0; k < steps; ++k) any[k] |= signal[k];
      const auto more = runs_of(signal);
      of_each.insert(more.begin(), more.end());
    }
    EXPECT_EQ(found_in(JamStream::global), runs_of(any));
    EXPECT_EQ(found_in(JamStream::particle), of_each);
  }
}

// A blade that turns at 10 rad/s and sinks at 0.1 m/s: a point fixed to it keeps its place in its frame.
TEST(BladeFrame, FollowsTheBlade) {
  const double spin = 10, sink = 0.1;
  std::vector<BladePose> poses;
  for (int k = 0; k < 3; ++k) {
    const double t = 0.01 * k;
    poses.push_back({t, Vec3(0, 0, -sink * t), Vec3(0, 0, -sink), Vec3(0, 0, spin), Eigen::Quaterniond(Eigen::AngleAxisd(spin * t, Vec3::UnitZ()))});
  }
  const Vec3 fixed(0.02, 0.001, 0.003);
  for (const double t : {0.0, 0.004, 0.01, 0.0173, 0.03}) {
    const Vec3 now = Eigen::AngleAxisd(spin * t, Vec3::UnitZ()) * fixed + Vec3(0, 0, -sink * t);
    EXPECT_LT((in_blade_frame(poses, t, now) - fixed).norm(), 1e-12);
  }
  EXPECT_EQ(in_blade_frame({}, 1, fixed), fixed);
}

TEST(Sites, AreSectorsOfTheBladeAndLayersOfItsHeight) {
  const Sites sites{.sectors = 2, .layers = 4, .z_low = 0, .z_high = 8e-3};
  EXPECT_EQ(sites.of(Vec3(1, 0.2, 1e-3)), 0u);
  EXPECT_EQ(sites.of(Vec3(1, -0.2, 1e-3)), 0u);
  EXPECT_EQ(sites.of(Vec3(-1, 0.2, 1e-3)), 1u);
  EXPECT_EQ(sites.of(Vec3(1, 0, 3e-3)), 2u);
  EXPECT_EQ(sites.of(Vec3(-1, 0, 9e-3)), 7u);
  EXPECT_EQ(sites.of(Vec3(-1, 0, -9e-3)), 1u);
  // Two jams at once at two sites are one global jam and two of sites.
  Excursions e;
  add(e, 1, 10, 50, 30, Vec3f(1, 0, 1e-3F));
  add(e, 2, 20, 60, 30, Vec3f(-1, 0, 1e-3F));
  EXPECT_EQ(step_jams(e, JamStream::global, {}, {}, sites, dt, 1, 0).size(), 1u);
  const auto by_site = step_jams(e, JamStream::site, {}, {}, sites, dt, 1, 0);
  ASSERT_EQ(by_site.size(), 2u);
  EXPECT_EQ(by_site[0].site, 0u);
  EXPECT_EQ(by_site[1].site, 1u);
}

// 200 records of 2 s of jams that come independently, 25 a second, of exponential durations of 3 ms, seen at every step: rate and median lie in
// their 95 % intervals in at least 93 of 100, with record ends that cut some off.
TEST(JamStatistics, IntervalsHoldTheTruth) {
  std::mt19937_64 random(21);
  const auto exponential = [&](double mean) { return -mean * std::log((double(random() >> 11) + 0.5) * 0x1p-53); };
  const double rate = 25, mean = 3e-3, record = 2;
  int rate_held = 0, median_held = 0;
  constexpr int records = 200;
  for (int trial = 0; trial < records; ++trial) {
    Excursions e;
    ParticleId particle = 0;
    for (double t = exponential(1 / rate); t < record; t += exponential(1 / rate)) {
      const double end = t + exponential(mean);
      const auto step = [](double time) { return std::uint64_t(time / dt) + 1; };
      add(e, ++particle, step(t), step(std::min(end, record)), 30, Vec3f::Zero(), end > record);
    }
    const JamStatistics s = jam_statistics(jams_of(e, JamStream::particle), 0, record);
    rate_held += s.rate.low <= rate && rate <= s.rate.high;
    const double median = mean * std::numbers::ln2;
    median_held += s.median.low <= median && median <= s.median.high;
    ASSERT_EQ(s.laws.size(), duration_laws().size());
  }
  EXPECT_GE(rate_held, 0.93 * records);
  EXPECT_GE(median_held, 0.93 * records);
}

}  // namespace
}  // namespace jam
