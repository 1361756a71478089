// Rolling friction of constant magnitude against the relative spin (type A of Ai, Chen, Rotter and Ooi, Powder Technol.
// 206 (2011) 269):  tau = -mu_r R* max(F_n, 0) w/|w|,  w the relative spin without its part about the normal.
//
// A constant torque chatters about w = 0 and, at large forces, turns the spin around within a step and grows without bound. So
// the torque of one contact takes away at most a tenth of the relative spin in a step: |tau| dt <= 0.1 I* |w|. A tenth,
// because a grain has up to about twelve contacts and their sum must not turn the spin around either.
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

struct ConstantTorque {
  static constexpr std::string_view name = "constant_torque";
  static constexpr double largest_share_of_spin = 0.1;

  // N m on i.
  template <class Real>
  static Triple<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, const NormalForce<Real>& normal,
                               const Real& dt) {
    const Triple<Real> w = touch.spin - touch.normal * dot(touch.spin, touch.normal);
    const Real size2 = dot(w, w);
    const Mask<Real> turning = size2 > Real(0.0);
    const Real torque_per_spin = c.rolling_friction * c.effective_radius * larger(normal.elastic, Real(0.0)) /
                                 square_root(select(turning, size2, Real(1.0)));
    const Real most = largest_share_of_spin * c.effective_inertia / dt;
    return w * select(turning, Real(-1.0) * smaller(torque_per_spin, most), Real(0.0));
  }
};

}  // namespace dem
