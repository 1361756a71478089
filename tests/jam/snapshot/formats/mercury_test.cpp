#include "libjam/snapshot/formats/mercury.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libjam/errors.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/jam/snapshot/formats/peer_data.hpp"

namespace jam {
namespace {

using namespace jam::test;
using testing::ElementsAre;
using testing::HasSubstr;

ImportMap mercury_map() {
  ImportMap map;
  map.format = "mercury";
  for (const char* name : {"blade", "floor", "vessel"}) {
    ImportWall wall;
    wall.wall.name = name;
    wall.wall.kind = "mesh";
    wall.mesh_id = static_cast<int>(map.walls.size());
    map.walls.push_back(wall);
  }
  return map;
}

std::vector<std::string> files() { return {data_file("mercury/scene.data"), data_file("mercury/scene.fstat")}; }

// The scene of the csv files, made by hand in MercuryDPM's format: particles are numbered 0, 1, 2 instead of 1, 2, 7.
TEST(Mercury, GivesTheSameFramesAsTheCsvFiles) {
  const ImportMap map = mercury_map();
  const SnapshotSource csv = open_source(csv_files()), mercury = open_source(files(), &map);
  ASSERT_EQ(mercury.frames, 2U);
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const Snapshot a = csv.read(frame), b = mercury.read(frame);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.step, b.step);
    EXPECT_THAT(b.particles.id, ElementsAre(0U, 1U, 2U));
    EXPECT_EQ(a.particles.position, b.particles.position);
    EXPECT_EQ(a.particles.radius, b.particles.radius);
    EXPECT_EQ(a.particles.velocity, b.particles.velocity);
    // One contact, though the file lists it from both sides.
    EXPECT_EQ(a.pp.row, b.pp.row);
    EXPECT_EQ(a.pp.normal_force, b.pp.normal_force);
    EXPECT_EQ(a.pp.tangential_force, b.pp.tangential_force);
    EXPECT_EQ(a.pp.overlap, b.pp.overlap);
    EXPECT_EQ(a.pw.row, b.pw.row);
    EXPECT_EQ(a.pw.wall, b.pw.wall);
    EXPECT_EQ(a.pw.normal_force, b.pw.normal_force);
    EXPECT_EQ(a.pw.point, b.pw.point);
    EXPECT_EQ(a.pw.normal, b.pw.normal);
  }
  // The particle slides towards -y; the floor slows it down: the file prints the direction on the wall with the wrong sign.
  EXPECT_EQ(mercury.read(0).pw.tangential_force[2], Vec3f(0.25F, 0, 0));
}

TEST(Mercury, NeedsNoMap) {
  const SnapshotSource source = open_source(files());
  ASSERT_EQ(source.info.walls.size(), 3U);
  EXPECT_EQ(source.info.walls[2].name, "wall_2");
  EXPECT_EQ(source.info.creator, "MercuryDPM");
  EXPECT_EQ(source.read(0).pw.size(), 3U);
}

TEST(Mercury, StepsFollowFromTheTimeStepAndSpeciesAreMaterials) {
  ImportMap map = mercury_map();
  map.dt = 1e-5;
  map.materials = {{{"steel", 7800, 2e11, 0.3}, 1}, {{"glass", 2500, 63e9, 0.2}, 0}};
  const SnapshotSource source = open_source(files(), &map);
  EXPECT_EQ(source.read(1).step, 100U);
  EXPECT_THAT(source.read(0).particles.material, ElementsAre(1, 1, 1));
}

TEST(Mercury, TrianglesThatAreNumberedAsWallsAreOneWall) {
  ImportMap map = mercury_map();
  map.walls.pop_back();
  map.walls[1].mesh_count = 2;  // walls 1 and 2
  const SnapshotSource source = open_source(files(), &map);
  const Snapshot s = source.read(0);
  EXPECT_THAT(s.pw.wall, ElementsAre(0, 1, 1));
  EXPECT_TRUE(s.pw.facet.empty());  // of the blade it is not known
  map.walls.resize(1);
  map.walls[0].mesh_count = 3;
  EXPECT_THAT(open_source(files(), &map).read(0).pw.facet, ElementsAre(0U, 2U, 1U));
}

TEST(Mercury, TwoDimensionalFilesAreRead) {
  const TemporaryFolder folder;
  const std::string data = folder.write("a.data", "2 0.5 0 0 1 1\n0.1 0.2 1 2 0.05 0 7 0\n0.19 0.2 0 0 0.05 0 0 0\n");
  const std::string fstat =
      folder.write("a.fstat", "# 0.5 1\n# 0 0 0 1 1 1\n# 0.05 0.05 0 0 0 0\n0.5 1 0 0.145 0.2 0 0.01 0 3 0 1 0 0 0 0 0\n");
  const Snapshot s = open_source({data, fstat}).read(0);
  EXPECT_EQ(s.particles.position[0], Vec3f(0.1F, 0.2F, 0));
  EXPECT_EQ(s.particles.velocity[0], Vec3f(1, 2, 0));
  EXPECT_EQ(s.particles.angular_velocity[0], Vec3f(0, 0, 7));
  EXPECT_THAT(s.pp.normal_force, ElementsAre(3.0F));  // listed once, from the second particle's side
}

std::string error_of(const TemporaryFolder& folder, const std::string& data, const std::string& fstat) {
  const ImportMap map = mercury_map();
  try {
    const SnapshotSource source = open_source({folder.write("s.data", data), folder.write("s.fstat", fstat)}, &map);
    for (std::size_t k = 0; k < source.frames; ++k) source.read(k);
    return "";
  } catch (const DataError& error) {
    return error.what();
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Mercury, ErrorsNameFileAndLine) {
  const TemporaryFolder folder;
  const std::string data = file_bytes(files()[0]), fstat = file_bytes(files()[1]);
  EXPECT_EQ(error_of(folder, data, fstat), "");
  EXPECT_THAT(error_of(folder, replaced(data, "3 0.001", "4 0.001"), fstat), HasSubstr("s.data:8: the file ends after 3 of 4 particles"));
  EXPECT_THAT(error_of(folder, replaced(data, "3 0.001", "2 0.001"), fstat), HasSubstr("s.data:8: expected the head of a frame"));
  EXPECT_THAT(error_of(folder, replaced(data, "0.1 0 0 0.0005", "x 0 0 0.0005"), fstat),
              HasSubstr("s.data:3: a value of the row is not a finite number"));
  EXPECT_THAT(error_of(folder, replaced(data, "0.0109 0 0.001", "0.0109 0"), fstat),
              HasSubstr("s.data:3: the row has 13 values, expected 14"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "25 1.5 -1", "25 1.5")), HasSubstr("s.fstat:4: the row has 15 values, expected 16"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "0 1 -3", "0 9 -3")),
              HasSubstr("s.fstat:6: the contact names particle 9, which is not among the 3 particles"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "0 1 -3", "0 1 -9")),
              HasSubstr("s.fstat:6: mesh 8.000000 is the mesh_id of no wall of the map"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "0 1 -3", "0 1 -2.5")), HasSubstr("s.fstat:6: i and j are"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "# 0.001 1\n", "")), HasSubstr("s.fstat:11: expected the second and third line"));
  EXPECT_THAT(error_of(folder, data, replaced(fstat, "# 0.001 1", "# 0.003 1")),
              HasSubstr("s.fstat: frame 1 is at time 0.003, that of the particles in"));
  EXPECT_THAT(error_of(folder, "nonsense\n", fstat), HasSubstr("s.data:1: is neither NAME.data"));
}

TEST(Mercury, FilesThatAreCutAnywhereGiveErrorsOrFewerFrames) {
  const TemporaryFolder folder;
  const std::string data = file_bytes(files()[0]), fstat = file_bytes(files()[1]);
  std::size_t errors = 0;
  for (std::size_t length = 0; length < data.size(); ++length) errors += !error_of(folder, data.substr(0, length), fstat).empty();
  EXPECT_GT(errors, data.size() - 40);
  errors = 0;
  for (std::size_t length = 0; length < fstat.size(); ++length) {
    const std::string error = error_of(folder, data, fstat.substr(0, length));
    errors += !error.empty();
    EXPECT_TRUE(error.empty() || error.find("s.fstat") != std::string::npos) << error;
  }
  EXPECT_GT(errors, fstat.size() / 2);  // a file that ends between two contacts is whole to any reader
}

}  // namespace
}  // namespace jam
