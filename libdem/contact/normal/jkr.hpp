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

// The stable root y(delta) of y^4 - y = delta for jkr_break <= delta <= 1e30.
// With y = y_c + e, y_c = 4^(-1/3), the quartic becomes e^2 (6 y_c^2 + 4 y_c e + e^2) = q^2 with q^2 = delta - jkr_break: no
// cancellation and no second positive root. For small and for large q, e tends to q/(2 r) and q/r with r = sqrt(q + 3/2 y_c^2),
// and e r/q is a smooth function of 1/r: here the polynomial that agrees with it at the Chebyshev nodes of
// [0, 1/sqrt(3/2 y_c^2)]. That is within 6.7e-7 everywhere, and needs no more digits than a float has. Two steps with the slope
// of the guess, each of which makes the error a millionth, reach rounding.
template <class Real>
Real jkr_root(const Real& delta) {
  constexpr double y_c = 0.62996052494743658;  // 4^(-1/3)
  constexpr double a = 6 * y_c * y_c, b = 4 * y_c, c = a / 4;
  constexpr float p0 = 1.0000006865390332f, p1 = -0.63002931654275204f, p2 = 0.29883539382789936f, p3 = -0.13349666407197169f,
                  p4 = 0.047349591724065933f, p5 = -0.0046482426081651743f, p6 = -0.0039879402227714332f,
                  p7 = 0.0012244462369246199f;
  const Real t = larger(delta - jkr_break, Real(1e-30));  // the least that leaves no 0/0 below; its root is y_c
  const auto q = square_root(to_single(t)), r2 = q + float(c), x = square_root(r2) * (1.0f / r2), x2 = x * x;
  using Single = std::remove_const_t<decltype(q)>;
  const auto line = [&](float slope, float start) { return multiply_add(Single(slope), Single(x), Single(start)); };
  const Single low = multiply_add(Single(x2), line(p3, p2), line(p1, p0)), high = multiply_add(Single(x2), line(p7, p6), line(p5, p4));
  const Single guess = q * x * multiply_add(Single(x2 * x2), high, low);
  const Single slope = guess * multiply_add(guess, multiply_add(Single(4.0f), guess, Single(float(3 * b))), Single(float(2 * a)));
  const Real per_slope = to_double(Single(1.0f / slope));
  Real e = to_double(guess);
  for (int k = 0; k < 2; ++k) {
    const Real excess = multiply_add(e * e, multiply_add(e, b + e, a), -1.0 * t);
    e = subtract_product(e, excess, per_slope);
  }
  return y_c + e;
}

// Energies in units of F_c s, from the integral of F over the overlap: u(y) = (32/45) y^10 - (16/9) y^7 + (2/3) y^4, zero for
// separated bodies (a = 0).
template <class Real>
Real jkr_energy(const Real& y) {
  const Real y3 = y * y * y, y4 = y3 * y;
  return y4 * multiply_add(y3, multiply_add(32.0 / 45.0, y3, -16.0 / 9.0), 2.0 / 3.0);
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
    const Mask<Real> sticky = c.adhesion_scale > Real(0.0);
    const Real y = jkr_root(Real(overlap * c.per_adhesion_length));
    const Real y3 = y * y * y;
    const Real pull_off = (1.5 * std::numbers::pi) * c.work_of_adhesion * c.effective_radius;
    const Real repulsive = pull_off * (16.0 / 9.0) * y3 * y3;  // 4 E* a^3/(3 R*)
    const Real root_radius = c.root_adhesion_radius * y, a = root_radius * root_radius;
    const NormalForce<Real> jkr = {subtract_product(repulsive, pull_off * (8.0 / 3.0), y3),
                                   root_radius,
                                   repulsive,
                                   pull_off,
                                   pull_off * c.adhesion_length * jkr_energy(y),
                                   Real(-std::numbers::pi) * c.work_of_adhesion * (a * a)};
    if (all(sticky)) return jkr;
    const NormalForce<Real> hertz = Hertz::evaluate(overlap, c);
    return {select(sticky, jkr.elastic, hertz.elastic),
            select(sticky, jkr.root_radius, hertz.root_radius),
            select(sticky, jkr.repulsive, hertz.repulsive),
            pull_off,
            select(sticky, jkr.energy, hertz.energy),
            select(sticky, jkr.surface_energy, Real(0.0))};
  }
};

// JKR whose contacts form at one point of the curve and break at another.
template <JkrPoint Form, JkrPoint Break>
struct JkrBetween : JkrForce {
  // Overlaps, m (<= 0).
  template <class Real>
  static Real form_overlap(const PairConstants<Real>& c) {
    if constexpr (Form == JkrPoint::touch) return Real(0.0);
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
