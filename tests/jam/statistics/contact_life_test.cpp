#include "libjam/statistics/contact_life.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace jam {
namespace {

Series with_ended(const Series::EndedContacts& ended) {
  Series series;
  series.ended_pp = {ended, ended};  // two windows
  series.ended_pw = {{}, {}};
  return series;
}

TEST(ContactLife, IsTheShareThatOutlastsWhereAllEnded) {
  const auto life = contact_life(with_ended({4, 0, 3, 1}), {}, {}, 0.5e-6);
  ASSERT_EQ(life.size(), 4u);
  const double together[] = {1, 0.5, 0.5, 0.125};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(life[k].from, 0.5e-6 * std::exp2(k));
    EXPECT_EQ(life[k].to, 1e-6 * std::exp2(k));
    EXPECT_DOUBLE_EQ(life[k].particles.together, together[k]);
    EXPECT_TRUE(std::isnan(life[k].walls.together));
  }
  EXPECT_EQ(life[2].particles.ended, 6u);
  // From a half at 2 us to an eighth at 4 us: half are gone at 2 us.
  EXPECT_DOUBLE_EQ(median_life(life, &ContactLife::particles), 2e-6);
  EXPECT_TRUE(std::isnan(median_life(life, &ContactLife::walls)));
}

// Cutler and Ederer by hand: 20 in all; octave 0: 4 end, 4 alive, exposed 20 - 2; octave 1: 6 end, 2 alive, exposed 12 - 1; then 4.
TEST(ContactLife, ExposesThoseStillTogetherForHalfTheirOctave) {
  Series::EndedContacts alive{};
  alive[0] = 4, alive[1] = 2, alive[2] = 4;
  const auto life = contact_life(with_ended({2, 3}), alive, {}, 1e-6);
  ASSERT_EQ(life.size(), 3u);
  EXPECT_DOUBLE_EQ(life[1].particles.together, 1 - 4.0 / 18);
  EXPECT_DOUBLE_EQ(life[2].particles.together, (1 - 4.0 / 18) * (1 - 6.0 / 11));
  EXPECT_EQ(life[2].particles.alive, 4u);
}

TEST(ContactLife, LeavesOutContactsOfUnknownAgeAndSourcesThatDoNotCount) {
  Series::EndedContacts ended{};
  ended[31] = 7;
  EXPECT_TRUE(contact_life(with_ended(ended), {}, {}, 1e-6).empty());
  EXPECT_TRUE(contact_life(Series{}, {}, {}, 1e-6).empty());
  EXPECT_TRUE(contact_life(with_ended({1}), {}, {}, 0).empty());
}

// Evaluated for the first time in step 8: once by step 8, twice by 9, four times by 11.
TEST(ContactLife, CountsAgesInStepsThatWereEvaluated) {
  const auto count = ages({8, 9, 11, 0, 1}, 11);
  Series::EndedContacts expected{};
  expected[2] = 1, expected[1] = 1, expected[0] = 1, expected[3] = 1, expected[31] = 1;
  EXPECT_EQ(count, expected);
}

}  // namespace
}  // namespace jam
