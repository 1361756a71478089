#include "libjam/statistics/jam_places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace jam {
namespace {

Track at(double height, float speed) {
  Track track;
  for (const double force : {30.0, 50.0, 40.0}) {
    Track::Point point;
    point.compressive_force = force;
    point.from_blade = Vec3f(0.012f, 0, force == 50 ? float(height) : 1.0f);  // only the peak's height counts
    point.speed_over_tip = speed;
    track.points.push_back(point);
  }
  return track;
}
constexpr Gap gap{.tip_radius = 0.01175, .vessel_radius = 0.0125, .z_low = 1e-3, .z_high = 7e-3};

TEST(JamPlaces, EvenHeightsPassAndOthersDoNot) {
  std::mt19937_64 random(4);
  const auto uniform = [&] { return double(random() >> 11) * 0x1.0p-53; };
  int refused = 0;
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<Track> even;
    for (int k = 0; k < 50; ++k) even.push_back(at(1e-3 + 6e-3 * uniform(), 0.5f));
    refused += jam_places(even, gap).even_p < 0.05;
  }
  // Binomial, n = 200, p = 0.05: between 2 and 20 but for one in a thousand.
  EXPECT_GE(refused, 2);
  EXPECT_LE(refused, 20);
  std::vector<Track> low;
  for (int k = 0; k < 50; ++k) low.push_back(at(1e-3 + 3e-3 * uniform(), 0.5f));
  EXPECT_LT(jam_places(low, gap).even_p, 1e-6);
  low.push_back(at(9e-3, 0.5f));  // above the blade
  EXPECT_EQ(jam_places(low, gap).heights, 50u);
}

TEST(JamPlaces, SaysHowFastJammedGrainsGo) {
  std::vector<Track> tracks;
  for (const float speed : {0.0f, 0.1f, 0.2f, 0.5f, 1.0f}) tracks.push_back(at(3e-3, speed));
  const JamPlaces places = jam_places(tracks, gap);
  EXPECT_NEAR(places.median, 0.2, 1e-7);
  EXPECT_NEAR(places.slow, 0.6, 1e-12);
  EXPECT_NEAR(places.between, 0.2, 1e-12);
  EXPECT_NEAR(places.fast, 0.2, 1e-12);
}

TEST(JamPlaces, AreUnknownWithoutJamsOrAGap) {
  const JamPlaces none = jam_places({}, gap);
  EXPECT_TRUE(std::isnan(none.even_p) && std::isnan(none.median) && std::isnan(none.fast));
  const std::vector<Track> one{at(3e-3, std::nanf(""))};
  EXPECT_TRUE(std::isnan(jam_places(one, {}).even_p));
  EXPECT_TRUE(std::isnan(jam_places(one, gap).median));
}

}  // namespace
}  // namespace jam
