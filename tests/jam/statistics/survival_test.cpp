#include "libjam/statistics/survival.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libjam/events/streams.hpp"
#include "libjam/statistics/jam_counts.hpp"
#include "tests/jam/events/hand_made_record.hpp"

namespace jam {
namespace {

std::vector<JamEvent> lasting(const std::vector<double>& survival_times) {
  std::vector<JamEvent> events;
  for (const double t : survival_times) events.emplace_back().survival_time = t;
  return events;
}

const std::vector<double> paper_classes{0.01, 0.02, 0.03, 0.04, 0.05};

TEST(SurvivalClassesTest, CountEventsButShareJamTime) {
  // 2 + 4 + 6 + 18 + 70 = 100 ms
  const auto classes = survival_classes(lasting({2e-3, 4e-3, 6e-3, 18e-3, 70e-3}), paper_classes, 2e-3, 2.0);
  ASSERT_EQ(classes.size(), 6u);
  const std::vector<std::uint32_t> events{3, 1, 0, 0, 0, 1};
  const std::vector<double> share{0.12, 0.18, 0, 0, 0, 0.70};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(classes[k].events, events[k]);
    EXPECT_DOUBLE_EQ(classes[k].frequency, events[k] / 2.0);
    EXPECT_NEAR(classes[k].share_of_jam_time, share[k], 1e-15);  // rounding of sums of five numbers below one
    EXPECT_DOUBLE_EQ(classes[k].low, 0.01 * static_cast<double>(k));
  }
  EXPECT_TRUE(std::isinf(classes[5].high));
}

TEST(SurvivalClassesTest, ATimeOnABoundBelongsToTheClassAboveWhateverTheRoundingOfTheFrameTimes) {
  // Five samples at 2 ms are 10 ms; frame times that are multiples of 2e-3 give a median distance a few ulp off it.
  for (const double interval : {2e-3, std::nextafter(2e-3, 0.0), 0.002 * (1 - 1e-10), 0.002 * (1 + 1e-10)}) {
    const auto classes = survival_classes(lasting({5 * interval}), paper_classes, interval, 1.0);
    EXPECT_EQ(classes[0].events, 0u);
    EXPECT_EQ(classes[1].events, 1u);
  }
  EXPECT_EQ(survival_classes(lasting({4 * 2e-3}), paper_classes, 2e-3, 1.0)[0].events, 1u);
}

TEST(SurvivalClassesTest, HaveZeroSharesAndFrequenciesWithoutEventsOrTime) {
  for (const SurvivalClass& c : survival_classes({}, paper_classes, 0, 0)) {
    EXPECT_EQ(c.events, 0u);
    EXPECT_EQ(c.frequency, 0);
    EXPECT_EQ(c.share_of_jam_time, 0);
  }
  const auto one = survival_classes(lasting({5e-3}), {}, 2e-3, 1.0);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].share_of_jam_time, 1);
}

TEST(JamCountsTest, HistogramCountsFramesByJammedParticles) {
  const auto frames = hand_made::record({{1, "..33.3"},  //
                                         {2, "...3.."},
                                         {3, "...3.."}});
  EXPECT_EQ(jammed_histogram(frames), (std::vector<std::uint32_t>{3, 2, 0, 1}));
  EXPECT_TRUE(jammed_histogram({}).empty());
}

TEST(JamCountsTest, ShareInTheGapIsOverParticlesAndFrames) {
  auto frames = hand_made::record({{1, ".333."},  //
                                   {2, "..3.."}});
  frames[1].jammed[0].in_gap = true;
  EXPECT_EQ(jammed_in_gap_share(frames), 0.25);
  EXPECT_TRUE(std::isnan(jammed_in_gap_share(hand_made::record({{1, "..."}}))));
}

}  // namespace
}  // namespace jam
