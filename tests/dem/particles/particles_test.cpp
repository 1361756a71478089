#include "libdem/particles/particles.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Particles, OneOverTheInertiaIsWithinRoundingOfIt) {
  for (const double radius : {3.7e-4, 5.55e-4, 2e-6})
    for (const double mass : {1.1e-6, 3e-14})
      EXPECT_DOUBLE_EQ(dem::sphere_inertia(mass, radius) * dem::inverse_sphere_inertia(1 / mass, 1 / radius), 1);
}

}  // namespace
