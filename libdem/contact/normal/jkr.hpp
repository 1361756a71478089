// Johnson, Kendall and Roberts (1971), "Surface energy and the contact of elastic solids", Proc. R. Soc. A 324, 301.
//
//   F = 4 E* a^3 / (3 R*) - sqrt(8 pi W E* a^3)          overlap = a^2/R* - sqrt(2 pi W a/E*)
//
// in the parameter-free form  y^4 - y = delta  with y = sqrt(a/a0), delta = overlap/s, s = a0^2/R* the adhesion length:
//
//   F/F_c = (16/9) y^6 - (8/3) y^3,   a = a0 y^2,   F_c = (3/2) pi W R*.
//
// A contact forms at overlap > 0 and, once formed, lasts until overlap < jkr_break * s, where y^3 = 1/4 and F = -(5/9) F_c.
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

struct Jkr {
  static constexpr std::string_view name = "jkr";

  // Overlap, m (<= 0), at which a formed contact breaks.
  template <class Real>
  static Real break_overlap(const PairConstants<Real>& c) {
    return jkr_break * c.adhesion_length;
  }

  template <class Real>
  static NormalForce<Real> evaluate(const Real& overlap, const PairConstants<Real>& c) {
    const Mask<Real> sticky = c.adhesion_length > Real(0.0);
    const Real s = select(sticky, c.adhesion_length, Real(1.0));
    const Real y = jkr_root(Real(overlap / s));
    const Real y3 = y * y * y;
    const Real pull_off = (1.5 * std::numbers::pi) * c.work_of_adhesion * c.effective_radius;
    const Real repulsive = pull_off * (16.0 / 9.0) * y3 * y3;
    const NormalForce<Real> hertz = Hertz::evaluate(overlap, c);
    return {select(sticky, repulsive - pull_off * (8.0 / 3.0) * y3, hertz.elastic),
            select(sticky, square_root(s * c.effective_radius) * y * y, hertz.contact_radius),
            // EDEM limits friction by the repulsive part 4 E* a^3/(3 R*) of JKR's force.
            select(sticky, repulsive, hertz.friction_load)};
  }
};

// dF/d(overlap), N/m, of a formed JKR contact; reference for time steps and tests.
inline double jkr_stiffness(double overlap, const PairConstants<double>& c) {
  const double y = jkr_root(overlap / c.adhesion_length), y2 = y * y;
  const double pull_off = 1.5 * std::numbers::pi * c.work_of_adhesion * c.effective_radius;
  return pull_off / c.adhesion_length * ((32.0 / 3.0) * y2 * y2 * y - 8 * y2) / (4 * y2 * y - 1);
}

}  // namespace dem
