#include "libjam/statistics/lifetimes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/jam/statistics/reference_table.hpp"

namespace jam {
namespace {

std::vector<std::vector<Lifetime>> groups_of(const std::string& name) {
  std::map<std::string, std::vector<Lifetime>> groups;
  for (const reference::Row& r : reference::table("lifetimes.csv"))
    if (r.text("case") == name) groups[r.text("group")].push_back({r.number("time"), r.number("ended") != 0, r.number("entry")});
  std::vector<std::vector<Lifetime>> all;
  for (auto& [group, lifetimes] : groups) all.push_back(std::move(lifetimes));
  return all;
}

TEST(KaplanMeier, IsThatOfRsSurvivalPackage) {
  for (const std::string name : {"whole", "censored", "ties", "truncated"}) {
    const SurvivalCurve curve = kaplan_meier(groups_of(name).at(0));
    std::size_t k = 0;
    for (const reference::Row& r : reference::table("kaplan_meier.csv")) {
      if (r.text("case") != name) continue;
      ASSERT_LT(k, curve.time.size());
      EXPECT_NEAR(curve.time[k], r.number("time"), 1e-12 * r.number("time"));
      EXPECT_EQ(double(curve.at_risk[k]), r.number("at_risk")) << name << k;
      EXPECT_EQ(double(curve.ended[k]), r.number("ended"));
      EXPECT_NEAR(curve.share[k], r.number("share"), 1e-12);
      EXPECT_EQ(std::isnan(curve.low[k]), std::isnan(r.number("low")));
      if (!std::isnan(curve.low[k])) {
        EXPECT_NEAR(curve.low[k], r.number("low"), 1e-9);
        EXPECT_NEAR(curve.high[k], r.number("high"), 1e-9);
      }
      ++k;
    }
    EXPECT_EQ(k, curve.time.size());
    for (const reference::Row& r : reference::table("medians.csv")) {
      if (r.text("case") != name) continue;
      const Quantile median = when_left(curve);
      // R averages two times where the share is exactly one half between them.
      if (std::none_of(curve.share.begin(), curve.share.end(), [](double share) { return std::abs(share - 0.5) < 1e-9; })) {
        EXPECT_NEAR(median.value, r.number("value"), 1e-12);
      }
      EXPECT_NEAR(median.low, r.number("low"), 1e-12);
      EXPECT_NEAR(median.high, r.number("high"), 1e-12);
    }
  }
}

TEST(KaplanMeier, IsTheShareThatOutlastsWhereNothingIsCutOff) {
  const SurvivalCurve curve = kaplan_meier(std::vector<Lifetime>{{1}, {2}, {2}, {4}});
  EXPECT_EQ(curve.time, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(curve.share, (std::vector<double>{0.75, 0.25, 0}));
  EXPECT_TRUE(kaplan_meier({}).time.empty());
  EXPECT_TRUE(std::isinf(when_left(kaplan_meier({})).value));
}

// The band holds the true share in 95 of 100 cases: 1000 records of 60 exponential lifetimes, half of them cut off. Binomial, so between
// 92.9 % and 97.1 % in all but 3 in a thousand such tests.
TEST(KaplanMeier, BandHoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 random(3);
  const auto exponential = [&](double mean) { return -mean * std::log((double(random() >> 11) + 0.5) * 0x1p-53); };
  int held = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Lifetime> lifetimes;
    for (int k = 0; k < 60; ++k) {
      const double life = exponential(1), cut = exponential(1);
      lifetimes.push_back({std::min(life, cut), life <= cut});
    }
    const SurvivalCurve curve = kaplan_meier(lifetimes);
    const auto after = std::upper_bound(curve.time.begin(), curve.time.end(), 0.5) - curve.time.begin();
    ASSERT_GT(after, 0);
    const double truth = std::exp(-0.5);
    held += curve.low[std::size_t(after) - 1] <= truth && truth <= curve.high[std::size_t(after) - 1];
  }
  EXPECT_GT(held, 929);
  EXPECT_LT(held, 971);
}

TEST(LogRank, IsThatOfRsSurvivalPackage) {
  for (const reference::Row& r : reference::table("log_rank.csv")) {
    const TestResult test = log_rank(groups_of(r.text("case")));
    EXPECT_NEAR(test.statistic, r.number("statistic"), 1e-9 * r.number("statistic"));
    EXPECT_EQ(double(test.degrees), r.number("degrees"));
    EXPECT_NEAR(test.p, r.number("p"), 1e-9);
  }
  EXPECT_EQ(log_rank(std::vector<std::vector<Lifetime>>{{{1}, {2}}}).p, 1);
}

std::vector<LifetimeBracket> brackets_of(double number) {
  std::vector<LifetimeBracket> brackets;
  for (const reference::Row& r : reference::table("brackets.csv"))
    if (r.number("case") == number) brackets.push_back({r.number("low"), r.number("high")});
  return brackets;
}

bool holds(const LifetimeBracket& b, double low, double high) {
  return b.low == b.high ? low == b.low && high == b.low : low >= b.low && high <= b.high && !(low == high && low == b.low);
}

// R stops its iteration at about 1e-4.
TEST(Turnbull, IsThatOfRsSurvivalPackage) {
  for (const double number : {1.0, 2.0, 3.0}) {
    const TurnbullEstimate estimate = turnbull(brackets_of(number));
    const auto rows = reference::table("turnbull.csv");
    for (std::size_t k = 0; k < estimate.high.size(); ++k) {
      if (std::isinf(estimate.high[k])) continue;
      double share = 1;
      for (const reference::Row& r : rows)
        if (r.number("case") == number && r.number("time") <= estimate.high[k]) share = r.number("share");
      EXPECT_NEAR(estimate.share_after(estimate.high[k]), share, 2e-3) << number << " at " << estimate.high[k];
    }
  }
}

// What makes it the largest likelihood: no mass could gain by moving. For each possible interval the mean over the brackets that hold it of
// one over their mass is at most 1, and 1 where there is mass (Gentleman and Geyer, Biometrika 81, 618, 1994).
TEST(Turnbull, HasTheLargestLikelihood) {
  for (const double number : {1.0, 2.0, 3.0}) {
    const std::vector<LifetimeBracket> brackets = brackets_of(number);
    const TurnbullEstimate e = turnbull(brackets);
    std::vector<double> mass_of;
    double total = 0;
    for (const double m : e.mass) total += m;
    EXPECT_NEAR(total, 1, 1e-6);
    for (const LifetimeBracket& b : brackets) {
      mass_of.push_back(0);
      for (std::size_t k = 0; k < e.mass.size(); ++k)
        if (holds(b, e.low[k], e.high[k])) mass_of.back() += e.mass[k];
    }
    const auto gain = [&](double low, double high) {
      double sum = 0;
      for (std::size_t b = 0; b < brackets.size(); ++b)
        if (holds(brackets[b], low, high)) sum += 1 / mass_of[b];
      return sum / double(brackets.size());
    };
    for (std::size_t k = 0; k < e.mass.size(); ++k) EXPECT_NEAR(gain(e.low[k], e.high[k]), 1, e.mass[k] > 1e-4 ? 1e-4 : 0.1);
    // Anywhere between two neighbouring bounds, and at each exact lifetime.
    std::vector<double> bounds;
    for (const LifetimeBracket& b : brackets) bounds.insert(bounds.end(), {b.low, b.high});
    std::sort(bounds.begin(), bounds.end());
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
      EXPECT_LE(gain(bounds[k], bounds[k + 1]), 1 + 1e-3);
      EXPECT_LE(gain(bounds[k], bounds[k]), 1 + 1e-3);
    }
  }
}

}  // namespace
}  // namespace jam
