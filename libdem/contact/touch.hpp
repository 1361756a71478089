// What a contact law is given and what it gives back, for particle-particle and particle-wall contacts alike.
//
// Signs, once: overlap > 0 in contact; the normal points from i to j (from the particle to the wall); velocity and spin are
// those of i relative to j; forces and torques are those on i. The contact point divides the branch vector in the ratio of
// the radii; against a wall that puts it at one radius from the particle's centre. It is one point for both bodies, so
// linear and angular momentum are conserved to rounding.
#pragma once
#include "libdem/contact/number.hpp"

namespace dem {

template <class Real>
struct Touch {
  Real overlap;           // m
  Triple<Real> normal;    // unit
  Triple<Real> velocity;  // m/s, of i's material point at the contact relative to j's
  Triple<Real> spin;      // rad/s, angular velocity of i relative to j
};

// Constants of one contact: of the two materials, and of the two bodies.
template <class Real>
struct PairConstants {
  Real effective_modulus;   // Pa, E*: 1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j
  Real effective_shear;     // Pa, G*: 1/G* = (2-nu_i)/G_i + (2-nu_j)/G_j
  Real damping_ratio;       // 1, -ln e / sqrt(ln^2 e + pi^2) >= 0
  Real friction;            // 1
  Real rolling_friction;    // 1
  Real work_of_adhesion;    // J/m^2
  Real effective_radius;    // m, R*: 1/R* = 1/R_i + 1/R_j
  Real effective_mass;      // kg
  Real effective_inertia;   // kg m^2, 1/(1/I_i + 1/I_j)
  Real adhesion_length;     // m, a0^2/R* = (4 pi^2 W^2 R*/E*^2)^(1/3); 0 without adhesion
};

template <class Real>
struct NormalForce {
  Real elastic;         // N, > 0 repulsive; adhesion included
  Real contact_radius;  // m
  Real friction_load;   // N, what Coulomb's limit multiplies
};

template <class Real>
struct TangentialForce {
  Triple<Real> force;    // N on i
  Mask<Real> sliding;
};

template <class Real>
struct ContactForce {
  Real elastic;                 // N, normal, > 0 repulsive
  Real damping;                 // N, normal, > 0 pushes apart
  Triple<Real> tangential;      // N on i
  Triple<Real> rolling_torque;  // N m on i
  Mask<Real> sliding;
};

}  // namespace dem
