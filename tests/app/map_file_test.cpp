#include "apps/jamscope/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libdem/errors.hpp"
#include "libjam/snapshot/open_source.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

const std::string data = JAMSCOPE_DATA_DIR;

std::string error_of(const std::string& text) {
  try {
    read_map_text(text, "my.toml");
    return "";
  } catch (const dem::CaseError& error) {
    return error.what();
  }
}

const std::string smallest = R"([source]
format = "lammps"
dt = "1 us"

[particles]
columns = { id = "id", x = "x", y = "y", z = "z", radius = "radius" }
)";

TEST(MapFile, QuantitiesCarryTheirUnits) {
  const jam::ImportMap map = read_map_text(smallest + R"(
[units]
length = "1 mm"
torque = "1 mN m"
[material.glass]
type = 2
density = "2.5 g/cm3"
young = "63 GPa"
[wall.side]
kind = "cylinder"
role = "vessel"
material = "glass"
point = ["0 m", "0 m", "0 m"]
axis = [0, 0, 2]
radius = "12.5 mm"
contacts = "recovered"
[wall.rotor]
kind = "mesh"
role = "blade"
mesh_id = 4
angular_velocity = ["0 rad/s", "0 rad/s", "90 deg/s"]
)",
                                           "my.toml");
  EXPECT_DOUBLE_EQ(map.dt, 1e-6);
  EXPECT_DOUBLE_EQ(map.units.length, 1e-3);
  EXPECT_DOUBLE_EQ(map.units.torque, 1e-3);
  EXPECT_DOUBLE_EQ(map.units.force, 1);
  ASSERT_EQ(map.materials.size(), 1U);
  EXPECT_EQ(map.materials[0].type, 2);
  EXPECT_NEAR(map.materials[0].material.density, 2500, 1e-9);
  ASSERT_EQ(map.walls.size(), 2U);  // in the order of the file
  EXPECT_TRUE(map.walls[0].recover);
  EXPECT_DOUBLE_EQ(map.walls[0].wall.radius, 12.5e-3);
  EXPECT_EQ(map.walls[1].wall.role, jam::WallRole::blade);
  EXPECT_EQ(map.walls[1].mesh_id, 4);
  EXPECT_NEAR(map.walls[1].angular_velocity.z(), std::acos(-1.0) / 2, 1e-12);
}

TEST(MapFile, UnknownKeysAreErrorsThatNameTheirPlaceAndTheNearestKnownKey) {
  EXPECT_EQ(error_of(smallest), "");
  EXPECT_THAT(error_of("[source]\nformat = \"lammps\"\ntd = \"1 us\"\n"),
              HasSubstr("my.toml:3:1: unknown key 'td' in [source]; did you mean 'dt'?"));
  EXPECT_THAT(error_of(smallest + "[unit]\n"), HasSubstr("my.toml:7:2: unknown table 'unit'; did you mean 'units'?"));
  EXPECT_THAT(error_of("[source]\nformat = \"lammps\"\n[particles]\ncolumns = { idd = \"id\" }\n"),
              HasSubstr("unknown key 'idd'"));
  EXPECT_THAT(error_of("[source]\nformat = \"vtk\"\n"), HasSubstr("got 'vtk'"));
  EXPECT_THAT(
      error_of(smallest + "[wall.a]\nkind = \"plane\"\nrole = \"vessel\"\npoint = [\"0 m\"]\nnormal = [0, 0, 1]\n"),
      HasSubstr("'point' wants three components, got 1"));
  EXPECT_THAT(error_of(smallest + "[wall.a]\nkind = \"plane\"\nrole = \"vessel\"\npoint = [\"0 m\", \"0 m\", \"0 "
                                  "m\"]\nnormal = [0, \"0\", 1]\n"),
              HasSubstr("'normal' wants a list of plain numbers"));
  EXPECT_THAT(error_of(smallest + "[wall.a]\nkind = \"mesh\"\nrole = \"blade\"\nmaterial = "
                                  "\"glas\"\n[material.glass]\ndensity = \"1 kg/m3\"\n"),
              HasSubstr("unknown material 'glas'; did you mean 'glass'?"));
  EXPECT_THAT(
      error_of(smallest + "[wall.a]\nkind = \"mesh\"\nrole = \"blade\"\nmesh = \"none.stl\"\nmesh_unit = \"mm\"\n"),
      HasSubstr("none.stl"));
  EXPECT_THAT(error_of(smallest + "[wall_loads]\nwall = \"bladd\"\n[wall.blade]\nkind = \"mesh\"\nrole = \"blade\"\n"),
              HasSubstr("unknown wall 'bladd'"));
}

TEST(MapFile, TheShippedMapsReadTheShippedDumps) {
  const std::string formats = data + "/formats/";
  const jam::ImportMap liggghts = read_map_file(data + "/maps/liggghts.toml");
  // The order of the files does not matter.
  const jam::SnapshotSource a =
      jam::open_source({formats + "liggghts.wall.local.xz", formats + "liggghts.blade.txt.xz",
                        formats + "liggghts.particles.dump.xz", formats + "liggghts.pair.local.xz"},
                       &liggghts);
  ASSERT_EQ(a.frames, 4U);
  EXPECT_EQ(a.series.size(), 90U);
  EXPECT_TRUE(a.info.wall_loads_known);
  EXPECT_NEAR(a.info.gap.tip_radius, 11.75e-3, 1e-8);  // measured on the mesh
  EXPECT_DOUBLE_EQ(a.info.gap.vessel_radius, 12.5e-3);
  ASSERT_EQ(a.info.walls.size(), 3U);
  EXPECT_EQ(a.info.walls[2].triangles.size(), 196U);
  const jam::Snapshot s = a.read(2);
  EXPECT_NEAR(s.time, 0.016, 1e-12);
  EXPECT_GT(*std::max_element(s.pw.normal_force.begin(), s.pw.normal_force.end()),
            790.0F);  // the run's largest, 790.695 N

  const jam::ImportMap lammps = read_map_file(data + "/maps/lammps.toml");
  const jam::SnapshotSource b = jam::open_source(
      {formats + "lammps.pair.local.xz", formats + "lammps.wall.dump.xz", formats + "lammps.particles.dump.xz"},
      &lammps);
  EXPECT_EQ(b.frames, 2U);
  EXPECT_EQ(b.info.walls.size(), 4U);
  EXPECT_EQ(b.read(0).walls.size(), 4U);
}

}  // namespace
}  // namespace jamscope
