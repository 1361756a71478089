// The constants of a contact from materials and bodies: each formula once.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "libdem/case/derived.hpp"
#include "libdem/contact/laws.hpp"

namespace dem {

// a0^2/R* = (4 pi^2 W^2 R*/E*^2)^(1/3), m: the overlap at which JKR's contact radius would follow a^2 = R* overlap alone.
inline double adhesion_length(double work_of_adhesion, double effective_radius, double modulus) {
  const double strain = work_of_adhesion / modulus;
  return std::cbrt(4 * std::numbers::pi * std::numbers::pi * (strain * strain) * effective_radius);
}

// F_c = (3/2) pi W R*, N: largest tension a JKR contact carries.
inline double pull_off_force(double work_of_adhesion, double effective_radius) {
  return 1.5 * std::numbers::pi * work_of_adhesion * effective_radius;
}

// The part that depends on the two materials alone; [M][M], row-major.
struct MaterialTable {
  std::size_t size = 0;
  std::vector<PairConstants<double>> pair;
  const PairConstants<double>& operator()(std::size_t a, std::size_t b) const { return pair[a * size + b]; }
};
MaterialTable make_material_table(const std::vector<Material>& materials,
                                  const std::vector<std::vector<Interaction>>& interactions, const LawChoice& law = {});

struct BodyConstants {
  double radius, mass, inertia;
};
inline double harmonic(double a, double b) { return a * b / (a + b); }

// Two spheres.
inline PairConstants<double> pair_constants(const PairConstants<double>& materials, const BodyConstants& a,
                                            const BodyConstants& b) {
  PairConstants<double> c = materials;
  c.effective_radius = harmonic(a.radius, b.radius);
  c.effective_mass = harmonic(a.mass, b.mass);
  c.effective_inertia = harmonic(a.inertia, b.inertia);
  c.adhesion_length = adhesion_length(c.work_of_adhesion, c.effective_radius, c.effective_modulus);
  return c;
}

// A sphere and a wall: flat, and so heavy that it does not move.
inline PairConstants<double> wall_constants(const PairConstants<double>& materials, const BodyConstants& a) {
  PairConstants<double> c = materials;
  c.effective_radius = a.radius;
  c.effective_mass = a.mass;
  c.effective_inertia = a.inertia;
  c.adhesion_length = adhesion_length(c.work_of_adhesion, c.effective_radius, c.effective_modulus);
  return c;
}

}  // namespace dem
