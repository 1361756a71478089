#include "libjam/snapshot/validate.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include "libjam/errors.hpp"
#include "libjam/snapshot/schema.hpp"

namespace jam {
namespace {

using schema::Item;
using schema::Need;

[[noreturn]] void fail(const std::string& place, const std::string& problem) {
  throw DataError(place + ": " + problem);
}

std::string text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}
template <class I>
requires std::is_integral_v<I> std::string text(I value) {
  return std::to_string(value);
}

void check_finite(double value, const std::string& what, const std::string& place) {
  if (!std::isfinite(value)) fail(place, what + " is " + text(value) + ", expected a finite number");
}
void check_finite(const Vec3& value, const std::string& what, const std::string& place) {
  for (const double x : value) check_finite(x, what, place);
}
void check_not_negative(double value, const std::string& what, const std::string& place) {
  if (!(value >= 0) || !std::isfinite(value)) fail(place, what + " is " + text(value) + ", expected a number >= 0");
}

// Are all numbers finite? Without a branch for each, of which there are half a million in a frame: x - x is 0 of a finite number, else not a number.
template <class Number>
bool all_finite(const Number* numbers, std::size_t count) {
  constexpr std::size_t width = 16;
  std::array<Number, width> sum{};
  std::size_t k = 0;
  for (; k + width <= count; k += width)
    for (std::size_t lane = 0; lane < width; ++lane) sum[lane] += numbers[k + lane] - numbers[k + lane];
  for (; k < count; ++k) sum[0] += numbers[k] - numbers[k];
  return std::all_of(sum.begin(), sum.end(), [](Number s) { return s == 0; });
}

// Floating-point columns only; integers have no bad values of their own.
template <class V>
void check_all_finite(const std::vector<V>& values, const std::string& name, const std::string& place) {
  constexpr h5::Type type = h5::Row<V>::type;
  constexpr unsigned width = h5::Row<V>::width;
  if constexpr (type == h5::Type::f4 || type == h5::Type::f8) {
    using Number = std::conditional_t<type == h5::Type::f4, float, double>;
    static_assert(sizeof(V) == width * sizeof(Number));
    if (values.empty()) return;
    const Number* numbers = nullptr;
    if constexpr (width == 1)
      numbers = values.data();
    else
      numbers = values.front().data();
    if (all_finite(numbers, width * values.size())) return;
    for (std::size_t k = 0; k < width * values.size(); ++k) {
      if (std::isfinite(numbers[k])) continue;
      fail(place, name + " row " + text(k / width) + (width > 1 ? " component " + text(k % width) : "") + " is " + text(double(numbers[k])) +
                      ", expected a finite number");
    }
  }
}

template <class V>
void check_column(const Item& item, const std::string& name, const std::vector<V>& values, std::size_t rows,
                  const std::string& place) {
  if (values.size() != rows && !(item.need == Need::optional && values.empty())) {
    fail(place, name + " has " + text(values.size()) + " rows, expected " + text(rows) +
                    (item.need == Need::optional ? " or none" : ""));
  }
  check_all_finite(values, name, place);
}

void check_particles(const Particles& p, const RunInfo& info, const std::string& place) {
  schema::visit_particles(p, [&](const Item& item, const auto& values) {
    check_column(item, std::string(item.path), values, p.size(), place);
  });
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i > 0 && p.id[i] <= p.id[i - 1]) {
      fail(place, "particle row " + text(i) + " has id " + text(p.id[i]) + " after id " + text(p.id[i - 1]) +
                      ", expected ascending unique ids");
    }
    if (!(p.radius[i] > 0)) {
      fail(place, "particle " + text(p.id[i]) + " has radius " + text(double(p.radius[i])) + " m, expected > 0");
    }
    if (!p.material.empty() && p.material[i] >= info.materials.size()) {
      fail(place, "particle " + text(p.id[i]) + " names material " + text(p.material[i]) + ", the run has " +
                      text(info.materials.size()) + " materials");
    }
    if (!p.compressive_force.empty() && p.compressive_force[i] < 0) {
      fail(place, "particle " + text(p.id[i]) + " has compressive force " + text(double(p.compressive_force[i])) +
                      " N, expected >= 0");
    }
  }
}

void check_pp(const ParticleContacts& c, std::size_t particles, const std::string& place) {
  schema::visit_pp(c, [&](const Item& item, const auto& values) {
    check_column(item, std::string(item.path), values, c.size(), place);
  });
  // Mostly all is well, which one loop without a branch finds out.
  bool fine = true;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto [i, j] = c.row[k];
    fine &= (i < j) & (j < particles);
  }
  for (std::size_t k = 1; k < c.size(); ++k) {
    const auto [i, j] = c.row[k];
    const auto [before_i, before_j] = c.row[k - 1];
    fine &= (before_i < i) | ((before_i == i) & (before_j < j));
  }
  if (fine) return;
  for (std::size_t k = 0; k < c.size(); ++k) {
    for (const std::uint32_t row : c.row[k]) {
      if (row >= particles) {
        fail(place, "contact " + text(k) + " names particle row " + text(row) + ", the frame has " + text(particles));
      }
    }
    if (c.row[k][0] >= c.row[k][1]) {
      fail(place, "contact " + text(k) + " has particle rows " + text(c.row[k][0]) + ", " + text(c.row[k][1]) +
                      ", expected the smaller first");
    }
    if (k > 0 && c.row[k] <= c.row[k - 1]) {
      fail(place, "contact " + text(k) + " of rows " + text(c.row[k][0]) + ", " + text(c.row[k][1]) + " follows rows " +
                      text(c.row[k - 1][0]) + ", " + text(c.row[k - 1][1]) + ", expected sorted unique pairs");
    }
  }
}

constexpr std::array<std::string_view, 6> wall_kinds{"plane", "cylinder", "cone", "disc", "spheres", "mesh"};

void check_wall_shape(const Wall& w, const std::string& name, const std::string& place) {
  check_finite(w.point, name + ": point", place);
  check_finite(w.axis, name + ": axis", place);
  check_not_negative(w.radius, name + ": radius", place);
  check_not_negative(w.high_radius, name + ": high radius", place);
  check_not_negative(w.hole_radius, name + ": hole radius", place);
  if (w.kind != "mesh" && w.kind != "spheres" && std::abs(w.axis.norm() - 1) > 1e-6) {
    fail(place, name + " has an axis of length " + text(w.axis.norm()) + ", expected 1");
  }
  if ((w.kind == "cylinder" || w.kind == "disc") && !(w.radius > 0)) {
    fail(place, name + " has radius 0, expected > 0");
  }
  if (w.kind == "cone") {
    if (!(w.radius > 0 || w.high_radius > 0)) fail(place, name + " has radius 0 at both ends, expected one > 0");
    check_finite(w.low, name + ": low", place);
    check_finite(w.high, name + ": high", place);
  }
  if (!(w.low < w.high)) {
    fail(place, name + " has its ends at " + text(w.low) + " m and " + text(w.high) + " m, expected the lower first");
  }
  if (w.kind == "disc" && !(w.hole_radius < w.radius)) {
    fail(place, name + " has a hole of radius " + text(w.hole_radius) + " m, expected less than its own radius, " +
                    text(w.radius) + " m");
  }
  if (!w.free_side.empty() && w.free_side != "inside" && w.free_side != "outside") {
    fail(place, name + " has its free side '" + w.free_side + "', expected inside or outside");
  }
  if (w.sphere_centre.size() != w.sphere_radius.size() || (w.kind == "spheres") != !w.sphere_centre.empty()) {
    fail(place, name + " of kind " + w.kind + " has " + text(w.sphere_centre.size()) + " centres and " +
                    text(w.sphere_radius.size()) + " radii of spheres");
  }
  check_all_finite(w.sphere_centre, name + ": sphere centres", place);
  for (std::size_t s = 0; s < w.sphere_radius.size(); ++s) {
    if (!(w.sphere_radius[s] > 0) || !std::isfinite(w.sphere_radius[s])) {
      fail(place, name + ": sphere " + text(s) + " has radius " + text(w.sphere_radius[s]) + " m, expected > 0");
    }
  }
}

void check_pw(const WallContacts& c, std::size_t particles, const RunInfo& info, const std::string& place) {
  schema::visit_pw(c, [&](const Item& item, const auto& values) {
    check_column(item, std::string(item.path), values, c.size(), place);
  });
  const auto key = [&](std::size_t k) {
    return std::tuple(c.row[k], c.wall[k], c.facet.empty() ? std::uint32_t{0} : c.facet[k]);
  };
  for (std::size_t k = 0; k < c.size(); ++k) {
    const std::string name = "wall contact " + text(k);
    if (c.row[k] >= particles) {
      fail(place, name + " names particle row " + text(c.row[k]) + ", the frame has " + text(particles));
    }
    if (c.wall[k] >= info.walls.size()) {
      fail(place, name + " names wall " + text(c.wall[k]) + ", the run has " + text(info.walls.size()));
    }
    const Wall& touched = info.walls[c.wall[k]];
    const std::size_t facets = touched.kind == "spheres" ? touched.sphere_radius.size() : touched.triangles.size();
    if (!c.facet.empty() && facets > 0 && c.facet[k] >= facets) {
      fail(place, name + " names facet " + text(c.facet[k]) + ", wall '" + touched.name + "' has " + text(facets));
    }
    if (!c.feature.empty() && c.feature[k] > static_cast<std::uint8_t>(WallFeature::vertex)) {
      fail(place, name + " has feature " + text(c.feature[k]) + ", expected 0, 1 or 2");
    }
    // Text formats carry about four digits.
    if (!c.normal.empty() && std::abs(c.normal[k].norm() - 1.0F) > 1e-3F) {
      fail(place, name + " has a normal of length " + text(double(c.normal[k].norm())) + ", expected 1");
    }
    if (k > 0 && key(k) < key(k - 1)) fail(place, name + " is out of order, expected sorted by row, wall, facet");
  }
}

}  // namespace

void validate(const RunInfo& info, const std::string& place) {
  check_finite(info.gravity, "gravity", place);
  check_not_negative(info.dt, "dt", place);
  check_not_negative(info.watch_force, "watch_force", place);
  check_not_negative(info.watch_radius, "watch_radius", place);
  check_not_negative(info.gap.tip_radius, "gap tip radius", place);
  check_not_negative(info.gap.vessel_radius, "gap vessel radius", place);
  check_finite(info.gap.z_low, "gap z_low", place);
  check_finite(info.gap.z_high, "gap z_high", place);

  std::set<std::string> materials;
  if (info.materials.size() > 256) fail(place, text(info.materials.size()) + " materials, expected at most 256");
  for (const Material& m : info.materials) {
    if (!materials.insert(m.name).second) fail(place, "material name '" + m.name + "' is used twice");
    const std::string name = "material '" + m.name + "': ";
    check_not_negative(m.density, name + "density", place);
    check_not_negative(m.young, name + "Young's modulus", place);
    check_finite(m.poisson, name + "Poisson's ratio", place);
  }
  const std::size_t rows = info.interactions.size();
  if (rows != 0 && rows != info.materials.size()) {
    fail(place, text(rows) + " rows of interactions, expected one per material, " + text(info.materials.size()));
  }
  for (const auto& row : info.interactions) {
    if (row.size() != rows) {
      fail(place, "a row of interactions has " + text(row.size()) + " entries, expected " + text(rows));
    }
    for (const Interaction& i : row) {
      check_finite(i.restitution, "restitution", place);
      check_finite(i.friction, "friction", place);
      check_finite(i.rolling, "rolling friction", place);
      check_finite(i.work_of_adhesion, "work of adhesion", place);
    }
  }

  std::set<std::string> names;
  if (info.walls.size() > 256) fail(place, text(info.walls.size()) + " walls, expected at most 256");
  for (const Wall& w : info.walls) {
    const std::string name = "wall '" + w.name + "'";
    if (w.name.empty() || w.name == "." || w.name == ".." || w.name.find('/') != std::string::npos ||
        w.name.find('\0') != std::string::npos) {
      fail(place, name + ": expected a name without '/' that is not empty, '.' or '..'");
    }
    if (!names.insert(w.name).second) fail(place, name + ": the name is used twice");
    if (std::ranges::find(wall_kinds, w.kind) == wall_kinds.end()) {
      fail(place, name + " has kind '" + w.kind + "', expected plane, cylinder, cone, disc, spheres or mesh");
    }
    if (w.role > WallRole::vessel) fail(place, name + " has an unknown role, expected blade, vessel or other");
    if (!w.material.empty() && !materials.contains(w.material)) {
      fail(place, name + " names material '" + w.material + "', which the run does not have");
    }
    check_wall_shape(w, name, place);
    check_all_finite(w.vertices, name + ": vertices", place);
    for (std::size_t t = 0; t < w.triangles.size(); ++t) {
      for (const std::uint32_t v : w.triangles[t]) {
        if (v >= w.vertices.size()) {
          fail(place, name + ": triangle " + text(t) + " names vertex " + text(v) + ", the mesh has " +
                          text(w.vertices.size()));
        }
      }
    }
    if (!w.triangle_label.empty() && w.triangle_label.size() != w.triangles.size()) {
      fail(place, name + " has " + text(w.triangle_label.size()) + " triangle labels, expected " +
                      text(w.triangles.size()) + " or none");
    }
  }
}

void validate(const Snapshot& s, const RunInfo& info, const std::string& place) {
  check_finite(s.time, "time", place);
  if (s.walls.size() != info.walls.size()) {
    fail(place, text(s.walls.size()) + " wall states, expected one per wall, " + text(info.walls.size()));
  }
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    const WallState& state = s.walls[w];
    const std::string name = "wall '" + info.walls[w].name + "': ";
    check_finite(state.position, name + "position", place);
    check_finite(state.velocity, name + "velocity", place);
    check_finite(state.angular_velocity, name + "angular velocity", place);
    check_finite(state.force, name + "force", place);
    check_finite(state.torque, name + "torque", place);
    const double norm = state.orientation.norm();
    if (!(std::abs(norm - 1) <= 1e-6)) {
      fail(place, name + "orientation quaternion of length " + text(norm) + ", expected 1");
    }
  }
  check_particles(s.particles, info, place);
  check_pp(s.pp, s.particles.size(), place);
  check_pw(s.pw, s.particles.size(), info, place);
}

void validate(const Series& s, const RunInfo& info, const std::string& place) {
  if (s.walls.size() > info.walls.size()) {
    fail(place, text(s.walls.size()) + " walls in the series, the run has " + text(info.walls.size()));
  }
  schema::visit_all_series(s, info.walls, [&](const std::string& name, const Item& item, const auto& values) {
    const bool axis = item.path == "/series/time" || item.path == "/series/step";
    if (axis && values.size() != s.size()) {
      fail(place, name + " has " + text(values.size()) + " rows, expected " + text(s.size()));
    }
    check_column(item, name, values, s.size(), place);
  });
  const std::uint64_t excursions = schema::excursion_rows(s, s.excursion_count.size());
  if (s.excursions.size() != excursions)
    fail(place, "/excursions has " + text(s.excursions.size()) + " rows, expected " + text(excursions) + " as /series/excursion_count says");
  schema::visit_excursions(s.excursions, [&](const Item& item, const auto& values) {
    if (values.size() != excursions)
      fail(place, std::string(item.path) + " has " + text(values.size()) + " rows, expected " + text(excursions));
    check_column(item, std::string(item.path), values, excursions, place);
  });
  for (std::size_t k = 0; k < excursions; ++k) {
    const Excursions& e = s.excursions;
    if (e.first_step[k] > e.peak_step[k] || e.peak_step[k] > e.last_step[k])
      fail(place, "/excursions row " + text(k) + " has its peak in step " + text(e.peak_step[k]) + ", expected one from " +
                      text(e.first_step[k]) + " to " + text(e.last_step[k]));
  }
  for (std::size_t r = 1; r < s.size(); ++r) {
    if (!(s.time[r] > s.time[r - 1]) || s.step[r] <= s.step[r - 1]) {
      fail(place, "/series row " + text(r) + " (time " + text(s.time[r]) + " s, step " + text(s.step[r]) +
                      ") does not follow row " + text(r - 1) + " (time " + text(s.time[r - 1]) + " s, step " +
                      text(s.step[r - 1]) + "), expected both to increase");
    }
  }
}

}  // namespace jam
