// Maps and files of data/formats, as the command line would read them from data/maps/*.toml.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"

namespace jam::test {

inline std::string data_file(const std::string& name) {
  return std::string(JAMSCOPE_DATA_DIR) + "/formats/" + name;
}

inline std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A folder of this test's own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("jamscope-" + std::to_string(getpid()) + "-" + test->test_suite_name() + "-" + test->name());
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

// Binary STL -> vertices (equal ones merged) and triangles in the order of the file.
inline void add_mesh(Wall& wall, const std::string& name) {
  const std::string bytes = file_bytes(std::string(JAMSCOPE_DATA_DIR) + "/maps/" + name);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  for (std::uint32_t f = 0; f < count; ++f) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> xyz{};
      std::memcpy(xyz.data(), bytes.data() + 84 + 50 * std::size_t{f} + 12 + 12 * k, 12);
      const Vec3 vertex(double{xyz[0]}, double{xyz[1]}, double{xyz[2]});
      const auto found = std::find(wall.vertices.begin(), wall.vertices.end(), vertex);
      triangle[k] = static_cast<std::uint32_t>(found - wall.vertices.begin());
      if (found == wall.vertices.end()) wall.vertices.push_back(vertex);
    }
    wall.triangles.push_back(triangle);
  }
}

inline ImportMap vessel_map(double dt) {
  ImportMap map;
  map.origin = "test map";
  map.dt = dt;
  map.particles.columns = {{"id", "id"},     {"material", "type"}, {"x", "x"},   {"y", "y"},       {"z", "z"},
                           {"vx", "vx"},     {"vy", "vy"},         {"vz", "vz"}, {"wx", "omegax"}, {"wy", "omegay"},
                           {"wz", "omegaz"}, {"radius", "radius"}, {"fx", "fx"}, {"fy", "fy"},     {"fz", "fz"}};
  map.materials = {{{"glass", 2500, 63e9, 0.2}, 1}};
  map.walls.resize(2);
  map.walls[0].wall.name = "bottom";
  map.walls[0].wall.kind = "plane";
  map.walls[1].wall.name = "cylinder";
  map.walls[1].wall.kind = "cylinder";
  map.walls[1].wall.role = WallRole::vessel;
  map.walls[1].wall.radius = 12.5e-3;
  return map;
}

inline ImportWall turning_blade(const std::string& name, const std::string& mesh) {
  ImportWall blade;
  blade.wall.name = name;
  blade.wall.kind = "mesh";
  blade.wall.role = WallRole::blade;
  add_mesh(blade.wall, mesh);
  blade.position = {0, 0, 4.5e-3};
  blade.velocity = {0, 0, -21.8e-3};
  blade.angular_velocity = {0, 0, 21.2};
  return blade;
}

inline ImportMap liggghts_map() {
  ImportMap map = vessel_map(1e-7);
  map.touch_tolerance = 1e-6;
  map.pair_contacts.columns = {{"id1", "c_pc[1]"},  {"id2", "c_pc[2]"},  {"fn_x", "c_pc[4]"},
                               {"fn_y", "c_pc[5]"}, {"fn_z", "c_pc[6]"}, {"ft_x", "c_pc[7]"},
                               {"ft_y", "c_pc[8]"}, {"ft_z", "c_pc[9]"}, {"overlap", "c_pc[10]"}};
  map.wall_contacts.columns = {{"px", "c_wc[1]"},      {"py", "c_wc[2]"},    {"pz", "c_wc[3]"},    {"mesh", "c_wc[7]"},
                               {"facet", "c_wc[8]"},   {"id", "c_wc[9]"},    {"fn_x", "c_wc[10]"}, {"fn_y", "c_wc[11]"},
                               {"fn_z", "c_wc[12]"},   {"ft_x", "c_wc[13]"}, {"ft_y", "c_wc[14]"}, {"ft_z", "c_wc[15]"},
                               {"overlap", "c_wc[16]"}};
  map.wall_loads.columns = {{"time", "t"}, {"fx", "Fx"}, {"fy", "Fy"}, {"fz", "Fz"},
                            {"tx", "Tx"},  {"ty", "Ty"}, {"tz", "Tz"}};
  map.walls[0].recover = map.walls[1].recover = true;
  map.walls.push_back(turning_blade("blade", "liggghts_blade.stl"));
  map.walls[2].mesh_id = 0;
  map.walls[2].has_load_series = true;
  return map;
}

inline ImportMap lammps_map() {
  ImportMap map = vessel_map(2e-6);
  map.pair_contacts.columns = {{"id1", "id1"}, {"id2", "id2"},  {"distance", "dist"}, {"fn_x", "fx"}, {"fn_y", "fy"},
                               {"fn_z", "fz"}, {"ft_x", "ftx"}, {"ft_y", "fty"},      {"ft_z", "ftz"}};
  map.wall_arrays.columns = {{"id", "id"}};
  map.walls[0].array = "f_wz";
  map.walls[1].array = "f_wc";
  map.walls.push_back(turning_blade("wing_1", "lammps_wing_1.stl"));
  map.walls.push_back(turning_blade("wing_2", "lammps_wing_2.stl"));
  map.walls[2].array = "f_b1";
  map.walls[3].array = "f_b2";
  return map;
}

inline std::vector<std::string> liggghts_files() {
  return {data_file("liggghts.particles.dump.xz"), data_file("liggghts.pair.local.xz"),
          data_file("liggghts.wall.local.xz")};
}

inline std::vector<std::string> lammps_files() {
  return {data_file("lammps.particles.dump.xz"), data_file("lammps.pair.local.xz"), data_file("lammps.wall.dump.xz")};
}

inline std::vector<std::string> csv_files() {
  return {data_file("csv/particles.csv"), data_file("csv/contacts.csv"), data_file("csv/wall_contacts.csv")};
}

}  // namespace jam::test
