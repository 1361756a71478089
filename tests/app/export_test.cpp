#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/jamscope/map_file.hpp"
#include "libjam/snapshot/export/export_formats.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

const std::string data = JAMSCOPE_DATA_DIR;
const std::string pea = data + "/reference/networks/pea.h5";  // three frames with contacts, walls and a case

TEST(ExportCommand, DumpsAndTablesHaveTheEventsOfTheirSource) {
  const Scratch scratch;
  const std::string set = " --set jam_force='2 mN' -q";
  ASSERT_EQ(run_program("analyze " + pea + " -o " + scratch / "source" + set).code, 0);
  const std::string events = text_of(scratch / "source/events.csv");
  ASSERT_GT(std::count(events.begin(), events.end(), '\n'), 3);
  for (const auto& [format, files] : {std::pair{"lammps", "*.dump"}, {"csv", "*.csv"}}) {
    const std::string folder = scratch / format;
    const Outcome outcome = run_program("export " + pea + " --to " + format + " -o " + folder);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("3 frames in " + folder));
    const Outcome back = run_program("analyze " + folder + "/" + files + " --map " + folder + "/map.toml -o " + folder + "_back" + set);
    ASSERT_EQ(back.code, 0) << back.err;
    EXPECT_EQ(text_of(folder + "_back/events.csv"), events) << format;
  }
}

// What write_map_file writes is read as what it was: walls of all kinds with all digits, materials, the case.
TEST(ExportCommand, AMapThatIsWrittenIsReadAsTheSame) {
  jam::ImportMap map;
  map.format = "lammps";
  map.creator = "a \"creator\" \\ of\nlines";
  map.dt = 1.0 / 3e7;
  map.gravity = {0.1, -0.2, -9.80665};
  map.one_record_a_touch = true;
  map.case_toml = "[analysis]\njam_force = \"3 N\"\n";
  map.particles.columns = {{"id", "id"}, {"x", "x [m]"}, {"y", "y"}, {"z", "z"}, {"radius", "r"}};
  map.wall_states.columns = {{"mesh", "wall"}};
  map.materials = {{{"hard-glass", 2500, 63e9, 0.2}, 1}, {{"steel", 1.0 / 3, 2.1e11, 0.3}, 2}};
  map.interactions = {{{0.9, 0.5, 0.01, 0.274}, {0.1, 0.2, 0.3, 1.0 / 7}}, {{0.1, 0.2, 0.3, 1.0 / 7}, {0, 0, 0, 0}}};
  map.gap = {0.0235, 0.025, -0.003, 1.0 / 300};
  const auto add = [&](const char* name, const char* kind) -> jam::Wall& {
    jam::ImportWall& wall = map.walls.emplace_back();
    wall.wall.name = name;
    wall.wall.kind = kind;
    wall.wall.material = "hard-glass";
    wall.wall.role = jam::WallRole::vessel;
    wall.wall.point = {1.0 / 3, -2e-9, 0};
    wall.wall.axis = jam::Vec3(1, 2, 3).normalized();
    wall.mesh_id = static_cast<int>(map.walls.size()) - 1;
    return wall.wall;
  };
  add("a floor", "plane");
  jam::Wall& side = add("side \"1\"", "cylinder");
  side.radius = 0.0125;
  side.low = -1.0 / 3;
  side.free_side = "inside";
  jam::Wall& cone = add("cone", "cone");
  cone.radius = 0;
  cone.high_radius = 0.1;
  cone.low = 0;
  cone.high = 0.7;
  jam::Wall& lid = add("lid", "disc");
  lid.radius = 0.5;
  lid.hole_radius = 0.1;
  jam::Wall& plate = add("rough/plate", "spheres");
  plate.sphere_centre = {{1.0 / 3, 0, 0}, {0, 1.0 / 7, 2e-20}};
  plate.sphere_radius = {1.0 / 9, 2};
  jam::Wall& blade = add("blade", "mesh");
  blade.role = jam::WallRole::blade;
  blade.vertices = {{1.0 / 3, 0, 0}, {0, 1.0 / 7, 0}, {0, 0, 1.0 / 9}, {-0.1, -0.1, -0.1}};
  blade.triangles = {{0, 1, 2}, {0, 3, 1}};

  const Scratch scratch;
  write_map_file(map, scratch / "map.toml", "a test");
  const jam::ImportMap got = read_map_file(scratch / "map.toml");
  EXPECT_EQ(got.creator, map.creator);
  EXPECT_EQ(got.dt, map.dt);
  EXPECT_EQ(got.gravity, map.gravity);
  EXPECT_TRUE(got.one_record_a_touch);
  EXPECT_EQ(got.case_toml, map.case_toml);
  EXPECT_EQ(got.case_sha256.size(), 64U);
  EXPECT_EQ(got.particles.columns, map.particles.columns);
  EXPECT_EQ(got.wall_states.columns, map.wall_states.columns);
  ASSERT_EQ(got.materials.size(), 2U);
  EXPECT_EQ(got.materials[1].material.density, 1.0 / 3);
  EXPECT_EQ(got.materials[1].type, 2);
  ASSERT_EQ(got.interactions.size(), 2U);
  EXPECT_EQ(got.interactions[1][0].work_of_adhesion, 1.0 / 7);
  EXPECT_EQ(got.interactions[0][1].rolling, 0.3);
  EXPECT_EQ(got.gap.z_high, 1.0 / 300);
  ASSERT_EQ(got.walls.size(), map.walls.size());
  for (std::size_t w = 0; w < got.walls.size(); ++w) {
    const jam::Wall &a = map.walls[w].wall, &b = got.walls[w].wall;
    EXPECT_EQ(got.walls[w].mesh_id, map.walls[w].mesh_id);
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.kind, a.kind);
    EXPECT_EQ(b.role, a.role);
    EXPECT_EQ(b.material, a.material);
    EXPECT_EQ(b.radius, a.radius);
    EXPECT_EQ(b.high_radius, a.high_radius);
    EXPECT_EQ(b.hole_radius, a.hole_radius);
    EXPECT_EQ(b.low, a.low);
    EXPECT_EQ(b.high, a.high);
    EXPECT_EQ(b.free_side, a.free_side);
    EXPECT_EQ(b.sphere_centre, a.sphere_centre);
    EXPECT_EQ(b.sphere_radius, a.sphere_radius);
    EXPECT_EQ(b.triangles.size(), a.triangles.size());
    if (a.kind != "mesh" && a.kind != "spheres") {
      EXPECT_EQ(b.point, a.point);
      EXPECT_EQ(b.axis, a.axis);
    }
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(b.vertices[b.triangles[t][k]], a.vertices[a.triangles[t][k]]);
    }
  }
}

TEST(ExportCommand, TheShippedMapsOfOtherCodesReadTheirExamples) {
  const std::string maps = data + "/maps/", formats = data + "/formats/";
  const jam::ImportMap mercury = read_map_file(maps + "mercury.toml");
  const jam::SnapshotSource a = jam::open_source({formats + "mercury/scene.fstat", formats + "mercury/scene.data"}, &mercury);
  EXPECT_EQ(a.frames, 2U);
  EXPECT_EQ(a.read(0).pw.size(), 3U);
  const jam::ImportMap edem = read_map_file(maps + "edem.toml");
  const jam::SnapshotSource b =
      jam::open_source({formats + "edem/particles.csv", formats + "edem/contacts.csv", formats + "edem/wall_contacts.csv"}, &edem);
  EXPECT_EQ(b.frames, 2U);
  EXPECT_EQ(b.read(0).pw.size(), 3U);
  const std::string yade_folder = formats + "yade/";
  const jam::ImportMap yade = read_map_file(maps + "yade.toml");
  const jam::SnapshotSource c = jam::open_source({yade_folder + "particles.csv.xz", yade_folder + "contacts.csv.xz",
                                                  yade_folder + "wall_contacts.csv.xz", yade_folder + "walls.csv.xz"},
                                                 &yade);
  ASSERT_EQ(c.frames, 4U);
  EXPECT_EQ(c.warnings, std::vector<std::string>{});  // the balance of forces closes
  const jam::Snapshot last = c.read(3);
  EXPECT_NEAR(last.walls[3].position.x(), 0.012, 1e-6);  // 0.12 s at 0.1 m/s
  EXPECT_NEAR(last.walls[3].velocity.x(), 0.1, 1e-6);
  EXPECT_GT(last.pw.size(), 0U);
}

TEST(ExportCommand, FramesAreChosenByNumber) {
  const Scratch scratch;
  EXPECT_EQ(run_program("export " + pea + " --to graphml --frame 1 -q -o " + scratch / "one").code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch / "one/frame_000001.graphml"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "one/frame_000000.graphml"));
  EXPECT_EQ(run_program("export " + pea + " --to vtp --frames 1: -q -o " + scratch / "some").code, 0);
  EXPECT_FALSE(std::filesystem::exists(scratch / "some/vtp/particles_000000.vtp"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "some/vtp/particles_000002.vtp"));
}

TEST(ExportCommand, WrongUsageIsRefusedBeforeAnythingIsWritten) {
  const Scratch scratch;
  const Outcome format = run_program("export " + pea + " --to lamps -o " + scratch / "x");
  EXPECT_EQ(format.code, 2);
  EXPECT_THAT(format.err, HasSubstr("'lamps' is no choice; did you mean 'lammps'?"));
  const Outcome frame = run_program("export " + pea + " --to csv --frame 3 -o " + scratch / "x");
  EXPECT_EQ(frame.code, 2);
  EXPECT_THAT(frame.err, HasSubstr("--frame 3: the frames are 0 to 2"));
  EXPECT_EQ(run_program("export " + pea + " --to csv --frame 1 --frames 1:2 -o " + scratch / "x").code, 2);
  EXPECT_FALSE(std::filesystem::exists(scratch / "x"));
  EXPECT_EQ(run_program("export no.h5 --to csv -o " + scratch / "x").code, 3);

  std::filesystem::create_directories(scratch / "full");
  std::ofstream(scratch / "full/mine.txt") << "mine";
  const Outcome full = run_program("export " + pea + " --to csv -o " + scratch / "full");
  EXPECT_EQ(full.code, 2);
  EXPECT_THAT(full.err, HasSubstr("--overwrite"));
  EXPECT_EQ(run_program("export " + pea + " --to csv --overwrite -q -o " + scratch / "full").code, 0);
  EXPECT_EQ(text_of(scratch / "full/mine.txt"), "mine");
}

TEST(ExportCommand, TheHelpListsTheFormats) {
  const Outcome help = run_program("export --help");
  for (const jam::ExportFormat& format : jam::export_formats()) {
    EXPECT_THAT(help.out, HasSubstr(std::string("  ") + format.name + " "));
    EXPECT_THAT(help.out, HasSubstr(format.doc));
  }
}

}  // namespace
}  // namespace jamscope
