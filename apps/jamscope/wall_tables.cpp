#include "apps/jamscope/wall_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

#include "libdem/errors.hpp"
#include "libdem/geometry/simple_bodies.hpp"
#include "libdem/geometry/stl.hpp"
#include "libdem/geometry/twisted_blade.hpp"
#include "libdem/geometry/validate_mesh.hpp"

namespace jamscope {
namespace {

using enum Need;
using dem::Vec3;

// What a reader of one kind of wall has at hand.
struct WallTable {
  Section& section;
  Document& document;
  const std::string& path;  // of the case file
  const std::string& name;

  void problem(const std::string& key, const std::string& message) const {
    document.problem(section.path() + "." + key, message);
  }
  bool vector(std::string_view key, const Dimension& dimension, Vec3& out, Need need = required) const {
    return read_vector(section, document, key, dimension, out, need);
  }
  // Of any length but zero; made a unit vector.
  void direction(const char* key, Vec3& out, Need need = required) const {
    std::vector<double> values;
    if (!section.numbers(key, values, need)) return;
    const bool three = values.size() == 3;
    if (three) out = Vec3(values[0], values[1], values[2]).normalized();
    if (!three || !(out.norm() > 0.5))
      problem(key, fmt::format("'{}' wants a direction like [0, 0, 1], three numbers that are not all zero", key));
  }
  void interval(const char* key, const Dimension& dimension, double& low, double& high) const {
    std::vector<double> values;
    if (!section.quantities(key, dimension, values)) return;
    if (values.size() != 2)
      problem(key, fmt::format("'{}' wants two ends like [\"-5 mm\", \"5 mm\"], got {}", key, values.size()));
    else
      low = values[0], high = values[1];
  }
  void free_side(dem::FreeSide& out) const {
    section.choice("free", {{"inside", dem::FreeSide::inside}, {"outside", dem::FreeSide::outside}}, out, optional);
  }
};

dem::WallShape read_plane(const WallTable& t) {
  dem::Plane plane;
  t.vector("point", dimension::length, plane.point);
  t.direction("normal", plane.normal);
  return plane;
}

dem::WallShape read_cylinder(const WallTable& t) {
  dem::Cylinder cylinder;
  t.vector("point", dimension::length, cylinder.point, optional);
  t.direction("axis", cylinder.axis, optional);
  t.section.quantity("radius", dimension::length, cylinder.radius);
  t.free_side(cylinder.free);
  t.section.quantity("low", dimension::length, cylinder.low, optional);
  t.section.quantity("high", dimension::length, cylinder.high, optional);
  return cylinder;
}

dem::WallShape read_cone(const WallTable& t) {
  dem::Cone cone;
  t.vector("point", dimension::length, cone.point, optional);
  t.direction("axis", cone.axis, optional);
  t.section.quantity("low_radius", dimension::length, cone.low_radius);
  t.section.quantity("high_radius", dimension::length, cone.high_radius);
  t.section.quantity("length", dimension::length, cone.length);
  t.free_side(cone.free);
  return cone;
}

dem::WallShape read_disc(const WallTable& t) {
  dem::Disc disc;
  t.vector("point", dimension::length, disc.point, optional);
  t.direction("normal", disc.normal, optional);
  t.section.quantity("radius", dimension::length, disc.radius);
  t.section.quantity("hole_radius", dimension::length, disc.hole_radius, optional);
  return disc;
}

dem::WallShape read_box(const WallTable& t) {
  Vec3 size = Vec3::Ones();
  t.vector("size", dimension::length, size);
  return dem::make_mesh_wall(dem::make_box(size));
}

dem::WallShape read_glued_grains(const WallTable& t) {
  dem::RoughPlate plate;
  plate.diameter = 1;  // where the file's cannot be read
  t.interval("x", dimension::length, plate.x_low, plate.x_high);
  t.interval("y", dimension::length, plate.y_low, plate.y_high);
  t.section.quantity("top", dimension::length, plate.top, optional);
  t.section.quantity("diameter", dimension::length, plate.diameter);
  t.section.number("roughness", plate.roughness, optional);
  t.section.whole_number("seed", plate.seed, optional);
  return dem::make_rough_plate(plate);
}

dem::WallShape read_stl_wall(const WallTable& t) {
  dem::MeshFile file;
  read_mesh_file(t.section, t.path, t.document, file);
  if (file.path.empty()) return dem::Plane{};
  dem::TriangleMesh mesh = dem::read_stl(file.path, file.scale).mesh;
  dem::label_tips(mesh);
  dem::validate_mesh(mesh, file.path);
  return dem::make_mesh_wall(std::move(mesh));
}

dem::WallShape read_twisted_wall(const WallTable& t) {
  dem::TwistedBlade blade;
  blade.diameter = 0;
  read_twisted(t.section, blade);
  if (!(blade.diameter > 0)) return dem::Plane{};
  return dem::make_mesh_wall(dem::make_twisted_blade(blade));
}

// TABLE of the kinds of walls. To add one: a function above and a row here; README.md lists the keys.
using ReadWall = dem::WallShape (*)(const WallTable&);
const std::vector<std::pair<std::string, ReadWall>>& kinds() {
  static const std::vector<std::pair<std::string, ReadWall>> rows{
      {"plane", read_plane},   {"cylinder", read_cylinder},         {"cone", read_cone},    {"disc", read_disc},
      {"box", read_box},       {"glued_grains", read_glued_grains}, {"stl", read_stl_wall}, {"twisted", read_twisted_wall},
  };
  return rows;
}

void read_motion(const WallTable& t, dem::WallMotion& motion) {
  t.vector("start", dimension::length, motion.start, optional);
  t.vector("velocity", dimension::speed, motion.velocity, optional);
  t.vector("angular_velocity", dimension::angular_velocity, motion.angular_velocity, optional);
  t.vector("pivot", dimension::length, motion.pivot, optional);
  std::string poses;
  if (!t.section.text("poses", poses, optional)) return;
  const std::string file = (std::filesystem::path(t.path).parent_path() / poses).lexically_normal().string();
  motion.table = std::make_shared<dem::PoseTable>(read_pose_table(file));
}

bool moves(const dem::WallMotion& m) {
  return m.table || m.velocity != Vec3::Zero() || m.angular_velocity != Vec3::Zero();
}

}  // namespace

bool read_vector(Section& section, Document& document, std::string_view key, const Dimension& dimension, Vec3& out,
                 Need need) {
  std::vector<double> values;
  if (!section.quantities(key, dimension, values, need)) return false;
  if (values.size() != 3) {
    document.problem(fmt::format("{}.{}", section.path(), key),
                     fmt::format("'{}' wants three components like [\"{}\", \"{}\", \"{}\"], got {}", key, dimension.example,
                                 dimension.example, dimension.example, values.size()));
    return false;
  }
  out = Vec3(values[0], values[1], values[2]);
  return true;
}

void read_twisted(Section& section, dem::TwistedBlade& blade) {
  section.quantity("diameter", dimension::length, blade.diameter);
  section.quantity("height", dimension::length, blade.height, optional);
  section.quantity("thickness", dimension::length, blade.thickness, optional);
  section.quantity("tip_twist", dimension::angle, blade.tip_twist, optional);
  section.number("twist_exponent", blade.twist_exponent, optional);
  section.quantity("shaft_diameter", dimension::length, blade.shaft_diameter, optional);
  section.quantity("shaft_length", dimension::length, blade.shaft_length, optional);
  using TipCut = dem::TwistedBlade::TipCut;
  section.choice("tip_cut", {{"cylindrical", TipCut::cylindrical}, {"flat", TipCut::flat}}, blade.tip_cut, optional);
}

void read_mesh_file(Section& section, const std::string& path, Document& document, dem::MeshFile& mesh) {
  std::string file, unit;
  if (section.text("file", file))
    mesh.path = (std::filesystem::path(path).parent_path() / file).lexically_normal().string();
  if (section.text("file_unit", unit)) {
    try {
      mesh.scale = to_si("1 " + unit, dimension::length);
    } catch (const UnitError&) {
      document.problem(section.path() + ".file_unit",
                       fmt::format("'file_unit' wants a unit of length, for example \"mm\"; got '{}'", unit));
    }
  }
}

dem::PoseTable read_pose_table(const std::string& path) {
  std::istringstream lines(read_text_file(path));
  constexpr std::string_view header = "time,x,y,z,qw,qx,qy,qz";
  std::string line;
  std::size_t number = 0;
  std::vector<dem::PoseRow> rows;
  while (std::getline(lines, line)) {
    ++number;
    std::erase_if(line, [](char c) { return c == ' ' || c == '\r' || c == '\t'; });
    if (line.empty() || line.front() == '#') continue;
    const auto fail = [&](const std::string& message) {
      return dem::CaseError(fmt::format("{}:{}: {}", path, number, message));
    };
    if (rows.empty() && line == header) continue;
    std::array<double, 8> value{};
    std::size_t count = 0;
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    while (count < value.size()) {
      const auto [next, error] = std::from_chars(at, end, value[count]);
      if (error != std::errc{}) throw fail(fmt::format("expected the numbers {}, got '{}'", header, line));
      ++count;
      at = next;
      if (at == end || *at != ',') break;
      ++at;
    }
    if (count != value.size() || at != end) throw fail(fmt::format("expected the 8 numbers {}, got '{}'", header, line));
    rows.push_back({value[0], Vec3(value[1], value[2], value[3]),
                    Eigen::Quaterniond(value[4], value[5], value[6], value[7])});
  }
  try {
    return dem::PoseTable(std::move(rows));
  } catch (const dem::CaseError& error) {
    throw dem::CaseError(fmt::format("{}: {}", path, error.what()));
  }
}

std::vector<dem::SceneWall> read_walls(Section walls, const dem::Case& c, const std::string& path, Document& document) {
  std::vector<dem::SceneWall> list;
  std::vector<std::string> names;
  if (c.rheometer) names = {"floor", "cylinder", "blade"};
  for (auto& [name, section] : walls.named_sections()) {
    const WallTable table{section, document, path, name};
    if (!std::all_of(name.begin(), name.end(), [](unsigned char ch) { return std::isalnum(ch) != 0 || ch == '_'; }))
      document.problem(section.path(), fmt::format("wall names have only letters, digits and '_', got '{}'", name), true);
    if (std::find(names.begin(), names.end(), name) != names.end())
      document.problem(section.path(), fmt::format("the rheometer has a wall '{}' already; choose another name", name), true);
    dem::SceneWall wall;
    wall.wall.name = name;
    std::string material;
    if (section.text("material", material)) {
      const auto found =
          std::find_if(c.materials.begin(), c.materials.end(), [&](const dem::Material& m) { return m.name == material; });
      if (found == c.materials.end()) {
        std::vector<std::string> known;
        for (const dem::Material& m : c.materials) known.push_back(m.name);
        table.problem("material", fmt::format("unknown material '{}'{}", material, suggestion(material, known)));
      } else {
        wall.wall.material = static_cast<std::size_t>(found - c.materials.begin());
      }
    }
    ReadWall read = nullptr;
    if (!section.choice("kind", kinds(), read)) continue;  // which keys belong here is not known
    try {
      read_motion(table, wall.wall.motion);
      wall.role = moves(wall.wall.motion) ? dem::WallRole::blade : dem::WallRole::vessel;
      using dem::WallRole;
      section.choice("role", {{"blade", WallRole::blade}, {"vessel", WallRole::vessel}, {"other", WallRole::other}}, wall.role,
                     optional);
      wall.wall.shape = read(table);
      section.finish();
      if (!document.has_problems()) dem::validate_wall(wall.wall);
    } catch (const std::runtime_error& error) {  // CaseError, GeometryError of a shape or a file
      document.problem(section.path(), error.what(), true);
    }
    list.push_back(std::move(wall));
  }
  walls.finish();
  return list;
}

}  // namespace jamscope
