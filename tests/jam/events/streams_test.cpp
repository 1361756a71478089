#include "libjam/events/streams.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "libjam/events/every_step.hpp"
#include "tests/jam/events/hand_made_record.hpp"

namespace jam {
namespace {

using hand_made::record;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double D = 2e-3;
// Products and sums of the few numbers 2e-3 and k.
constexpr double rounding = 1e-15;

TEST(StreamsTest, AnUninterruptedRunIsOneEventWithAllItsNumbers) {
  const auto frames = record({{7, "..354.."}});
  const auto events = global_events(frames, {D});
  ASSERT_EQ(events.size(), 1u);
  const JamEvent& e = events[0];
  EXPECT_EQ(e.first_frame, 2u);
  EXPECT_EQ(e.last_frame, 4u);
  EXPECT_EQ(e.samples, 3u);
  EXPECT_NEAR(e.start, 4e-3, rounding);
  EXPECT_NEAR(e.end, 8e-3, rounding);
  EXPECT_NEAR(e.survival_time, 6e-3, rounding);
  EXPECT_NEAR(e.shortest, 4e-3, rounding);
  EXPECT_NEAR(e.longest, 8e-3, rounding);
  EXPECT_FALSE(e.open_at_start);
  EXPECT_FALSE(e.open_at_end);
  EXPECT_EQ(e.peak_force, 50);
  EXPECT_NEAR(e.peak_time, 6e-3, rounding);
  EXPECT_EQ(e.peak_particle, 7u);
  EXPECT_THAT(e.members, ElementsAre(7));
}

TEST(StreamsTest, AJamFreeFrameEndsAnEvent) {
  const auto events = global_events(record({{7, ".33.3."}}), {D});
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].samples, 2u);
  EXPECT_EQ(events[1].samples, 1u);
  EXPECT_EQ(events[1].shortest, 0);
}

TEST(StreamsTest, TwoJamsAtTheSameTimeAreOneGlobalEventAndTwoTracks) {
  const auto frames = record({{3, ".3333.."},  //
                              {9, "..555.."}});
  const auto events = global_events(frames, {D});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].samples, 4u);
  EXPECT_THAT(events[0].members, ElementsAre(3, 9));
  EXPECT_EQ(events[0].peak_particle, 9u);

  const auto tracks = particle_tracks(frames, {D});
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].particle, 3u);
  EXPECT_EQ(tracks[0].event.samples, 4u);
  EXPECT_THAT(tracks[0].event.members, ElementsAre(3));
  EXPECT_EQ(tracks[0].event.peak_force, 30);
  EXPECT_EQ(tracks[1].particle, 9u);
  EXPECT_EQ(tracks[1].event.samples, 3u);
  ASSERT_EQ(tracks[1].points.size(), 3u);
  EXPECT_EQ(tracks[1].points[1].frame, 3u);
  EXPECT_EQ(tracks[1].points[1].position, Vec3f(9, 3, 0));
  EXPECT_EQ(tracks[1].points[1].compressive_force, 50);
}

TEST(StreamsTest, AJamHandedFromOneGrainToTheNextIsOneGlobalEventAndTwoTracks) {
  const auto frames = record({{3, ".33..."},  //
                              {9, "...55."}});
  const auto events = global_events(frames, {D});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].samples, 4u);
  EXPECT_THAT(events[0].members, ElementsAre(3, 9));
  const auto tracks = particle_tracks(frames, {D});
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].event.last_frame, 2u);
  EXPECT_EQ(tracks[1].event.first_frame, 3u);
  EXPECT_FALSE(tracks[0].event.open_at_end);
}

TEST(StreamsTest, AGrainThatJamsTwiceInsideOneEventIsNamedOnce) {
  const auto frames = record({{3, ".3.3.."},  //
                              {9, ".4444."}});
  EXPECT_THAT(global_events(frames, {D}).at(0).members, ElementsAre(3, 9));
  const auto tracks = particle_tracks(frames, {D});
  ASSERT_EQ(tracks.size(), 3u);  // by first frame, then particle
  EXPECT_EQ(tracks[0].particle, 3u);
  EXPECT_EQ(tracks[1].particle, 9u);
  EXPECT_EQ(tracks[2].particle, 3u);
  EXPECT_EQ(tracks[2].event.first_frame, 3u);
}

TEST(StreamsTest, EqualPeaksGoToTheEarliestFrameAndThenTheSmallestId) {
  const auto event = global_events(record({{2, ".35."},  //
                                           {4, ".5.."},
                                           {6, ".55."}}),
                                   {D})
                         .at(0);
  EXPECT_EQ(event.peak_particle, 4u);
  EXPECT_NEAR(event.peak_time, 2e-3, rounding);
}

TEST(StreamsTest, AnEventAtTheEdgeOfTheRecordIsOpenThereAndItsBracketHasNoEnd) {
  const auto frames = record({{3, "33..3"}});
  const auto events = global_events(frames, {D});
  ASSERT_EQ(events.size(), 2u);
  EXPECT_TRUE(events[0].open_at_start);
  EXPECT_FALSE(events[0].open_at_end);
  EXPECT_FALSE(events[1].open_at_start);
  EXPECT_TRUE(events[1].open_at_end);
  for (const JamEvent& e : events) EXPECT_TRUE(std::isinf(e.longest));
  EXPECT_NEAR(events[0].survival_time, 4e-3, rounding);
  EXPECT_NEAR(events[0].shortest, 2e-3, rounding);
}

TEST(StreamsTest, MissingFramesCutAnEventAndOpenBothParts) {
  //  time/D   0  1  2  3  .  .  6  7
  auto frames = record({{3, ".3333."}});
  for (std::size_t k = 4; k < frames.size(); ++k) frames[k].time += 2 * D;
  EXPECT_NEAR(sampling_interval(frames), D, rounding);
  const auto events = global_events(frames, {D});
  const auto tracks = particle_tracks(frames, {D});
  ASSERT_EQ(events.size(), 2u);
  ASSERT_EQ(tracks.size(), 2u);
  for (const JamEvent* parts : {&events[0], &tracks[0].event}) {
    EXPECT_FALSE(parts->open_at_start);
    EXPECT_TRUE(parts->open_at_end);
    EXPECT_EQ(parts->samples, 3u);
  }
  for (const JamEvent* parts : {&events[1], &tracks[1].event}) {
    EXPECT_TRUE(parts->open_at_start);
    EXPECT_FALSE(parts->open_at_end);
    EXPECT_EQ(parts->samples, 1u);
  }
}

TEST(StreamsTest, UnevenSamplingUpToOneAndAHalfIntervalsCutsNothing) {
  auto frames = record({{3, ".3333.."}});
  for (std::size_t k = 4; k < frames.size(); ++k) frames[k].time += 0.49 * D;
  EXPECT_EQ(global_events(frames, {D}).size(), 1u);
}

TEST(StreamsTest, AnEventIsBridgedWhenOneOfItsFramesIs) {
  auto frames = record({{3, ".33...3."},  //
                        {9, ".33....."}});
  frames[2].jammed[0].bridged = true;
  const auto events = global_events(frames, {D});
  EXPECT_TRUE(events[0].bridged);
  EXPECT_FALSE(events[1].bridged);
  const auto tracks = particle_tracks(frames, {D});
  EXPECT_TRUE(tracks[0].event.bridged);   // particle 3 was part of the bridge,
  EXPECT_FALSE(tracks[1].event.bridged);  // particle 9 was not
}

TEST(StreamsTest, WhetherThePeakSatInTheGapIsThatOfThePeakParticleThen) {
  auto frames = record({{3, ".373."},  //
                        {9, ".666."}});
  frames[2].jammed[0].in_gap = true;
  EXPECT_TRUE(global_events(frames, {D}).at(0).peak_in_gap);
  frames[2].jammed[0].in_gap = false;
  frames[2].jammed[1].in_gap = true;
  EXPECT_FALSE(global_events(frames, {D}).at(0).peak_in_gap);
}

TEST(StreamsTest, NothingComesOfNothing) {
  EXPECT_THAT(global_events({}, {}), IsEmpty());
  EXPECT_THAT(particle_tracks({}, {}), IsEmpty());
  EXPECT_THAT(global_events(record({{3, "....."}}), {D}), IsEmpty());
  const auto one = record({{3, "3"}});
  EXPECT_EQ(sampling_interval(one), 0);
  ASSERT_EQ(global_events(one, {}).size(), 1u);
  EXPECT_TRUE(global_events(one, {})[0].open_at_start && global_events(one, {})[0].open_at_end);
}

TEST(StreamsTest, AgreeWithASearchThroughEachParticlesRowOnRandomRecords) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::pair<ParticleId, std::string>> rows;
    for (ParticleId p = 1; p <= 6; ++p) {
      std::string picture;
      for (int k = 0; k < 60; ++k) picture += random() % 3 == 0 ? static_cast<char>('3' + random() % 6) : '.';
      rows.emplace_back(p, picture);
    }
    // (first frame, particle, samples) of every maximal run.
    std::set<std::tuple<std::size_t, ParticleId, std::size_t>> expected, found;
    for (const auto& [p, picture] : rows) {
      for (std::size_t k = 0; k < picture.size(); ++k) {
        if (picture[k] == '.' || (k > 0 && picture[k - 1] != '.')) continue;
        expected.emplace(k, p, std::min(picture.find('.', k), picture.size()) - k);
      }
    }
    std::size_t previous_first = 0;
    for (const Track& track : particle_tracks(record(rows), {D})) {
      found.emplace(track.event.first_frame, track.particle, track.event.samples);
      EXPECT_EQ(track.points.size(), track.event.samples);
      EXPECT_GE(track.event.first_frame, previous_first);
      previous_first = track.event.first_frame;
    }
    EXPECT_EQ(found, expected);
  }
}

// Frames 2 ms apart; letters are above end_force and not jammed.
TEST(StreamsTest, AnEventLastsWhileItIsAboveItsEndForce) {
  const auto frames = record({{3, ".bb....."},       // never jammed: part of the event, no member, no track
                              {7, "..b3b3b."},      //
                              {9, "......b."}});
  const auto events = global_events(frames, {D});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].first_frame, 1u);
  EXPECT_EQ(events[0].last_frame, 6u);
  EXPECT_THAT(events[0].members, ElementsAre(7));
  EXPECT_EQ(events[0].peak_particle, 7u);
  const auto tracks = particle_tracks(frames, {D});
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].event.first_frame, 2u);
  EXPECT_EQ(tracks[0].event.samples, 5u);
  EXPECT_EQ(tracks[0].points.size(), 5u);
}

TEST(StreamsTest, PausesUpToTheHoldOffDoNotEndAnEvent) {
  const auto frames = record({{7, "3.3..3...3"}});
  const auto samples = [&](double hold_off) {
    std::vector<std::uint32_t> all;
    for (const JamEvent& event : global_events(frames, {D, hold_off})) all.push_back(event.samples);
    std::vector<std::uint32_t> of_tracks;
    for (const Track& track : particle_tracks(frames, {D, hold_off})) of_tracks.push_back(track.event.samples);
    EXPECT_EQ(all, of_tracks);
    return all;
  };
  EXPECT_THAT(samples(0.99 * D), ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(samples(1 * D), ElementsAre(3, 1, 1));
  EXPECT_THAT(samples(2 * D), ElementsAre(6, 1));
  EXPECT_THAT(samples(3 * D), ElementsAre(10));
}

TEST(StreamsTest, NoHoldOffReachesOverMissingFrames) {
  auto frames = record({{7, "3333"}});
  for (std::size_t k = 2; k < 4; ++k) frames[k].time += 4 * D;
  EXPECT_EQ(global_events(frames, {D, 100 * D}).size(), 2u);
}

TEST(StreamsTest, ShortEventsDoNotCount) {
  const auto frames = record({{3, "3..33.333"}});
  EXPECT_EQ(global_events(frames, {D, 0, 2 * D}).size(), 2u);
  EXPECT_EQ(particle_tracks(frames, {D, 0, 3 * D}).size(), 1u);
}

// The sampled rule and the rule of every step (every_step.hpp) are one: they agree where every step is a frame.
TEST(StreamsTest, TheRuleIsThatOfEveryStep) {
  std::mt19937 random(11);
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<std::pair<ParticleId, std::string>> rows;
    Excursions stays;
    const Detector detector{.start_force = 15, .end_force = 2, .hold_off = double(random() % 4) * D, .shortest = double(random() % 4) * D};
    for (ParticleId p = 1; p < 5; ++p) {
      std::string picture;
      for (int k = 0; k < 40; ++k) picture += ".....df2346"[random() % 11];
      rows.emplace_back(p, picture);
    }
    const auto frames = record(rows);
    struct Stay {
      std::uint64_t first, last;
      ParticleId particle;
      float peak;
    };
    std::vector<Stay> all;
    for (const auto& [p, picture] : rows)
      for (std::size_t k = 0; k < picture.size(); ++k) {
        if (picture[k] == '.') continue;
        Stay stay{k, k, p, 0};
        for (; k < picture.size() && picture[k] != '.'; ++k) {
          stay.last = k;
          stay.peak = std::max(stay.peak, picture[k] >= 'a' ? float(picture[k] - 'a') : 10.0f * float(picture[k] - '0'));
        }
        all.push_back(stay);
      }
    std::sort(all.begin(), all.end(), [](const Stay& a, const Stay& b) { return std::pair(a.first, a.particle) < std::pair(b.first, b.particle); });
    for (const Stay& stay : all) {
      stays.particle.push_back(stay.particle);
      stays.first_step.push_back(stay.first);
      stays.last_step.push_back(stay.last);
      stays.peak_step.push_back(stay.first);
      stays.peak_force.push_back(stay.peak);
      for (auto* column : {&stays.impulse, &stays.work, &stays.path, &stays.turned}) column->push_back(0);
      for (auto* column : {&stays.first_position, &stays.peak_position, &stays.last_position}) column->push_back(Vec3f::Zero());
      stays.open.push_back(0);
    }
    const SampledDetector sampled{D, detector.hold_off, detector.shortest};
    using Span = std::pair<long, long>;
    std::vector<Span> by_frames, by_steps;
    for (const JamEvent& e : global_events(frames, sampled)) by_frames.emplace_back(std::lround(e.start / D), std::lround(e.end / D));
    for (const StepJam& j : step_jams(stays, JamStream::global, detector, {}, {}, D, 1, 0))
      by_steps.emplace_back(std::lround(j.start / D), std::lround(j.end / D));
    EXPECT_EQ(by_frames, by_steps);
    std::vector<std::tuple<long, ParticleId, long>> tracks, step_tracks;
    for (const Track& t : particle_tracks(frames, sampled)) tracks.emplace_back(std::lround(t.event.start / D), t.particle, std::lround(t.event.end / D));
    for (const StepJam& j : step_jams(stays, JamStream::particle, detector, {}, {}, D, 1, 0))
      step_tracks.emplace_back(std::lround(j.start / D), j.members.at(0), std::lround(j.end / D));
    std::sort(step_tracks.begin(), step_tracks.end());
    EXPECT_EQ(tracks, step_tracks);
  }
}

TEST(SamplingIntervalTest, IsTheMedianDistance) {
  std::vector<JamFrame> frames(4);
  frames[1].time = 1;
  frames[2].time = 3;
  frames[3].time = 7;
  EXPECT_EQ(sampling_interval(frames), 2);
  frames.resize(3);
  EXPECT_EQ(sampling_interval(frames), 1.5);
}

// The sampling kernel. A jam of true duration d at a uniformly random phase of a sampling with interval D:
// P(n = k) = max(0, 1 - |d/D - k|), so E[n D] = d, misses included.
TEST(SamplingKernelTest, SurvivalTimesAreUnbiasedForJamsAtARandomPhase) {
  std::mt19937_64 random(20240229);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  for (const double d : {0.3, 1.0, 1.7, 4.25}) {  // in units of D
    const int trials = 20000;
    const std::size_t frame_count = 10;
    std::map<unsigned, int> counts;
    double sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const double begin = 2 + uniform();
      std::vector<JamFrame> frames(frame_count);
      for (std::size_t k = 0; k < frame_count; ++k) {
        frames[k].time = static_cast<double>(k);
        if (frames[k].time >= begin && frames[k].time < begin + d) {
          frames[k].jammed.push_back({.particle = 1, .compressive_force = 30});
        }
      }
      const auto events = global_events(frames, {1.0});
      ASSERT_LE(events.size(), 1u);
      const unsigned n = events.empty() ? 0 : events[0].samples;
      if (n > 0) {
        EXPECT_GT(d, events[0].shortest - 1e-12);
        EXPECT_LT(d, events[0].longest + 1e-12);
      }
      ++counts[n];
      sum += n;
    }
    // The variance of n is f (1 - f) <= 1/4 with f the fraction of d/D; five standard errors, so that one run in two
    // million would fail by chance (and this one, with its fixed seed, never does).
    const double fraction = d - std::floor(d);
    const double tolerance = 5 * std::sqrt(fraction * (1 - fraction) / trials) + 1e-12;
    EXPECT_NEAR(sum / trials, d, tolerance);
    for (const auto& [n, count] : counts) {
      const double probability = std::max(0.0, 1 - std::abs(d - n));
      EXPECT_NEAR(count / static_cast<double>(trials), probability, tolerance) << "d/D = " << d << ", n = " << n;
    }
  }
}

// Exponential durations with mean tau (reference table, D = 2 ms): share missed 1 - (tau/D)(1 - exp(-D/tau)) and mean n
// D of those detected, tau / (1 - missed).
TEST(SamplingKernelTest, MissesTheKnownShareOfExponentialJams) {
  struct Row {
    double tau, missed, mean_detected;  // s, 1, s
  };
  std::mt19937_64 random(7);
  for (const Row& row : {Row{1e-3, 0.568, 2.31e-3}, Row{2e-3, 0.368, 3.16e-3}, Row{5e-3, 0.176, 6.05e-3},
                         Row{10e-3, 0.093, 11.05e-3}, Row{20e-3, 0.048, 21.0e-3}}) {
    const int trials = 20000;
    int missed = 0;
    double sum = 0, sum_of_squares = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const double u = static_cast<double>((random() >> 11) + 1) * 0x1.0p-53;  // (0, 1]
      const double d = -row.tau * std::log(u);
      const double begin = D * (1 + static_cast<double>(random() >> 11) * 0x1.0p-53);
      const auto frame_count = static_cast<std::size_t>((begin + d) / D) + 3;
      std::vector<JamFrame> frames(frame_count);
      for (std::size_t k = 0; k < frame_count; ++k) {
        frames[k].time = static_cast<double>(k) * D;
        if (frames[k].time >= begin && frames[k].time < begin + d) {
          frames[k].jammed.push_back({.particle = 1, .compressive_force = 30});
        }
      }
      const auto events = global_events(frames, {D});
      missed += events.empty();
      for (const JamEvent& e : events) {
        sum += e.survival_time;
        sum_of_squares += e.survival_time * e.survival_time;
      }
    }
    const double share = static_cast<double>(missed) / trials, detected = trials - missed, mean = sum / detected;
    // Four standard errors, and half a unit of the table's last digit.
    EXPECT_NEAR(share, row.missed, 4 * std::sqrt(row.missed * (1 - row.missed) / trials) + 5e-4);
    EXPECT_NEAR(mean, row.mean_detected, 4 * std::sqrt((sum_of_squares / detected - mean * mean) / detected) + 5e-5);
  }
}

}  // namespace
}  // namespace jam
