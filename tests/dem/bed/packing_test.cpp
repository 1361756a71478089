#include "libdem/bed/packing.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dem {
namespace {

TEST(Packing, SolidFractionOfACubicLatticeIsPiOverSix) {
  Particles p;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 6; ++k) p.add(std::uint32_t(p.size() + 1), 0, 0.5, Vec3(i + 0.5, j + 0.5, k + 0.5));
  const BoxRegion box{0, 4, 0, 4};
  EXPECT_NEAR(solid_fraction(p, box, 1, 5), std::numbers::pi / 6, 1e-14);
  EXPECT_NEAR(solid_fraction(p, box, 1.5, 4.5), std::numbers::pi / 6, 1e-14);  // halves of spheres at both ends
  EXPECT_NEAR(solid_fraction(p, box, 0, 12), 0.5 * std::numbers::pi / 6, 1e-14);
  EXPECT_EQ(solid_fraction(p, box, 5, 5), 0);
  // The rest of the grains is outside of half the box.
  EXPECT_NEAR(solid_fraction(p, BoxRegion{0, 2, 0, 4}, 1, 5), std::numbers::pi / 6, 1e-14);
}

TEST(Packing, SolidFractionCutsASphereIntoItsCaps) {
  Particles p;
  p.add(1, 0, 1, Vec3(0, 0, 1));
  // Cap of height h: pi h^2 (3R - h)/3; in a cylinder of radius 1 the slice has the volume pi h.
  for (const double h : {0.1, 0.7, 1.0, 1.9})
    EXPECT_NEAR(solid_fraction(p, CylinderRegion{1}, 0, h), h * (3 - h) / 3, 1e-14);
}

TEST(Packing, RattlersDoNotCountForTheMechanicalCoordination) {
  EXPECT_EQ(mechanical_coordination({0, 1, 1, 4, 6}), 5);
  EXPECT_EQ(mechanical_coordination({0, 1}), 0);
  EXPECT_EQ(mechanical_coordination({}), 0);
}

// Two walls face each other across the first grain, two meet at the second's corner: only the first is squeezed, and what it touches counts
// for it.
TEST(Packing, OverlapsOfSqueezedGrainsAreToldApart) {
  State s;
  s.particles.add(1, 0, 0.5, Vec3(0, 0, 0));
  s.particles.add(2, 0, 0.25, Vec3(0.7, 0, 0));
  s.particles.add(3, 0, 0.5, Vec3(0.7, 0.745, 0));
  s.particles.add(4, 0, 0.5, Vec3(0.7, 1.74, 0));
  const auto pair = [&](std::uint32_t i, std::uint32_t j, double contact_radius) {
    State::Pair c{};
    c.i = i;
    c.j = j;
    c.contact_radius = contact_radius;
    s.pairs.push_back(c);
  };
  const auto wall = [&](std::uint32_t i, const Vec3& normal, double distance, double contact_radius = 1) {
    State::WallPair c{};
    c.i = i;
    c.normal = normal;
    c.distance = distance;
    c.contact_radius = contact_radius;
    s.wall_pairs.push_back(c);
  };
  pair(1, 2, 1);
  pair(2, 3, 1);
  wall(1, Vec3(0, 0, -1), 0.249);
  wall(3, Vec3(1, 0, 0), 0.499);
  Overlaps o = overlaps_of(s);
  EXPECT_NEAR(o.largest, 0.02, 1e-14);  // 0.005 of 0.25
  EXPECT_EQ(o.squeezed, 0u);
  EXPECT_EQ(o.largest_squeezed, 0);

  wall(1, Vec3(1, 0, 0), 0.24);                 // at right angles: a corner
  wall(0, Vec3(0, -1, 0), 0.45);
  wall(0, Vec3(0.1, 0.99, 0), 0.4, 0);          // does not act
  o = overlaps_of(s);
  EXPECT_NEAR(o.largest, 0.1, 1e-14);
  EXPECT_EQ(o.squeezed, 0u);

  s.wall_pairs.back().contact_radius = 1;
  pair(0, 1, 1);                                // 0.05 of 0.25, with the squeezed grain
  o = overlaps_of(s);
  EXPECT_EQ(o.squeezed, 1u);
  EXPECT_NEAR(o.largest_squeezed, 0.2, 1e-14);  // the wider of its contacts with walls and with a grain
  EXPECT_NEAR(o.largest, 0.04, 1e-14);          // 0.01 of 0.25 at the corner
}

TEST(Packing, RegionsKnowTheirInside) {
  const CylinderRegion circle{2};
  const BoxRegion box{-1, 3, 0, 1};
  EXPECT_NEAR(cross_section(circle), 4 * std::numbers::pi, 1e-14);
  EXPECT_EQ(cross_section(box), 4);
  EXPECT_EQ(clear_radius(box), 0.5);
  EXPECT_EQ(held_inside(circle, Vec3(0.5, 0.5, 7), 0.5), Vec3(0.5, 0.5, 7));
  EXPECT_LT((held_inside(circle, Vec3(3, 4, 7), 0.5) - Vec3(0.9, 1.2, 7)).norm(), 1e-15);
  EXPECT_EQ(held_inside(box, Vec3(5, -2, 1), 0.25), Vec3(2.75, 0.25, 1));
  // The unit square is mapped to the inside with equal areas: the inner half of u covers half of the area.
  EXPECT_NEAR(point_inside(circle, 0.5, 0.2, 0).squaredNorm(), 2, 1e-14);
  EXPECT_EQ(point_inside(box, 0.5, 0.5, 0.25), Vec3(1, 0.5, 0));
}

}  // namespace
}  // namespace dem
