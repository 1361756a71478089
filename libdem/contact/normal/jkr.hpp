// Johnson, Kendall and Roberts (1971), "Surface energy and the contact of elastic solids", Proc. R. Soc. A 324, 301.
//
//   F = 4 E* a^3 / (3 R*) - sqrt(8 pi W E* a^3)          overlap = a^2/R* - sqrt(2 pi W a/E*)
//
// in the parameter-free form  y^4 - y = delta  with y = sqrt(a/a0), delta = overlap/s, s = a0^2/R* the adhesion length:
//
//   F/F_c = (16/9) y^6 - (8/3) y^3,   a = a0 y^2,   F_c = (3/2) pi W R*.
//
// A contact forms at overlap > 0 and, once formed, lasts until overlap < jkr_break * s, where y^3 = 1/4 and F = -(5/9) F_c;
// other codes let it form or break at other points of the curve (rows below).
#pragma once
#include <numbers>
#include <string_view>

#include "libdem/contact/normal/hertz.hpp"
#include "libdem/contact/touch.hpp"

namespace dem {

// -(27/256)^(1/3): the overlap, in adhesion lengths, at which a formed contact breaks.
inline constexpr double jkr_break = -0.47247039371057742;

// The stable root y(delta) of y^4 - y = delta for delta >= jkr_break.
// With y = y_c + e, y_c = 4^(-1/3), the quartic becomes e^2 (6 y_c^2 + 4 y_c e + e^2) = delta - jkr_break: no cancellation,
// no second positive root, and a good start for every delta: sqrt(q + c) - sqrt(c) with q^2 = delta - jkr_break is within
// 3 %, so two Halley steps and one Newton step reach rounding.
template <class Real>
Real jkr_root(const Real& delta) {
  constexpr double y_c = 0.62996052494743658;  // 4^(-1/3)
  constexpr double a = 6 * y_c * y_c, b = 4 * y_c, c = a / 4, root_c = 0.77154094;
  const Real t = larger(delta - jkr_break, Real(0.0));
  const Real q = square_root(t);
  Real e = q / (square_root(q + c) + root_c);
  for (int k = 0; k < 2; ++k) {
    const Real p = e * e * (a + e * (b + e)) - t;
    const Real p1 = e * (2 * a + e * (3 * b + 4 * e));
    const Real p2 = 2 * a + e * (6 * b + 12 * e);
    const Real step = p * p1 / (p1 * p1 - 0.5 * p * p2);
    e = select(t > Real(0.0), e - step, Real(0.0));
  }
  const Real p = e * e * (a + e * (b + e)) - t;
  const Real p1 = e * (2 * a + e * (3 * b + 4 * e));
  e = select(t > Real(0.0), e - p / p1, Real(0.0));
  return y_c + e;
}

// Energies in units of F_c s, from the integral of F over the overlap: u(y) = (32/45) y^10 - (16/9) y^7 + (2/3) y^4, zero for
// separated bodies (a = 0).
template <class Real>
Real jkr_energy(const Real& y) {
  const Real y3 = y * y * y, y4 = y3 * y;
  return y4 * ((32.0 / 45.0) * y3 * y3 - (16.0 / 9.0) * y3 + 2.0 / 3.0);
}

// Where a JKR contact forms and where it breaks, as roots y of the quartic. Energy is lost where the two differ: the
// hysteresis of the separation, 7.092 (W^5 R*^4/E*^2)^(1/3) for the physical pair of touch and turning_point.
enum class JkrPoint {
  touch,          // y = 1: overlap 0, F = -(8/9) F_c
  force_minimum,  // y^3 = 3/4: F = -F_c, the largest tension
  turning_point,  // y^3 = 1/4: F = -(5/9) F_c, no equilibrium beyond
};
constexpr double jkr_root(JkrPoint point) {
  return point == JkrPoint::touch ? 1 : point == JkrPoint::force_minimum ? 0.90856029641606983 : 0.62996052494743658;
}
constexpr double jkr_overlap(JkrPoint point) {  // in adhesion lengths
  const double y = jkr_root(point);
  return point == JkrPoint::turning_point ? jkr_break : y * y * y * y - y;
}

struct JkrForce {
  static constexpr bool adhesive = true;

  template <class Real>
  static NormalForce<Real> evaluate(const Real& overlap, const PairConstants<Real>& c) {
    const Mask<Real> sticky = c.adhesion_length > Real(0.0);
    const Real s = select(sticky, c.adhesion_length, Real(1.0));
    const Real y = jkr_root(Real(overlap / s));
    const Real y3 = y * y * y;
    const Real pull_off = (1.5 * std::numbers::pi) * c.work_of_adhesion * c.effective_radius;
    const Real repulsive = pull_off * (16.0 / 9.0) * y3 * y3;  // 4 E* a^3/(3 R*)
    const Real a2 = s * c.effective_radius * y3 * y;
    const NormalForce<Real> hertz = Hertz::evaluate(overlap, c);
    return {select(sticky, repulsive - pull_off * (8.0 / 3.0) * y3, hertz.elastic),
            select(sticky, square_root(s * c.effective_radius) * y * y, hertz.contact_radius),
            select(sticky, repulsive, hertz.repulsive),
            pull_off,
            select(sticky, pull_off * s * jkr_energy(y), hertz.energy),
            select(sticky, Real(-std::numbers::pi) * c.work_of_adhesion * a2, Real(0.0))};
  }
};

// JKR whose contacts form at one point of the curve and break at another.
template <JkrPoint Form, JkrPoint Break>
struct JkrBetween : JkrForce {
  // Overlaps, m (<= 0).
  template <class Real>
  static Real form_overlap(const PairConstants<Real>& c) {
    return jkr_overlap(Form) * c.adhesion_length;
  }
  template <class Real>
  static Real break_overlap(const PairConstants<Real>& c) {
    return jkr_overlap(Break) * c.adhesion_length;
  }
  // J, stored in a contact that forms and in one that breaks.
  template <class Real>
  static Real form_energy(const PairConstants<Real>& c) {
    return (1.5 * std::numbers::pi * jkr_energy(jkr_root(Form))) * c.work_of_adhesion * c.effective_radius * c.adhesion_length;
  }
  template <class Real>
  static Real break_energy(const PairConstants<Real>& c) {
    return (1.5 * std::numbers::pi * jkr_energy(jkr_root(Break))) * c.work_of_adhesion * c.effective_radius * c.adhesion_length;
  }
};

// The physical one: forms at the first touch, where the force jumps to -(8/9) F_c, holds on in the neck, breaks at the
// turning point.
struct Jkr : JkrBetween<JkrPoint::touch, JkrPoint::turning_point> {
  static constexpr std::string_view name = "jkr";
};
// Breaks where the tension is largest, as LAMMPS's granular/jkr does.
struct JkrForceMinimum : JkrBetween<JkrPoint::touch, JkrPoint::force_minimum> {
  static constexpr std::string_view name = "jkr_force_minimum";
};
// The same curve on approach and on parting, as EDEM's "JKR V1": attraction begins before the touch and no energy is lost.
// (EDEM cuts the tail at 0.9965 of this overlap.)
struct JkrNonHysteretic : JkrBetween<JkrPoint::turning_point, JkrPoint::turning_point> {
  static constexpr std::string_view name = "jkr_non_hysteretic";
};

// dF/d(overlap), N/m, of a formed JKR contact; reference for time steps and tests.
inline double jkr_stiffness(double overlap, const PairConstants<double>& c) {
  const double y = jkr_root(overlap / c.adhesion_length), y2 = y * y;
  const double pull_off = 1.5 * std::numbers::pi * c.work_of_adhesion * c.effective_radius;
  return pull_off / c.adhesion_length * ((32.0 / 3.0) * y2 * y2 * y - 8 * y2) / (4 * y2 * y - 1);
}

}  // namespace dem
