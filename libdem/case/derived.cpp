#include "libdem/case/derived.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libdem/case/bed_region.hpp"
#include "libdem/case/size_distribution.hpp"

namespace dem {

using std::numbers::pi;

double effective_modulus(const Material& a, const Material& b) {
  return 1 / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young);
}

double shear_modulus(const Material& m) {
  return m.young / (2 * (1 + m.poisson));
}

double effective_shear_modulus(const Material& a, const Material& b) {
  return 1 / ((2 - a.poisson) / shear_modulus(a) + (2 - b.poisson) / shear_modulus(b));
}

double rayleigh_time(const Material& m, double radius) {
  return pi * radius * std::sqrt(m.density / shear_modulus(m)) / (0.1631 * m.poisson + 0.8766);
}

double hertz_contact_time(double effective_mass, double effective_radius, double effective_modulus, double speed) {
  // The factor is 2 (15/16)^(2/5) times the integral of dx / sqrt(1 - x^(5/2)) over [0, 1].
  const double factor = 2 * std::pow(15.0 / 16.0, 0.4) * std::sqrt(pi) * 0.4 * std::tgamma(0.4) / std::tgamma(0.9);
  return factor *
         std::pow(effective_mass * effective_mass / (effective_radius * effective_modulus * effective_modulus * speed),
                  0.2);
}

Squeeze squeeze(const Material& grain, const Material& wall_a, const Material& wall_b, double diameter, double gap) {
  Squeeze s;
  if (!(gap > 0) || !(diameter > gap)) return s;
  const double radius = diameter / 2, mass = grain.density * pi / 6 * diameter * diameter * diameter;
  const double modulus_a = effective_modulus(grain, wall_a), modulus_b = effective_modulus(grain, wall_b);
  // Equal forces 4/3 E* sqrt(R) overlap^(3/2).
  const double overlap_a = (diameter - gap) / (1 + std::pow(modulus_a / modulus_b, 2.0 / 3.0));
  const double overlap_b = diameter - gap - overlap_a;
  const double contact_a = std::sqrt(radius * overlap_a), contact_b = std::sqrt(radius * overlap_b);
  s.force = 4.0 / 3.0 * modulus_a * contact_a * overlap_a;
  s.normal_stiffness = 2 * (modulus_a * contact_a + modulus_b * contact_b);
  s.tangential_stiffness =
      8 * (effective_shear_modulus(grain, wall_a) * contact_a + effective_shear_modulus(grain, wall_b) * contact_b);
  s.critical_step = 2 * std::sqrt(mass / std::max(s.normal_stiffness, 3.5 * s.tangential_stiffness));
  return s;
}

double tip_radius(const Case& c) {
  const auto* const blade = std::get_if<TwistedBlade>(&c.blade.shape);
  return blade ? blade->diameter / 2 : 0;
}

double flat_tip_distance(const TwistedBlade& blade) {
  const double radius = blade.diameter / 2;
  const double y = blade.thickness / 2 * std::cos(blade.tip_twist) + blade.height / 2 * std::abs(std::sin(blade.tip_twist));
  return std::sqrt((radius - y) * (radius + y));
}

namespace {

// What there is of a rheometer only; needs the sizes of the grains.
void derive_rheometer(const Case& c, double tip, Derived& d) {
  const Material& grain = c.materials[material_index(c, c.bed.material)];
  const Material& vessel = c.materials[material_index(c, c.vessel.material)];
  const Material& blade = c.materials[material_index(c, c.blade.material)];
  d.axial_velocity = c.motion.tip_speed * std::sin(c.motion.helix_angle);
  d.angular_velocity = c.motion.tip_speed * std::cos(c.motion.helix_angle) / tip;
  d.travel = std::abs(d.axial_velocity) * c.duration;
  d.turns = d.angular_velocity * c.duration / (2 * pi);
  d.end_height = c.blade.start_height + d.axial_velocity * c.duration;
  d.gap = c.vessel.diameter / 2 - tip;
  d.gap_over_mean = d.gap / c.bed.mean_diameter;
  d.gap_over_d90 = d.gap / d.d90;
  d.modulus_vessel = effective_modulus(grain, vessel);
  d.modulus_blade = effective_modulus(grain, blade);
  d.contact_time = hertz_contact_time(d.mean_mass / 2, d.reduced_radius, d.modulus, c.motion.tip_speed);
  d.mean_in_gap = squeeze(grain, blade, vessel, c.bed.mean_diameter, d.gap);

  const auto* const twisted = std::get_if<TwistedBlade>(&c.blade.shape);
  const bool flat = twisted && twisted->tip_cut == TwistedBlade::TipCut::flat;
  d.entrance = flat ? c.vessel.diameter / 2 - flat_tip_distance(*twisted) : d.gap;
  const auto& friction_on = c.interactions[material_index(c, c.bed.material)];
  const double friction = std::min(friction_on[material_index(c, c.blade.material)].friction, friction_on[material_index(c, c.vessel.material)].friction);
  d.drawn_in = d.entrance * (1 + friction * friction);
  const auto share_below = [&](double diameter) { return size_share_below(c.bed, diameter / c.bed.mean_diameter); };
  d.drawn_in_share = share_below(d.drawn_in) - share_below(d.gap);
  if (d.drawn_in_share > 0) d.largest_in_gap = squeeze(grain, blade, vessel, std::min(d.drawn_in, d.largest_diameter), d.gap);
}

}  // namespace

Derived derive(const Case& c, double tip) {
  Derived d;
  const Material& grain = c.materials[material_index(c, c.bed.material)];
  const std::size_t g = material_index(c, c.bed.material);
  const double adhesion = c.interactions[g][g].work_of_adhesion, gravity = c.gravity.norm();

  const double mean = c.bed.mean_diameter, a = c.bed.size_low, b = c.bed.size_high, radius = mean / 2;
  d.smallest_diameter = a * mean;
  d.largest_diameter = b * mean;
  d.d90 = size_quantile(c.bed, 0.9) * mean;
  d.mean_mass = grain.density * pi / 6 * mean * mean * mean;
  const double bed_volume = cross_section(bed_region(c)) * c.bed.depth;
  const double grains_if_solid = bed_volume / (mean_cubed_size(c.bed) * pi / 6 * mean * mean * mean);
  d.grains_loose = 0.56 * grains_if_solid;
  d.grains = 0.60 * grains_if_solid;
  d.grains_dense = 0.64 * grains_if_solid;

  d.modulus = effective_modulus(grain, grain);
  d.reduced_radius = radius / 2;
  d.pull_off_force = 1.5 * pi * adhesion * d.reduced_radius;
  d.bond = 1.5 * pi * adhesion * radius / (d.mean_mass * gravity);
  d.cohesion =
      std::cbrt(std::pow(adhesion, 5) / (grain.young * grain.young * std::pow(radius, 8))) / (grain.density * gravity);

  d.rayleigh_mean = rayleigh_time(grain, radius);
  d.rayleigh_smallest = rayleigh_time(grain, a * radius);
  d.step_over_rayleigh_mean = c.step / d.rayleigh_mean;
  d.step_over_rayleigh_smallest = c.step / d.rayleigh_smallest;
  if (c.rheometer) derive_rheometer(c, tip, d);

  // The frame at t = 0 counts too.
  d.steps = std::round(c.duration / c.step);
  d.frames = 1 + std::floor(c.duration / c.output.frame_interval * (1 + 1e-12));
  d.series_rows = std::floor(c.duration / c.output.series_interval * (1 + 1e-12));
  d.checkpoints = std::floor(c.duration / c.output.checkpoint_interval * (1 + 1e-12));
  d.particle_steps = d.grains * d.steps;
  // Bytes of one row of each table of the snapshot schema. Wall contacts: one grain in 1.3 diameters squared of wall.
  constexpr double particle_row = 49, particle_contact_row = 41, wall_contact_row = 67, series_row = 960;
  // Of a round bed of that cross-section.
  const double diameter = std::sqrt(4 / pi * cross_section(bed_region(c)));
  const double wall_contacts = pi * diameter * (c.bed.depth + diameter / 4) / (1.3 * mean * mean);
  d.bytes_per_frame = d.grains * (particle_row + 2.6 * particle_contact_row) + wall_contacts * wall_contact_row;
  d.bytes_on_disk = 0.66 * d.frames * d.bytes_per_frame + d.series_rows * series_row;
  return d;
}

}  // namespace dem
