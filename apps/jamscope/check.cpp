#include "apps/jamscope/check.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/jamscope/derived_table.hpp"
#include "apps/jamscope/sha256.hpp"
#include "libdem/case/check_case.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/blade_surface.hpp"

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
  dem::BladeSurface blade;
  std::vector<DerivedRow> rows;
  std::vector<std::string> warnings;
};

Checked checked(const CaseFile& file) {
  Checked result;
  try {
    result.blade = dem::blade_surface(file.physics);
  } catch (const dem::GeometryError& error) {
    throw dem::GeometryError(fmt::format("{}: {}", file.path, error.what()));
  }
  const double tip = result.blade.extent.tip_radius;
  result.rows = derived_table(file.physics, dem::derive(file.physics, tip));
  result.warnings = file.warnings;
  if (dem::tip_radius(file.physics) == 0)  // a mesh, whose fit could not be judged without its tip radius
    for (const dem::CaseProblem& p : dem::case_problems(file.physics, tip)) {
      const std::string warning = fmt::format("{}: {} {}", file.path, p.key, p.message);
      if (p.fatal) throw dem::CaseError(warning);
      result.warnings.push_back(warning);
    }
  return result;
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
  text += fmt::format("\nblade surface: {} triangles, closed; {:.3g} mm clear of the wall, {:.3g} mm of the floor\n",
                      check.blade.mesh.triangles.size(), 1e3 * check.blade.clearance.radial,
                      1e3 * check.blade.clearance.floor);
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
  for (const DerivedRow& row : derived_table(c, dem::derive(c)))
    json["derived"][row.group][identifier(row.name)] = row.si;
  json["blade"] = {{"triangles", check.blade.mesh.triangles.size()},
                   {"radial_clearance", check.blade.clearance.radial},
                   {"floor_clearance", check.blade.clearance.floor}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace jamscope
