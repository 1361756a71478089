// Where the energy of the contacts goes, exact to rounding for the leapfrog scheme.
//
// With velocities v- before and v+ after the impulse that a grain gets at step n, its kinetic energy there is K_n = m/2 v-.v+, and
//
//   the sum over the impulses J of J_n . (v- + v+)/2, half of the first and of the last left out,                           (1)
//
// is exactly what K changes by: v+ of one impulse is v- of the next. So what a contact takes from its bodies at a step is half its
// impulses and angular impulses with the velocities before and half with those after. From this the ledger books, each by its
// own formula, what is stored (energies as functions of the contact's state), damped, turned into heat by sliding and rolling,
// and lost when contacts form and break. What is left of (1) is the error of the time stepping itself: of the second order in
// the step where forces are smooth, of the first where contacts form, break, begin or cease to slide. It is reported as such.
#pragma once
#include <Eigen/Core>

#include "libdem/case/case.hpp"

namespace dem {

// J, since the ledger was begun; > 0 is taken from the grains unless said otherwise.
struct LedgerSums {
  double normal_damping = 0;
  double tangential_damping = 0;
  double sliding = 0;
  double rolling = 0;           // rolling resistance, viscous and plastic
  double detachment = 0;        // lost by the forming and breaking of contacts: adhesion hysteresis, and springs that let go
  double stiffness_change = 0;  // gained (> 0) by tangential springs whose stiffness changed at a given length or force
  double time_stepping = 0;     // lost (> 0) or made (< 0) by the finite time step

  LedgerSums& operator+=(const LedgerSums& more) {
    normal_damping += more.normal_damping;
    tangential_damping += more.tangential_damping;
    sliding += more.sliding;
    rolling += more.rolling;
    detachment += more.detachment;
    stiffness_change += more.stiffness_change;
    time_stepping += more.time_stepping;
    return *this;
  }
};

// J, energies stored in one contact or in all.
struct StoredEnergy {
  double normal = 0;      // integral of the elastic normal force; <= 0 for a JKR neck at rest
  double surface = 0;     // <= 0, the part of `normal` that closed surfaces hold
  double tangential = 0;  // in the tangential spring
  double rolling = 0;     // in the rolling spring
  double total() const { return normal + tangential + rolling; }
  StoredEnergy& operator+=(const StoredEnergy& more) {
    normal += more.normal;
    surface += more.surface;
    tangential += more.tangential;
    rolling += more.rolling;
    return *this;
  }
};

// A contact's forces, part by part, and its geometry at its last evaluation. All zero where there was no contact. Of a wall:
// velocity of its material point at the contact and its spin.
struct LastForces {
  double duration = 0;                                                   // s, of the impulses
  Vec3 normal = Vec3::Zero();                                            // unit
  double arm_i = 0, arm_j = 0;                                           // m
  double elastic = 0, damping = 0;                                       // N
  Vec3 tangential_elastic = Vec3::Zero(), tangential_viscous = Vec3::Zero();  // N on i
  Vec3 rolling_i = Vec3::Zero(), rolling_j = Vec3::Zero();               // N m
  Vec3 wall_velocity = Vec3::Zero(), wall_spin = Vec3::Zero();           // m/s, rad/s
  double normal_energy = 0, surface_energy = 0, tangential_energy = 0, rolling_energy = 0;  // J
  StoredEnergy energy() const { return {normal_energy, surface_energy, tangential_energy, rolling_energy}; }
};

// Half of (1) for one contact, with `centres` the velocity of i less that of j (of a wall: nothing), and its spins.
inline LedgerSums half_of_work(const LastForces& f, const Vec3& centres, const Vec3& spin_i, const Vec3& spin_j) {
  const Vec3 u = centres + (f.arm_i * spin_i + f.arm_j * spin_j).cross(f.normal) - f.wall_velocity;
  const double half = 0.5 * f.duration, closing = u.dot(f.normal);
  LedgerSums sums;
  sums.normal_damping = half * f.damping * closing;
  sums.tangential_damping = -half * f.tangential_viscous.dot(u);
  sums.rolling = -half * (f.rolling_i.dot(spin_i) + f.rolling_j.dot(spin_j));
  // What was stored, slid away and so on is taken off where it is known.
  sums.time_stepping = half * (f.elastic * closing - f.tangential_elastic.dot(u));
  return sums;
}

}  // namespace dem
