// The constants of a contact from materials and bodies: each formula once.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "libdem/case/derived.hpp"
#include "libdem/contact/laws.hpp"
#include "libdem/particles/particles.hpp"

namespace dem {

// (4 pi^2 W^2/E*^2)^(1/3), m^(2/3), to more digits than a double has.
inline long double adhesion_scale(double work_of_adhesion, double modulus) {
  const long double strain = (long double)(work_of_adhesion) / modulus, pi = std::numbers::pi_v<long double>;
  return std::cbrt(4 * pi * pi * (strain * strain));
}

// a0^2/R* = (4 pi^2 W^2 R*/E*^2)^(1/3), m: the overlap at which JKR's contact radius would follow a^2 = R* overlap alone.
inline double adhesion_length(double work_of_adhesion, double effective_radius, double modulus) {
  return double(adhesion_scale(work_of_adhesion, modulus) * std::cbrt((long double)(effective_radius)));
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
template <class Real>
Real harmonic(const Real& a, const Real& b) { return a * b / (a + b); }

// The cube root of x > 0, rounded once but for one number in some thousand: the library's in double precision and one of Newton's steps in
// more digits, which is much less work than its root in more digits.
inline double cube_root(double x) {
  const long double root = std::cbrt(x), square = root * root;
  return double(root - (square * root - x) / (3 * square));
}

// From the work of adhesion and the modulus what set_effective_radius() needs of them.
inline void set_adhesion(PairConstants<double>& c) {
  // Each is rounded once, as the law takes powers of them.
  const long double scale = adhesion_scale(c.work_of_adhesion, c.effective_modulus);
  c.adhesion_scale = double(scale);
  // Adhesion that no digit of a force shows is none: overlaps in its lengths would be beyond the numbers that jkr_root() bears.
  if (c.adhesion_scale < 1e-30) c.adhesion_scale = 0;
  c.per_adhesion_scale = c.adhesion_scale > 0 ? double(1 / scale) : 0;
  c.root_adhesion_scale = c.adhesion_scale > 0 ? double(std::sqrt(std::sqrt(scale))) : 0;
}

// All that depends on the effective radius, m, given with its cube root and one over that.
template <class Real>
void set_effective_radius(PairConstants<Real>& c, const Real& effective_radius, const Real& cube_root, const Real& per_cube_root) {
  c.effective_radius = effective_radius;
  c.cube_root = cube_root;
  c.adhesion_length = c.adhesion_scale * cube_root;
  c.per_adhesion_length = c.per_adhesion_scale * per_cube_root;
  c.root_adhesion_radius = c.root_adhesion_scale * cube_root;
}
inline void set_effective_radius(PairConstants<double>& c, double effective_radius) {
  const double root = cube_root(effective_radius);
  set_effective_radius(c, effective_radius, root, 1 / root);
}

// From the bodies' masses, kg: sqrt(m*), by one root and no quotient.
template <class Real>
void set_effective_mass(PairConstants<Real>& c, const Real& a, const Real& b) {
  const Real product = a * b;
  c.root_mass = product * inverse_root(Real(product * (a + b)));
}
// From their moments of inertia, kg m^2, likewise: I_i I_j/(I_i + I_j).
template <class Real>
void set_effective_inertia(PairConstants<Real>& c, const Real& a, const Real& b) {
  const Real root = inverse_root(Real(a + b));
  c.effective_inertia = a * b * (root * root);
}

// Two spheres.
inline PairConstants<double> pair_constants(const PairConstants<double>& materials, const BodyConstants& a,
                                            const BodyConstants& b) {
  PairConstants<double> c = materials;
  set_effective_radius(c, harmonic(a.radius, b.radius));
  set_effective_mass(c, a.mass, b.mass);
  set_effective_inertia(c, a.inertia, b.inertia);
  return c;
}

// A sphere and a wall: flat, and so heavy that it does not move.
inline PairConstants<double> wall_constants(const PairConstants<double>& materials, const BodyConstants& a) {
  PairConstants<double> c = materials;
  set_effective_radius(c, a.radius);
  c.root_mass = std::sqrt(a.mass);
  c.effective_inertia = a.inertia;
  return c;
}

// Of wall_constants(), for a wall of principal curvatures k1, k2 (1/m, > 0 hollow towards the sphere) at the contact: the
// bodies' relative curvatures are 1/R - k1 and 1/R - k2, and R* = 1/sqrt((1/R - k1)(1/R - k2)), which is exact to first order
// in the difference of the two (Johnson, Contact Mechanics, section 4.2; for a grain in a vessel of 27 grain radii the force at
// an overlap is exact to 1e-5). A hollow nearly as narrow as the sphere conforms to it and is no contact at a point: R* stops
// at `conforming` R.
inline constexpr double conforming = 10;
// Of a flat wall's, those where the wall is hollow enough to stop R*.
inline PairConstants<double> most_conforming(PairConstants<double> flat) {
  set_effective_radius(flat, flat.effective_radius * conforming);
  return flat;
}
// The same for these curvatures.
inline PairConstants<double> on_curved_wall(PairConstants<double> flat, const std::array<double, 2>& curvature) {
  if (curvature[0] == 0 && curvature[1] == 0) return flat;
  const double radius = flat.effective_radius;
  const double a = 1 - radius * curvature[0], b = 1 - radius * curvature[1];
  constexpr double least = 1 / (conforming * conforming);
  const double ratio = 1 / std::sqrt(a > 0 && b > 0 ? std::max(a * b, least) : least);
  set_effective_radius(flat, flat.effective_radius * ratio);
  return flat;
}

}  // namespace dem
