#include "libjam/jamming/check_criteria.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "libjam/errors.hpp"
#include "libjam/jamming/gap.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jam {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw CriteriaError(text.str());
}

void expect_not_negative(const char* name, double value) {
  if (!std::isfinite(value) || value < 0) refuse("criteria: ", name, " = ", value, ", expected a number >= 0");
}

void expect_role(const RunInfo& info, WallRole role, const char* name) {
  const auto has_role = [role](const Wall& wall) { return wall.role == role; };
  if (std::any_of(info.walls.begin(), info.walls.end(), has_role)) return;
  std::string walls;
  for (const Wall& wall : info.walls) walls += (walls.empty() ? "" : ", ") + wall.name;
  refuse("walls: none has the role ", name, " (walls: ", walls.empty() ? "none" : walls,
         "), expected at least one, because jams bridge a blade and a vessel");
}

}  // namespace

void check_criteria(const Criteria& criteria, const RunInfo& info) {
  const JamCriterion* criterion = find_jam_criterion(criteria.criterion);
  if (criterion == nullptr) {
    std::string names;
    for (const JamCriterion& row : jam_criteria()) names += (names.empty() ? "" : ", ") + std::string(row.name);
    refuse("criteria: criterion = \"", criteria.criterion, "\", expected one of ", names);
  }
  if (criteria.threshold) expect_not_negative("threshold", *criteria.threshold);
  const auto has_stiffness = [](const Material& m) { return m.young > 0; };
  if (criterion->of_stiffness && (info.materials.empty() || !std::all_of(info.materials.begin(), info.materials.end(), has_stiffness)))
    refuse("criteria: criterion = \"", criteria.criterion, "\" needs the Young's modulus of all materials, which the data do not have");
  if (criterion->of_gap && !gap_known(info)) refuse("criteria: criterion = \"", criteria.criterion, "\" needs the gap between blade tip and vessel, which the data do not have");
  expect_not_negative("jam_force", criteria.jam_force);
  expect_not_negative("hold_off", criteria.hold_off);
  expect_not_negative("shortest_jam", criteria.shortest_jam);
  if (criteria.end_force && !(*criteria.end_force >= 0 && *criteria.end_force <= criteria.jam_force))
    refuse("criteria: end_force = ", *criteria.end_force, " N, expected 0 to jam_force = ", criteria.jam_force, " N");
  expect_not_negative("bridge_contact_share", criteria.bridge_contact_share);
  expect_not_negative("gap_margin", criteria.gap_margin);
  double previous = 0;
  for (std::size_t k = 0; k < criteria.survival_classes.size(); ++k) {
    const double bound = criteria.survival_classes[k];
    if (!std::isfinite(bound) || bound <= previous) {
      refuse("criteria: survival_classes[", k, "] = ", bound, " s, expected more than ", previous, " s");
    }
    previous = bound;
  }
  expect_role(info, WallRole::blade, "blade");
  expect_role(info, WallRole::vessel, "vessel");
}

}  // namespace jam
