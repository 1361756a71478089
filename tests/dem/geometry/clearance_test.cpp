#include "libdem/geometry/clearance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libdem/errors.hpp"
#include "libdem/geometry/twisted_blade.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const TriangleMesh& mesh, double radius, const AxialPath& path) {
  try {
    require_clearance(blade_clearance(mesh, radius, path), radius);
  } catch (const GeometryError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Clearance, ThePapersBladeKeepsItsGapAndStopsAboveTheFloor) {
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  const TriangleMesh blade = make_twisted_blade(shape);
  const BladeExtent extent = blade_extent(blade);
  // Lower edge at the bed's surface, 52 mm; 21.789 mm/s down for 2 s leave 52 - 43.578 = 8.422 mm.
  const AxialPath path{52e-3 - extent.z_low, -21.789e-3, 2};
  const Clearance c = blade_clearance(blade, 12.5e-3, path);
  EXPECT_NEAR(c.radial, 0.75e-3, 1e-15);
  EXPECT_NEAR(c.floor, 8.422e-3, 1e-12);
  EXPECT_EQ(c.floor_time, 2);
  EXPECT_EQ(refusal(blade, 12.5e-3, path), "accepted");
}

TEST(Clearance, ARisingBladeIsLowestAtTheStart) {
  const Clearance c = blade_clearance(test::box(2e-3, 1e-3, 4e-3), 5e-3, {10e-3, 3e-3, 2});
  EXPECT_NEAR(c.floor, 8e-3, 1e-17);
  EXPECT_EQ(c.floor_time, 0);
  EXPECT_NEAR(c.radial, 5e-3 - std::hypot(1e-3, 0.5e-3), 1e-17);
  EXPECT_NEAR(c.floor_point.z(), -2e-3, 1e-18);
}

TEST(Clearance, TouchingTheWallOrTheFloorIsRefusedWithPointTimeAndDepth) {
  const TriangleMesh box = test::box(6e-3, 8e-3, 4e-3);  // 5 mm from the axis
  EXPECT_EQ(refusal(box, 5.1e-3, {10e-3, 0, 1}), "accepted");
  EXPECT_THAT(refusal(box, 4.5e-3, {10e-3, 0, 1}),
              AllOf(HasSubstr("0.005 m from the axis"), HasSubstr("0.0005 m into the wall"), HasSubstr("t = 0 s"),
                    HasSubstr("0.0045 m")));
  EXPECT_THAT(refusal(box, 6e-3, {10e-3, -5e-3, 2}), AllOf(HasSubstr("t = 2 s"), HasSubstr("0.002 m below the floor")));
  EXPECT_THAT(refusal(box, 6e-3, {1e-3, 5e-3, 2}), HasSubstr("t = 0 s"));
}

TEST(Clearance, NumbersThatMakeNoSenseAreRefused) {
  const TriangleMesh box = test::box(6e-3, 8e-3, 4e-3);
  EXPECT_THAT(refusal({}, 1, {}), HasSubstr("no triangles"));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal(box, bad, {1, 0, 1}), HasSubstr("expected"));
    EXPECT_THAT(refusal(box, 1, {bad, 0, 1}), HasSubstr("expected"));
    EXPECT_THAT(refusal(box, 1, {1, bad, 1}), HasSubstr("expected"));
    EXPECT_THAT(refusal(box, 1, {1, 0, bad}), HasSubstr("expected"));
  }
  EXPECT_THAT(refusal(box, -1, {1, 0, 1}), HasSubstr("expected"));
  EXPECT_THAT(refusal(box, 1, {1, 0, -1}), HasSubstr("expected"));
}

TEST(Clearance, LabelTipsFindsTheTipsOfABladeFromAFile) {
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  const TriangleMesh made = make_twisted_blade(shape);
  TriangleMesh found = made;
  found.labels.clear();
  label_tips(found);
  for (std::size_t t = 0; t < made.triangles.size(); ++t)
    EXPECT_EQ(found.labels[t] == FacetLabel::tip, made.labels[t] == FacetLabel::tip);
}

}  // namespace
}  // namespace dem
