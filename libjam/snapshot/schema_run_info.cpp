#include "libjam/snapshot/schema_run_info.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "libjam/errors.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/validate.hpp"

namespace jam {
namespace {

using schema::attribute_of;
using schema::column;
using schema::Item;
using schema::item;
using schema::object_of;
using schema::path_of;

constexpr std::array<std::string_view, 3> role_names{"other", "blade", "vessel"};  // in the order of WallRole

template <class V>
void set(h5::File& file, const Item& i, const V& value, std::string_view wall = {}) {
  file.set_attribute(object_of(i, wall), attribute_of(i), value);
}
void set_text(h5::File& file, const Item& i, const std::string& text, std::string_view wall = {}) {
  if (!text.empty()) file.set_attribute(object_of(i, wall), attribute_of(i), text);
}

template <class V>
V get(const h5::File& file, const Item& i, std::string_view wall = {}) {
  return file.attribute<V>(object_of(i, wall), attribute_of(i));
}
// Leaves `value` alone where the file does not have the attribute.
template <class V>
void get_optional(const h5::File& file, const Item& i, V& value, std::string_view wall = {}) {
  if (file.has_attribute(object_of(i, wall), attribute_of(i))) value = get<V>(file, i, wall);
}

template <class V>
void write(h5::File& file, const Item& i, const std::vector<V>& values, std::string_view wall = {}) {
  file.write(path_of(i, wall), values, std::string(i.unit), std::string(i.doc));
}

// f(item, member) of a material, of an interaction, of the gap.
template <class F>
void visit_material(F&& f) {
  f(column<double>("/materials/density"), &Material::density);
  f(column<double>("/materials/young"), &Material::young);
  f(column<double>("/materials/poisson"), &Material::poisson);
}
template <class F>
void visit_interaction(F&& f) {
  f(column<double>("/interactions/restitution"), &Interaction::restitution);
  f(column<double>("/interactions/friction"), &Interaction::friction);
  f(column<double>("/interactions/rolling"), &Interaction::rolling);
  f(column<double>("/interactions/work_of_adhesion"), &Interaction::work_of_adhesion);
}
template <class F>
void visit_gap(F&& f) {
  f(column<double>("/run@gap_tip_radius"), &Gap::tip_radius);
  f(column<double>("/run@gap_vessel_radius"), &Gap::vessel_radius);
  f(column<double>("/run@gap_z_low"), &Gap::z_low);
  f(column<double>("/run@gap_z_high"), &Gap::z_high);
}
template <class R, class F>
void visit_texts(R& info, F&& f) {
  f(item("/@creator"), info.creator);
  f(item("/@creator_version"), info.creator_version);
  f(item("/@commit"), info.commit);
  f(item("/@created_utc"), info.created_utc);
  f(item("/@case_sha256"), info.case_sha256);
}

void write_wall(h5::File& file, const Wall& wall, std::uint8_t id) {
  file.make_group("/walls/" + wall.name);
  set(file, column<std::uint8_t>("/walls/*@id"), id, wall.name);
  set_text(file, item("/walls/*@kind"), wall.kind, wall.name);
  set_text(file, item("/walls/*@role"), std::string(role_names[static_cast<std::size_t>(wall.role)]), wall.name);
  set_text(file, item("/walls/*@material"), wall.material, wall.name);
  set_text(file, item("/walls/*@torque_origin"), "pose_position", wall.name);
  const Wall none;
  const bool analytic = wall.kind != "mesh" && wall.kind != "spheres";
  if (analytic || wall.point != none.point) set(file, column<Vec3>("/walls/*@point"), wall.point, wall.name);
  if (analytic || wall.axis != none.axis) set(file, column<Vec3>("/walls/*@axis"), wall.axis, wall.name);
  if (wall.radius != 0 || wall.kind == "cone") set(file, column<double>("/walls/*@radius"), wall.radius, wall.name);
  if (wall.high_radius != 0 || wall.kind == "cone")
    set(file, column<double>("/walls/*@high_radius"), wall.high_radius, wall.name);
  if (wall.hole_radius != 0) set(file, column<double>("/walls/*@hole_radius"), wall.hole_radius, wall.name);
  if (std::isfinite(wall.low)) set(file, column<double>("/walls/*@low"), wall.low, wall.name);
  if (std::isfinite(wall.high)) set(file, column<double>("/walls/*@high"), wall.high, wall.name);
  set_text(file, item("/walls/*@free_side"), wall.free_side, wall.name);
  if (!wall.sphere_centre.empty()) {
    write(file, column<Vec3>("/walls/*/sphere_centre"), wall.sphere_centre, wall.name);
    write(file, column<double>("/walls/*/sphere_radius"), wall.sphere_radius, wall.name);
  }
  if (!wall.vertices.empty()) write(file, column<Vec3>("/walls/*/vertices"), wall.vertices, wall.name);
  if (!wall.triangles.empty()) {
    write(file, column<std::array<std::uint32_t, 3>>("/walls/*/triangles"), wall.triangles, wall.name);
  }
  if (!wall.triangle_label.empty()) {
    write(file, column<std::uint8_t>("/walls/*/triangle_label"), wall.triangle_label, wall.name);
  }
}

Wall read_wall(const h5::File& file, const std::string& name) {
  Wall wall;
  wall.name = name;
  wall.kind = get<std::string>(file, item("/walls/*@kind"), name);
  const auto role = get<std::string>(file, item("/walls/*@role"), name);
  const auto* const known = std::find(role_names.begin(), role_names.end(), role);
  if (known == role_names.end()) {
    file.fail(path_of(item("/walls/*@role"), name), "is '" + role + "', expected blade, vessel or other");
  }
  wall.role = static_cast<WallRole>(known - role_names.begin());
  get_optional(file, item("/walls/*@material"), wall.material, name);
  get_optional(file, column<Vec3>("/walls/*@point"), wall.point, name);
  get_optional(file, column<Vec3>("/walls/*@axis"), wall.axis, name);
  get_optional(file, column<double>("/walls/*@radius"), wall.radius, name);
  get_optional(file, column<double>("/walls/*@high_radius"), wall.high_radius, name);
  get_optional(file, column<double>("/walls/*@hole_radius"), wall.hole_radius, name);
  get_optional(file, column<double>("/walls/*@low"), wall.low, name);
  get_optional(file, column<double>("/walls/*@high"), wall.high, name);
  get_optional(file, item("/walls/*@free_side"), wall.free_side, name);
  const auto read = [&]<class V>(const Item& i, std::vector<V>& values) {
    if (const std::string path = path_of(i, name); file.exists(path)) values = file.read<V>(path);
  };
  read(column<Vec3>("/walls/*/sphere_centre"), wall.sphere_centre);
  read(column<double>("/walls/*/sphere_radius"), wall.sphere_radius);
  read(column<Vec3>("/walls/*/vertices"), wall.vertices);
  read(column<std::array<std::uint32_t, 3>>("/walls/*/triangles"), wall.triangles);
  read(column<std::uint8_t>("/walls/*/triangle_label"), wall.triangle_label);
  return wall;
}

}  // namespace

void write_run_info(h5::File& file, const RunInfo& info) {
  set_text(file, item("/@format"), std::string(schema::format));
  set(file, column<std::array<std::uint32_t, 2>>("/@schema_version"), schema::version);
  visit_texts(info, [&](const Item& i, const std::string& text) { set_text(file, i, text); });
  set(file, column<std::uint64_t>("/@seed"), info.seed);
  set(file, column<Vec3>("/@gravity"), info.gravity);
  if (info.dt != 0) set(file, column<double>("/@dt"), info.dt);

  file.make_group("/run");
  set(file, column<std::uint8_t>("/run@wall_loads_known"), std::uint8_t{info.wall_loads_known});
  if (info.watch_force > 0) {
    set(file, column<double>("/run@watch_force"), info.watch_force);
    set(file, column<std::uint64_t>("/run@watch_stride"), info.watch_stride);
    if (info.watch_radius > 0) set(file, column<double>("/run@watch_radius"), info.watch_radius);
  }
  const Gap& gap = info.gap;
  if (gap.tip_radius != 0 || gap.vessel_radius != 0 || gap.z_low != 0 || gap.z_high != 0) {
    visit_gap([&](const Item& i, double Gap::*member) { set(file, i, gap.*member); });
  }

  if (!info.case_toml.empty()) {
    file.write_text("/case/toml", info.case_toml, std::string(item("/case/toml").doc));
  }
  if (!info.argv.empty()) file.write_texts("/case/argv", info.argv, std::string(item("/case/argv").doc));

  if (!info.materials.empty()) {
    std::vector<std::string> names;
    for (const Material& m : info.materials) names.push_back(m.name);
    file.write_texts("/materials/name", names, std::string(item("/materials/name").doc));
    visit_material([&](const Item& i, double Material::*member) {
      std::vector<double> values;
      for (const Material& m : info.materials) values.push_back(m.*member);
      write(file, i, values);
    });
  }
  if (!info.interactions.empty()) {
    visit_interaction([&](const Item& i, double Interaction::*member) {
      std::vector<double> values;
      for (const auto& row : info.interactions) {
        for (const Interaction& pair : row) values.push_back(pair.*member);
      }
      file.write_matrix(path_of(i), values, info.interactions.size(), std::string(i.unit), std::string(i.doc));
    });
  }
  file.make_group("/walls");
  for (std::size_t w = 0; w < info.walls.size(); ++w) write_wall(file, info.walls[w], static_cast<std::uint8_t>(w));
}

RunInfo read_run_info(const h5::File& file) {
  if (!file.has_attribute("/", "format") || get<std::string>(file, item("/@format")) != schema::format) {
    file.fail("/@format", "not a snapshot file, expected '" + std::string(schema::format) + "'");
  }
  const auto version = get<std::array<std::uint32_t, 2>>(file, item("/@schema_version"));
  if (version[0] != schema::version[0]) {
    file.fail("/@schema_version", "is " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
                                      ", expected " + std::to_string(schema::version[0]) + ".x");
  }
  RunInfo info;
  visit_texts(info, [&](const Item& i, std::string& text) { get_optional(file, i, text); });
  info.seed = get<std::uint64_t>(file, column<std::uint64_t>("/@seed"));
  info.gravity = get<Vec3>(file, column<Vec3>("/@gravity"));
  get_optional(file, column<double>("/@dt"), info.dt);
  info.wall_loads_known = get<std::uint8_t>(file, column<std::uint8_t>("/run@wall_loads_known")) != 0;
  get_optional(file, column<double>("/run@watch_force"), info.watch_force);
  get_optional(file, column<std::uint64_t>("/run@watch_stride"), info.watch_stride);
  get_optional(file, column<double>("/run@watch_radius"), info.watch_radius);
  visit_gap([&](const Item& i, double Gap::*member) { get_optional(file, i, info.gap.*member); });
  if (file.exists("/case/toml")) info.case_toml = file.read_text("/case/toml");
  if (file.exists("/case/argv")) info.argv = file.read_texts("/case/argv");

  if (file.exists("/materials/name")) {
    for (const std::string& name : file.read_texts("/materials/name")) info.materials.push_back({.name = name});
    visit_material([&](const Item& i, double Material::*member) {
      const auto values = file.read<double>(path_of(i));
      if (values.size() != info.materials.size()) {
        file.fail(path_of(i),
                  "has " + std::to_string(values.size()) + " rows, expected " + std::to_string(info.materials.size()));
      }
      for (std::size_t m = 0; m < values.size(); ++m) info.materials[m].*member = values[m];
    });
  }
  if (const std::size_t n = info.materials.size(); file.exists("/interactions")) {
    info.interactions.assign(n, std::vector<Interaction>(n));
    visit_interaction([&](const Item& i, double Interaction::*member) {
      std::uint64_t columns = 0;
      const auto values = file.read_matrix<double>(path_of(i), columns);
      if (columns != n || values.size() != n * n) {
        file.fail(path_of(i), "has " + std::to_string(values.size()) + " values in " + std::to_string(columns) +
                                  " columns, expected " + std::to_string(n) + " x " + std::to_string(n));
      }
      for (std::size_t k = 0; k < values.size(); ++k) info.interactions[k / n][k % n].*member = values[k];
    });
  }

  const std::vector<std::string> names = file.children("/walls");
  info.walls.resize(names.size());
  std::vector<bool> seen(names.size(), false);
  for (const std::string& name : names) {
    const auto id = get<std::uint8_t>(file, column<std::uint8_t>("/walls/*@id"), name);
    if (id >= names.size() || seen[id]) {
      file.fail(path_of(item("/walls/*@id"), name),
                "is " + std::to_string(id) + ", expected unique numbers below " + std::to_string(names.size()));
    }
    seen[id] = true;
    info.walls[id] = read_wall(file, name);
  }
  validate(info, file.path());
  return info;
}

}  // namespace jam
