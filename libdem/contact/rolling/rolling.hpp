// Resistance against rolling. w is the relative spin without its part about the normal, F_n the elastic normal force where it
// pushes (0 where it pulls), R* the effective radius. Types A to C of Ai, Chen, Rotter and Ooi, Powder Technol. 206 (2011)
// 269.
//
// A torque of constant size chatters about w = 0 and, at large forces, turns the spin around within a step and grows without
// bound. So the torque of one contact takes away at most a tenth of a spin in a step: |tau| dt <= 0.1 I* |w|. A tenth, because
// a grain has up to about twelve contacts and their sum must not turn the spin around either. In a jam that is far from the whole
// torque (full_torque_force()), and how fast jammed grains roll under their load depends on it; an elastic_plastic one has no such limit.
// So that contacts that step at their own rate resist alike, the limit is that of the run's step, as long as no more than a fifth of a spin
// goes in the contact's own: the spins of equal grains that turn against n neighbours each grow from n = 2/share on.
#pragma once
#include <string_view>

#include "libdem/contact/touch.hpp"

namespace dem {

namespace rolling {

inline constexpr double largest_share_of_spin = 0.1;         // in a step of the run
inline constexpr double largest_share_in_own_step = 0.2;  // in a longer one of a contact

// 1/s, the share of a spin that may be taken away in a time.
template <class Real>
Real largest_share_rate(const Interval<Real>& dt) {
  return smaller(Real(largest_share_of_spin * dt.finest_rate), Real(largest_share_in_own_step * dt.rate));
}

template <class Real>
Triple<Real> without_twist(const Triple<Real>& spin, const Triple<Real>& normal) {
  return subtract_product(spin, normal, dot(spin, normal));
}

// -size w/|w|, no more than the largest share of the spin.
template <class Real>
Triple<Real> against(const Triple<Real>& w, const Real& size, const PairConstants<Real>& c, const Interval<Real>& dt) {
  const Real size2 = dot(w, w);
  const Mask<Real> turning = size2 > Real(0.0);
  const Real per_spin = size * inverse_root(size2);
  const Real most = c.effective_inertia * largest_share_rate(dt);
  return w * select(turning, -smaller(per_spin, most), Real(0.0));
}

template <class Real>
Triple<Real> negative(const Triple<Real>& t) {
  return {-t.x, -t.y, -t.z};
}

// N, the force on a grain of this mass, kg, up to which a constant torque resists in full where the grain rolls along a wall with this spin,
// rad/s: mu_r R F dt = share I w, with I = (2/5) m R^2.
inline double full_torque_force(double mass, double radius, double spin, double rolling_friction, double dt) {
  return largest_share_of_spin * 0.4 * mass * radius * spin / (rolling_friction * dt);
}

}  // namespace rolling

struct FreeRolling {
  static constexpr std::string_view name = "none";
  static constexpr bool has_spring = false, objective = true;
  template <class Real>
  static RollingTorque<Real> evaluate(const Touch<Real>&, const PairConstants<Real>&, const NormalForce<Real>&, Springs<Real>&,
                                      const Interval<Real>&) {
    const Real zero(0.0);
    return {{zero, zero, zero}, {zero, zero, zero}, zero};
  }
};

// Type A with the relative spin: tau = -mu_r R* F_n w/|w| on i, the opposite on j.
struct ConstantTorque {
  static constexpr std::string_view name = "constant_torque";
  static constexpr bool has_spring = false, objective = true;
  template <class Real>
  static RollingTorque<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, const NormalForce<Real>& normal,
                                      Springs<Real>&, const Interval<Real>& dt) {
    const Triple<Real> w = rolling::without_twist(touch.spin_i - touch.spin_j, touch.normal);
    const Real size = c.rolling_friction * c.effective_radius * larger(normal.elastic, Real(0.0));
    const Triple<Real> on_i = rolling::against(w, size, c, dt);
    return {on_i, rolling::negative(on_i), Real(0.0)};
  }
};

// EDEM's standard model: tau = -mu_r R F_n omega/|omega| with the spin and the lever of each particle on its own. Not
// objective: two grains that turn together as one body slow each other down, and angular momentum is not conserved. No torque
// on a wall (EDEM leaves it out of a geometry's torque).
struct EdemRolling {
  static constexpr std::string_view name = "edem";
  static constexpr bool has_spring = false, objective = false;
  template <class Real>
  static RollingTorque<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, const NormalForce<Real>& normal,
                                      Springs<Real>&, const Interval<Real>& dt) {
    const Real load = c.rolling_friction * larger(normal.elastic, Real(0.0));
    return {rolling::against(touch.spin_i, load * touch.arm_i, c, dt),
            rolling::against(touch.spin_j, load * touch.arm_j, c, dt), Real(0.0)};
  }
};

// Type C, the elastic-plastic spring-dashpot: an elastic torque M that grows by -k_r w dt up to mu_r R* F_n, and, while it is
// below, a viscous one -2 eta_r sqrt(I_r k_r) w, eta_r the rolling damping. k_r = 2.25 k_n mu_r^2 R*^2 for spheres, with
// Hertz's tangent stiffness k_n = 2 E* a; I_r^-1 = (I_i + m_i R_i^2)^-1 + (I_j + m_j R_j^2)^-1, which for spheres, whose
// moment about the contact is (7/2) I, is (7/2) I*. The elastic torque turns with the normal.
struct ElasticPlasticRolling {
  static constexpr std::string_view name = "elastic_plastic";
  static constexpr bool has_spring = true, objective = true;
  template <class Real>
  static RollingTorque<Real> evaluate(const Touch<Real>& touch, const PairConstants<Real>& c, const NormalForce<Real>& normal,
                                      Springs<Real>& springs, const Interval<Real>& dt) {
    const Triple<Real> w = rolling::without_twist(touch.spin_i - touch.spin_j, touch.normal);
    const Real lever = c.rolling_friction * c.effective_radius;
    const Real stiffness = 4.5 * c.effective_modulus * normal.contact_radius() * lever * lever;
    const Triple<Real> trial = subtract_product(rolling::without_twist(springs.rolling, touch.normal), w, Real(stiffness * dt.length));
    const Real limit = lever * larger(normal.elastic, Real(0.0));
    const Real size2 = dot(trial, trial);
    const Mask<Real> plastic = size2 > limit * limit;
    springs.rolling = trial * select(plastic, limit * inverse_root(size2), Real(1.0));
    // Explicit damping, and so no more than the largest share of the spin.
    const Real damping = smaller(2.0 * c.rolling_damping * square_root(3.5 * c.effective_inertia * stiffness),
                                 Real(c.effective_inertia * rolling::largest_share_rate(dt)));
    const Triple<Real> on_i = subtract_product(springs.rolling, w, select(plastic, Real(0.0), damping));
    const Mask<Real> stiff = stiffness > Real(0.0);
    const Real energy = select(stiff, 0.5 * dot(springs.rolling, springs.rolling) / select(stiff, stiffness, Real(1.0)), Real(0.0));
    return {on_i, rolling::negative(on_i), energy};
  }
};

}  // namespace dem
