#include "libdem/geometry/twisted_blade.hpp"

#include <gtest/gtest.h>

#include "libdem/errors.hpp"
#include "libdem/geometry/mesh_contact.hpp"
#include "libdem/geometry/validate_mesh.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using namespace test;

constexpr double degree = std::numbers::pi / 180;

TwistedBlade paper_blade() {
  TwistedBlade blade;
  blade.diameter = 23.5e-3;
  return blade;
}

double volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const auto& t : mesh.triangles) v += mesh.vertices[t[0]].cross(mesh.vertices[t[1]]).dot(mesh.vertices[t[2]]) / 6;
  return v;
}

Vec3 centroid(const TriangleMesh& mesh, std::size_t t) {
  return (mesh.vertices[mesh.triangles[t][0]] + mesh.vertices[mesh.triangles[t][1]] +
          mesh.vertices[mesh.triangles[t][2]]) /
         3;
}

Vec3 area_normal(const TriangleMesh& mesh, std::size_t t) {
  const Vec3& a = mesh.vertices[mesh.triangles[t][0]];
  return (mesh.vertices[mesh.triangles[t][1]] - a).cross(mesh.vertices[mesh.triangles[t][2]] - a) / 2;
}

TEST(TwistedBlade, EveryShapeIsAValidClosedSurface) {
  for (const double twist : {-80., -30., 0., 15., 45.})
    for (const double shaft : {0., 5e-3})
      for (const auto cut : {TwistedBlade::TipCut::cylindrical, TwistedBlade::TipCut::flat}) {
        TwistedBlade blade = paper_blade();
        blade.tip_twist = twist * degree;
        blade.shaft_diameter = shaft;
        blade.tip_cut = cut;
        const TriangleMesh mesh = make_twisted_blade(blade);
        EXPECT_NO_THROW(validate_mesh(mesh, "blade")) << twist << ' ' << shaft;
        EXPECT_LT(mesh.triangles.size(), 9000U);
        EXPECT_EQ(mesh.labels.size(), mesh.triangles.size());
      }
}

TEST(TwistedBlade, OtherProportionsAreValidToo) {
  std::mt19937_64 rng(1);
  for (int i = 0; i < 12; ++i) {
    TwistedBlade blade;
    blade.diameter = uniform(rng, 10e-3, 60e-3);
    blade.height = uniform(rng, 0.1, 0.5) * blade.diameter;
    blade.thickness = uniform(rng, 0.03, 0.5) * blade.height;
    blade.tip_twist = uniform(rng, -70, 70) * degree;
    blade.twist_exponent = uniform(rng, 0.5, 3);
    blade.shaft_diameter = uniform(rng, 0.1, 0.5) * blade.diameter;
    blade.shaft_length = blade.height * uniform(rng, 0.7, 10);
    EXPECT_NO_THROW(validate_mesh(make_twisted_blade(blade), "blade " + std::to_string(i)));
  }
}

TEST(TwistedBlade, AnUntwistedPlateIsAPlate) {
  TwistedBlade blade = paper_blade();
  blade.tip_twist = 0;
  blade.shaft_diameter = 0;
  blade.tip_cut = TwistedBlade::TipCut::flat;
  const TriangleMesh mesh = make_twisted_blade(blade);
  // A flat cut lets only the corners reach the tip radius: half length sqrt(R^2 - (t/2)^2).
  const double half_length = std::sqrt(std::pow(11.75e-3, 2) - std::pow(0.75e-3, 2));
  EXPECT_NEAR(volume(mesh), 2 * half_length * blade.height * blade.thickness, 1e-12 * volume(mesh));
  for (const Vec3& p : mesh.vertices) {
    EXPECT_LE(std::abs(p.x()), half_length + 1e-15);
    EXPECT_LE(std::abs(p.y()), 0.75e-3 + 1e-15);
    EXPECT_LE(std::abs(p.z()), 3e-3 + 1e-15);
  }
}

TEST(TwistedBlade, TheTipSurfaceIsCoaxialWithTheVessel) {
  const TriangleMesh mesh = make_twisted_blade(paper_blade());
  double area = 0, deepest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.labels[t] != FacetLabel::tip) continue;
    area += area_normal(mesh, t).norm();
    EXPECT_GT(area_normal(mesh, t).dot(Vec3(centroid(mesh, t).x(), centroid(mesh, t).y(), 0)), 0);
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.vertices[mesh.triangles[t][k]], &b = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
      EXPECT_NEAR(std::hypot(a.x(), a.y()), 11.75e-3, 1e-17);
      deepest = std::max(deepest, 11.75e-3 - ((a + b) / 2).head<2>().norm());
    }
  }
  EXPECT_LT(deepest, 11.75e-3 / 4000);
  EXPECT_LT(deepest, 5e-6) << "1 % of the 0.75 mm gap";
  // Two tips of height x thickness, bent by at most 12 degrees.
  EXPECT_NEAR(area, 2 * 6e-3 * 1.5e-3, 0.02 * area);
  const BladeExtent extent = blade_extent(mesh);
  EXPECT_NEAR(extent.tip_radius, 11.75e-3, 1e-17);
}

TEST(TwistedBlade, OnlyTheCornersOfAFlatTipReachTheTipRadius) {
  TwistedBlade blade = paper_blade();
  blade.tip_cut = TwistedBlade::TipCut::flat;
  const TriangleMesh mesh = make_twisted_blade(blade);
  EXPECT_NEAR(blade_extent(mesh).tip_radius, 11.75e-3, 1e-17);
  std::size_t at_radius = 0;
  for (const Vec3& p : mesh.vertices) at_radius += std::abs(std::hypot(p.x(), p.y()) - 11.75e-3) < 1e-12;
  EXPECT_EQ(at_radius, 4U);  // two of each arm
}

TEST(TwistedBlade, TheSectionTurnsAsTheTwistLawSays) {
  TwistedBlade blade = paper_blade();
  blade.shaft_diameter = 0;
  for (const double exponent : {0.7, 1., 2.}) {
    blade.twist_exponent = exponent;
    const MeshContactFinder finder(make_twisted_blade(blade));
    std::vector<std::uint32_t> candidates;
    std::vector<MeshTouch> touches;
    for (const double u : {0.1, 0.25, 0.5, 0.75, 0.95}) {
      // The middle line of the leading face at radius u R: half a thickness from the axis of the arm, along (0, cos,
      // -sin).
      const double beta = blade.tip_twist * std::pow(u, exponent);
      const Vec3 forward(0, std::cos(beta), -std::sin(beta));
      const Vec3 on_face = Vec3(u * 11.75e-3, 0, 0) + forward * blade.thickness / 2;
      candidates.clear();
      finder.candidate_triangles(on_face + 0.2e-3 * forward, 0.3e-3, candidates);
      finder.touches(on_face + 0.2e-3 * forward, 0.3e-3, candidates, touches);
      ASSERT_EQ(touches.size(), 1U);
      EXPECT_EQ(finder.mesh().labels[touches[0].facet], FacetLabel::face);
      // Facets are flat over 1.5 degrees of twist: 0.01 of thickness; the curved fibre tip shortens the arm by 0.2 %.
      // The face also leans along the arm by thickness / 2 * d beta / dx, at most 3 degrees for these exponents but at
      // u = 0.1.
      EXPECT_NEAR(touches[0].distance, 0.2e-3, 0.02e-3) << u << ' ' << exponent;
      EXPECT_NEAR(std::asin(touches[0].normal.z()), beta, 3 * degree) << u << ' ' << exponent;
    }
  }
}

TEST(TwistedBlade, PositiveTwistPushesGrainsDownWhenTurningCounterClockwise) {
  for (const double sign : {1., -1.}) {
    TwistedBlade blade = paper_blade();
    blade.tip_twist = sign * 30 * degree;
    const TriangleMesh mesh = make_twisted_blade(blade);
    Vec3 leading = Vec3::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.labels[t] != FacetLabel::face) continue;
      const Vec3 velocity = Vec3::UnitZ().cross(centroid(mesh, t)), normal = area_normal(mesh, t);
      if (normal.dot(velocity) > 0) leading += normal;
    }
    EXPECT_LT(sign * leading.z(), 0)
        << "the outward normal of the leading faces has the sign of minus the twist along z";
    EXPECT_GT(std::abs(leading.z()), 0.1 * 2 * 9e-3 * 6e-3);
  }
}

TEST(TwistedBlade, AHalfTurnMapsTheBladeOntoItself) {
  const TriangleMesh mesh = make_twisted_blade(paper_blade());
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 3) {
    const Vec3 p = mesh.vertices[v];
    EXPECT_LT(nearest_distance(mesh, Vec3(-p.x(), -p.y(), p.z())), 1e-12);
  }
}

TEST(TwistedBlade, TheOppositeTwistIsTheMirrorImage) {
  TwistedBlade blade = paper_blade();
  blade.shaft_diameter = 0;  // the prism of the shaft is turned a little, the plate is not
  const TriangleMesh right = make_twisted_blade(blade);
  blade.tip_twist = -blade.tip_twist;
  const TriangleMesh left = make_twisted_blade(blade);
  EXPECT_NEAR(volume(left), volume(right), 1e-12 * volume(right));
  for (const Vec3& p : left.vertices) {
    const Vec3 mirrored(p.x(), -p.y(), p.z());
    EXPECT_TRUE(std::ranges::any_of(right.vertices, [&](const Vec3& q) { return (q - mirrored).norm() < 1e-15; }));
  }
}

TEST(TwistedBlade, LabelsSayWhichPartATriangleBelongsTo) {
  const TriangleMesh mesh = make_twisted_blade(paper_blade());
  std::array<double, 4> area{};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    area[static_cast<std::size_t>(mesh.labels[t])] += area_normal(mesh, t).norm();
    const Vec3 c = centroid(mesh, t);
    const double r = std::hypot(c.x(), c.y());
    if (mesh.labels[t] == FacetLabel::hub) {
      EXPECT_LE(r, 2.5e-3 * (1 + 1e-12));
    } else {
      // The shaft ends h / 20 above the lower edge, so the plate shows below it.
      if (c.z() > -2.7e-3) {
        EXPECT_GT(r, 2.5e-3 * std::cos(std::numbers::pi / 36) * (1 - 1e-9));
      }
      EXPECT_LE(std::abs(c.z()), 3.1e-3);
    }
  }
  // Plate outside the shaft: two arms of 9.25 mm with two faces (6 mm) and two thin sides (1.5 mm) each, the lower one
  // also below the shaft (5 mm); twisting stretches.
  EXPECT_NEAR(area[0], 4 * 9.25e-3 * 6e-3, 0.05 * area[0]);
  EXPECT_NEAR(area[1], (4 * 9.25e-3 + 5e-3) * 1.5e-3, 0.05 * area[1]);
  EXPECT_GT(area[3], 0.9 * 2 * std::numbers::pi * 2.5e-3 * 57e-3);
}

TEST(TwistedBlade, TheShaftReachesAsHighAsAsked) {
  TwistedBlade blade = paper_blade();
  const auto top = [](const TriangleMesh& mesh) {
    double z = -1;
    for (const Vec3& p : mesh.vertices) z = std::max(z, p.z());
    return z;
  };
  EXPECT_DOUBLE_EQ(top(make_twisted_blade(blade)), 60e-3);
  blade.shaft_length = 25e-3;
  const TriangleMesh mesh = make_twisted_blade(blade);
  EXPECT_DOUBLE_EQ(top(mesh), 25e-3);
  // The extent is that of the plate: h/2 cos 30 + t/2 sin 30 at the tip's corners, h/2 on the axis, more in between.
  const BladeExtent extent = blade_extent(mesh);
  EXPECT_GT(extent.z_high, 3e-3 * std::cos(30 * degree) + 0.75e-3 * std::sin(30 * degree));
  EXPECT_LE(extent.z_high, std::hypot(3e-3, 0.75e-3));
  EXPECT_NEAR(extent.z_low, -extent.z_high, 1e-15);
}

TEST(TwistedBlade, TheSameParametersGiveTheSameMesh) {
  const TriangleMesh a = make_twisted_blade(paper_blade()), b = make_twisted_blade(paper_blade());
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.labels, b.labels);
}

TEST(TwistedBlade, ImpossibleShapesAreRefusedWithValueAndBound) {
  const auto message = [](auto change) {
    TwistedBlade blade = paper_blade();
    change(blade);
    try {
      make_twisted_blade(blade);
    } catch (const GeometryError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const double nan = std::nan("");
  EXPECT_EQ(message([](TwistedBlade& b) { b.diameter = -1e-3; }),
            "blade: diameter = -0.001 m; expected a positive length below 10 m");
  EXPECT_NE(message([&](TwistedBlade& b) { b.diameter = nan; }).find("diameter = nan"), std::string::npos);
  EXPECT_NE(message([&](TwistedBlade& b) { b.height = nan; }).find("height = nan"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.height = 24e-3; }).find("0.02115 m"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.thickness = 7e-3; }).find("thickness = 0.007 m"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.thickness = 1e-9; }).find("thickness"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.tip_twist = 1.5; }).find("tip_twist = 1.5 rad"), std::string::npos);
  EXPECT_NE(message([&](TwistedBlade& b) { b.tip_twist = nan; }).find("tip_twist = nan"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.twist_exponent = 0; }).find("twist_exponent = 0"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.shaft_diameter = 20e-3; }).find("shaft_diameter = 0.02 m"),
            std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.shaft_diameter = -1; }).find("shaft_diameter = -1 m"), std::string::npos);
  EXPECT_NE(message([](TwistedBlade& b) { b.shaft_length = 1e-3; }).find("shaft_length = 0.001 m"), std::string::npos);
}

}  // namespace
}  // namespace dem
