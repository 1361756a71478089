// What a contact law is given and what it gives back, for particle-particle and particle-wall contacts alike.
//
// Signs, once: overlap > 0 in contact; the normal points from i to j (from the particle to the wall); velocity is that of i
// relative to j; forces and torques are those on i, unless named _j. The contact point divides the branch vector in the ratio
// of the radii; against a wall that puts it at one radius from the particle's centre. It is one point for both bodies, so
// linear and angular momentum are conserved to rounding.
#pragma once
#include <array>
#include <cstddef>

#include "libdem/contact/number.hpp"

namespace dem {

template <class Real>
struct Touch {
  Real overlap;           // m
  Triple<Real> normal;    // unit
  Triple<Real> velocity;  // m/s, of i's material point at the contact relative to j's
  Triple<Real> spin_i, spin_j;  // rad/s, of the two bodies; a wall is body j
  Real arm_i, arm_j;      // m, from the centres to the contact point; 0 for a wall
  // m/s, at which the bodies near each other along the normal when they have this overlap. `velocity` is that of the leapfrog scheme,
  // half a step earlier: it is what a spring has been stretched with since, but a damper that lags by half a step errs by a share
  // of the step in the force.
  Real closing;
};

// Constants of one contact: of the two materials, and of the two bodies. Roots are kept where the law would take them every time.
template <class Real>
struct PairConstants {
  Real effective_modulus;   // Pa, E*: 1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j
  Real effective_shear;     // Pa, G*: 1/G* = (2-nu_i)/G_i + (2-nu_j)/G_j
  Real normal_damping, tangential_damping;  // sqrt(Pa), >= 0, the damping law's per_root() of the restitution
  Real friction;            // 1
  Real rolling_friction;    // 1
  Real rolling_damping;     // 1, share of critical damping of an elastic rolling resistance
  Real work_of_adhesion;    // J/m^2
  Real adhesion_scale;      // m^(2/3), k = (4 pi^2 W^2/E*^2)^(1/3); 0 without adhesion
  Real per_adhesion_scale;  // m^(-2/3), 1/k; 0 without adhesion
  Real root_adhesion_scale; // m^(1/6), k^(1/4)

  Real cube_root;           // m^(1/3), R*^(1/3)
  Real effective_inertia;   // kg m^2, 1/(1/I_i + 1/I_j)
  Real root_mass;           // kg^(1/2), sqrt(m*): 1/m* = 1/m_i + 1/m_j

  Real effective_radius;    // m, R*: 1/R* = 1/R_i + 1/R_j
  Real adhesion_length;     // m, s = a0^2/R* = k R*^(1/3); 0 without adhesion
  Real per_adhesion_length; // 1/m, 1/s; 0 without adhesion
  Real root_adhesion_radius;  // m^(1/2), sqrt(a0) = k^(1/4) R*^(1/3)
};

// TABLES of the members: those of the two materials; those that differ from contact to contact of the same materials; and those that
// follow from both and the radii (set_effective_radius), which is less work than to read them.
template <class Real>
inline constexpr std::array material_constants = {
    &PairConstants<Real>::effective_modulus,  &PairConstants<Real>::effective_shear,  &PairConstants<Real>::normal_damping,
    &PairConstants<Real>::tangential_damping, &PairConstants<Real>::friction,         &PairConstants<Real>::rolling_friction,
    &PairConstants<Real>::rolling_damping,    &PairConstants<Real>::work_of_adhesion, &PairConstants<Real>::adhesion_scale,
    &PairConstants<Real>::per_adhesion_scale, &PairConstants<Real>::root_adhesion_scale};
template <class Real>
inline constexpr std::array contact_constants = {
    &PairConstants<Real>::cube_root, &PairConstants<Real>::effective_inertia, &PairConstants<Real>::root_mass};
template <class Real>
inline constexpr std::array radius_constants = {
    &PairConstants<Real>::effective_radius, &PairConstants<Real>::adhesion_length, &PairConstants<Real>::per_adhesion_length,
    &PairConstants<Real>::root_adhesion_radius};
inline constexpr std::size_t constants_per_contact = contact_constants<double>.size();

// How long springs advance: s, and 1/s. Of no length: nothing slips further and rolling resistance has no limit from the spin.
template <class Real>
struct Interval {
  Real length, rate;
  Real finest_rate;  // 1/s, of the run's step, where contacts step at their own rate; else `rate`
  Interval(const Real& l) : Interval(l, Real(1.0 / l)) {}
  Interval(const Real& l, const Real& r) : Interval(l, r, r) {}
  Interval(const Real& l, const Real& r, const Real& finest) : length(l), rate(r), finest_rate(finest) {}
};

// What a contact remembers between steps.
template <class Real>
struct Springs {
  Triple<Real> tangential;  // m, elastic tangential displacement of i relative to j
  Triple<Real> rolling;     // N m, elastic part of the rolling torque on i
  Real contact_radius;      // m, of the step before; 0 for a new contact
};

template <class Real>
struct NormalForce {
  Real elastic;         // N, > 0 repulsive; adhesion included
  Real root_radius;     // m^(1/2), root of the contact radius
  Real repulsive;       // N, without the part that adhesion pulls with
  Real pull_off;        // N, largest tension the contact carries; 0 without adhesion
  Real energy;          // J, integral of the elastic force over the overlap; 0 for separated bodies
  Real surface_energy;  // J, <= 0, the part of `energy` that is gained by closing surfaces
  Real contact_radius() const { return root_radius * root_radius; }  // m
};

// kg/s: what multiplies the closing speed and the sliding speed. Where a damping law says so, over the root of a radius of the
// contact times the effective mass, in sqrt(Pa).
template <class Real>
struct DampingCoefficients {
  Real normal, tangential;
};

// The force on i is elastic + viscous. In the ledger's columns: `energy` is stored in the spring, `slip_work` is what sliding
// turned into heat in this step, `stiffness_work` what the spring gained because its stiffness changed under it.
template <class Real>
struct TangentialForce {
  Triple<Real> elastic, viscous;               // N on i
  Mask<Real> sliding;                          // at the friction limit
  Real energy, slip_work, stiffness_work;      // J
};

template <class Real>
struct RollingTorque {
  Triple<Real> on_i, on_j;  // N m
  Real energy;              // J, stored
};

template <class Real>
struct ContactForce {
  NormalForce<Real> normal;
  Real damping;  // N, normal, > 0 pushes apart
  TangentialForce<Real> tangential;
  RollingTorque<Real> rolling;
};

}  // namespace dem
