#include "apps/jamscope/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/sha256.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "apps/jamscope/units.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/stl.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/text_input.hpp"

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

// The path of a file that is named relative to the map.
std::string beside(const std::string& map_path, const std::string& file) {
  return (std::filesystem::path(map_path).parent_path() / file).lexically_normal().string();
}

void read_source(Section source, Document& document, jam::ImportMap& map) {
  source.choice("format",
                {{"lammps", std::string("lammps")},
                 {"csv", std::string("csv")},
                 {"mercury", std::string("mercury")},
                 {"edem", std::string("edem")}},
                map.format);
  source.text("creator", map.creator, optional);
  source.quantity("dt", dimension::time, map.dt, optional);
  read_vector(source, document, "gravity", dimension::acceleration, map.gravity);
  source.number("touch_tolerance", map.touch_tolerance, optional);
  source.truth("one_record_a_touch", map.one_record_a_touch, optional);
  if (std::string file; source.text("case", file, optional)) {
    map.case_toml = read_text_file(beside(document.path(), file));
    map.case_sha256 = sha256_hex(map.case_toml);
  }
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
    // "glass-steel"; names may hold hyphens too, so the first one that splits the pair into two known names counts.
    std::size_t hyphen = std::min(pair.find('-'), pair.size());
    const auto known = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    for (std::size_t at = hyphen; at < pair.size(); at = std::min(pair.find('-', at + 1), pair.size())) {
      if (!known(pair.substr(0, at)) || !known(pair.substr(at + 1))) continue;
      hyphen = at;
      break;
    }
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
  const std::string path = beside(map_path, file);
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

// Glued spheres from a CSV file with the header x,y,z,radius: m, in the body frame.
void read_spheres(const std::string& path, jam::Wall& wall) {
  std::istringstream lines(read_text_file(path));
  std::string line;
  std::vector<std::string_view> parts;
  std::getline(lines, line);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  if (line != "x,y,z,radius") throw dem::CaseError(path + ":1: expected the header x,y,z,radius");
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    jam::split_csv(line, parts);
    std::array<double, 4> values{};
    bool fine = parts.size() == values.size();
    for (std::size_t k = 0; fine && k < values.size(); ++k) fine = jam::parse_number(parts[k], values[k]);
    if (!fine || !(values[3] > 0))
      throw dem::CaseError(fmt::format("{}:{}: expected three coordinates and a radius > 0", path, number));
    wall.sphere_centre.emplace_back(values[0], values[1], values[2]);
    wall.sphere_radius.push_back(values[3]);
  }
}

// The keys of an analytic wall's shape, in its body frame.
void read_shape(Section& section, Document& document, const std::string& map_path, jam::Wall& wall) {
  if (wall.kind == "spheres") {
    if (std::string file; section.text("spheres", file)) read_spheres(beside(map_path, file), wall);
    return;
  }
  const bool round = wall.kind == "cylinder" || wall.kind == "cone";
  const Need ends = wall.kind == "cone" ? required : optional;
  read_vector(section, document, "point", dimension::length, wall.point, required);
  read_direction(section, document, round ? "axis" : "normal", wall.axis);
  if (wall.kind == "cylinder" || wall.kind == "disc") section.quantity("radius", dimension::length, wall.radius);
  if (wall.kind == "disc") section.quantity("hole_radius", dimension::length, wall.hole_radius, optional);
  if (wall.kind == "cone") {
    section.quantity("low_radius", dimension::length, wall.radius);
    section.quantity("high_radius", dimension::length, wall.high_radius);
  }
  if (round) {
    section.quantity("low", dimension::length, wall.low, ends);
    section.quantity("high", dimension::length, wall.high, ends);
    section.choice("free", {{"inside", std::string("inside")}, {"outside", std::string("outside")}}, wall.free_side,
                   optional);
  }
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
      "kind",
      {{"plane", std::string("plane")},
       {"cylinder", std::string("cylinder")},
       {"cone", std::string("cone")},
       {"disc", std::string("disc")},
       {"spheres", std::string("spheres")},
       {"mesh", std::string("mesh")}},
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
  std::uint64_t mesh_id = 0;
  if (section.whole_number("mesh_id", mesh_id, optional))
    entry.mesh_id = static_cast<int>(std::min<std::uint64_t>(mesh_id, 1'000'000'000));
  std::uint64_t mesh_count = 1;
  if (section.whole_number("mesh_count", mesh_count, optional))
    entry.mesh_count = static_cast<int>(std::min<std::uint64_t>(mesh_count, 1'000'000'000));
  if (known && wall.kind == "mesh") {
    read_mesh(section, document, map_path, wall);
    read_vector(section, document, "position", dimension::length, entry.position);
    read_vector(section, document, "velocity", dimension::speed, entry.velocity);
    read_vector(section, document, "angular_velocity", angular_velocity, entry.angular_velocity);
    section.quantity("motion_start", dimension::time, entry.motion_start, optional);
  } else if (known) {
    read_shape(section, document, map_path, wall);
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
  read_table(root.section("wall_states", optional), jam::known_wall_state_fields(), map.wall_states);
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

namespace {

// A basic string of TOML.
std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

// Numbers with as many digits as give the same bits when they are read.
std::string quantity(double value, const char* unit) { return fmt::format("\"{} {}\"", value, unit); }
std::string vector_text(const jam::Vec3& v, const char* unit) {
  return fmt::format("[{}, {}, {}]", quantity(v.x(), unit), quantity(v.y(), unit), quantity(v.z(), unit));
}
// TOML wants a point or an exponent in a number that is not whole.
std::string direction_text(const jam::Vec3& v) { return fmt::format("[{:#}, {:#}, {:#}]", v.x(), v.y(), v.z()); }

// File names of letters, digits, '_', '-' and '.', different for different walls.
std::string wall_file(const jam::Wall& wall, std::size_t number, const char* ending) {
  std::string name = fmt::format("wall_{}_{}", number, wall.name);
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  return name + ending;
}

// Triangles in their order, in m, with all digits; a binary STL file has 32-bit coordinates.
std::string stl_text(const jam::Wall& wall) {
  std::string text = "solid wall\n";
  for (const auto& triangle : wall.triangles) {
    const jam::Vec3 &a = wall.vertices[triangle[0]], &b = wall.vertices[triangle[1]], &c = wall.vertices[triangle[2]];
    jam::Vec3 normal = (b - a).cross(c - a);
    if (normal.norm() > 0) normal.normalize();
    text += fmt::format("facet normal {:.6g} {:.6g} {:.6g}\nouter loop\n", normal.x(), normal.y(), normal.z());
    for (const jam::Vec3* v : {&a, &b, &c}) text += fmt::format("vertex {} {} {}\n", v->x(), v->y(), v->z());
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid wall\n";
}

std::string spheres_text(const jam::Wall& wall) {
  std::string text = "x,y,z,radius\n";
  for (std::size_t s = 0; s < wall.sphere_centre.size(); ++s) {
    const jam::Vec3& c = wall.sphere_centre[s];
    text += fmt::format("{},{},{},{}\n", c.x(), c.y(), c.z(), wall.sphere_radius[s]);
  }
  return text;
}

std::string table_text(const char* name, const jam::ImportTable& table) {
  if (!table.used()) return "";
  std::string columns;
  for (const auto& [field, column] : table.columns)
    columns += fmt::format("{} {} = {}", columns.empty() ? "" : ",", field, toml_string(column));
  return fmt::format("\n[{}]\n{}columns = {{{} }}\n", name,
                     table.file.empty() ? "" : fmt::format("file = {}\n", toml_string(table.file)), columns);
}

const char* role_text(jam::WallRole role) {
  switch (role) {
    case jam::WallRole::blade: return "blade";
    case jam::WallRole::vessel: return "vessel";
    case jam::WallRole::other: break;
  }
  return "other";
}

std::string wall_text(const jam::ImportWall& entry, std::size_t number, const std::filesystem::path& folder) {
  const jam::Wall& w = entry.wall;
  std::string text = fmt::format("\n[wall.{}]\nkind = \"{}\"\nrole = \"{}\"\n", toml_string(w.name), w.kind, role_text(w.role));
  if (!w.material.empty()) text += fmt::format("material = {}\n", toml_string(w.material));
  if (entry.mesh_id >= 0) text += fmt::format("mesh_id = {}\n", entry.mesh_id);
  if (!entry.source_name.empty()) text += fmt::format("source_name = {}\n", toml_string(entry.source_name));
  if (w.kind == "mesh") {
    if (!w.triangles.empty()) {
      const std::string file = wall_file(w, number, ".stl");
      write_text_file((folder / file).string(), stl_text(w));
      text += fmt::format("mesh = \"{}\"\nmesh_unit = \"m\"\n", file);
    }
    return text;
  }
  if (w.kind == "spheres") {
    const std::string file = wall_file(w, number, ".csv");
    write_text_file((folder / file).string(), spheres_text(w));
    return text + fmt::format("spheres = \"{}\"\n", file);
  }
  const bool round = w.kind == "cylinder" || w.kind == "cone";
  text += fmt::format("point = {}\n{} = {}\n", vector_text(w.point, "m"), round ? "axis" : "normal", direction_text(w.axis));
  if (w.kind == "cylinder" || w.kind == "disc") text += fmt::format("radius = {}\n", quantity(w.radius, "m"));
  if (w.hole_radius > 0) text += fmt::format("hole_radius = {}\n", quantity(w.hole_radius, "m"));
  if (w.kind == "cone")
    text += fmt::format("low_radius = {}\nhigh_radius = {}\n", quantity(w.radius, "m"), quantity(w.high_radius, "m"));
  if (round) {
    if (std::isfinite(w.low)) text += fmt::format("low = {}\n", quantity(w.low, "m"));
    if (std::isfinite(w.high)) text += fmt::format("high = {}\n", quantity(w.high, "m"));
    if (!w.free_side.empty()) text += fmt::format("free = \"{}\"\n", w.free_side);
  }
  return text;
}

}  // namespace

void write_map_file(const jam::ImportMap& map, const std::string& path, const std::string& how_to_read) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::string text = fmt::format("# {}\n\n[source]\nformat = \"{}\"\n", how_to_read, map.format);
  if (!map.creator.empty()) text += fmt::format("creator = {}\n", toml_string(map.creator));
  if (map.dt > 0) text += fmt::format("dt = {}\n", quantity(map.dt, "s"));
  text += fmt::format("gravity = {}\n", vector_text(map.gravity, "m/s2"));
  if (map.one_record_a_touch) text += "one_record_a_touch = true\n";
  if (!map.case_toml.empty()) {
    write_text_file((folder / "case.toml").string(), map.case_toml);
    text += "case = \"case.toml\"               # its [analysis] holds for these data\n";
  }
  text += table_text("particles", map.particles);
  text += table_text("pair_contacts", map.pair_contacts);
  text += table_text("wall_contacts", map.wall_contacts);
  text += table_text("wall_states", map.wall_states);
  for (const jam::ImportMaterial& m : map.materials) {
    text += fmt::format("\n[material.{}]\n", toml_string(m.material.name));
    if (m.type >= 0) text += fmt::format("type = {}\n", m.type);
    text += fmt::format("density = {}\nyoung = {}\npoisson = {:#}\n", quantity(m.material.density, "kg/m3"),
                        quantity(m.material.young, "Pa"), m.material.poisson);
  }
  for (std::size_t a = 0; a < map.interactions.size(); ++a) {
    for (std::size_t b = a; b < map.interactions.size(); ++b) {
      const jam::Interaction& i = map.interactions[a][b];
      text += fmt::format("\n[interaction.{}]\nrestitution = {:#}\nfriction = {:#}\nrolling_friction = {:#}\nwork_of_adhesion = {}\n",
                          toml_string(map.materials[a].material.name + "-" + map.materials[b].material.name), i.restitution,
                          i.friction, i.rolling, quantity(i.work_of_adhesion, "J/m2"));
    }
  }
  for (std::size_t w = 0; w < map.walls.size(); ++w) text += wall_text(map.walls[w], w, folder);
  if (map.gap.tip_radius > 0) {
    text += fmt::format("\n[gap]\ntip_radius = {}\nvessel_radius = {}\nz_low = {}\nz_high = {}\n",
                        quantity(map.gap.tip_radius, "m"), quantity(map.gap.vessel_radius, "m"),
                        quantity(map.gap.z_low, "m"), quantity(map.gap.z_high, "m"));
  }
  write_text_file(path, text);
}

}  // namespace jamscope
