#include "libjam/events/peaks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace jam {
namespace {

using ::testing::ElementsAre;

TEST(Peaks, OfASmallSeriesByHand) {
  //                       0  1  2  3  4  5  6
  const auto found = peaks(std::vector<double>{1, 5, 2, 9, 4, 6, 0});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].at, 3u);
  EXPECT_EQ(found[0].prominence(), 9);  // to the lowest value
  EXPECT_EQ(found[1].at, 5u);
  EXPECT_EQ(found[1].prominence(), 2);
  EXPECT_EQ(found[2].at, 1u);
  EXPECT_EQ(found[2].prominence(), 3);
  EXPECT_THAT(counts_above(found, std::vector<double>{0.5, 2, 4.5, 5, 9, 0}), ElementsAre(1, 2, 3, 2, 0, 1));
  EXPECT_TRUE(peaks({}).empty());
  const auto flat = peaks(std::vector<double>{3, 3, 3});
  ASSERT_EQ(flat.size(), 1u);
  EXPECT_EQ(flat[0].prominence(), 0);
}

// Counts of stretches above every value, and just below it, written out; and each prominence by its definition: how far one must go down from the peak
// on the way to something higher, or to the lowest value of all.
TEST(Peaks, CountStretchesAboveEveryThreshold) {
  std::mt19937_64 random(17);
  for (int scene = 0; scene < 300; ++scene) {
    std::vector<double> series(1 + random() % 40);
    for (double& x : series) x = double(random() % 12);
    const auto found = peaks(series);
    std::vector<double> thresholds{-1};
    for (int v = 0; v <= 12; ++v) thresholds.insert(thresholds.end(), {double(v), v + 0.5});
    const auto counts = counts_above(found, thresholds);
    for (std::size_t t = 0; t < thresholds.size(); ++t) {
      std::size_t stretches = 0;
      for (std::size_t k = 0; k < series.size(); ++k) stretches += series[k] > thresholds[t] && (k == 0 || !(series[k - 1] > thresholds[t]));
      EXPECT_EQ(counts[t], stretches) << thresholds[t];
    }
    for (std::size_t p = 1; p < found.size(); ++p) {
      const std::size_t at = found[p].at;
      const auto higher = [&](std::size_t k) { return series[k] > series[at] || (series[k] == series[at] && k < at); };
      double pass = -std::numeric_limits<double>::infinity();
      for (const int step : {-1, 1}) {
        double low = series[at];
        for (std::ptrdiff_t k = std::ptrdiff_t(at); k >= 0 && k < std::ptrdiff_t(series.size()); k += step) {
          low = std::min(low, series[std::size_t(k)]);
          if (higher(std::size_t(k))) {
            pass = std::max(pass, low);
            break;
          }
        }
      }
      EXPECT_EQ(found[p].death, pass);
    }
  }
}

}  // namespace
}  // namespace jam
