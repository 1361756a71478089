#include "libjam/statistics/run_groups.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>

namespace jam {
namespace {

using Runs = std::vector<std::vector<double>>;

TEST(RunGroups, AreJudgedByAllWaysToDealTheRunsOut) {
  // Of the 70 ways to deal out eight runs, this one and its mirror image are the farthest apart.
  const std::vector<RunShare> low{{1}, {2}, {3}, {4}}, high{{5}, {6}, {7}, {8}};
  const GroupTest test = same_share(low, high);
  EXPECT_DOUBLE_EQ(test.difference, 4);
  EXPECT_DOUBLE_EQ(test.p, 2.0 / 70);
  EXPECT_DOUBLE_EQ(same_share(high, low).p, 2.0 / 70);
  // 1 + 8 against 2 + 3 (of 1, 2, 3, 8), as far as their mirror images and less far than 1 + 2 or 1 + 3 against the others: all six
  // ways are at least as far.
  EXPECT_DOUBLE_EQ(same_share(std::vector<RunShare>{{1}, {8}}, std::vector<RunShare>{{2}, {3}}).p, 1);
  EXPECT_DOUBLE_EQ(same_share(std::vector<RunShare>{{1}, {2}}, std::vector<RunShare>{{3}, {8}}).p, 2.0 / 6);
}

TEST(RunGroups, WeighRunsByTheirRecords) {
  // 6 jams in 3 s, 2 a second, against 4 a second. Dealt out otherwise: 3 against 2, or 8/3 against 2.
  const std::vector<RunShare> a{{2, 1}, {4, 2}}, b{{4, 1}};
  EXPECT_DOUBLE_EQ(same_share(a, b).difference, 2);
  EXPECT_DOUBLE_EQ(same_share(a, b).p, 1.0 / 3);
}

// Straight from the definition.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (const std::vector<double>* values : {&a, &b})
    for (const double x : *values) {
      const auto share = [&](const std::vector<double>& of) {
        double n = 0;
        for (const double value : of) n += value <= x;
        return n / double(of.size());
      };
      largest = std::max(largest, std::abs(share(a) - share(b)));
    }
  return largest;
}

TEST(RunGroups, DistributionsAreAsFarApartAsKolmogorovAndSmirnovSay) {
  std::mt19937_64 random(7);
  const auto value = [&] { return double(random() % 50); };  // some are equal
  Runs runs(5);
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::size_t k = 0; k < 7 + 5 * r; ++k) runs[r].push_back(value());
  const auto pooled = [&](unsigned members) {
    std::vector<double> values;
    for (std::size_t r = 0; r < runs.size(); ++r)
      if (members >> r & 1) values.insert(values.end(), runs[r].begin(), runs[r].end());
    return values;
  };
  const GroupTest test = same_distribution(std::span(runs).first(2), std::span(runs).last(3));
  const double seen = distance(pooled(0b00011), pooled(0b11100));
  EXPECT_NEAR(test.difference, seen, 1e-15);
  int as_far = 0, all = 0;
  for (unsigned members = 0; members < 32; ++members) {
    if (std::popcount(members) != 2) continue;
    ++all;
    as_far += distance(pooled(members), pooled(31U ^ members)) >= seen - 1e-12;
  }
  EXPECT_DOUBLE_EQ(test.p, double(as_far) / all);
}

// Runs whose values, all alike but for the run's own factor, say little more than one value a run: with jams that follow from each other, a
// test of values as if they were independent would find a difference in most pairs of groups.
TEST(RunGroups, OfTheSameKindDifferInOneOfTwentyComparisons) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> scatter(0, 0.3);
  int shares = 0, distributions = 0;
  constexpr int comparisons = 300;
  for (int c = 0; c < comparisons; ++c) {
    Runs runs(10);
    std::vector<RunShare> sums;
    for (std::vector<double>& run : runs) {
      const double own = std::exp(scatter(random));
      for (int k = 0; k < 30; ++k) run.push_back(own * std::exp(0.1 * scatter(random)));
      sums.push_back({own});
    }
    shares += same_share(std::span(sums).first(5), std::span(sums).last(5)).p < 0.05;
    distributions += same_distribution(std::span(runs).first(5), std::span(runs).last(5)).p < 0.05;
  }
  // 12 of the 252 ways: 4.8 %, 14 of 300; three standard deviations of the counts are 11.
  EXPECT_NEAR(shares, 14, 11);
  EXPECT_NEAR(distributions, 14, 11);
}

TEST(RunGroups, SayWhatTheyWouldHaveSeen) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> scatter(0, 0.2);
  const auto draw = [&](double factor) -> std::vector<RunShare> {
    std::vector<RunShare> runs;
    for (int r = 0; r < 6; ++r) runs.push_back({factor * std::exp(scatter(random))});
    return runs;
  };
  double factor = 0;
  for (int k = 0; k < 10; ++k) factor += seen_factor(draw(1), draw(1)) / 10;
  // Of normal values, by t with 10 degrees of freedom: (2.23 + 0.88) sqrt(2/6) standard deviations, a factor of 1.43; the runs' own
  // scatter, of twelve, is known to a fifth of it, and less of it is in draws with replacement.
  EXPECT_NEAR(factor, 1.43, 0.1);
  int seen = 0;
  for (int k = 0; k < 200; ++k) seen += same_share(draw(1), draw(factor)).p < 0.05;
  EXPECT_NEAR(seen / 200.0, 0.8, 0.12);
}

// Differences 1, 2 and -4 of three pairs: of the eight ways to swap, as far as -1 are all but none: +-7, +-5, +-3, +-1.
TEST(RunGroups, InPairsAreJudgedByAllWaysToSwap) {
  const std::vector<RunShare> a{{10}, {100}, {1000}}, b{{11}, {102}, {996}}, c{{11}, {102}, {1004}};
  EXPECT_NEAR(same_share(a, b, Dealt::within_pairs).difference, -1.0 / 3, 1e-12);
  EXPECT_DOUBLE_EQ(same_share(a, b, Dealt::within_pairs).p, 1);
  EXPECT_DOUBLE_EQ(same_share(a, c, Dealt::within_pairs).p, 2.0 / 8);
  const Runs low{{1, 2}, {11, 12}, {21, 22}}, high{{3, 4}, {13, 14}, {23, 24}};
  EXPECT_DOUBLE_EQ(same_distribution(low, high, Dealt::within_pairs).difference, 1.0 / 3);
  EXPECT_DOUBLE_EQ(same_distribution(low, high, Dealt::within_pairs).p, 1) << "wherever the pairs do not overlap the distance is the same";
}

// Beds differ by a factor of two, the two runs of a bed by a tenth: pairs see a factor that groups do not. More than 64 pairs are dealt out
// at random like fewer.
TEST(RunGroups, InPairsLeaveOutWhatBedsDifferBy) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> scatter;
  const auto draw = [&](std::size_t pairs, double factor) {
    std::array<std::vector<RunShare>, 2> groups;
    for (std::size_t k = 0; k < pairs; ++k) {
      const double bed = std::exp(0.7 * scatter(random));
      groups[0].push_back({bed * std::exp(0.07 * scatter(random))});
      groups[1].push_back({factor * bed * std::exp(0.07 * scatter(random))});
    }
    return groups;
  };
  const auto [a, b] = draw(20, 1.2);
  EXPECT_LT(same_share(a, b, Dealt::within_pairs).p, 0.01);
  EXPECT_GT(same_share(a, b).p, 0.05);
  EXPECT_LT(seen_factor(a, b, Dealt::within_pairs), 1.2);
  EXPECT_GT(seen_factor(a, b), 1.5);
  int differ = 0;
  constexpr int comparisons = 300;
  for (int k = 0; k < comparisons; ++k) {
    const auto [first, second] = draw(k % 2 == 0 ? 10 : 70, 1);
    differ += same_share(first, second, Dealt::within_pairs).p < 0.05;
  }
  EXPECT_NEAR(differ, 15, 12);  // three standard deviations
}

TEST(RunGroups, TooFewToTell) {
  const std::vector<RunShare> few{{1}, {2}, {3}}, others{{10}, {20}, {30}};
  EXPECT_DOUBLE_EQ(same_share(few, others).p, 0.1);
  EXPECT_TRUE(std::isnan(seen_factor(few, others)));
  EXPECT_EQ(same_distribution(Runs{{}, {}}, Runs{{1}, {2}}).p, 1);
  EXPECT_TRUE(std::isnan(same_distribution(Runs{{}, {}}, Runs{{1}, {2}}).difference));
  EXPECT_EQ(same_share({}, std::vector<RunShare>{{1}}).p, 1);
  // Nothing anywhere: no difference.
  EXPECT_EQ(same_share(std::vector<RunShare>(4, {0}), std::vector<RunShare>(4, {0})).p, 1);
}

TEST(RunGroups, OfManyRunsAreDealtOutAtRandom) {
  std::vector<RunShare> a, b;
  for (int r = 0; r < 12; ++r) {
    a.push_back({double(r)});
    b.push_back({double(r) + 20});
  }
  const GroupTest test = same_share(a, b);  // 2 of 2.7 million ways; as they are counts
  EXPECT_DOUBLE_EQ(test.p, 1e-4);
  EXPECT_EQ(same_share(a, a).p, 1);
}

}  // namespace
}  // namespace jam
