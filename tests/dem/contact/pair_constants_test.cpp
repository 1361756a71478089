#include "libdem/contact/pair_constants.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dem {
namespace {

// Against the textbook's formulas in more digits, from grains of a micrometre to boulders, and both ways round. Each takes some five
// roundings and a root that is right to a unit in the last place.
TEST(PairConstants, ReduceMassesAndMomentsOfInertia) {
  constexpr double exact = 8 * std::numeric_limits<double>::epsilon();
  for (double a = 1e-22; a < 1e6; a *= 7.3)
    for (double b = a; b < 1e12 * a; b *= 31) {
      const long double reduced = (long double)(a) * b / ((long double)(a) + b);
      PairConstants<double> c, other;
      set_effective_mass(c, a, b);
      set_effective_inertia(c, a, b);
      EXPECT_NEAR(double(c.root_mass / std::sqrt(reduced)), 1, exact) << a << ", " << b;
      EXPECT_NEAR(double(c.effective_inertia / reduced), 1, exact) << a << ", " << b;
      set_effective_mass(other, b, a);
      set_effective_inertia(other, b, a);
      EXPECT_EQ(other.root_mass, c.root_mass);
      EXPECT_EQ(other.effective_inertia, c.effective_inertia);
      PairConstants<Pack> packs;
      set_effective_mass(packs, Pack(a), Pack(b));
      set_effective_inertia(packs, Pack(a), Pack(b));
      EXPECT_EQ(double(packs.root_mass[0]), c.root_mass);
      EXPECT_EQ(double(packs.effective_inertia[0]), c.effective_inertia);
    }
}

}  // namespace
}  // namespace dem
