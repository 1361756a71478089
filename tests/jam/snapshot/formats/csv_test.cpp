#include "libjam/snapshot/formats/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "libjam/errors.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/jam/snapshot/formats/peer_data.hpp"

namespace jam {
namespace {

using namespace jam::test;
using testing::ElementsAre;
using testing::HasSubstr;

// 1e-7: the snapshot is float32.
void expect_same(const Snapshot& a, const Snapshot& b) {
  ASSERT_EQ(a.particles.id, b.particles.id);
  ASSERT_EQ(a.pp.row, b.pp.row);
  ASSERT_EQ(a.pw.row, b.pw.row);
  for (std::size_t i = 0; i < a.particles.size(); ++i) {
    EXPECT_EQ(a.particles.position[i], b.particles.position[i]);
    EXPECT_EQ(a.particles.radius[i], b.particles.radius[i]);
  }
  for (std::size_t c = 0; c < a.pp.size(); ++c) {
    EXPECT_NEAR(a.pp.normal_force[c], b.pp.normal_force[c], 2e-7 * 25);
    EXPECT_LT((a.pp.tangential_force[c] - b.pp.tangential_force[c]).norm(), 2e-7 * 25);
    EXPECT_NEAR(a.pp.overlap[c], b.pp.overlap[c], 1e-11);
  }
  EXPECT_EQ(a.pw.wall, b.pw.wall);
  for (std::size_t c = 0; c < a.pw.size(); ++c) {
    EXPECT_NEAR(a.pw.normal_force[c], b.pw.normal_force[c], 2e-7 * 26);
    EXPECT_LT((a.pw.normal[c] - b.pw.normal[c]).norm(), 1e-6);
    EXPECT_LT((a.pw.point[c] - b.pw.point[c]).norm(), 1e-9);
  }
}

TEST(Csv, ThreeFilesWithTheFixedHeadersNeedNoMap) {
  const SnapshotSource source = open_source(csv_files());
  ASSERT_EQ(source.frames, 2U);
  // Walls in the order of their names, roles from them.
  ASSERT_EQ(source.info.walls.size(), 3U);
  EXPECT_EQ(source.info.walls[0].name, "blade");
  EXPECT_EQ(source.info.walls[0].role, WallRole::blade);
  EXPECT_EQ(source.info.walls[1].name, "floor");
  EXPECT_EQ(source.info.walls[1].role, WallRole::other);
  EXPECT_EQ(source.info.walls[2].name, "vessel");
  EXPECT_EQ(source.info.walls[2].role, WallRole::vessel);

  const Snapshot first = source.read(0);
  EXPECT_EQ(first.time, 0);
  EXPECT_THAT(first.particles.id, ElementsAre(1U, 2U, 7U));
  EXPECT_FLOAT_EQ(first.particles.velocity[1].x(), 0.1F);
  EXPECT_TRUE(first.particles.angular_velocity.empty());  // not known, so absent
  ASSERT_EQ(first.pp.size(), 1U);
  EXPECT_EQ(first.pp.row[0], (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_FLOAT_EQ(first.pp.normal_force[0], 25);
  // The file gives the force on particle 2 (its id1); the snapshot that on the smaller row, particle 1.
  EXPECT_FLOAT_EQ(first.pp.tangential_force[0].z(), -1.5F);
  ASSERT_EQ(first.pw.size(), 3U);
  EXPECT_THAT(first.pw.row, ElementsAre(0U, 1U, 2U));
  EXPECT_THAT(first.pw.wall, ElementsAre(0, 2, 1));

  const Snapshot second = source.read(1);
  EXPECT_EQ(second.time, 0.001);
  EXPECT_EQ(second.step, 1U);
  EXPECT_EQ(second.pw.size(), 0U);  // a frame without rows has no contacts
  EXPECT_EQ(second.pp.size(), 1U);
}

TEST(Csv, FramesMayBeReadInAnyOrderAndAgain) {
  const SnapshotSource source = open_source(csv_files());
  const Snapshot second = source.read(1), first = source.read(0), again = source.read(1);
  EXPECT_EQ(first.step, 0U);
  expect_same(second, again);
  EXPECT_THROW(source.read(2), DataError);
}

TEST(Csv, TheOrderAndTheCompressionOfTheFilesDoNotMatter) {
  const SnapshotSource plain = open_source(csv_files());
  const SnapshotSource mixed = open_source(
      {data_file("csv/wall_contacts.csv.xz"), data_file("csv/contacts.csv.gz"), data_file("csv/particles.csv.gz")});
  for (std::size_t frame = 0; frame < 2; ++frame) expect_same(plain.read(frame), mixed.read(frame));
}

TEST(Csv, RowsInAnyOrderGiveTheSameSnapshot) {
  const TemporaryFolder folder;
  auto files = csv_files();
  files[1] = folder.write(
      "contacts.csv", "frame,fn,id1,id2,ft_x,ft_y,ft_z,overlap\r\n0,25,1,2,0,0,-1.5,1e-4\r\n1,2,2,1,0,0,0,1e-5\r\n");
  files[2] = folder.write("walls.csv",
                          "frame,id,wall,fn,px,py,pz,nx,ny,nz\n0,7,floor,0.5,0.0100,0.0015,0,0,0,-1\n"
                          "0,1,blade,26,0.0095,0,0.0010,-1,0,0\n0,2,\"vessel\",24,0.0114,0,0.0010,1,0,0\n");
  const SnapshotSource a = open_source(csv_files()), b = open_source(files);
  for (std::size_t frame = 0; frame < 2; ++frame) expect_same(a.read(frame), b.read(frame));
}

TEST(Csv, WallsGetTheirRolesFromTheirNames) {
  EXPECT_EQ(role_from_name("FT4_Blade"), WallRole::blade);
  EXPECT_EQ(role_from_name("Geometry 2"), WallRole::blade);
  EXPECT_EQ(role_from_name("Vessel"), WallRole::vessel);
  EXPECT_EQ(role_from_name("side wall"), WallRole::vessel);
  EXPECT_EQ(role_from_name("blade wall"), WallRole::blade);
  EXPECT_EQ(role_from_name("floor"), WallRole::other);
}

// The scene of the csv files as a LAMMPS dump: particles, pairs and a listed wall with vectors instead of numbers.
TEST(Formats, TheSameSceneGivesTheSameSnapshotInEveryFormat) {
  const TemporaryFolder folder;
  const std::string box = "ITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n";
  const auto header = [&](int step, const char* what, int rows, const char* columns) {
    std::ostringstream text;
    text << "ITEM: TIMESTEP\n" << step << "\nITEM: NUMBER OF ATOMS\n" << rows << "\n" << box;
    text << "ITEM: " << what << " " << columns << "\n";
    return text.str();
  };
  // In mm and mN; the map's units must undo that.
  const std::string particles = header(0, "ATOMS", 3, "id x y z radius vx vy vz ") +
                                "7 10.0 1.5 0.4 0.4 0 0 -0.1\n1 10.0 0 1.0 0.5 0 0 0\n2 10.9 0 1.0 0.5 0.1 0 0 \n" +
                                header(1, "ATOMS", 3, "id x y z radius vx vy vz ") +
                                "7 10.0 1.5 0.4 0.4 0 0 0\n1 10.0 0 1.0 0.5 0 0 0\n2 10.99 0 1.0 0.5 0 0 0\n";
  const std::string pairs = header(0, "ENTRIES", 1, "a b f1 f2 f3 t1 t2 t3 d") + "1 2 -25000 0 0 0 0 -1500 0.1\n" +
                            header(1, "ENTRIES", 1, "a b f1 f2 f3 t1 t2 t3 d") + "2 1 2000 0 0 0 0 0 0.01\n";
  const std::string walls = header(0, "ENTRIES", 3, "n m f1 f2 f3 x1 x2 x3") +
                            "2 12 -24000 0 0 11.4 0 1.0\n1 10 26000 0 0 9.5 0 1.0\n7 11 0 0 500 10.0 1.5 0\n" +
                            header(1, "ENTRIES", 0, "n m f1 f2 f3 x1 x2 x3");
  ImportMap map;
  map.dt = 1e-3;
  map.units.length = map.units.force = 1e-3;
  map.particles.columns = {{"id", "id"},         {"x", "x"},   {"y", "y"},   {"z", "z"},
                           {"radius", "radius"}, {"vx", "vx"}, {"vy", "vy"}, {"vz", "vz"}};
  map.pair_contacts.columns = {{"id1", "a"},   {"id2", "b"},   {"fn_x", "f1"}, {"fn_y", "f2"},  {"fn_z", "f3"},
                               {"ft_x", "t1"}, {"ft_y", "t2"}, {"ft_z", "t3"}, {"overlap", "d"}};
  map.wall_contacts.columns = {{"id", "n"},    {"mesh", "m"}, {"fn_x", "f1"}, {"fn_y", "f2"},
                               {"fn_z", "f3"}, {"px", "x1"},  {"py", "x2"},   {"pz", "x3"}};
  for (const char* name : {"blade", "floor", "vessel"}) {
    ImportWall wall;
    wall.wall.name = name;
    wall.wall.kind = "mesh";
    wall.wall.role = role_from_name(name);
    wall.mesh_id = 10 + static_cast<int>(map.walls.size());
    map.walls.push_back(wall);
  }
  const SnapshotSource csv = open_source(csv_files());
  const SnapshotSource dump =
      open_source({folder.write("w", walls), folder.write("p", particles), folder.write("c", pairs)}, &map);
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const Snapshot a = csv.read(frame), b = dump.read(frame);
    EXPECT_DOUBLE_EQ(a.time, b.time);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.particles.velocity, b.particles.velocity);
    expect_same(a, b);
  }

  // The same as one file a frame.
  const std::size_t cut = particles.find("ITEM: TIMESTEP", 1);
  const SnapshotSource split =
      open_source({folder.write("p1", particles.substr(cut)), folder.write("p0", particles.substr(0, cut)),
                   folder.write("w", walls), folder.write("c", pairs)},
                  &map);
  for (std::size_t frame = 0; frame < 2; ++frame) expect_same(csv.read(frame), split.read(frame));
}

TEST(Csv, AMapNamesOtherColumnsAndAddsGeometry) {
  const TemporaryFolder folder;
  ImportMap map;
  map.format = "csv";
  map.wall_contacts.columns = {{"frame", "step"}, {"id", "grain"}, {"wall", "body"}, {"fn", "N"}};
  ImportWall floor;
  floor.wall.name = "ground";
  floor.wall.kind = "plane";
  floor.source_name = "G";
  map.walls = {floor};
  const SnapshotSource source =
      open_source({csv_files()[0], csv_files()[1], folder.write("w.csv", "N,body,grain,step\n0.5,G,7,0\n")}, &map);
  const Snapshot s = source.read(0);
  ASSERT_EQ(s.pw.size(), 1U);
  // From the plane's equation: grain 7 lies on z = 0.
  EXPECT_LT((s.pw.normal[0] - Vec3f(0, 0, -1)).norm(), 1e-6F);
  EXPECT_LT((s.pw.point[0] - Vec3f(0.01F, 0.0015F, 0)).norm(), 1e-8F);
  EXPECT_NEAR(s.pw.overlap[0], 0, 1e-9);
}

void expect_error(const std::vector<std::string>& files, const std::vector<std::string>& parts) {
  try {
    const SnapshotSource source = open_source(files);
    for (std::size_t frame = 0; frame < source.frames; ++frame) source.read(frame);
    FAIL() << "no error, expected one with: " << parts.front();
  } catch (const DataError& error) {
    for (const std::string& part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
  }
}

TEST(Csv, ErrorsNameFileLineValueAndWhatWasExpected) {
  const TemporaryFolder folder;
  const auto files = csv_files();
  const std::string head = "frame,time,id,x,y,z,radius\n";
  const auto with_particles = [&](const std::string& rows) {
    return std::vector<std::string>{folder.write("p.csv", head + rows)};
  };
  expect_error(with_particles("0,0,1,0,0,nan,1\n"), {"p.csv:2", "'z'", "'nan'", "finite number"});
  expect_error(with_particles("0,0,1,0,0,1e99,1\n"), {"p.csv:2", "'1e99'", "finite number"});
  expect_error(with_particles("0,0,1,0,0,0,1\n0,0,1,0,0,2,1\n"), {"p.csv:3", "particle 1", "twice"});
  expect_error(with_particles("0,0,1,0,0,0\n"), {"p.csv:2", "6 values, expected 7"});
  expect_error(with_particles("0,0,1.5,0,0,0,1\n"), {"p.csv:2", "1.5", "whole number"});
  expect_error(with_particles("0,0,-1,0,0,0,1\n"), {"p.csv:2", "whole number"});
  expect_error(with_particles("0,0,1,0,0,0,-1\n"), {"p.csv:2", "radius", "expected > 0"});
  expect_error(with_particles("0,0,1,0,0,0,1\n0,0.5,2,0,0,0,1\n"), {"p.csv:3", "time differs"});
  expect_error(with_particles("1,0,1,0,0,0,1\n0,1,1,0,0,0,1\n"), {"p.csv:3", "step 0 comes after step 1"});
  expect_error(with_particles("0,1,1,0,0,0,1\n1,1,1,0,0,0,1\n"), {"p.csv", "step 1", "not later"});
  expect_error(with_particles("\n0,0,1,0,0,0,1\n"), {"p.csv:3", "blank"});
  expect_error(with_particles(""), {"p.csv", "no frame of particles"});
  expect_error({with_particles("5,0,1,0,0,0,1\n")[0], files[1]}, {"contacts.csv", "has step 0", "p.csv have not"});
  expect_error({folder.write("p.csv", "frame,time,id,x,y,radius\n"), files[1]},
               {"p.csv:1", "lacks z", "columns are: frame, time"});
  expect_error({files[1], files[2]}, {"none of the inputs holds particles"});
  expect_error({files[0], files[0]}, {"second table of particles"});

  const auto with_contacts = [&](const std::string& rows) {
    return std::vector<std::string>{files[0], folder.write("c.csv", "frame,id1,id2,fn\n" + rows), files[2]};
  };
  expect_error(with_contacts("0,1,9,1\n"), {"c.csv:2", "particle 9", "not among the 3"});
  expect_error(with_contacts("0,1,1,1\n"), {"c.csv:2", "touches itself"});
  expect_error(with_contacts("0,1,2,1\n0,2,1,1\n"), {"c.csv:3", "1 and 2", "twice"});
  expect_error(with_contacts("0,1,2,\n"), {"c.csv:2", "'fn'", "''"});

  const auto with_walls = [&](const std::string& rows) {
    return std::vector<std::string>{files[0], files[1], folder.write("w.csv", "frame,id,wall,fn,nx,ny,nz\n" + rows)};
  };
  expect_error(with_walls("0,1,blade,1,0,0,2\n"), {"w.csv:2", "normal has length 2"});
  expect_error(with_walls("0,1,,1,0,0,1\n"), {"w.csv:2", "name of the wall is empty"});
  expect_error(with_walls("0,8,blade,1,0,0,1\n"), {"w.csv:2", "particle 8"});
}

}  // namespace
}  // namespace jam
