#include "libdem/geometry/blade_surface.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "libdem/errors.hpp"
#include "libdem/geometry/stl.hpp"
#include "tests/dem/case/ft4.hpp"

namespace dem {
namespace {

TEST(BladeSurface, OfThePaperLeavesTheGapAndStaysAboveTheFloor) {
  const BladeSurface blade = blade_surface(ft4('a'));
  // Vertices of the tip lie on the tip radius; round-off of one coordinate rotation.
  EXPECT_NEAR(blade.extent.tip_radius, 11.75e-3, 1e-12);
  EXPECT_NEAR(blade.clearance.radial, 0.75e-3, 1e-12);
  EXPECT_NEAR(blade.clearance.floor, 52e-3 - 43.5779e-3, 1e-7);  // six digits of the travel
}

TEST(BladeSurface, FromAFileIsTheSameBlade) {
  Case c = ft4('a');
  const BladeSurface made = blade_surface(c);
  const std::string path = (std::filesystem::temp_directory_path() / "jamscope_blade_surface_test.stl").string();
  write_stl(made.mesh, path);
  c.blade.shape = MeshFile{path, 1};
  const BladeSurface read = blade_surface(c);
  EXPECT_EQ(read.mesh.triangles.size(), made.mesh.triangles.size());
  // Coordinates of 12 mm in 32 bits are good to 1e-9 m.
  EXPECT_NEAR(read.extent.tip_radius, made.extent.tip_radius, 2e-9);
  EXPECT_NEAR(read.extent.z_low, made.extent.z_low, 2e-9);
  // The same file in the wrong unit does not fit.
  c.blade.shape = MeshFile{path, 1.1};
  EXPECT_THROW(blade_surface(c), GeometryError);
  std::filesystem::remove(path);
  EXPECT_THROW(blade_surface(c), GeometryError);
}

TEST(BladeSurface, ThatWouldTouchTheFloorIsRefused) {
  Case c = ft4('a');
  c.blade.start_height = 40e-3;
  EXPECT_THROW(blade_surface(c), GeometryError);
}

}  // namespace
}  // namespace dem
