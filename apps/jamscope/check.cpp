#include "apps/jamscope/check.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/jamscope/derived_table.hpp"
#include "apps/jamscope/sha256.hpp"
#include "apps/jamscope/simulation_view.hpp"
#include "libdem/case/check_case.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/blade_surface.hpp"
#include "libdem/scene/scene.hpp"

namespace jamscope {
namespace {

// "Rayleigh time, mean grain" -> "rayleigh_time_mean_grain".
std::string identifier(const std::string& name) {
  std::string key;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z')
      key += static_cast<char>(c - 'A' + 'a');
    else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      key += c;
    else if (c == ' ')
      key += '_';
  }
  return key;
}

// What needs the blade's surface, and so cannot be said by reading the file alone.
struct Checked {
  std::optional<dem::BladeSurface> blade;  // of a rheometer
  dem::Scene scene;
  std::vector<DerivedRow> rows;
  std::vector<std::string> warnings;
};

Checked checked(const CaseFile& file) {
  Checked result;
  try {
    if (file.physics.rheometer) result.blade = dem::blade_surface(file.physics);
    result.scene = dem::make_scene(file.physics, file.walls);
  } catch (const dem::GeometryError& error) {
    throw dem::GeometryError(fmt::format("{}: {}", file.path, error.what()));
  }
  const double tip = result.blade ? result.blade->extent.tip_radius : 0;
  result.rows = derived_table(file.physics, dem::derive(file.physics, tip));
  result.warnings = file.warnings;
  if (result.blade && dem::tip_radius(file.physics) == 0)  // a mesh, whose fit could not be judged without its tip radius
    for (const dem::CaseProblem& p : dem::case_problems(file.physics, tip)) {
      const std::string warning = fmt::format("{}: {} {}", file.path, p.key, p.message);
      if (p.fatal) throw dem::CaseError(warning);
      result.warnings.push_back(warning);
    }
  return result;
}

const char* role_name(dem::WallRole role) {
  switch (role) {
    case dem::WallRole::blade:
      return "blade";
    case dem::WallRole::vessel:
      return "vessel";
    case dem::WallRole::other:
      break;
  }
  return "other";
}

std::string wall_line(const dem::Scene& scene, std::size_t w) {
  const dem::Wall& wall = scene.setup.walls[w];
  const double speed = dem::largest_speed(wall);
  const std::string motion = speed > 0 ? fmt::format("moves at up to {:.3g} mm/s", 1e3 * speed) : "at rest";
  return fmt::format("  {:<32}{:>11} {:<6} of {}, {}\n", wall.name, wall_kind(wall.shape), role_name(scene.roles[w]),
                     scene.setup.materials[wall.material].name, motion);
}

}  // namespace

std::string check_text(const CaseFile& file) {
  const dem::Case& c = file.physics;
  const Checked check = checked(file);
  std::string text = fmt::format("{}: {}\n{}\n", c.name, c.description, file.path);
  std::string group;
  for (const DerivedRow& row : check.rows) {
    if (row.group != group) text += fmt::format("\n{}\n", row.group);
    group = row.group;
    std::string line = fmt::format("  {:<32}{:>11} {:<6}{}", row.name, row.value, row.unit, row.note);
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  text += "\nwalls\n";
  for (std::size_t w = 0; w < check.scene.roles.size(); ++w) text += wall_line(check.scene, w);
  if (check.blade)
    text += fmt::format("\nblade surface: {} triangles, closed; {:.3g} mm clear of the wall, {:.3g} mm of the floor\n",
                        check.blade->mesh.triangles.size(), 1e3 * check.blade->clearance.radial,
                        1e3 * check.blade->clearance.floor);
  for (const std::string& warning : check.warnings) text += fmt::format("warning: {}\n", warning);
  return text;
}

std::string check_json(const CaseFile& file) {
  const dem::Case& c = file.physics;
  const Checked check = checked(file);
  nlohmann::ordered_json json{{"name", c.name},
                              {"description", c.description},
                              {"case_sha256", sha256_hex(file.text)},
                              {"warnings", check.warnings}};
  for (const DerivedRow& row : check.rows)
    json["derived"][row.group][identifier(row.name)] = row.si;
  for (std::size_t w = 0; w < check.scene.roles.size(); ++w) {
    const dem::Wall& wall = check.scene.setup.walls[w];
    json["walls"].push_back({{"name", wall.name},
                             {"kind", wall_kind(wall.shape)},
                             {"role", role_name(check.scene.roles[w])},
                             {"material", check.scene.setup.materials[wall.material].name},
                             {"largest_speed", dem::largest_speed(wall)}});
  }
  if (check.blade)
    json["blade"] = {{"triangles", check.blade->mesh.triangles.size()},
                     {"radial_clearance", check.blade->clearance.radial},
                     {"floor_clearance", check.blade->clearance.floor}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace jamscope
