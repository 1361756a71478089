#include "apps/jamscope/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "apps/jamscope/toml_reader.hpp"
#include "apps/jamscope/units.hpp"
#include "libdem/geometry/stl.hpp"
#include "libjam/snapshot/formats/assemble.hpp"

namespace jamscope {
namespace {

using enum Need;

constexpr Dimension angular_velocity{"an angular velocity", "rad/s", "21.2 rad/s", {0, 0, -1, 1}};
constexpr Dimension torque{"a torque", "N m", "1 N m", {2, 1, -2, 0}};

const std::vector<std::string> load_fields{"time", "fx", "fy", "fz", "tx", "ty", "tz"};

void wrong_size(Document& document, const Section& section, const std::string& key, std::size_t got) {
  document.problem(section.path() + "." + key, fmt::format("'{}' wants three components, got {}", key, got));
}

void read_vector(Section& section, Document& document, const std::string& key, const Dimension& dimension,
                 jam::Vec3& out, Need need = optional) {
  std::vector<double> values;
  if (!section.quantities(key, dimension, values, need)) return;
  if (values.size() != 3) return wrong_size(document, section, key, values.size());
  out = {values[0], values[1], values[2]};
}

void read_direction(Section& section, Document& document, const std::string& key, jam::Vec3& out) {
  std::vector<double> values;
  if (!section.numbers(key, values)) return;
  if (values.size() != 3) return wrong_size(document, section, key, values.size());
  out = {values[0], values[1], values[2]};
}

void read_source(Section source, Document& document, jam::ImportMap& map) {
  source.choice("format", {{"lammps", std::string("lammps")}, {"csv", std::string("csv")}}, map.format);
  source.text("creator", map.creator, optional);
  source.quantity("dt", dimension::time, map.dt, optional);
  read_vector(source, document, "gravity", dimension::acceleration, map.gravity);
  source.number("touch_tolerance", map.touch_tolerance, optional);
  source.finish();
}

void read_units(Section units, jam::ImportUnits& u) {
  units.quantity("length", dimension::length, u.length, optional);
  units.quantity("time", dimension::time, u.time, optional);
  units.quantity("velocity", dimension::speed, u.velocity, optional);
  units.quantity("angular_velocity", angular_velocity, u.angular_velocity, optional);
  units.quantity("force", dimension::force, u.force, optional);
  units.quantity("torque", torque, u.torque, optional);
  units.finish();
}

// `wall` receives the key of that name where the table is about one wall.
void read_table(Section table, const std::vector<std::string>& fields, jam::ImportTable& out,
                std::string* wall = nullptr) {
  if (!table) return;
  table.text("file", out.file, optional);
  if (wall != nullptr) table.text("wall", *wall);
  Section columns = table.section("columns");
  for (const std::string& field : fields) {
    if (std::string column; columns.text(field, column, optional)) out.columns[field] = column;
  }
  columns.finish();
  table.finish();
}

void read_materials(Section materials, jam::ImportMap& map) {
  for (auto& [name, section] : materials.named_sections()) {
    jam::ImportMaterial m;
    m.material.name = name;
    std::uint64_t type = 0;
    if (section.whole_number("type", type, optional))
      m.type = static_cast<int>(std::min<std::uint64_t>(type, 1'000'000'000));
    section.quantity("density", dimension::density, m.material.density);
    section.quantity("young", dimension::pressure, m.material.young, optional);
    section.number("poisson", m.material.poisson, optional);
    section.finish();
    map.materials.push_back(m);
  }
  materials.finish();
}

std::vector<std::string> names_of(const jam::ImportMap& map) {
  std::vector<std::string> names;
  for (const jam::ImportMaterial& m : map.materials) names.push_back(m.material.name);
  return names;
}

void read_interactions(Section interactions, Document& document, jam::ImportMap& map) {
  if (!interactions) return;
  const std::vector<std::string> names = names_of(map);
  map.interactions.assign(names.size(), std::vector<jam::Interaction>(names.size()));
  for (auto& [pair, section] : interactions.named_sections()) {
    jam::Interaction i;
    section.number("restitution", i.restitution, optional);
    section.number("friction", i.friction, optional);
    section.number("rolling_friction", i.rolling, optional);
    section.quantity("work_of_adhesion", dimension::surface_energy, i.work_of_adhesion, optional);
    section.finish();
    const std::size_t hyphen = std::min(pair.find('-'), pair.size());
    std::size_t index[2] = {names.size(), names.size()};
    const std::string parts[2] = {pair.substr(0, hyphen), hyphen < pair.size() ? pair.substr(hyphen + 1) : ""};
    for (std::size_t k = 0; k < 2; ++k) {
      index[k] = static_cast<std::size_t>(std::find(names.begin(), names.end(), parts[k]) - names.begin());
      if (index[k] == names.size()) {
        document.problem(section.path(), fmt::format("unknown material '{}'{}", parts[k], suggestion(parts[k], names)),
                         true);
      }
    }
    if (index[0] < names.size() && index[1] < names.size()) {
      map.interactions[index[0]][index[1]] = map.interactions[index[1]][index[0]] = i;
    }
  }
  interactions.finish();
}

void read_mesh(Section& section, Document& document, const std::string& map_path, jam::Wall& wall) {
  std::string file, unit;
  if (!section.text("mesh", file, optional)) return;
  double scale = 1;
  if (section.text("mesh_unit", unit)) {
    try {
      scale = to_si("1 " + unit, dimension::length);
    } catch (const UnitError&) {
      document.problem(section.path() + ".mesh_unit",
                       fmt::format("'mesh_unit' wants a unit of length, for example \"mm\"; got '{}'", unit));
      return;
    }
  }
  const auto path = (std::filesystem::path(map_path).parent_path() / file).lexically_normal().string();
  dem::StlMesh stl = dem::read_stl(path, scale);
  if (stl.degenerate_triangles + stl.repeated_triangles > 0) {
    // Contacts name triangles by their place in the file, and these were dropped.
    document.problem(
        section.path() + ".mesh",
        fmt::format("'{}' has {} triangles without area or given twice; the triangle numbers of the contacts would not "
                    "fit: remove them from the mesh, or leave 'mesh' out",
                    path, stl.degenerate_triangles + stl.repeated_triangles));
  }
  wall.vertices = std::move(stl.mesh.vertices);
  wall.triangles = std::move(stl.mesh.triangles);
}

void read_wall(const std::string& name, Section& section, Document& document, const std::string& map_path,
               jam::ImportMap& map) {
  jam::ImportWall entry;
  jam::Wall& wall = entry.wall;
  wall.name = name;
  using jam::WallRole;
  section.choice("role", {{"blade", WallRole::blade}, {"vessel", WallRole::vessel}, {"other", WallRole::other}},
                 wall.role);
  const bool known = section.choice(
      "kind", {{"plane", std::string("plane")}, {"cylinder", std::string("cylinder")}, {"mesh", std::string("mesh")}},
      wall.kind);
  if (section.text("material", wall.material, optional)) {
    const std::vector<std::string> names = names_of(map);
    if (std::find(names.begin(), names.end(), wall.material) == names.end()) {
      document.problem(section.path() + ".material",
                       fmt::format("unknown material '{}'{}", wall.material, suggestion(wall.material, names)));
    }
  }
  std::string contacts;
  section.choice("contacts", {{"listed", std::string("listed")}, {"recovered", std::string("recovered")}}, contacts,
                 optional);
  entry.recover = contacts == "recovered";
  section.text("source_name", entry.source_name, optional);
  section.text("array", entry.array, optional);
  if (known && wall.kind == "mesh") {
    std::uint64_t mesh_id = 0;
    if (section.whole_number("mesh_id", mesh_id, optional))
      entry.mesh_id = static_cast<int>(std::min<std::uint64_t>(mesh_id, 1'000'000'000));
    read_mesh(section, document, map_path, wall);
    read_vector(section, document, "position", dimension::length, entry.position);
    read_vector(section, document, "velocity", dimension::speed, entry.velocity);
    read_vector(section, document, "angular_velocity", angular_velocity, entry.angular_velocity);
    section.quantity("motion_start", dimension::time, entry.motion_start, optional);
  } else if (known) {
    read_vector(section, document, "point", dimension::length, wall.point, required);
    read_direction(section, document, wall.kind == "plane" ? "normal" : "axis", wall.axis);
    if (wall.kind == "cylinder") section.quantity("radius", dimension::length, wall.radius);
  }
  // Which keys belong here is not known where the kind is not.
  if (known) section.finish();
  map.walls.push_back(std::move(entry));
}

void read_gap(Section gap, jam::Gap& g) {
  if (!gap) return;
  gap.quantity("tip_radius", dimension::length, g.tip_radius);
  gap.quantity("vessel_radius", dimension::length, g.vessel_radius, optional);
  gap.quantity("z_low", dimension::length, g.z_low);
  gap.quantity("z_high", dimension::length, g.z_high);
  gap.finish();
}

}  // namespace

jam::ImportMap read_map_text(std::string_view text, const std::string& path) {
  Document document(text, path, {});
  jam::ImportMap map;
  map.origin = path;
  Section root = document.root();
  read_source(root.section("source"), document, map);
  read_units(root.section("units", optional), map.units);
  read_table(root.section("particles", optional), jam::known_particle_fields(), map.particles);
  read_table(root.section("pair_contacts", optional), jam::known_pair_fields(), map.pair_contacts);
  read_table(root.section("wall_contacts", optional), jam::known_wall_fields(), map.wall_contacts);
  read_table(root.section("wall_arrays", optional), {"id"}, map.wall_arrays);
  std::string loaded;
  read_table(root.section("wall_loads", optional), load_fields, map.wall_loads, &loaded);
  read_materials(root.section("material", optional), map);
  read_interactions(root.section("interaction", optional), document, map);
  Section walls = root.section("wall", optional);
  std::vector<std::string> names;
  for (auto& [name, section] : walls.named_sections()) {
    read_wall(name, section, document, path, map);
    map.walls.back().has_load_series = name == loaded;
    names.push_back(name);
  }
  walls.finish();
  if (!loaded.empty() && std::find(names.begin(), names.end(), loaded) == names.end()) {
    document.problem("wall_loads.wall", fmt::format("unknown wall '{}'{}", loaded, suggestion(loaded, names)));
  }
  read_gap(root.section("gap", optional), map.gap);
  root.finish();
  document.throw_problems();
  return map;
}

jam::ImportMap read_map_file(const std::string& path) {
  return read_map_text(read_text_file(path), path);
}

}  // namespace jamscope
