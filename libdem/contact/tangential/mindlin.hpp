// Mindlin (1949) no-slip stiffness on a total spring, with Coulomb's limit:
//
//   F_t = -k_t xi - 2 sqrt(5/6) beta sqrt(k_t m*) v_t,   k_t = 8 G* a,   |F_t| <= mu * friction load.
//
// The spring xi turns with the normal and keeps its length; on sliding it is set back to what alone would give the limit
// (-F_t/k_t), as in the reference integration of Chung and Ooi's test 4.
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

struct Mindlin {
  static constexpr std::string_view name = "mindlin";

  template <class Real>
  static TangentialForce<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c,
                                        const NormalForce<Real>& normal, Triple<Real>& spring, const Real& dt) {
    const Real v_n = dot(touch.velocity, touch.normal);
    const Triple<Real> v_t = touch.velocity - touch.normal * v_n;

    const Real length2 = dot(spring, spring);
    Triple<Real> xi = spring - touch.normal * dot(spring, touch.normal);
    const Real projected2 = dot(xi, xi);
    const Mask<Real> turn = projected2 > Real(0.0);
    const Real keep = select(turn, square_root(length2 / select(turn, projected2, Real(1.0))), Real(0.0));
    xi = xi * keep + v_t * dt;

    const Real k_t = 8.0 * c.effective_shear * normal.contact_radius;
    const Real gamma_t = (2 * 0.91287092917527690) * c.damping_ratio * square_root(k_t * c.effective_mass);
    const Triple<Real> trial = xi * (-k_t) - v_t * gamma_t;
    const Real limit = c.friction * normal.friction_load;
    const Real size2 = dot(trial, trial);
    const Mask<Real> sliding = size2 > limit * limit;
    const Real scale = select(sliding, limit / square_root(select(sliding, size2, Real(1.0))), Real(1.0));
    const Triple<Real> force = trial * scale;
    const Mask<Real> elastic = k_t > Real(0.0);
    const Real compliance = select(elastic, Real(-1.0) / select(elastic, k_t, Real(1.0)), Real(0.0));
    spring = select(sliding, force * compliance, xi);
    return {force, sliding};
  }
};

}  // namespace dem
