#include "libjam/statistics/rates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "libjam/statistics/sampled_durations.hpp"
#include "tests/jam/statistics/reference_table.hpp"

namespace jam {
namespace {

struct Draws {
  std::mt19937_64 random;
  explicit Draws(std::uint64_t seed) : random(seed) {}
  double uniform() { return (double(random() >> 11) + 0.5) * 0x1p-53; }
  double exponential(double mean) { return -mean * std::log(uniform()); }
};

TEST(PoissonRate, IsRsPoissonTest) {
  for (const reference::Row& r : reference::table("rates.csv")) {
    const Rate rate = poisson_rate(std::uint64_t(r.number("events")), r.number("time"));
    EXPECT_NEAR(rate.low, r.number("low"), 1e-10 * r.number("low"));
    EXPECT_NEAR(rate.high, r.number("high"), 1e-10 * r.number("high"));
    EXPECT_EQ(rate.value, r.number("events") / r.number("time"));
  }
  EXPECT_TRUE(std::isnan(poisson_rate(3, 0).value));
}

TEST(SameRateProbability, IsRsPoissonTestOfTwo) {
  for (const reference::Row& r : reference::table("two_rates.csv"))
    EXPECT_NEAR(same_rate_probability(std::uint64_t(r.number("events_a")), r.number("time_a"), std::uint64_t(r.number("events_b")), r.number("time_b")),
                r.number("p"), 1e-9);
}

// Variance over mean by hand: counts 2, 0, 1, 1: mean 1, variance 2/3.
TEST(FanoFactor, IsVarianceOverMeanOfTheCounts) {
  EXPECT_NEAR(fano_factor(std::vector<double>{0.1, 0.2, 2.5, 3.9}, 0, 4, 4), 2.0 / 3, 1e-15);
  EXPECT_TRUE(std::isnan(fano_factor({}, 0, 4, 4)));
}

// Brute force: 400,000 events drawn one by one, merged where they overlap, for durations that are all alike, exponential, and of two kinds: only the mean
// matters. Means of some 1e5 busy periods have errors of 0.3 to 0.6 %; five of them are allowed.
TEST(Overlapping, IsWhatDrawingAndMergingEventsGives) {
  for (const double at_a_time : {0.3, 1.0, 2.0})
    for (const int kind : {0, 1, 2}) {
      Draws draw(std::uint64_t(10 * at_a_time) + std::uint64_t(kind));
      const double rate = 120, mean = at_a_time / rate;
      double start = 0, begin = 0, end = 0, busy = 0;
      std::size_t periods = 0;
      constexpr int events = 400'000;
      for (int k = 0; k < events; ++k) {
        start += draw.exponential(1 / rate);
        if (start > end) {
          busy += end - begin;
          ++periods;
          begin = end = start;
        }
        const double duration = kind == 0 ? mean : kind == 1 ? draw.exponential(mean) : draw.uniform() < 0.5 ? 0.2 * mean : 1.8 * mean;
        end = std::max(end, start + duration);
      }
      const Overlapping any = overlapping(rate, mean);
      EXPECT_NEAR(any.share, busy / start, 0.01 * any.share) << at_a_time << ' ' << kind;
      EXPECT_NEAR(any.rate, double(periods) / start, 0.02 * any.rate) << at_a_time << ' ' << kind;
      EXPECT_NEAR(any.mean_duration, busy / double(periods), 0.03 * any.mean_duration) << at_a_time << ' ' << kind;
      EXPECT_NEAR(any.share, any.rate * any.mean_duration, 1e-14);
    }
}

TEST(Overlapping, OfNoneAndOfRareEvents) {
  EXPECT_EQ(overlapping(0, 1).share, 0);
  EXPECT_EQ(overlapping(0, 1).rate, 0);
  EXPECT_TRUE(std::isnan(overlapping(0, 1).mean_duration));
  EXPECT_NEAR(overlapping(1e-12, 1).mean_duration, 1, 1e-11);  // no cancellation where they hardly ever overlap
}

// Independent starts: p is uniform, so below 0.05 in about 5 of 100 records (1 to 11 in all but 1 in a hundred such tests); starts in bursts,
// or regular ones, are told from them.
TEST(ExponentialDistances, TellBurstsAndClocksFromIndependentStarts) {
  Draws draw(8);
  int refused = 0;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> start{0};
    for (int k = 0; k < 50; ++k) start.push_back(start.back() + draw.exponential(0.03));
    refused += exponential_distances(start).p < 0.05;
  }
  EXPECT_GE(refused, 1);
  EXPECT_LE(refused, 11);
  std::vector<double> bursts{0}, clock{0};
  for (int k = 0; k < 50; ++k) {
    bursts.push_back(bursts.back() + draw.exponential(k % 5 == 0 ? 0.2 : 0.005));
    clock.push_back(clock.back() + 0.03 + draw.exponential(0.003));
  }
  EXPECT_LT(exponential_distances(bursts).p, 0.01);
  EXPECT_LT(exponential_distances(clock).p, 0.01);
  EXPECT_GT(fano_factor(bursts, 0, bursts.back(), 20), 1.5);
  EXPECT_LT(fano_factor(clock, 0, clock.back(), 20), 0.5);
}

TEST(BootstrapMean, HoldsTheTruthAlmostAsOftenAsItSays) {
  Draws draw(2);
  int held = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> blocks;
    for (int k = 0; k < 20; ++k) blocks.push_back(draw.exponential(3));
    const BlockMean mean = bootstrap_mean(blocks);
    held += mean.low <= 3 && 3 <= mean.high;
  }
  // Percentiles of 20 skewed blocks hold it in about 91 of 100.
  EXPECT_GT(held, 168);
  EXPECT_LT(held, 197);
}

// The table of network.md, section 3: D = 2 ms, exponential durations of each mean; unseen share and the mean of n D of those seen.
TEST(SampledDurations, MissShortEventsAsTheKernelSays) {
  Draws draw(4);
  const double interval = 2e-3;
  struct Expected {
    double mean, unseen, mean_of_seen;
  };
  for (const Expected& e : {Expected{1e-3, 0.568, 2.31e-3}, {2e-3, 0.368, 3.16e-3}, {5e-3, 0.176, 6.05e-3}, {10e-3, 0.093, 11.05e-3}, {20e-3, 0.048, 21.0e-3}}) {
    int unseen = 0;
    double sum = 0, true_sum = 0, kernel_unseen = 0;
    constexpr int events = 400000;
    for (int k = 0; k < events; ++k) {
      const double duration = draw.exponential(e.mean), phase = interval * draw.uniform();
      const int n = int(std::floor((phase + duration) / interval));
      unseen += n == 0;
      sum += n * interval;
      true_sum += duration;
      kernel_unseen += seen_with_samples(0, duration, interval);
    }
    EXPECT_NEAR(unseen / double(events), e.unseen, 2e-3);
    EXPECT_NEAR(kernel_unseen / events, e.unseen, 2e-3);
    EXPECT_NEAR(sum / (events - unseen), e.mean_of_seen, 0.01 * e.mean_of_seen);
    EXPECT_NEAR(sum, true_sum, 0.01 * true_sum);  // unseen ones included
  }
  for (const double duration : {0.3e-3, 2e-3, 7.1e-3}) {
    double total = 0, mean = 0;
    for (std::uint64_t n = 0; n < 6; ++n) total += seen_with_samples(n, duration, interval), mean += double(n) * seen_with_samples(n, duration, interval);
    EXPECT_NEAR(total, 1, 1e-12);
    EXPECT_NEAR(mean * interval, duration, 1e-15);
  }
}

// 300 records of 4 s, true rate 30/s, durations of 0.5 to 20 ms, sampled at 500 Hz: mean duration and rate lie within their 95 % intervals in at
// least 93 of 100 (the rate's is wider on purpose), while the naive rate misses the truth nearly always where events are short.
TEST(SampledDurations, CorrectedRatesAndMeansHoldTheTruth) {
  Draws draw(5);
  const double interval = 2e-3, observed = 4, rate = 30;
  for (const double mean : {0.5e-3, 2e-3, 20e-3}) {
    int mean_held = 0, rate_held = 0, naive_held = 0;
    constexpr int records = 300;
    for (int record = 0; record < records; ++record) {
      std::vector<std::uint32_t> samples;
      for (double t = draw.exponential(1 / rate); t < observed; t += draw.exponential(1 / rate)) {
        const double duration = draw.exponential(mean);
        const double first = std::ceil(t / interval) * interval;
        if (first < t + duration) samples.push_back(1 + std::uint32_t((t + duration - first) / interval));
      }
      const ExponentialDurations found = exponential_durations(samples, interval, observed);
      mean_held += found.low <= mean && mean <= found.high;
      rate_held += found.rate.low <= rate && rate <= found.rate.high;
      const Rate naive = poisson_rate(samples.size(), observed);
      naive_held += naive.low <= rate && rate <= naive.high;
    }
    EXPECT_GE(mean_held, 0.93 * records) << mean;
    EXPECT_GE(rate_held, 0.93 * records) << mean;
    if (mean < 1e-3) {
      EXPECT_LT(naive_held, 0.02 * records);
    }
  }
  EXPECT_TRUE(std::isnan(exponential_durations({}, interval, observed).mean));
}

}  // namespace
}  // namespace jam
