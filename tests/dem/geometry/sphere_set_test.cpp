#include "libdem/geometry/sphere_set.hpp"

#include <gtest/gtest.h>

#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using test::uniform;

TEST(SphereSet, FindsWhatTryingEverySphereFinds) {
  std::mt19937_64 rng(1);
  std::size_t found = 0;
  for (const Vec3& size : {Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0.4, 0.5, 0.6), Vec3(0, 0, 0), Vec3(30, 20, 1)}) {
    for (const std::size_t count : {1U, 2U, 300U}) {
      std::vector<Vec3> centres;
      std::vector<double> radii;
      for (std::size_t k = 0; k < count; ++k) {
        centres.push_back(size.cwiseProduct(Vec3(uniform(rng, 0, 1), uniform(rng, 0, 1), uniform(rng, 0, 1))));
        radii.push_back(uniform(rng, 0.02, k % 50 == 0 ? 0.3 : 0.05));
      }
      const SphereSet set(centres, radii);
      for (int q = 0; q < 200; ++q) {
        const Vec3 x =
            size.cwiseProduct(Vec3(uniform(rng, -0.2, 1.2), uniform(rng, -0.2, 1.2), uniform(rng, -0.2, 1.2))) +
            uniform(rng, 0, 0.3) * test::random_direction(rng);
        const double reach = uniform(rng, 0, 0.4);
        std::vector<std::uint32_t> expected, near{77};  // within() appends
        for (std::uint32_t k = 0; k < count; ++k)
          if ((centres[k] - x).norm() <= reach + radii[k]) expected.push_back(k);
        set.within(x, reach, near);
        EXPECT_EQ(near.front(), 77U);
        near.erase(near.begin());
        EXPECT_EQ(near, expected);
        EXPECT_EQ(set.any_within(x, reach), !expected.empty());
        found += expected.size();
      }
    }
  }
  EXPECT_GT(found, 10000U);
}

TEST(SphereSet, ReachesItsFarthestPoint) {
  const SphereSet set({Vec3(1, 0, 0), Vec3(0, -3, 4)}, {4.5, 0.25});
  EXPECT_NEAR(set.reach(), 5.5, 1e-15);
}

}  // namespace
}  // namespace dem
