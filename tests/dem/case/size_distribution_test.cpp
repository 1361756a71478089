#include "libdem/case/size_distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libdem/case/derived.hpp"
#include "tests/dem/case/ft4.hpp"

namespace dem {
namespace {

Bed bed(Bed::Sizes sizes, double low = 0.8, double high = 1.2) {
  Bed b;
  b.sizes = sizes;
  b.size_low = low;
  b.size_high = high;
  return b;
}

// The mean of x^k over the grains as the mean over all quantiles: the midpoint rule in u, whose error falls with 1/n^2.
double moment(const Bed& b, int k) {
  constexpr int n = 100000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += std::pow(size_quantile(b, (i + 0.5) / n), k);
  return sum / n;
}

TEST(SizeDistribution, MomentsAreThoseOfTheSampledSizes) {
  for (const Bed::Sizes sizes : {Bed::Sizes::by_number, Bed::Sizes::by_mass})
    for (const auto& [low, high] : {std::pair{0.8, 1.2}, {0.5, 2.0}, {1.0, 1.0}}) {
      const Bed b = bed(sizes, low, high);
      EXPECT_NEAR(mean_size(b), moment(b, 1), 1e-8);
      EXPECT_NEAR(mean_cubed_size(b), moment(b, 3), 1e-7);
      EXPECT_EQ(size_quantile(b, 0), low);
      EXPECT_NEAR(size_quantile(b, 1), high, 1e-15 * high);
    }
  EXPECT_NEAR(mean_cubed_size(bed(Bed::Sizes::by_number)), 1.04, 1e-12);    // 2 * (0.64 + 1.44) / 4
  EXPECT_NEAR(mean_cubed_size(bed(Bed::Sizes::by_mass)), 0.9216, 1e-12);    // 2 * 0.64 * 1.44 / 2
}

TEST(SizeDistribution, UniformByMassMeansEqualMassInEqualRanges) {
  const Bed b = bed(Bed::Sizes::by_mass);
  constexpr int n = 100000;
  double mass[4] = {0, 0, 0, 0}, total = 0;
  for (int i = 0; i < n; ++i) {
    const double x = size_quantile(b, (i + 0.5) / n), m = x * x * x;
    mass[std::min(int((x - 0.8) / 0.1), 3)] += m;
    total += m;
  }
  // One grain more or less in a range of some 20,000 makes the tolerance.
  for (const double part : mass) EXPECT_NEAR(part / total, 0.25, 1e-4);
}

TEST(SizeDistribution, ShareBelowAndQuantileAreInverse) {
  for (const Bed::Sizes sizes : {Bed::Sizes::by_number, Bed::Sizes::by_mass}) {
    const Bed b = bed(sizes);
    for (double u = 0.05; u < 1; u += 0.05) EXPECT_NEAR(size_share_below(b, size_quantile(b, u)), u, 1e-14);
    EXPECT_EQ(size_share_below(b, 0.7), 0);
    EXPECT_EQ(size_share_below(b, 1.3), 1);
    EXPECT_EQ(size_share_below(bed(sizes, 1, 1), 1), 1);
  }
}

TEST(SizeDistribution, BedsByMassHoldMoreAndSmallerGrains) {
  Case c = ft4('a');
  const Derived number = derive(c);
  c.bed.sizes = Bed::Sizes::by_mass;
  const Derived mass = derive(c);
  EXPECT_NEAR(mass.grains / number.grains, 1.04 / 0.9216, 1e-12);
  EXPECT_NEAR(number.d90, 1.16 * 0.925e-3, 1e-15);
  // 1/x^2 = 1/0.64 - 0.9 (1/0.64 - 1/1.44) = 0.78125.
  EXPECT_NEAR(mass.d90, 0.925e-3 / std::sqrt(0.78125), 1e-15);
}

}  // namespace
}  // namespace dem
