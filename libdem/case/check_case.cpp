#include "libdem/case/check_case.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>

#include "libdem/case/bed_region.hpp"
#include "libdem/errors.hpp"

namespace dem {
namespace {

// Above these shares of the smallest grain's Rayleigh time a run is refused, or warned about.
constexpr double step_refused = 0.30, step_warned = 0.20;
// A settled bed of more grains than this does not fit the identifiers and memory of one machine.
constexpr double most_grains = 5e7;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string percent(double share) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g %%", 100 * share);
  return buffer;
}

struct Checker {
  std::vector<CaseProblem> problems;

  void add(bool fatal, std::string key, std::string message) {
    problems.push_back({fatal, std::move(key), std::move(message)});
  }
  void refuse(std::string key, std::string message) { add(true, std::move(key), std::move(message)); }
  void warn(std::string key, std::string message) { add(false, std::move(key), std::move(message)); }

  // Each returns whether the value passed, so that later rules can build on it.
  bool positive(std::string key, double value, const char* unit) {
    if (value > 0 && std::isfinite(value)) return true;
    refuse(std::move(key), "must be positive, got " + text(value) + unit);
    return false;
  }
  bool not_negative(std::string key, double value, const char* unit) {
    if (value >= 0 && std::isfinite(value)) return true;
    refuse(std::move(key), "must not be negative, got " + text(value) + unit);
    return false;
  }
};

void check_materials(const Case& c, Checker& check) {
  const auto sticks = [](const Interaction& i) { return i.work_of_adhesion > 0; };
  if (c.contact.normal == "hertz" && std::any_of(c.interactions.begin(), c.interactions.end(), [&](const auto& row) {
        return std::any_of(row.begin(), row.end(), sticks);
      }))
    check.warn("contact.normal", "= hertz knows no adhesion: the work_of_adhesion of the interactions has no effect");
  for (const Material& m : c.materials) {
    const std::string key = "material." + m.name;
    check.positive(key + ".density", m.density, " kg/m3");
    check.positive(key + ".young", m.young, " Pa");
    if (!(m.poisson >= 0 && m.poisson <= 0.5))
      check.refuse(key + ".poisson", "must lie in [0, 0.5], got " + text(m.poisson));
    if (m.young > 0 && m.young < 1e4)
      check.warn(key + ".young", "is only " + text(m.young) + " Pa: is a prefix (MPa, GPa) missing?");
  }
  for (std::size_t a = 0; a < c.materials.size(); ++a)
    for (std::size_t b = a; b < c.materials.size(); ++b) {
      const Interaction& pair = c.interactions[a][b];
      const std::string key = "interaction." + c.materials[a].name + "-" + c.materials[b].name;
      if (!(pair.restitution > 0 && pair.restitution <= 1))
        check.refuse(key + ".restitution", "must lie in (0, 1], got " + text(pair.restitution));
      check.not_negative(key + ".friction", pair.friction, "");
      check.not_negative(key + ".rolling_friction", pair.rolling_friction, "");
      check.not_negative(key + ".work_of_adhesion", pair.work_of_adhesion, " J/m2");
    }
}

bool check_bed(const Case& c, Checker& check) {
  bool good = check.positive("bed.mean_diameter", c.bed.mean_diameter, " m");
  good &= check.positive("bed.size_low", c.bed.size_low, "");
  if (!(c.bed.size_high >= c.bed.size_low) || !std::isfinite(c.bed.size_high)) {
    check.refuse("bed.size_high",
                 "must not be smaller than bed.size_low = " + text(c.bed.size_low) + ", got " + text(c.bed.size_high));
    good = false;
  }
  good &= check.positive("bed.depth", c.bed.depth, " m");
  if (c.rheometer) good &= check.positive("vessel.diameter", c.vessel.diameter, " m");
  if (const auto& box = c.bed.box) {
    if (!(box->x_high > box->x_low))
      check.refuse("bed.x", "must rise, got " + text(box->x_low) + " m to " + text(box->x_high) + " m");
    if (!(box->y_high > box->y_low))
      check.refuse("bed.y", "must rise, got " + text(box->y_low) + " m to " + text(box->y_high) + " m");
    good &= box->x_high > box->x_low && box->y_high > box->y_low;
  } else if (!c.rheometer) {
    check.refuse("bed.x", "and y must say where the bed is, as there is no vessel");
    good = false;
  }
  if (!good) return false;

  const double largest = c.bed.size_high * c.bed.mean_diameter;
  if (c.bed.size_low + c.bed.size_high < 1.98 || c.bed.size_low + c.bed.size_high > 2.02)
    check.warn("bed.size_low", "and size_high are not symmetric about 1, so mean_diameter is not the mean" +
                                   (c.bed.sizes == Bed::Sizes::by_mass ? std::string(" by mass") : std::string()) +
                                   ": it is " + text((c.bed.size_low + c.bed.size_high) / 2) + " times that");
  if (c.bed.depth < largest) {
    check.refuse("bed.depth",
                 "leaves no bed: " + text(c.bed.depth) + " m is less than one grain of " + text(largest) + " m");
    good = false;
  }
  if (c.bed.box && clear_radius(*c.bed.box) < 0.5 * largest) {
    check.refuse("bed.x", "and y leave no room for one of the largest grains (" + text(largest) + " m)");
    good = false;
  }
  if (c.rheometer && c.vessel.diameter < 2 * largest) {
    check.refuse("vessel.diameter", "must be at least two of the largest grains (" + text(largest) + " m), got " +
                                        text(c.vessel.diameter) + " m");
    good = false;
  }
  if (good && derive(c).grains > most_grains) {
    check.refuse("bed.mean_diameter",
                 "would need " + text(derive(c).grains) + " grains for this bed, more than " + text(most_grains));
    good = false;
  }
  return good;
}

bool check_twisted_blade(const Case& c, const TwistedBlade& blade, Checker& check) {
  bool good = check.positive("blade.diameter", blade.diameter, " m");
  good &= check.positive("blade.height", blade.height, " m");
  good &= check.positive("blade.thickness", blade.thickness, " m");
  good &= check.positive("blade.twist_exponent", blade.twist_exponent, "");
  good &= check.not_negative("blade.shaft_diameter", blade.shaft_diameter, " m");
  good &= check.not_negative("blade.shaft_length", blade.shaft_length, " m");
  if (!(std::abs(blade.tip_twist) < std::numbers::pi / 2)) {
    check.refuse("blade.tip_twist",
                 "must lie in (-90, 90) deg, got " + text(blade.tip_twist * 180 / std::numbers::pi) + " deg");
    good = false;
  }
  if (good && blade.shaft_diameter >= blade.diameter) {
    check.refuse("blade.shaft_diameter", "must be smaller than blade.diameter = " + text(blade.diameter) + " m, got " +
                                             text(blade.shaft_diameter) + " m");
    good = false;
  }
  if (good && c.vessel.diameter > 0 && blade.diameter >= c.vessel.diameter) {
    check.refuse("blade.diameter", "must be smaller than vessel.diameter = " + text(c.vessel.diameter) + " m, got " +
                                       text(blade.diameter) + " m");
    good = false;
  }
  return good;
}

bool check_blade_and_motion(const Case& c, Checker& check) {
  bool blade = true;
  if (const auto* twisted = std::get_if<TwistedBlade>(&c.blade.shape))
    blade = check_twisted_blade(c, *twisted, check);
  else
    blade = check.positive("blade.scale", std::get<MeshFile>(c.blade.shape).scale, "");
  bool motion = check.positive("motion.tip_speed", c.motion.tip_speed, " m/s");
  if (!(std::abs(c.motion.helix_angle) < std::numbers::pi / 2)) {
    check.refuse("motion.helix_angle",
                 "must lie in (-90, 90) deg, got " + text(c.motion.helix_angle * 180 / std::numbers::pi) + " deg");
    motion = false;
  }
  return blade && motion;
}

void check_fit(const Case& c, double tip, Checker& check) {
  const double largest = c.bed.size_high * c.bed.mean_diameter;
  if (tip >= c.vessel.diameter / 2) {
    // A twisted blade has been told so in terms of its own diameter.
    if (std::holds_alternative<MeshFile>(c.blade.shape))
      check.refuse("blade.file",
                   "reaches " + text(tip) + " m from the axis, the vessel only " + text(c.vessel.diameter / 2) + " m");
    return;
  }
  const Derived d = derive(c, tip);
  const double lowest = std::min(c.blade.start_height, d.end_height);
  if (!(lowest > 0)) {
    const bool at_once = c.blade.start_height <= 0;
    check.refuse("blade.start_height",
                 at_once ? "must be positive (0 is the vessel floor), got " + text(c.blade.start_height) + " m"
                         : "= " + text(c.blade.start_height) + " m is too low: moving down at " +
                               text(-d.axial_velocity) + " m/s the blade reaches the floor after " +
                               text(-c.blade.start_height / d.axial_velocity) + " s of " + text(c.duration) + " s");
  } else if (lowest < largest) {
    check.warn("blade.start_height", "lets the blade come within " + text(lowest) +
                                         " m of the floor, less than the largest grain (" + text(largest) +
                                         " m): grains will be crushed there");
  }
  if (lowest > c.bed.depth)
    check.warn("blade.start_height",
               "keeps the blade above the bed (depth " + text(c.bed.depth) + " m) for the whole duration");
}

void check_step(const Case& c, Checker& check) {
  const Derived d = derive(c);
  const std::string share = percent(d.step_over_rayleigh_smallest);
  if (d.step_over_rayleigh_smallest > step_refused) {
    check.refuse("run.step", "= " + text(c.step) + " s is " + share + " of the smallest grain's Rayleigh time (" +
                                 text(d.rayleigh_smallest) + " s); at most " + percent(step_refused) +
                                 " is stable, 10 to 20 % is usual");
  } else if (d.step_over_rayleigh_smallest > step_warned) {
    check.warn("run.step", "= " + text(c.step) + " s is " + share + " of the smallest grain's Rayleigh time (" +
                               text(d.rayleigh_smallest) + " s); 10 to 20 % is usual");
  }
  if (d.mean_in_gap.critical_step > 0 && c.step > 0.5 * d.mean_in_gap.critical_step)
    check.warn("run.step", "= " + text(c.step) + " s is " + percent(c.step / d.mean_in_gap.critical_step) +
                               " of the critical step of a grain squeezed in the gap (" +
                               text(d.mean_in_gap.critical_step) + " s)");
}

// Results fall on steps at which all contacts are evaluated, so every interval must be a whole number of them.
void check_interval(const std::string& key, double interval, const Case& c, Checker& check) {
  if (!check.positive(key, interval, " s")) return;
  const double step = c.step * double(1U << c.levels), count = interval / step, whole = std::round(count);
  if (whole < 1 || std::abs(count - whole) > 1e-6 * std::max(1.0, whole)) {
    const std::string levels =
        c.levels == 0
            ? ""
            : " (" + std::to_string(1U << c.levels) + " steps of " + text(c.step) + " s, after which all contacts meet)";
    check.refuse(key, "must be a whole number of steps of " + text(step) + " s" + levels + ", got " + text(interval) +
                          " s = " + text(count) + " steps");
  } else if (interval > c.duration * (1 + 1e-12)) {
    check.warn(key, "= " + text(interval) + " s is longer than the run (" + text(c.duration) + " s)");
  }
}

bool known_materials(const Case& c, Checker& check) {
  bool good = true;
  const auto known = [&](const std::string& name) {
    return std::any_of(c.materials.begin(), c.materials.end(), [&](const Material& m) { return m.name == name; });
  };
  for (const auto& [key, name, used] :
       {std::tuple<const char*, const std::string&, bool>{"bed.material", c.bed.material, true},
        {"vessel.material", c.vessel.material, c.rheometer},
        {"blade.material", c.blade.material, c.rheometer}})
    if (used && !known(name)) {
      check.refuse(key, "is not among the materials: '" + name + "'");
      good = false;
    }
  bool square = c.interactions.size() == c.materials.size();
  for (const auto& row : c.interactions) square &= row.size() == c.materials.size();
  if (!square) {
    check.refuse("interaction", "must be given for every pair of materials");
    good = false;
  }
  return good;
}

}  // namespace

std::vector<CaseProblem> case_problems(const Case& c, double tip) {
  Checker check;
  if (!known_materials(c, check)) return check.problems;  // nothing else can be worked out
  check_materials(c, check);
  const bool bed = check_bed(c, check);
  const bool rheometer = c.rheometer && check_blade_and_motion(c, check);
  if (!c.rheometer && !(c.domain_low.array() < c.domain_high.array()).all())
    check.refuse("domain.high", "must lie above domain.low in every direction");
  const bool duration = check.positive("run.duration", c.duration, " s");
  const bool open = c.automatic_step && c.step == 0;  // not chosen yet
  bool step = !open && check.positive("run.step", c.step, " s");
  if (c.levels > most_levels) {
    check.refuse("run.levels", "must be at most " + std::to_string(most_levels) + ", got " + std::to_string(c.levels));
    step = false;
  }
  if (!(c.accuracy > 0 && c.accuracy <= most_accuracy))
    check.refuse("run.accuracy", "must lie above 0 and be at most " + text(most_accuracy) + ", got " + text(c.accuracy));
  const double gravity = c.gravity.norm();
  if (!(gravity > 0) || !std::isfinite(gravity))
    check.refuse("run.gravity", "must be positive, or the bed does not settle; got " + text(gravity) + " m/s2");

  const bool grains = bed && std::none_of(check.problems.begin(), check.problems.end(), [](const CaseProblem& p) {
                        return p.fatal && p.key.starts_with("material.");
                      });
  const Capture& capture = c.output.capture;
  if (!(capture.before >= 0)) check.refuse("output.capture_before", "must not be negative, got " + text(capture.before) + " s");
  if (!(capture.after >= 0)) check.refuse("output.capture_after", "must not be negative, got " + text(capture.after) + " s");
  check.positive("output.capture_gigabytes", capture.most_bytes / 1e9, " GB");
  if (grains && rheometer && duration && tip > 0) check_fit(c, tip, check);
  if (grains && step) check_step(c, check);
  if (duration && step) {
    check_interval("run.duration", c.duration, c, check);
    check_interval("output.frame_interval", c.output.frame_interval, c, check);
    check_interval("output.series_interval", c.output.series_interval, c, check);
    check_interval("output.checkpoint_interval", c.output.checkpoint_interval, c, check);
    if (c.output.capture.interval != 0) check_interval("output.capture_interval", c.output.capture.interval, c, check);
  }
  return check.problems;
}

std::vector<std::string> check_case(const Case& c) {
  std::vector<std::string> warnings;
  for (const CaseProblem& p : case_problems(c)) {
    if (p.fatal) throw CaseError(p.key + " " + p.message);
    warnings.push_back(p.key + " " + p.message);
  }
  return warnings;
}

}  // namespace dem
