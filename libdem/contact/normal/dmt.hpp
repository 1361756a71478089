// Derjaguin, Muller and Toporov (1975), J. Colloid Interface Sci. 53, 314, in the form of Maugis: Hertz's force and contact
// radius, and a constant attraction while the bodies touch,
//
//   F = (4/3) E* sqrt(R*) overlap^(3/2) - F_c,   F_c = 2 pi W R*.
//
// The limit of JKR for small, stiff bodies (Tabor's parameter (R* W^2/(E*^2 z0^3))^(1/3) << 1). Attraction at a distance is
// left out, so nothing is lost by touching and parting.
#pragma once
#include <numbers>
#include <string_view>

#include "libdem/contact/normal/hertz.hpp"

namespace dem {

struct Dmt : Hertz {
  static constexpr std::string_view name = "dmt";
  static constexpr bool adhesive = true;

  template <class Real>
  static NormalForce<Real> evaluate(const Real& overlap, const PairConstants<Real>& c) {
    NormalForce<Real> f = Hertz::evaluate(overlap, c);
    f.pull_off = (2 * std::numbers::pi) * c.work_of_adhesion * c.effective_radius;
    f.elastic = f.elastic - f.pull_off;
    f.surface_energy = Real(0.0) - f.pull_off * larger(overlap, Real(0.0));
    f.energy = f.energy + f.surface_energy;
    return f;
  }
};

}  // namespace dem
