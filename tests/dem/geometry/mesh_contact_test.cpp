#include "libdem/geometry/mesh_contact.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "libdem/errors.hpp"
#include "libdem/geometry/twisted_blade.hpp"
#include "libdem/geometry/validate_mesh.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using namespace test;

constexpr double radius = 0.4625e-3;  // m, the paper's mean grain

std::vector<MeshTouch> touches(const MeshContactFinder& finder, const Vec3& centre, double reach = radius) {
  std::vector<std::uint32_t> candidates;
  finder.candidate_triangles(centre, reach, candidates);
  std::vector<MeshTouch> out;
  finder.touches(centre, reach, candidates, out);
  return out;
}

// Stands for the contact force: continuous in the sphere's position if no touch jumps, is lost or is counted twice.
Vec3 sum_of_overlaps(const std::vector<MeshTouch>& all) {
  Vec3 sum = Vec3::Zero();
  for (const MeshTouch& t : all) sum += (radius - t.distance) * -t.normal;
  return sum;
}

double largest_overlap(const std::vector<MeshTouch>& all) {
  double largest = 0;
  for (const MeshTouch& t : all) largest = std::max(largest, radius - t.distance);
  return largest;
}

bool same_features(const std::vector<MeshTouch>& a, const std::vector<MeshTouch>& b) {
  return std::ranges::equal(a, b, [](const MeshTouch& s, const MeshTouch& t) {
    return s.feature == t.feature && s.feature_id == t.feature_id;
  });
}

double gap(double a, double b) {
  return std::abs(a - b);
}
double gap(const Vec3& a, const Vec3& b) {
  return (a - b).norm();
}

struct Rolling {
  std::size_t fewest = 1000, most = 0, changes = 0;
  double jump = 0;  // m, largest change of `measure` across a change of features
};

// Rolls the sphere along a straight line. Wherever the touched features change, halves the interval until its ends are
// 1e-12 radius apart and measures the jump there.
template <typename Measure>
Rolling roll(const MeshContactFinder& finder, const Vec3& from, const Vec3& to, std::size_t steps, Measure measure) {
  Rolling result;
  const auto at = [&](double s) { return touches(finder, from + s * (to - from)); };
  std::vector<MeshTouch> before;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(steps);
    const std::vector<MeshTouch> now = at(s);
    result.fewest = std::min(result.fewest, now.size());
    result.most = std::max(result.most, now.size());
    if (i > 0 && !same_features(before, now)) {
      ++result.changes;
      double low = s - 1 / static_cast<double>(steps), high = s;
      std::vector<MeshTouch> at_low = before, at_high = now;
      while ((high - low) * (to - from).norm() > 1e-12 * radius) {
        const double middle = (low + high) / 2;
        if (middle == low || middle == high) break;
        const std::vector<MeshTouch> halfway = at(middle);
        (same_features(at_low, halfway) ? low : high) = middle;
        (same_features(at_low, halfway) ? at_low : at_high) = halfway;
      }
      result.jump = std::max(result.jump, gap(measure(at_low), measure(at_high)));
    }
    before = now;
  }
  return result;
}

TEST(MeshContact, ATriangulatedPlaneIsThePlane) {
  std::mt19937_64 rng(1);
  const MeshContactFinder finder(slab(8, 2e-3, 1e-3, rng));
  const auto& mesh = finder.mesh();
  for (int i = 0; i < 6000; ++i) {
    Vec3 centre(uniform(rng, -1.5e-3, 1.5e-3), uniform(rng, -1.5e-3, 1.5e-3), uniform(rng, 0.3, 1) * radius);
    // A third each: anywhere, exactly above an inner vertex, exactly above the middle of an edge.
    const auto& t = mesh.triangles[rng() % 128];
    if (i % 3 == 1) centre.head<2>() = mesh.vertices[t[0]].head<2>();
    if (i % 3 == 2) centre.head<2>() = (0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]])).head<2>();
    if (centre.head<2>().cwiseAbs().maxCoeff() > 1.9e-3) continue;
    const std::vector<MeshTouch> all = touches(finder, centre);
    ASSERT_EQ(all.size(), 1U) << centre.transpose();
    EXPECT_NEAR((all[0].point - Vec3(centre.x(), centre.y(), 0)).norm(), 0, 1e-12 * radius);
    EXPECT_NEAR((all[0].normal - Vec3(0, 0, -1)).norm(), 0, 1e-12);
    EXPECT_NEAR(all[0].distance, centre.z(), 1e-12 * radius);
  }
}

TEST(MeshContact, ARotatedTriangulatedPlaneIsThePlane) {
  std::mt19937_64 rng(2);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Isometry3d motion = random_motion(rng, 0.05);
    const TriangleMesh flat = slab(6, 2e-3, 1e-3, rng);
    const MeshContactFinder finder(moved(flat, motion));
    for (int i = 0; i < 300; ++i) {
      Vec3 centre(uniform(rng, -1.5e-3, 1.5e-3), uniform(rng, -1.5e-3, 1.5e-3), uniform(rng, 0.3, 1) * radius);
      const auto& t = flat.triangles[rng() % 72];
      if (i % 2 == 1) centre.head<2>() = (0.3 * flat.vertices[t[0]] + 0.7 * flat.vertices[t[1]]).head<2>();
      if (centre.head<2>().cwiseAbs().maxCoeff() > 1.9e-3) continue;
      const std::vector<MeshTouch> all = touches(finder, motion * centre);
      ASSERT_EQ(all.size(), 1U);
      // Coordinates of 0.05 m carry 7e-18 m of rounding, normals of sides of 0.1 mm 1e-13.
      EXPECT_NEAR((all[0].point - motion * Vec3(centre.x(), centre.y(), 0)).norm(), 0, 1e-12 * 0.05);
      EXPECT_NEAR((all[0].normal - motion.linear() * Vec3(0, 0, -1)).norm(), 0, 1e-12);
    }
  }
}

TEST(MeshContact, ASphereRollsOverATriangulatedPlaneWithoutAJolt) {
  std::mt19937_64 rng(3);
  const MeshContactFinder finder(slab(8, 2e-3, 1e-3, rng));
  const Vec3 vertex = finder.mesh().vertices[40];  // an inner one
  const double z = 0.9 * radius;
  const Rolling along = roll(finder, Vec3(-1.7e-3, -1.1e-3, z), Vec3(1.7e-3, 1.3e-3, z), 3000, sum_of_overlaps);
  const Vec3 through(vertex.x(), vertex.y(), z), side(0.4e-3, 0.1e-3, 0);
  const Rolling across_vertex = roll(finder, through - side, through + side, 1000, sum_of_overlaps);
  for (const Rolling& r : {along, across_vertex}) {
    EXPECT_EQ(r.fewest, 1U);
    EXPECT_EQ(r.most, 1U);
    EXPECT_GE(r.changes, 1U);
    EXPECT_LT(r.jump, 1e-9 * radius);
  }
  EXPECT_GE(along.changes, 8U);
}

TEST(MeshContact, ASphereRollsOverAConvexEdgeAndAVertexWithOneTouch) {
  const double a = 2e-3, above = 0.5 * a + 0.9 * radius;
  const MeshContactFinder finder(box(a, a, a));
  // From above the upper side, beyond the edge, to beside it; over the corner; and along the edge past its end.
  const double d = 0.5 * a, out = 0.6 * radius;
  for (const auto& [from, to] :
       {std::pair(Vec3(0, 0.1e-3, above), Vec3(d + out, 0.1e-3, d + out)),
        std::pair(Vec3(d + out, 0.1e-3, d + out), Vec3(above, 0.2e-3, 0)),
        std::pair(Vec3(0, 0.1e-3, above), Vec3(d + 0.4 * radius, d + 0.4 * radius, d + 0.4 * radius)),
        std::pair(Vec3(d + out, 0, d + out), Vec3(d + out, d + 0.3 * radius, d + out))}) {
    const Rolling r = roll(finder, from, to, 2000, sum_of_overlaps);
    EXPECT_EQ(r.fewest, 1U);
    EXPECT_EQ(r.most, 1U);
    EXPECT_GE(r.changes, 1U);
    EXPECT_LT(r.jump, 1e-9 * radius);
  }
  const Vec3 corner(d, d, d);
  const std::vector<MeshTouch> at_corner = touches(finder, corner + 0.5 * radius * Vec3(1, 2, 2) / 3);
  ASSERT_EQ(at_corner.size(), 1U);
  EXPECT_EQ(at_corner[0].feature, MeshFeature::vertex);
  EXPECT_NEAR((at_corner[0].point - corner).norm(), 0, 1e-15);
  EXPECT_NEAR(at_corner[0].distance, 0.5 * radius, 1e-15);
  EXPECT_NEAR((at_corner[0].normal + Vec3(1, 2, 2) / 3).norm(), 0, 1e-12);
  const std::vector<MeshTouch> at_edge = touches(finder, Vec3(d + 0.3 * radius, 0.2e-3, d + 0.4 * radius));
  ASSERT_EQ(at_edge.size(), 1U);
  EXPECT_EQ(at_edge[0].feature, MeshFeature::edge);
  EXPECT_NEAR(at_edge[0].distance, 0.5 * radius, 1e-15);
  EXPECT_NEAR((at_edge[0].point - Vec3(d, 0.2e-3, d)).norm(), 0, 1e-15);
}

TEST(MeshContact, ASphereInAConcaveCornerTouchesBothSides) {
  const double opening = std::numbers::pi / 2;
  const MeshContactFinder finder(book(opening, 3e-3, 4e-3));
  // The sides lean at 45 degrees; at height h over the valley both are h / sqrt 2 away.
  const double h = 0.95 * radius * std::numbers::sqrt2;
  const std::vector<MeshTouch> seated = touches(finder, Vec3(0, h, 0.1e-3));
  ASSERT_EQ(seated.size(), 2U);
  for (const MeshTouch& t : seated) {
    EXPECT_EQ(t.feature, MeshFeature::face);
    EXPECT_NEAR(t.distance, 0.95 * radius, 1e-15);
  }
  EXPECT_NEAR(seated[0].normal.dot(seated[1].normal), 0, 1e-12);
  // Rolling down one side: one touch, then a second one that begins without overlap.
  const Vec3 along(-std::sin(opening / 2), std::cos(opening / 2), 0),
      off(std::cos(opening / 2), std::sin(opening / 2), 0);
  const Rolling r = roll(finder, 2e-3 * along + 0.98 * radius * off + Vec3(0, 0, 1e-4),
                         0.9 * radius * along + 0.98 * radius * off + Vec3(0, 0, 1e-4), 2000, sum_of_overlaps);
  EXPECT_EQ(r.fewest, 1U);
  EXPECT_EQ(r.most, 2U);
  EXPECT_LT(r.jump, 1e-9 * radius);
}

TEST(MeshContact, AShallowValleyIsOneContactAndTheLargerOverlapIsContinuous) {
  const double opening = (180 - 6) * std::numbers::pi / 180;
  const TriangleMesh valley = book(opening, 3e-3, 4e-3);
  const MeshContactFinder merged(valley), separate(valley, 0);
  const Vec3 from(-1e-3, 0.97 * radius, 2e-4), to(1e-3, 0.97 * radius, 2e-4);
  const Rolling one = roll(merged, from, to, 4000, largest_overlap);
  EXPECT_EQ(one.fewest, 1U);
  EXPECT_EQ(one.most, 1U);
  EXPECT_LT(one.jump, 1e-9 * radius);
  // Without merging the second minimum pushes at full strength at once: the reason for merging.
  const Rolling two = roll(separate, from, to, 4000, sum_of_overlaps);
  EXPECT_EQ(two.most, 2U);
  EXPECT_GT(two.jump, 1e-3 * radius);
}

TEST(MeshContact, AFinelyMeshedCylinderIsTouchedOnceAllTheWayRound) {
  const MeshContactFinder finder(cylinder(120, 3e-3, 4e-3));
  Vec3 from(3e-3 + 0.95 * radius, 0, 3e-4);
  for (int side = 0; side < 12; ++side) {
    const double angle = (side + 1) * std::numbers::pi / 60;
    const Vec3 to((3e-3 + 0.95 * radius) * std::cos(angle), (3e-3 + 0.95 * radius) * std::sin(angle),
                  3e-4 - side * 1e-5);
    const Rolling r = roll(finder, from, to, 500, sum_of_overlaps);
    EXPECT_EQ(r.fewest, 1U);
    EXPECT_EQ(r.most, 1U);
    EXPECT_GE(r.changes, 1U);
    EXPECT_LT(r.jump, 1e-9 * radius);
    from = to;
  }
  // The polygon lies at most its sagitta inside the circle.
  for (int i = 0; i < 500; ++i) {
    const Vec3 centre = (3e-3 + 0.9 * radius) * Vec3(std::cos(0.0123 * i), std::sin(0.0123 * i), 0);
    const std::vector<MeshTouch> all = touches(finder, centre);
    ASSERT_EQ(all.size(), 1U);
    const double sagitta = 3e-3 * (1 - std::cos(std::numbers::pi / 120));
    EXPECT_GT(all[0].distance, 0.9 * radius - 1e-15);
    EXPECT_LT(all[0].distance, 0.9 * radius + sagitta + 1e-15);
  }
}

TEST(MeshContact, TheFarSideOfAThinPlateDoesNotPush) {
  const MeshContactFinder finder(box(4e-3, 4e-3, 0.1e-3));
  const std::vector<MeshTouch> above = touches(finder, Vec3(0.3e-3, 0.2e-3, 0.05e-3 + 0.5 * radius));
  ASSERT_EQ(above.size(), 1U);
  EXPECT_NEAR((above[0].normal - Vec3(0, 0, -1)).norm(), 0, 1e-12);
  const std::vector<MeshTouch> near_edge = touches(finder, Vec3(1.99e-3, 0.2e-3, 0.05e-3 + 0.5 * radius));
  EXPECT_EQ(near_edge.size(), 1U);
  EXPECT_TRUE(touches(finder, Vec3(0.1e-3, 0.2e-3, 0.01e-3)).empty()) << "a centre inside the solid touches nothing";
}

TEST(MeshContact, ACentreOnTheSurfaceGetsTheInwardNormal) {
  const MeshContactFinder finder(box(4e-3, 4e-3, 4e-3));
  for (const Vec3& p : {Vec3(1e-3, 0.3e-3, 2e-3), Vec3(2e-3, 0.3e-3, 2e-3), Vec3(2e-3, 2e-3, 2e-3)}) {
    const std::vector<MeshTouch> all = touches(finder, p);
    ASSERT_FALSE(all.empty());
    for (const MeshTouch& t : all) {
      EXPECT_EQ(t.distance, 0);
      EXPECT_NEAR(t.normal.norm(), 1, 1e-12);
      EXPECT_LT(t.normal.dot(p), 0);
    }
  }
}

// The definition, evaluated the slow way: the nearest point of a triangle is a minimum if no triangle that holds this
// point has a nearer one, and it counts if the surface is reached from outside there.
std::vector<Vec3> brute_force_minima(const TriangleMesh& mesh, const Vec3& centre, double reach) {
  constexpr double rounding = 1e-12;  // m; features are far larger
  std::vector<Vec3> nearest(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) nearest[t] = nearest_point(mesh, t, centre);
  std::vector<Vec3> minima;
  for (const Vec3& p : nearest) {
    const double distance = (p - centre).norm();
    if (distance > reach) continue;
    bool minimum = std::ranges::none_of(minima, [&](const Vec3& q) { return (q - p).norm() < rounding; });
    for (std::size_t t = 0; minimum && t < nearest.size(); ++t)
      if ((nearest[t] - centre).norm() < distance - 1e-15 && (nearest_point(mesh, t, p) - p).norm() < rounding)
        minimum = false;
    if (minimum && !is_inside(mesh, p + 1e-3 * (centre - p))) minima.push_back(p);
  }
  return minima;
}

void expect_brute_force_minima(const TriangleMesh& mesh, double reach, int trials, std::mt19937_64& rng) {
  const MeshContactFinder separate(mesh, 0), merged(mesh);
  for (int i = 0; i < trials; ++i) {
    const Vec3 centre = random_outside_point(mesh, reach, rng);
    const std::vector<MeshTouch> all = touches(separate, centre, reach);
    const std::vector<Vec3> expected = brute_force_minima(mesh, centre, reach);
    ASSERT_EQ(all.size(), expected.size()) << "centre " << centre.transpose();
    double nearest = 1e300;
    for (const MeshTouch& t : all) {
      EXPECT_TRUE(std::ranges::any_of(expected, [&](const Vec3& p) { return (p - t.point).norm() < 1e-12; }));
      EXPECT_NEAR((t.point - centre).norm(), t.distance, 1e-15);
      EXPECT_NEAR((centre + t.distance * t.normal - t.point).norm(), 0, 1e-15);
      nearest = std::min(nearest, t.distance);
    }
    const double global = nearest_distance(mesh, centre);
    if (global < reach) {
      EXPECT_NEAR(nearest, global, 1e-15);
    }

    double nearest_merged = 1e300;
    for (const MeshTouch& t : touches(merged, centre, reach)) nearest_merged = std::min(nearest_merged, t.distance);
    EXPECT_EQ(nearest, nearest_merged) << "merging keeps the nearest";
  }
}

TEST(MeshContact, TheTouchesAreTheLocalMinimaOnRandomHulls) {
  std::mt19937_64 rng(5);
  for (int k = 0; k < 20; ++k) {
    const TriangleMesh hull = random_hull(16, 1e-3, rng);
    ASSERT_NO_THROW(validate_mesh(hull, "hull"));
    expect_brute_force_minima(hull, 2 * radius, 150, rng);
  }
}

TEST(MeshContact, TheTouchesAreTheLocalMinimaInAConcaveBody) {
  std::mt19937_64 rng(6);
  for (const double degrees : {40., 90., 130., 170.})
    expect_brute_force_minima(moved(book(degrees * std::numbers::pi / 180, 2e-3, 2e-3), random_motion(rng, 0.01)),
                              2 * radius, 250, rng);
}

TEST(MeshContact, TheTouchesAreTheLocalMinimaOnTheBlade) {
  std::mt19937_64 rng(7);
  TwistedBlade plate;
  plate.diameter = 23.5e-3;
  plate.shaft_diameter = 0;
  expect_brute_force_minima(make_twisted_blade(plate), 1.2 * radius, 150, rng);
}

TEST(MeshContact, TheNearestTouchIsTheNearestPointOfTheBladeWithItsShaft) {
  std::mt19937_64 rng(8);
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  const TriangleMesh blade = make_twisted_blade(shape);
  const MeshContactFinder finder(blade);
  for (int i = 0; i < 500; ++i) {
    const Vec3 centre = random_outside_point(blade, 1.5 * radius, rng);
    const double expected = nearest_distance(blade, centre);
    double nearest = 1e300;
    for (const MeshTouch& t : touches(finder, centre, 1.5 * radius)) nearest = std::min(nearest, t.distance);
    if (expected < 1.5 * radius) {
      EXPECT_NEAR(nearest, expected, 1e-15) << centre.transpose();
    }
  }
}

TEST(MeshContact, TouchesMoveWithTheBodyAndDoNotDependOnTheOrderOfItsTriangles) {
  std::mt19937_64 rng(9);
  const auto by_place = [](std::vector<MeshTouch> all) {
    std::ranges::sort(all, {}, &MeshTouch::distance);
    return all;
  };
  for (int k = 0; k < 10; ++k) {
    const TriangleMesh mesh = k % 2 == 0 ? random_hull(14, 1e-3, rng) : book(1.9, 2e-3, 2e-3);
    const Eigen::Isometry3d motion = random_motion(rng, 0.03);
    const MeshContactFinder finder(mesh), other(moved(shuffled(mesh, rng), motion));
    for (int i = 0; i < 100; ++i) {
      const Vec3 centre = random_outside_point(mesh, radius, rng);
      const auto expected = by_place(touches(finder, centre)), found = by_place(touches(other, motion * centre));
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t t = 0; t < found.size(); ++t) {
        EXPECT_EQ(found[t].feature, expected[t].feature);
        EXPECT_NEAR(found[t].distance, expected[t].distance, 1e-15);
        EXPECT_NEAR((found[t].point - motion * expected[t].point).norm(), 0, 1e-15);
      }
    }
  }
}

TEST(MeshContact, CandidatesHoldEveryTriangleInReachInOrder) {
  std::mt19937_64 rng(10);
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  const MeshContactFinder finder(make_twisted_blade(shape));
  const TriangleMesh& mesh = finder.mesh();
  std::size_t found = 0, needed = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 centre(uniform(rng, -13e-3, 13e-3), uniform(rng, -4e-3, 4e-3), uniform(rng, -5e-3, 8e-3));
    const double reach = uniform(rng, 0.1e-3, 2e-3);
    std::vector<std::uint32_t> candidates{7};  // what is there stays
    finder.candidate_triangles(centre, reach, candidates);
    ASSERT_EQ(candidates[0], 7U);
    candidates.erase(candidates.begin());
    EXPECT_TRUE(std::ranges::is_sorted(candidates));
    EXPECT_EQ(std::ranges::adjacent_find(candidates), candidates.end());
    found += candidates.size();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if ((nearest_point(mesh, t, centre) - centre).norm() <= reach) {
        ++needed;
        EXPECT_TRUE(std::ranges::binary_search(candidates, t));
      }
  }
  EXPECT_GT(needed, 1000U);
  EXPECT_LT(found, 2 * needed) << "too many candidates cost time in every step";
}

TEST(MeshContact, MoreCandidatesThanNeededChangeNothing) {
  std::mt19937_64 rng(11);
  const MeshContactFinder finder(random_hull(16, 1e-3, rng));
  std::vector<std::uint32_t> all(finder.mesh().triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  for (int i = 0; i < 200; ++i) {
    const Vec3 centre = random_outside_point(finder.mesh(), radius, rng);
    std::vector<MeshTouch> from_all;
    finder.touches(centre, radius, all, from_all);
    const std::vector<MeshTouch> from_few = touches(finder, centre);
    ASSERT_TRUE(same_features(from_all, from_few));
    for (std::size_t t = 0; t < from_all.size(); ++t) EXPECT_EQ(from_all[t].distance, from_few[t].distance);
  }
}

TEST(MeshContact, ThreadsGetTheSameTouches) {
  std::mt19937_64 rng(12);
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  const MeshContactFinder finder(make_twisted_blade(shape));
  std::vector<Vec3> centres;
  for (int i = 0; i < 500; ++i)
    centres.emplace_back(uniform(rng, -12e-3, 12e-3), uniform(rng, -3e-3, 3e-3), uniform(rng, -4e-3, 4e-3));
  const auto checksum = [&] {
    double sum = 0;
    for (const Vec3& c : centres)
      for (const MeshTouch& t : touches(finder, c)) sum += t.distance * (1 + t.feature_id);
    return sum;
  };
  const double expected = checksum();
  std::array<double, 4> results{};
  {
    std::vector<std::jthread> threads;
    for (double& r : results) threads.emplace_back([&] { r = checksum(); });
  }
  EXPECT_GT(expected, 0);
  for (const double r : results) EXPECT_EQ(r, expected);
}

TEST(MeshContact, AnOpenSurfaceIsRefused) {
  TriangleMesh open = box(1e-3, 1e-3, 1e-3);
  open.triangles.pop_back();
  open.labels.pop_back();
  EXPECT_THROW(MeshContactFinder{open}, GeometryError);
}

}  // namespace
}  // namespace dem
