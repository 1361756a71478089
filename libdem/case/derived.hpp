// Numbers that follow from a case by formula, before anything is simulated.
//
// References: [J] K. L. Johnson, Contact Mechanics (1985); [X] W. Xuan, W. Nan, Powder Technology (2024) 120003;
// [B] M. A. Behjani et al., Powder Technology 323 (2018), the cohesion number; [T] C. Thornton, Granular Dynamics,
// Contact Mechanics and Particle System Simulations (2015), the Rayleigh time.
#pragma once
#include <cstdint>

#include "libdem/case/case.hpp"

namespace dem {

// 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, Pa [J, eq. 4.20].
double effective_modulus(const Material& a, const Material& b);

// G = E / (2 (1 + nu)) and 1/G* = (2 - nu1)/G1 + (2 - nu2)/G2, Pa [J, section 7.3].
double shear_modulus(const Material& m);
double effective_shear_modulus(const Material& a, const Material& b);

// T_R = pi R sqrt(rho/G) / (0.1631 nu + 0.8766), s: the time a surface wave takes around half a grain [T].
double rayleigh_time(const Material& m, double radius);

// 2.87 (m*^2 / (R* E*^2 v))^(1/5), s: duration of an elastic impact at relative speed v > 0 [J, eq. 11.24].
double hertz_contact_time(double effective_mass, double effective_radius, double effective_modulus, double speed);

// A grain of diameter d caught between two walls a distance gap < d apart, flat against both, undeformed elsewhere:
// both contacts carry the same Hertz force, their overlaps add up to d - gap. All zero where the grain fits.
struct Squeeze {
  double force = 0;                 // N
  double normal_stiffness = 0;      // N/m, dF/d(overlap), sum of both contacts
  double tangential_stiffness = 0;  // N/m, 8 G* a, sum of both contacts
  double critical_step = 0;         // s, 2 / highest frequency: 2 sqrt(m / max(k_n, 7/2 k_t)); 7/2: with rotation
};
Squeeze squeeze(const Material& grain, const Material& wall_a, const Material& wall_b, double diameter, double gap);

// Largest distance of the blade from its axis, m; 0 for a mesh file, whose vertices know (libdem/geometry).
double tip_radius(const Case& c);

// Distance of flat tips (TipCut::flat) from the axis, m: their corners, at y = t/2 cos(beta) + h/2 |sin(beta)| from the middle, reach the tip radius.
double flat_tip_distance(const TwistedBlade& blade);

struct Derived {
  // Motion [X, section 2]; this, the moduli with vessel and blade, contact_time, mean_in_gap and largest_in_gap of a rheometer only.
  double axial_velocity = 0;    // m/s, u = v sin(alpha); negative: downward
  double angular_velocity = 0;  // rad/s, omega = v cos(alpha) / R_tip, positive whatever the sense
  double travel = 0;            // m, |u| duration
  double turns = 0;
  double end_height = 0;     // m, lowest point of the blade at the end
  double gap = 0;            // m, between tip and vessel
  double gap_over_mean = 0;  // gap / mean diameter
  double gap_over_d90 = 0;   // gap / D90 by number
  // A grain that touches vessel and leading edge is drawn in where both can hold it, tan of half the angle between them <= mu: up to the
  // diameter entrance (1 + mu^2) (flat vessel, sharp edge, nobody pushes; data/reference/paper, "Which grains jam").
  double entrance = 0;         // m, widest gap at the tips: `gap`, or that in the middle of tips which are cut flat
  double drawn_in = 0;         // m, mu: the smaller friction of grain on blade and vessel
  double drawn_in_share = 0;   // of the grains, by number, those that do not fit through the gap and are drawn in

  // Grains; moments and quantiles of their sizes from libdem/case/size_distribution.hpp.
  double smallest_diameter = 0, largest_diameter = 0, d90 = 0;  // m, D90 by number: 90 % of the grains are smaller
  double mean_mass = 0;                                         // kg, of a grain of mean diameter
  double grains = 0, grains_loose = 0, grains_dense = 0;        // at solid fractions 0.60, 0.56 and 0.64

  // Contact, grain on grain of mean diameter unless said otherwise.
  double modulus = 0, modulus_vessel = 0, modulus_blade = 0;  // Pa, E*
  double reduced_radius = 0;                                  // m, R* = R / 2
  double pull_off_force = 0;                                  // N, 3/2 pi W R*
  double bond = 0;      // (3/2 pi W R) / (m g): the paper's, with R instead of R*, so twice the ratio of the forces [X]
  double cohesion = 0;  // (W^5 / (E^2 R^8))^(1/3) / (rho g), with Young's modulus E and the grain radius R [X, B]

  // Times, s.
  double rayleigh_mean = 0, rayleigh_smallest = 0;
  double step_over_rayleigh_mean = 0, step_over_rayleigh_smallest = 0;
  double contact_time = 0;  // Hertz, two mean grains at the tip speed
  Squeeze mean_in_gap;      // a mean grain between blade tip and vessel
  Squeeze largest_in_gap;   // the largest that is drawn in, where the gap is narrowest

  // Cost.
  double steps = 0, frames = 0, series_rows = 0, checkpoints = 0;
  double particle_steps = 0;
  double bytes_per_frame = 0;  // before compression, at 2.6 contacts per grain
  double bytes_on_disk = 0;    // of snapshots and series, compressed to 0.66 (measured on a settled bed)
};

// Every number of the case must be finite; where one is out of range the numbers that depend on it mean nothing, but
// nothing else happens. tip: tip radius, m. Throws CaseError where bed, vessel or blade are of an unknown material.
Derived derive(const Case& c, double tip);
inline Derived derive(const Case& c) {
  return derive(c, tip_radius(c));
}

}  // namespace dem
