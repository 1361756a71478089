// Cells of the power tessellation: lattices in boxes, sums over boxes, points counted one by one, and walls of each kind.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "libjam/tessellation/convex_hull.hpp"
#include "libjam/tessellation/power_cells.hpp"

namespace jam {
namespace {

Wall plane(const Vec3& point, const Vec3& normal) {
  Wall wall;
  wall.kind = "plane";
  wall.point = point;
  wall.axis = normal;
  return wall;
}
// Six planes about the box from 0 to `size`.
std::vector<Wall> box(const Vec3& size) {
  std::vector<Wall> walls;
  for (int axis = 0; axis < 3; ++axis) {
    walls.push_back(plane(Vec3::Zero(), Vec3::Unit(axis)));
    walls.push_back(plane(size, -Vec3::Unit(axis)));
  }
  return walls;
}

Snapshot spheres(const std::vector<Vec3f>& centres, const std::vector<float>& radii, std::size_t walls) {
  Snapshot s;
  for (std::size_t i = 0; i < centres.size(); ++i) s.particles.id.push_back(ParticleId(i));
  s.particles.position = centres;
  s.particles.radius = radii;
  s.walls.resize(walls);
  return s;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(PowerCells, OfACubicLatticeAreCubes) {
  std::vector<Vec3f> centres;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) centres.emplace_back(Vec3f(float(x), float(y), float(z)) + Vec3f::Constant(0.5f));
  const std::vector<Wall> walls = box(Vec3(4, 3, 3));
  for (const double volume : power_cell_volumes(spheres(centres, std::vector<float>(centres.size(), 0.5f), walls.size()), walls))
    EXPECT_NEAR(volume, 1, 1e-12);
}

// Polydisperse spheres: the cells fill the box, and hold as many of 200,000 random points as their volume says.
TEST(PowerCells, AreTheNearestPointsByPower) {
  std::mt19937 random(1);
  const auto uniform = [&] { return float(random() % 1000000) * 1e-6f; };
  std::vector<Vec3f> centres;
  std::vector<float> radii;
  while (centres.size() < 60) {
    const float x = uniform(), y = uniform(), z = uniform(), r = 0.05f + 0.1f * uniform();
    const Vec3f centre(x, y, z);
    bool inside = centre.minCoeff() > r && centre.maxCoeff() < 1 - r;
    for (std::size_t k = 0; k < centres.size(); ++k) inside = inside && (centres[k] - centre).norm() > 0.9f * (r + radii[k]);
    if (inside) centres.push_back(centre), radii.push_back(r);
  }
  const std::vector<Wall> walls = box(Vec3(1, 1, 1));
  const std::vector<double> volume = power_cell_volumes(spheres(centres, radii, walls.size()), walls);
  ASSERT_EQ(volume.size(), 60u);
  EXPECT_NEAR(sum(volume), 1, 1e-9);
  std::vector<double> points(60, 0.0);
  constexpr int all = 200000;
  for (int k = 0; k < all; ++k) {
    const float x = uniform(), y = uniform(), z = uniform();
    std::size_t nearest = 0;
    float least = 1e9f;
    for (std::size_t i = 0; i < 60; ++i) {
      const float power = (centres[i] - Vec3f(x, y, z)).squaredNorm() - radii[i] * radii[i];
      if (power < least) least = power, nearest = i;
    }
    points[nearest] += 1;
  }
  // Five standard deviations of a binomial count.
  for (std::size_t i = 0; i < 60; ++i) EXPECT_NEAR(points[i] / all, volume[i], 5 * std::sqrt(volume[i] / all));
}

// The face between two touching spheres is the plane through their contact.
TEST(PowerCells, MeetWhereSpheresTouch) {
  const std::vector<Wall> walls = box(Vec3(3, 2, 2));
  const std::vector<double> volume = power_cell_volumes(spheres({{1, 1, 1}, {2.5f, 1, 1}}, {1, 0.5f}, walls.size()), walls);
  EXPECT_NEAR(volume[0], 2 * 4, 1e-12);
  EXPECT_NEAR(volume[1], 1 * 4, 1e-12);
}

TEST(PowerCells, AreOpenAtAFreeSurfaceAndEmptyInsideOthers) {
  std::vector<Wall> walls = box(Vec3(2, 2, 2));
  EXPECT_NEAR(power_cell_volumes(spheres({{1, 1, 1}}, {1}, walls.size()), walls)[0], 8, 1e-12);
  EXPECT_EQ(power_cell_volumes(spheres({{1, 1, 1}, {1.2f, 1, 1}}, {1, 0.1f}, walls.size()), walls)[1], 0);
  walls.pop_back();  // the lid
  EXPECT_TRUE(std::isnan(power_cell_volumes(spheres({{1, 1, 1}}, {1}, walls.size()), walls)[0]));
  EXPECT_TRUE(power_cell_volumes(spheres({}, {}, walls.size()), walls).empty());
}

// A disc of the cylinder 1 high: pi R^2. Tangents every 2 degrees circumscribe it: tan(1 degree)/(1 degree) = 1 + 1.0e-4 more.
TEST(PowerCells, AreBoundedByCylindersConesAndDiscsWhereverTheyAre) {
  Wall cylinder;
  cylinder.kind = "cylinder";
  cylinder.point = Vec3(0, 0, -1);
  cylinder.radius = 3;
  cylinder.low = 0, cylinder.high = 5;
  Wall disc;
  disc.kind = "disc";
  disc.radius = 4;
  const std::vector<Wall> walls{cylinder, disc, plane(Vec3(0, 0, 1), -Vec3::UnitZ())};
  const double excess = std::tan(std::numbers::pi / 180) / (std::numbers::pi / 180);
  for (const float off : {0.0f, 0.7f, 1.9f}) {
    const std::vector<double> volume = power_cell_volumes(spheres({{off, 0.2f, 0.5f}}, {1.4f}, 3), walls);
    EXPECT_NEAR(volume[0], 9 * std::numbers::pi * excess, 1e-9) << off;
    // The same elsewhere and turned.
    Snapshot moved = spheres({{off, 0.2f, 0.5f}}, {1.4f}, 3);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.5, 0.3, -0.6, 0.1).normalized();
    moved.particles.position[0] = (turn * moved.particles.position[0].cast<double>() + Vec3(5, 6, 7)).cast<float>();
    for (WallState& wall : moved.walls) wall.orientation = turn, wall.position = Vec3(5, 6, 7);
    EXPECT_NEAR(power_cell_volumes(moved, walls)[0], volume[0], 1e-5);
  }
  // A cone from radius 2 at z = 0 to 3 at z = 1: pi (4 + 6 + 9)/3. Its tangents are taken at the height of the centre, and are those of the
  // whole cone.
  Wall cone = cylinder;
  cone.kind = "cone";
  cone.point = Vec3::Zero();
  cone.radius = 2, cone.high_radius = 3, cone.high = 1;
  const std::vector<Wall> funnel{cone, disc, plane(Vec3(0, 0, 1), -Vec3::UnitZ())};
  EXPECT_NEAR(power_cell_volumes(spheres({{0.3f, 0, 0.5f}}, {1}, 3), funnel)[0], std::numbers::pi * 19 / 3 * excess, 2e-2);
}

// A thin slab as a mesh between two spheres takes its volume away from them, and a wall of glued spheres takes part as sites.
TEST(PowerCells, AreBoundedByABladeAndByGluedSpheres) {
  Wall slab;
  slab.kind = "mesh";
  for (const double x : {1.4, 1.6})
    for (const double y : {-1.0, 3.0})
      for (const double z : {-1.0, 3.0}) slab.vertices.emplace_back(x, y, z);
  slab.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  std::vector<Wall> walls = box(Vec3(3, 2, 2));
  walls.push_back(slab);
  const std::vector<double> volume = power_cell_volumes(spheres({{0.7f, 1, 1}, {2.3f, 1, 1}}, {0.7f, 0.6f}, walls.size()), walls);
  EXPECT_NEAR(volume[0], 1.4 * 4, 1e-12);
  EXPECT_NEAR(volume[1], 1.4 * 4, 1e-12);

  Wall glued;
  glued.kind = "spheres";
  glued.sphere_centre = {Vec3(2.3, 1, 1)};
  glued.sphere_radius = {0.8};
  walls.back() = glued;
  EXPECT_NEAR(power_cell_volumes(spheres({{0.7f, 1, 1}}, {0.8f}, walls.size()), walls)[0], 1.5 * 4, 1e-6);
}

TEST(ConvexHull, OfCubesAndFlatSets) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.emplace_back(k & 1, k >> 1 & 1, 2 * (k >> 2));
  corners.emplace_back(0.5, 0.5, 0.5);
  EXPECT_NEAR(convex_hull_volume(corners), 2, 1e-14);
  corners.resize(4);
  EXPECT_EQ(convex_hull_volume(corners), 0);
  EXPECT_EQ(convex_hull_volume({}), 0);
}

}  // namespace
}  // namespace jam
