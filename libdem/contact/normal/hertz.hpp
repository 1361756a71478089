// Hertz (1882): F = (4/3) E* sqrt(R*) overlap^(3/2), a = sqrt(R* overlap). Johnson (1985) section 4.2.
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

struct Hertz {
  static constexpr std::string_view name = "hertz";
  static constexpr bool adhesive = false;

  template <class Real>
  static Real form_overlap(const PairConstants<Real>&) {
    return Real(0.0);
  }
  template <class Real>
  static Real break_overlap(const PairConstants<Real>&) {
    return Real(0.0);
  }
  template <class Real>
  static Real form_energy(const PairConstants<Real>&) {
    return Real(0.0);
  }
  template <class Real>
  static Real break_energy(const PairConstants<Real>&) {
    return Real(0.0);
  }

  template <class Real>
  static NormalForce<Real> evaluate(const Real& overlap, const PairConstants<Real>& c) {
    const Real h = larger(overlap, Real(0.0));
    const Real a = square_root(c.effective_radius * h);
    const Real force = (4.0 / 3.0) * c.effective_modulus * a * h;
    return {force, square_root(a), force, Real(0.0), 0.4 * force * h, Real(0.0)};
  }
};

}  // namespace dem
