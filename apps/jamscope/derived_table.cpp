#include "apps/jamscope/derived_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apps/jamscope/console.hpp"
#include "libdem/case/automatic_step.hpp"
#include "libdem/contact/rolling/rolling.hpp"

namespace jamscope {
namespace {

// Three digits, with an SI prefix that leaves one to three of them before the point.
struct Scaled {
  std::string value, unit;
};
Scaled scaled(double si, const std::string& unit) {
  constexpr std::array<const char*, 9> prefixes{"p", "n", "u", "m", "", "k", "M", "G", "T"};
  int step = 0;  // powers of 1000
  if (si != 0 && std::isfinite(si)) step = static_cast<int>(std::floor(std::log10(std::abs(si) * (1 + 1e-12)) / 3));
  step = std::clamp(step, -4, 4);
  return {fmt::format("{:.3g}", si / std::pow(1000.0, step)),
          fmt::format("{}{}", prefixes[static_cast<std::size_t>(step + 4)], unit)};
}

std::string whole(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  for (std::size_t at = digits.size(); at > 3 && digits.size() > 4; at -= 3) {
    if (at - 3 == 0) break;
    digits.insert(at - 3, 1, ' ');
  }
  return digits;
}

}  // namespace

std::vector<DerivedRow> derived_table(const dem::Case& c, const dem::Derived& d) {
  std::vector<DerivedRow> rows;
  const auto add = [&](const char* group, const char* name, double si, const char* unit, std::string note = "") {
    const Scaled s = scaled(si, unit);
    rows.push_back({group, name, s.value, s.unit, std::move(note), si});
  };
  const auto add_plain = [&](const char* group, const char* name, double value, std::string text,
                             std::string note = "") {
    rows.push_back({group, name, std::move(text), "", std::move(note), value});
  };
  const auto percent = [](double share) { return fmt::format("{:.3g} %", 100 * share); };

  if (c.rheometer) {
    add("motion", "axial velocity u", d.axial_velocity, "m/s", d.axial_velocity < 0 ? "downward" : "upward");
    rows.push_back({"motion", "angular velocity omega", fmt::format("{:.3g}", d.angular_velocity), "rad/s",
                    c.motion.clockwise ? "clockwise seen from above" : "counter-clockwise seen from above",
                    d.angular_velocity});
    add("motion", "travel", d.travel, "m", fmt::format("{:.3g} turns", d.turns));
    add("motion", "lowest point at the end", d.end_height, "m", "above the floor");
    add("motion", "gap between tip and vessel", d.gap, "m",
        fmt::format("{:.2f} of the mean grain, {:.2f} of D90", d.gap_over_mean, d.gap_over_d90));
  }

  add_plain(
      "bed", "grains", d.grains, whole(d.grains),
      fmt::format("estimate; {} at solid fraction 0.56 to {} at 0.64", whole(d.grains_loose), whole(d.grains_dense)));
  add("bed", "grain diameter", c.bed.mean_diameter, "m",
      fmt::format("on average; {:.3g} to {:.3g} mm", 1e3 * d.smallest_diameter, 1e3 * d.largest_diameter));
  add("bed", "mass of the mean grain", d.mean_mass * 1e3, "g");
  rows.back().si = d.mean_mass;

  const auto modulus = [](double pascal) {
    const Scaled s = scaled(pascal, "Pa");
    return s.value + " " + s.unit;
  };
  add("contact", "effective modulus E*", d.modulus, "Pa",
      c.rheometer ? fmt::format("vessel {}, blade {}", modulus(d.modulus_vessel), modulus(d.modulus_blade)) : "");
  add("contact", "pull-off force", d.pull_off_force, "N", "3/2 pi W R*");
  add_plain("contact", "Bond number", d.bond, fmt::format("{:.3g}", d.bond), "3/2 pi W R / (m g)");
  add_plain("contact", "Cohesion number", d.cohesion, fmt::format("{:.2g}", d.cohesion),
            "(W^5 / (E^2 R^8))^(1/3) / (rho g)");
  if (c.rheometer) add("contact", "mean grain squeezed in the gap", d.mean_in_gap.force, "N", d.mean_in_gap.force > 0 ? "" : "it fits");
  if (c.rheometer) {
    const bool flat = d.entrance > d.gap;
    add("contact", "friction draws in grains up to", d.drawn_in, "m",
        fmt::format("{} of them do not fit through the gap and get in; gap (1 + mu^2){}", percent(d.drawn_in_share),
                    flat ? fmt::format(", {:.3g} mm in the middle of flat tips", 1e3 * d.entrance) : ""));
    add("contact", "largest of them squeezed", d.largest_in_gap.force, "N",
        d.largest_in_gap.force > 0 ? (flat ? "by blade and vessel each, at most: rolled into the narrowest place" : "by blade and vessel each") : "none is");
  }
  // A grain that rolls between tip and vessel goes at half the tip's speed.
  const double rolling_friction =
      c.rheometer ? c.interactions[dem::material_index(c, c.bed.material)][dem::material_index(c, c.blade.material)].rolling_friction : 0;
  if (rolling_friction > 0 && c.contact.rolling != "none" && c.contact.rolling != "elastic_plastic") {
    const double radius = c.bed.mean_diameter / 2, spin = c.motion.tip_speed / c.bed.mean_diameter;
    add("contact", "rolling resistance in full up to", dem::rolling::full_torque_force(d.mean_mass, radius, spin, rolling_friction, c.step), "N",
        "on a grain that rolls along the tip, at this step; rolling = \"elastic_plastic\" has no such limit");
  }

  add("time", "step", c.step, "s",
      fmt::format("{} of the smallest grain's Rayleigh time, {} of the mean one's",
                  percent(d.step_over_rayleigh_smallest), percent(d.step_over_rayleigh_mean)));
  if (c.levels > 0)
    add("time", "longest step", c.step * double(1U << c.levels), "s",
        fmt::format("contacts step at their own rate, every 1 to {} steps, accuracy {:.3g}", 1U << c.levels, c.accuracy));
  if (c.automatic_step) {
    const dem::StepChoice choice = dem::choose_steps(c);
    add("time", "wanted by the stiffest contact", choice.stiffest, "s",
        d.mean_in_gap.force > 0 ? "a mean grain squeezed in the gap" : "a mean grain squeezed by 5 % of its diameter");
    add("time", "wanted by the softest contact", choice.softest, "s", "a mean grain on another under ten times its weight");
  }
  add("time", "Rayleigh time, smallest grain", d.rayleigh_smallest, "s");
  add("time", "Rayleigh time, mean grain", d.rayleigh_mean, "s");
  if (c.rheometer) add("time", "critical step in the gap", d.mean_in_gap.critical_step, "s",
      d.mean_in_gap.force > 0 ? fmt::format("the step is {} of it", percent(c.step / d.mean_in_gap.critical_step))
                              : "nothing is squeezed");
  if (c.rheometer) add("time", "Hertz contact time at tip speed", d.contact_time, "s",
      fmt::format("{:.3g} steps", d.contact_time / c.step));

  add_plain("cost", "steps", d.steps, whole(d.steps), fmt::format("for {} s", c.duration));
  add_plain("cost", "frames", d.frames, whole(d.frames),
            fmt::format("and {} rows of series, {} checkpoints", whole(d.series_rows), whole(d.checkpoints)));
  // The rates between which dense runs lie on one core of machines with AVX2 or AVX-512.
  add_plain("cost", "grain steps", d.particle_steps, fmt::format("{:.2g}", d.particle_steps),
            fmt::format("{} to {} on one core at 5 to 15 million a second{}", duration_text(d.particle_steps / 5e6),
                        duration_text(d.particle_steps / 15e6),
                        c.levels > 0 ? ", less what contacts at their own rate save (jamscope bench)" : ""));
  add("cost", "disk", d.bytes_on_disk, "B", "estimate, compressed");
  return rows;
}

}  // namespace jamscope
