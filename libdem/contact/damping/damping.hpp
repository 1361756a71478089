// Viscous damping of the normal and the tangential motion: what the closing and the sliding speed are multiplied with.
//
// A damped Hertz impact, F_d = c v with c proportional to overlap^(1/4), is a linear damped oscillator in overlap^(5/4)
// (Tsuji, Tanaka and Ishida 1992; Antypov and Elliott 2011, EPL 94, 50004), so that the restitution does not depend on speed.
// Each law is per_root() of the materials times sqrt(radius m*).
#pragma once
#include <cmath>
#include <numbers>
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

// Damping ratio whose damped Hertz impact without adhesion returns with `restitution`, if the contact ends at zero
// overlap: -ln e / sqrt(ln^2 e + pi^2).
inline double damping_ratio(double restitution) {
  if (restitution <= 0) return 1;
  const double l = std::log(restitution);
  return -l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
}

namespace damping {
// c = 2 sqrt(5/6) beta sqrt(S m*), S_n = 2 E* r and S_t = 8 G* r with a radius r of the contact (EDEM's Hertz-Mindlin model).
inline DampingCoefficients<double> per_root(double restitution, double effective_modulus, double effective_shear) {
  const double factor = 2 * std::sqrt(5.0 / 6.0) * damping_ratio(restitution);
  return {factor * std::sqrt(2 * effective_modulus), factor * std::sqrt(8 * effective_shear)};
}
template <class Real>
DampingCoefficients<Real> of_radius(const Real& root_radius, const PairConstants<Real>& c) {
  const Real root = root_radius * c.root_mass;
  return {c.normal_damping * root, c.tangential_damping * root};
}
}  // namespace damping

// With the law's own contact radius: continuous through zero overlap, damps necks too.
struct ContactRadiusDamping {
  static constexpr std::string_view name = "contact_radius";
  static DampingCoefficients<double> per_root(double restitution, double modulus, double shear) {
    return damping::per_root(restitution, modulus, shear);
  }
  template <class Real>
  static DampingCoefficients<Real> evaluate(const Real&, const NormalForce<Real>& normal, const PairConstants<Real>& c) {
    return damping::of_radius(normal.root_radius, c);
  }
};

// With sqrt(R* overlap), Hertz's radius, whatever the normal law: EDEM's JKR model to the letter. No damping in a neck.
struct OverlapDamping {
  static constexpr std::string_view name = "overlap";
  static DampingCoefficients<double> per_root(double restitution, double modulus, double shear) {
    return damping::per_root(restitution, modulus, shear);
  }
  template <class Real>
  static DampingCoefficients<Real> evaluate(const Real& overlap, const NormalForce<Real>&, const PairConstants<Real>& c) {
    return damping::of_radius(square_root(square_root(c.effective_radius * larger(overlap, Real(0.0)))), c);
  }
};

// Tsuji, Tanaka and Ishida (1992), Powder Technol. 71, 239: c = alpha(e) sqrt(m k), the same for both directions, with the
// polynomial alpha(e) that they fitted, k = (4/3) E* a and, as in their equal spheres, m = 2 m*. (LAMMPS's `tsuji` puts m*
// for m and returns with more than the set restitution: 0.928 for 0.9.)
struct TsujiDamping {
  static constexpr std::string_view name = "tsuji";
  static DampingCoefficients<double> per_root(double restitution, double modulus, double) {
    const double e = restitution;
    const double alpha = 1.2728 + e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
    return {alpha * std::sqrt(8.0 / 3.0 * modulus), alpha * std::sqrt(8.0 / 3.0 * modulus)};
  }
  template <class Real>
  static DampingCoefficients<Real> evaluate(const Real&, const NormalForce<Real>& normal, const PairConstants<Real>& c) {
    return damping::of_radius(normal.root_radius, c);
  }
};

}  // namespace dem
