#include "apps/jamscope/wall_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/check.hpp"
#include "libdem/errors.hpp"
#include "libjam/snapshot/reader.hpp"
#include "tests/app/program.hpp"

namespace jamscope {
namespace {

using testing::HasSubstr;

const std::string head = R"([material.glass]
density = "2500 kg/m3"
young = "63 GPa"
poisson = 0.2
[interaction.glass-glass]
restitution = 0.9
friction = 0.5
[bed]
material = "glass"
mean_diameter = "1 mm"
size_low = 0.8
size_high = 1.2
sizes = "mass"
x = ["-5 mm", "5 mm"]
y = ["-4 mm", "4 mm"]
depth = "5 mm"
[domain]
low = ["-1 cm", "-1 cm", "-1 cm"]
high = ["1 cm", "1 cm", "4 cm"]
[run]
duration = "2 ms"
step = "50 ns"
[output]
frame_interval = "1 ms"
series_interval = "1 ms"
checkpoint_interval = "1 ms"
)";

std::string error_of(const std::string& walls, const std::string& path = "scene.toml") {
  try {
    read_case_text(head + walls, path);
  } catch (const dem::CaseError& e) {
    return e.what();
  }
  return "no error";
}

TEST(WallTables, EveryKindIsRead) {
  Scratch folder;
  std::ofstream(folder / "poses.csv") << "time,x,y,z,qw,qx,qy,qz\n0,0,0,0.01,1,0,0,0\n# later\n0.001, 0, 0, 0.02, 0.9, 0, 0, 0.1\n";
  const CaseFile file = read_case_text(head + R"(
[wall.floor]
material = "glass"
kind = "plane"
point = ["0 m", "0 m", "-1 mm"]
normal = [0, 3, 4]
[wall.pipe]
material = "glass"
role = "other"
kind = "cylinder"
radius = "2 cm"
axis = [0, 0, 1]
free = "outside"
low = "-1 cm"
high = "3 cm"
angular_velocity = ["0 rad/s", "0 rad/s", "3 rad/s"]
[wall.hopper]
material = "glass"
kind = "cone"
low_radius = "1 mm"
high_radius = "1 cm"
length = "1 cm"
[wall.gate]
material = "glass"
kind = "disc"
radius = "1 cm"
hole_radius = "2 mm"
poses = "poses.csv"
[wall.blade]
material = "glass"
kind = "box"
size = ["1 mm", "2 mm", "3 mm"]
start = ["1 cm", "0 m", "0 m"]
velocity = ["10 mm/s", "0 m/s", "0 m/s"]
pivot = ["1 mm", "0 m", "0 m"]
[wall.plate]
material = "glass"
kind = "glued_grains"
diameter = "1 mm"
x = ["-5 mm", "5 mm"]
y = ["-5 mm", "5 mm"]
top = "1 mm"
roughness = 0.3
seed = 4
[wall.arm]
material = "glass"
kind = "twisted"
diameter = "8 mm"
shaft_diameter = "2 mm"
)", folder / "scene.toml");
  EXPECT_FALSE(file.physics.rheometer);
  EXPECT_EQ(file.physics.bed.sizes, dem::Bed::Sizes::by_mass);
  ASSERT_TRUE(file.physics.bed.box.has_value());
  EXPECT_NEAR(file.physics.bed.box->y_high, 4e-3, 1e-15);
  EXPECT_NEAR(file.physics.domain_high.z(), 0.04, 1e-15);
  ASSERT_EQ(file.walls.size(), 7u);
  const auto wall = [&](const std::string& name) -> const dem::SceneWall& {
    for (const dem::SceneWall& w : file.walls)
      if (w.wall.name == name) return w;
    throw std::runtime_error(name);
  };
  EXPECT_NEAR(std::get<dem::Plane>(wall("floor").wall.shape).normal.z(), 0.8, 1e-15);
  EXPECT_EQ(wall("floor").role, dem::WallRole::vessel);
  const auto& pipe = std::get<dem::Cylinder>(wall("pipe").wall.shape);
  EXPECT_EQ(pipe.free, dem::FreeSide::outside);
  EXPECT_NEAR(pipe.high, 0.03, 1e-15);
  EXPECT_EQ(wall("pipe").role, dem::WallRole::other);
  EXPECT_NEAR(wall("pipe").wall.motion.angular_velocity.z(), 3, 1e-15);
  EXPECT_NEAR(std::get<dem::Cone>(wall("hopper").wall.shape).low_radius, 1e-3, 1e-18);
  EXPECT_NEAR(std::get<dem::Disc>(wall("gate").wall.shape).hole_radius, 2e-3, 1e-18);
  ASSERT_TRUE(wall("gate").wall.motion.table);
  EXPECT_NEAR(wall("gate").wall.motion.table->at(0.0005).position.z(), 0.015, 1e-15);
  EXPECT_EQ(wall("gate").role, dem::WallRole::blade);  // what moves is a blade unless it is said otherwise
  EXPECT_NEAR(wall("blade").wall.motion.pivot.x(), 1e-3, 1e-18);
  EXPECT_TRUE(std::holds_alternative<dem::MeshWall>(wall("blade").wall.shape));
  EXPECT_EQ(std::get<dem::GluedGrains>(wall("plate").wall.shape).spheres->centres().size(), 6u * 11 + 6u * 10);
  EXPECT_TRUE(std::holds_alternative<dem::MeshWall>(wall("arm").wall.shape));
  EXPECT_THAT(check_text(file), HasSubstr("gate"));
  EXPECT_THAT(check_json(file), HasSubstr("\"largest_speed\""));
}

TEST(WallTables, ProblemsNameTheirPlace) {
  const auto plane = [](const std::string& more) { return "[wall.floor]\nmaterial = \"glass\"\nkind = \"plane\"\n" + more; };
  EXPECT_THAT(error_of(plane("point = [\"0 m\", \"0 m\", \"0 m\"]\nnormal = [0, 0, 0]\n")),
              testing::AllOf(HasSubstr("scene.toml:31:"), HasSubstr("wants a direction")));
  EXPECT_THAT(error_of(plane("point = [\"0 m\", \"0 m\"]\nnormal = [0, 0, 1]\n")), HasSubstr("wants three components"));
  EXPECT_THAT(error_of(plane("point = [\"0 m\", \"0 m\", \"0 s\"]\nnormal = [0, 0, 1]\n")), HasSubstr("scene.toml:30:"));
  EXPECT_THAT(error_of(plane("normal = [0, 0, 1]\npoint = [\"0 m\", \"0 m\", \"0 m\"]\nnormals = 1\n")), HasSubstr("unknown key 'normals'"));
  EXPECT_THAT(error_of("[wall.floor]\nmaterial = \"gless\"\nkind = \"plane\"\nnormal = [0, 0, 1]\npoint = [\"0 m\", \"0 m\", \"0 m\"]\n"),
              HasSubstr("did you mean 'glass'"));
  EXPECT_THAT(error_of("[wall.floor]\nmaterial = \"glass\"\nkind = \"plain\"\n"), HasSubstr("plane"));
  EXPECT_THAT(error_of("[wall.pipe]\nmaterial = \"glass\"\nkind = \"cylinder\"\nradius = \"-1 mm\"\n"), HasSubstr("scene.toml:27:"));
  EXPECT_THAT(error_of("[wall.b]\nmaterial = \"glass\"\nkind = \"box\"\nsize = [\"1 mm\", \"0 mm\", \"1 mm\"]\n"),
              HasSubstr("edges of a box"));
  EXPECT_THAT(error_of("[wall.b]\nmaterial = \"glass\"\nkind = \"stl\"\nfile = \"none.stl\"\nfile_unit = \"mm\"\n"),
              HasSubstr("none.stl"));
  EXPECT_THAT(error_of("[wall.b]\nmaterial = \"glass\"\nkind = \"disc\"\nradius = \"1 mm\"\nposes = \"none.csv\"\n"),
              HasSubstr("none.csv"));
  // An endless wall that turns about another axis than its own has no largest speed.
  EXPECT_THAT(error_of(plane("point = [\"0 m\", \"0 m\", \"0 m\"]\nnormal = [0, 0, 1]\n"
                             "angular_velocity = [\"1 rad/s\", \"0 rad/s\", \"0 rad/s\"]\n")),
              HasSubstr("endless"));
  // Without walls and without a rheometer there is nothing.
  EXPECT_THAT(error_of(""), HasSubstr("vessel"));
}

TEST(WallTables, PoseTablesNameFileAndLine) {
  Scratch folder;
  const auto problem = [&](const std::string& text) -> std::string {
    std::ofstream(folder / "p.csv") << text;
    try {
      read_pose_table(folder / "p.csv");
    } catch (const dem::CaseError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(problem("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0\n"), HasSubstr("p.csv:3: expected the 8 numbers"));
  EXPECT_THAT(problem("0,0,0,0,1,0,0,0\nx\n"), HasSubstr("p.csv:2:"));
  EXPECT_THAT(problem("0,0,0,0,1,0,0,0\n"), HasSubstr("p.csv"));  // one row is no motion
  EXPECT_THAT(problem("0,0,0,0,1,0,0,0\n1,0,0,1,1,0,0,0\n"), "none");
}

// The recoater with a handful of grains, from file to report.
TEST(WallTables, ShippedSceneRunsFromFileToReport) {
  Scratch folder;
  const std::string out = folder / "out";
  const Outcome run = run_program("simulate " JAMSCOPE_DATA_DIR "/cases/spreading.toml -o " + out +
                                  " -q --threads 1 --bed-cache '' --set bed.depth='0.1 mm' --set bed.x='[\"0 mm\", \"0.2 mm\"]'"
                                  " --set bed.y='[\"-0.1 mm\", \"0.1 mm\"]' --set run.duration='0.1 ms'"
                                  " --set output.frame_interval='0.05 ms' --set output.checkpoint_interval='0.1 ms'");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(text_of(out + "/summary.json"), HasSubstr("\"name\": \"spreading\""));
  EXPECT_THAT(run_program("inspect " + out + "/run.h5").out, HasSubstr("plate"));
  EXPECT_GT(text_of(out + "/report.html").size(), 10000u);
  EXPECT_EQ(run_program("analyze " + out + "/run.h5 -q -o " + (folder / "again")).code, 0);
}

// A piston that throws grains out of the domain: the run stops with code 1 and a message, and the state it stopped in is the last
// frame of a sound file.
TEST(WallTables, ARunThatPhysicsStopsKeepsItsLastFrame) {
  Scratch folder;
  std::ofstream(folder / "piston.toml") << head << R"(
[wall.pipe]
material = "glass"
kind = "cylinder"
radius = "4 mm"
[wall.piston]
material = "glass"
kind = "disc"
radius = "4 mm"
velocity = ["0 m/s", "0 m/s", "20 m/s"]
)";
  const std::string out = folder / "out";
  const Outcome run = run_program("simulate " + (folder / "piston.toml") + " -o " + out +
                                  " -q --threads 1 --bed-cache '' --set bed.depth='2 mm' --set bed.x='[\"-2 mm\", \"2 mm\"]'"
                                  " --set bed.y='[\"-2 mm\", \"2 mm\"]' --set output.frame_interval='0.5 ms'");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, testing::AllOf(HasSubstr("grain"), HasSubstr("has left the domain"), HasSubstr("t = ")));
  const jam::SnapshotSource source = jam::open_jamscope_file(out + "/run.h5");
  EXPECT_TRUE(source.warnings.empty());
  ASSERT_GT(source.frames, 1u);
  const jam::Snapshot last = source.read(source.frames - 1);
  EXPECT_NE(last.step % 10000, 0u) << "frames are 10,000 steps apart, the last one is out of turn";
  double farthest = 0;
  for (const jam::Vec3f& x : last.particles.position) farthest = std::max(farthest, double(x.z()));
  EXPECT_GT(farthest, 0.04);
  EXPECT_GT(text_of(out + "/summary.json").size(), 1000u);
}

}  // namespace
}  // namespace jamscope
