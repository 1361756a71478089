#include "apps/jamscope/simulation_view.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <set>

#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/validate.hpp"
#include "libjam/snapshot/writer.hpp"

namespace jamscope {
namespace {

using dem::Vec3;

dem::TriangleMesh tetrahedron() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
          std::vector<dem::FacetLabel>(4, dem::FacetLabel::face)};
}

// Every shape of libdem is written to a snapshot file, read back, and found sound.
TEST(SimulationView, EveryShapeOfAWallIsStored) {
  const Vec3 point(1, 2, 3), axis = Vec3(1, 2, 2) / 3.0;
  const std::vector<std::pair<std::string, dem::WallShape>> shapes{
      {"plane", dem::Plane{point, axis}},
      {"cylinder", dem::Cylinder{point, axis, 0.5}},
      {"cylinder", dem::Cylinder{point, axis, 0.5, dem::FreeSide::outside, -0.25, 0.75}},
      {"cone", dem::Cone{point, axis, 0, 0.5, 2, dem::FreeSide::outside}},
      {"disc", dem::Disc{point, axis, 0.5, 0.25}},
      {"spheres", dem::make_glued_grains({point, axis}, {0.5, 0.25})},
      {"mesh", dem::make_mesh_wall(tetrahedron())}};
  std::set<std::size_t> rows;
  dem::Scene scene;
  scene.setup.materials = {{"glass", 2500, 63e9, 0.2}};
  scene.setup.interactions = {{{}}};
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    rows.insert(shapes[k].second.index());
    scene.setup.walls.push_back({"wall " + std::to_string(k), 0, shapes[k].second, {}});
    scene.roles.push_back(dem::WallRole::vessel);
  }
  EXPECT_EQ(rows.size(), std::variant_size_v<dem::WallShape>);

  const auto path = std::filesystem::path(testing::TempDir()) / "every_shape.h5";
  const jam::RunInfo info = run_info(CaseFile{}, scene, {});
  EXPECT_NO_THROW(jam::validate(info));
  jam::SnapshotWriter::create(path, info);
  const std::vector<jam::Wall> walls = jam::open_jamscope_file(path).info.walls;
  std::filesystem::remove(path);
  ASSERT_EQ(walls.size(), shapes.size());
  const double inf = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    EXPECT_EQ(walls[k].kind, shapes[k].first);
    if (k < 5) {
      EXPECT_EQ(walls[k].point, point);
      EXPECT_EQ(walls[k].axis, axis);
    }
  }
  EXPECT_EQ(walls[1].radius, 0.5);
  EXPECT_EQ(walls[1].free_side, "inside");
  EXPECT_EQ(walls[1].low, -inf);
  EXPECT_EQ(walls[1].high, inf);
  EXPECT_EQ(walls[2].free_side, "outside");
  EXPECT_EQ(walls[2].low, -0.25);
  EXPECT_EQ(walls[2].high, 0.75);
  EXPECT_EQ(walls[3].radius, 0);
  EXPECT_EQ(walls[3].high_radius, 0.5);
  EXPECT_EQ(walls[3].low, 0);
  EXPECT_EQ(walls[3].high, 2);
  EXPECT_EQ(walls[4].radius, 0.5);
  EXPECT_EQ(walls[4].hole_radius, 0.25);
  EXPECT_EQ(walls[5].sphere_centre, (std::vector<Vec3>{point, axis}));
  EXPECT_EQ(walls[5].sphere_radius, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(walls[6].vertices, tetrahedron().vertices);
  EXPECT_EQ(walls[6].triangles, tetrahedron().triangles);
}

}  // namespace
}  // namespace jamscope
