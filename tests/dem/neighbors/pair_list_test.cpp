#include "libdem/neighbors/pair_list.hpp"

#include <gtest/gtest.h>

#include <random>

namespace dem {
namespace {

struct Scene {
  std::vector<Vec3> position;
  std::vector<double> radius;
};

Scene random_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1.0p-53; };
  Scene scene;
  const std::size_t n = std::size_t(draw(0, 60));
  const Vec3 box(draw(0, 5), draw(0, 5), draw(0, 5));  // from points and planes to dilute clouds
  for (std::size_t i = 0; i < n; ++i) {
    scene.position.emplace_back(draw(-1, 1) * box.x(), draw(-1, 1) * box.y(), draw(-1, 1) * box.z());
    const double radius = draw(0.1, 0.6);
    scene.radius.push_back(seed % 3 == 0 && i % 17 == 0 ? draw(1, 5) : seed % 4 == 0 ? 0.4 : radius);  // a few boulders; many alike
  }
  if (n > 3 && seed % 5 == 0) scene.position[2] *= 1e6;  // a stray far away
  return scene;
}

TEST(PairList, FindsTheSamePairsAsBruteForceInAThousandScenes) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const Scene s = random_scene(seed);
    const double skin = 0.05 * double(seed % 7);
    const PairList list = build_pair_list(s.position, s.radius, skin);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
    for (std::uint32_t i = 0; i < s.radius.size(); ++i)
      for (std::uint32_t j = i + 1; j < s.radius.size(); ++j)
        if ((s.position[i] - s.position[j]).norm() < s.radius[i] + s.radius[j] + skin) expected.emplace_back(i, j);
    for (std::size_t k = 0; k < list.size(); ++k) found.emplace_back(list.first[k], list.second[k]);
    ASSERT_EQ(found, expected) << "seed " << seed;
    for (std::uint32_t i = 0; i < s.radius.size(); ++i)
      for (std::uint32_t k = list.begin[i]; k < list.begin[i + 1]; ++k) ASSERT_EQ(list.first[k], i);
  }
}

}  // namespace
}  // namespace dem
