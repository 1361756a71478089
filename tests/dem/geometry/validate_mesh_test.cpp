#include "libdem/geometry/validate_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libdem/errors.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string message(const TriangleMesh& mesh) {
  try {
    validate_mesh(mesh, "part");
  } catch (const GeometryError& e) {
    return e.what();
  }
  return "accepted";
}

TriangleMesh two(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh out = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  out.vertices.insert(out.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) out.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  out.labels.insert(out.labels.end(), b.labels.begin(), b.labels.end());
  return out;
}

TriangleMesh shifted(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.vertices) p += by;
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TEST(ValidateMesh, ClosedBodiesAreAccepted) {
  std::mt19937_64 rng(1);
  EXPECT_EQ(message(test::box(1e-3, 2e-3, 3e-3)), "accepted");
  EXPECT_EQ(message(test::cylinder(60, 2e-3, 5e-3)), "accepted");
  EXPECT_EQ(message(test::book(1, 2e-3, 3e-3)), "accepted");
  EXPECT_EQ(message(test::random_hull(20, 1, rng)), "accepted");
  EXPECT_EQ(message(two(test::box(1, 1, 1), shifted(test::box(1, 1, 1), {2, 0, 0}))), "accepted");
  EXPECT_EQ(message(shifted(test::box(1e-3, 1e-3, 1e-3), {100, 0, 0})), "accepted");
}

TEST(ValidateMesh, EveryFaultIsNamedWithItsPlace) {
  const TriangleMesh box = test::box(1, 1, 1);
  TriangleMesh m = box;
  m.triangles.pop_back();
  m.labels.pop_back();
  EXPECT_THAT(message(m), AllOf(HasSubstr("mesh 'part'"), HasSubstr("edge from vertex"), HasSubstr("1 triangle(s)"),
                                HasSubstr("exactly two")));
  m = box;
  m.triangles[5][1] = 99;
  EXPECT_THAT(message(m), AllOf(HasSubstr("triangle 5 names vertex 99"), HasSubstr("below 8")));
  m = box;
  m.vertices[3].y() = std::nan("");
  EXPECT_THAT(message(m), AllOf(HasSubstr("vertex 3"), HasSubstr("nan"), HasSubstr("finite")));
  m = box;
  m.vertices[3].y() = 1e12;
  EXPECT_THAT(message(m), AllOf(HasSubstr("vertex 3"), HasSubstr("1000 m")));
  m = box;
  m.triangles[4][0] = m.triangles[4][1];
  EXPECT_THAT(message(m), AllOf(HasSubstr("triangle 4"), HasSubstr("no area")));
  m = box;
  std::swap(m.triangles[7][0], m.triangles[7][1]);
  EXPECT_THAT(message(m), AllOf(HasSubstr("same direction"), HasSubstr("7")));
  EXPECT_THAT(message(inside_out(box)), AllOf(HasSubstr("volume of -1 m^3"), HasSubstr("positive")));
  m = box;
  m.labels.pop_back();
  EXPECT_THAT(message(m), HasSubstr("11 labels for 12 triangles"));
  EXPECT_THAT(message({}), HasSubstr("0 triangles"));
}

TEST(ValidateMesh, ThreeSheetsInOneEdgeAreRefused) {
  TriangleMesh m = test::box(1, 1, 1);
  m.vertices.emplace_back(2, 2, 2);
  m.triangles.push_back({m.triangles[0][0], m.triangles[0][1], 8});
  m.labels.push_back(FacetLabel::face);
  EXPECT_THAT(message(m), HasSubstr("triangle(s)"));
}

TEST(ValidateMesh, BodiesThatTouchInAVertexAreRefused) {
  // Two tetrahedra with a common apex.
  TriangleMesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}};
  m.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}};
  m.labels.assign(8, FacetLabel::face);
  EXPECT_THAT(message(m), AllOf(HasSubstr("touch only in vertex 0"), HasSubstr("one fan")));
}

TEST(ValidateMesh, CrossingBodiesAreRefused) {
  EXPECT_THAT(message(two(test::box(1, 1, 1), shifted(test::box(1, 1, 1), {0.5, 0.4, 0.3}))),
              AllOf(HasSubstr("cross or overlap"), HasSubstr("triangle 0"), HasSubstr("does not meet itself")));
  // A vertex of a box pulled through the opposite side.
  TriangleMesh m = test::box(1, 1, 1);
  m.vertices[0] = Vec3(0.2, 0.1, -3);
  EXPECT_THAT(message(m), HasSubstr("mesh 'part'"));
}

TEST(RepairMesh, TurnedTrianglesAreTurnedBack) {
  std::mt19937_64 rng(2);
  for (int k = 0; k < 10; ++k) {
    TriangleMesh m = two(test::random_hull(15, 1, rng), shifted(test::book(1, 1, 1), {5, 0, 0}));
    ASSERT_EQ(message(m), "accepted");
    const TriangleMesh good = weld_mesh(m).mesh;  // a hull leaves inner points unused
    std::size_t turned = 0;
    for (auto& t : m.triangles)
      if (rng() % 3 == 0) std::swap(t[0], t[1]), ++turned;
    const MeshRepair repair = repair_mesh(m);
    EXPECT_EQ(repair.turned_triangles, turned);
    EXPECT_EQ(message(repair.mesh), "accepted");
    EXPECT_EQ(repair.mesh.vertices, good.vertices);
    EXPECT_EQ(repair_mesh(inside_out(good)).turned_triangles, good.triangles.size());
    EXPECT_EQ(repair_mesh(good).turned_triangles, 0U);
  }
}

TEST(RepairMesh, UselessPartsAreDroppedAndCounted) {
  TriangleMesh m = test::box(1, 1, 1);
  // A soup: every triangle with vertices of its own, off by up to 1e-9 m, and rubbish.
  std::mt19937_64 rng(3);
  TriangleMesh soup;
  for (const auto& t : m.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(m.vertices[v] + 1e-9 * test::random_direction(rng));
    soup.triangles.push_back({n, n + 1, n + 2});
    soup.labels.push_back(FacetLabel::tip);
  }
  soup.triangles.push_back({0, 1, 1});
  soup.triangles.push_back({2, 0, 1});
  soup.vertices.emplace_back(7, 7, 7);
  soup.labels.resize(14, FacetLabel::hub);
  const MeshRepair repair = repair_mesh(soup, 1e-8);
  EXPECT_EQ(repair.merged_vertices, 36U - 8U);
  EXPECT_EQ(repair.degenerate_triangles, 1U);
  EXPECT_EQ(repair.repeated_triangles, 1U);
  EXPECT_EQ(repair.unused_vertices, 1U);
  EXPECT_EQ(repair.turned_triangles, 0U);
  EXPECT_EQ(repair.mesh.labels, std::vector<FacetLabel>(12, FacetLabel::tip));
  EXPECT_EQ(message(repair.mesh), "accepted");
}

TEST(RepairMesh, AHoleStaysAHole) {
  TriangleMesh m = test::box(1, 1, 1);
  m.triangles.pop_back();
  m.labels.pop_back();
  EXPECT_THAT(message(repair_mesh(m).mesh), HasSubstr("1 triangle(s)"));
}

TEST(RepairMesh, AMillionVerticesInOnePlaceTakeNoTime) {
  TriangleMesh m = test::box(1, 1, 1);
  m.vertices.resize(300000, Vec3(0.3, 0.3, 0.3));
  EXPECT_EQ(repair_mesh(m).merged_vertices, 300000U - 9U);
  EXPECT_EQ(message(repair_mesh(m, 1e-6).mesh), "accepted");
}

TEST(RepairMesh, NumbersOutOfRangeAreRefused) {
  TriangleMesh m = test::box(1, 1, 1);
  m.triangles[0][0] = 8;
  EXPECT_THROW(repair_mesh(m), GeometryError);
  m = test::box(1, 1, 1);
  m.vertices[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(repair_mesh(m), GeometryError);
}

}  // namespace
}  // namespace dem
