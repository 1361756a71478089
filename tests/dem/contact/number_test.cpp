// The operations that packs have of their own, against those of single numbers.
#include "libdem/contact/number.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace dem {
namespace {

Pack filled(std::mt19937_64& random, double least, double most) {
  std::uniform_real_distribution<double> exponent(least, most);
  return Pack([&](auto) { return std::exp2(exponent(random)); });
}

TEST(Number, InverseRootsAreRightToAUnitInTheLastPlace) {
  std::mt19937_64 random(1);
  long double worst = 0;
  for (int round = 0; round < 100000; ++round) {
    const Pack a = filled(random, -1020, 1020), r = inverse_root(a);
    for (std::size_t k = 0; k < pack_width; ++k) {
      EXPECT_EQ(double(r[k]), inverse_root(double(a[k])));
      const long double exact = 1 / std::sqrt((long double)(a[k]));
      worst = std::max(worst, std::abs(double(r[k]) / exact - 1) / std::numeric_limits<double>::epsilon());
    }
  }
  // Of two roundings at the end, each of half an epsilon; more than a fifth, as no method of two roundings is exact.
  EXPECT_LE(worst, 1.0L);
  EXPECT_GE(worst, 0.2L);
}

TEST(Number, ExtremaOfPacksAreThoseOfSingleNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const double values[] = {-infinity, -1.5, -0.0, 0.0, 1e-310, 2.5, infinity, nan};
  for (const double a : values)
    for (const double b : values) {
      const auto same = [](const Pack& pack, double single) {
        for (std::size_t k = 0; k < pack_width; ++k)
          if (std::bit_cast<std::uint64_t>(double(pack[k])) != std::bit_cast<std::uint64_t>(single)) return false;
        return true;
      };
      EXPECT_TRUE(same(larger(Pack(a), Pack(b)), larger(a, b))) << a << ' ' << b;
      EXPECT_TRUE(same(smaller(Pack(a), Pack(b)), smaller(a, b))) << a << ' ' << b;
    }
}

}  // namespace
}  // namespace dem
