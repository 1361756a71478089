// How often a contact is evaluated. Contacts step at their own rate: one of level l is evaluated at every 2^l-th step, and its
// force then acts on both of its bodies at once, as an impulse as long as the time until they meet again. A grain moves at the
// rate of the finest of its contacts. What level a contact may have follows from what it does:
//
//   omega h <= 2 accuracy,  omega^2 = 2 E* a / m*,        where it vibrates about the load it carries                       (1)
//   omega h <= accuracy,    omega at the deepest overlap that its normal speed v can drive it to,                           (2)
//
// h = 2^l steps. Of an elastic Hertz impact that overlap is d = (15 m* v^2 / (16 E* sqrt(R*)))^(2/5) (Johnson, Contact
// Mechanics, section 11.4), so that in (2) omega^10 = (15/8)^5 (16 E* sqrt(R*) / (15 m*))^4 v^2. An impact takes 4.02/omega, and
// around its peak the force is F (1 - (omega t)^2/2): seen every h, the largest one seen is at most (omega h)^2/8 below it, 0.5 %
// for an accuracy of 0.2. The leapfrog scheme is stable for omega h < 2, omega of all contacts of a grain together: that is about
// three times the omega of one of them.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "libdem/case/case.hpp"
#include "libdem/contact/touch.hpp"

namespace dem {

struct Resolution {
  double step = 0;                      // s, of level 0
  double accuracy = default_accuracy;  // 1
  std::uint8_t highest = 0;             // level; 0: everything at every step
};

// Steps between evaluations, 2^level: the exponent's bits of a double.
inline double stride(std::uint8_t level) { return std::bit_cast<double>((1023 + std::uint64_t{level}) << 52); }
// 2^-level
inline double per_stride(std::uint8_t level) { return std::bit_cast<double>((1023 - std::uint64_t{level}) << 52); }

// The highest level that is due at this step.
inline std::uint8_t due_at(std::uint64_t step, std::uint8_t highest) {
  return std::uint8_t(std::min<int>(std::countr_zero(step), highest));
}

// What level 0 just resolves: contact radius and normal speed. A level higher is a quarter of the radius, 1/32 of the speed.
struct LevelScale {
  float radius = 0;  // m
  float speed = 0;   // m/s
};

// Of a pack the smallest of its lanes'.
template <class Real>
LevelScale level_scale(const PairConstants<Real>& c, const Resolution& r) {
  const double relative = r.accuracy / r.step, relative2 = relative * relative;  // 1/s
  const double ratio = std::pow(15.0 / 8, 2.5);
  const Real mass = c.root_mass * c.root_mass;
  const Real radius = Real(4 * relative2) * mass / (Real(2.0) * c.effective_modulus);
  const Real stiffness = Real(16.0) * c.effective_modulus * square_root(c.effective_radius) / (Real(15.0) * mass);
  const Real speed = Real(relative2 * relative2 * relative / ratio) / (stiffness * stiffness);
  return {float(least_of(radius)), float(least_of(speed))};
}

// Resolved with omega h at most `share` of what (1) and (2) allow?
inline bool resolved(std::uint8_t level, const LevelScale& scale, double radius, double speed, double share) {
  const double h = stride(level), h2 = h * h, s2 = share * share;
  return radius * h2 <= s2 * scale.radius && speed * (h2 * h2 * h) <= s2 * s2 * share * scale.speed;
}

// What a contact's level must resolve.
struct Demand {
  double radius = 0;  // m, of the contact
  double speed = 0;   // m/s, normal
  double impact = 0;  // m/s, likewise where it drives the contact deeper than it is loaded (drives_deeper)
};

// Would a contact of radius a be driven to more than half of a by its normal speed v? The vibrations of others are small against
// the load: (1) resolves them. In terms of what level 0 resolves, (1) with a_0 and (2) with v_0 and a quarter of a_0:
// (v/v_0)^(2/5) a_0/4 > a/2.
template <class Real>
Mask<Real> drives_deeper(const LevelScale& scale, const Real& radius, const Real& speed) {
  const Real relative_radius = radius * Real(2 / double(scale.radius)), relative_speed = speed * Real(1 / double(scale.speed));
  const Real square = relative_radius * relative_radius;
  return relative_speed * relative_speed > square * square * relative_radius;
}

// A level falls at once to what is resolved and not above `cap`; it rises by one where the next one is due as well and would
// still be resolved with some room, whatever drives the contact.
inline std::uint8_t next_level(std::uint8_t level, std::uint8_t due, std::uint8_t cap, const LevelScale& scale,
                               const Demand& demand) {
  constexpr double room = 0.8;
  if (level < due && level < cap && resolved(level + 1, scale, demand.radius, demand.speed, room)) return level + 1;
  level = std::min(level, cap);
  while (level > 0 && !resolved(level, scale, demand.radius, demand.impact, 1.0)) --level;
  return level;
}

// How many contacts were evaluated, blocks of pairs (of eight lanes) and touches of walls; and how many it would have been if all
// had been at every step.
struct Evaluations {
  std::uint64_t blocks = 0, blocks_at_every_step = 0;
  std::uint64_t touches = 0, touches_at_every_step = 0;
  Evaluations& operator+=(const Evaluations& more) {
    blocks += more.blocks;
    blocks_at_every_step += more.blocks_at_every_step;
    touches += more.touches;
    touches_at_every_step += more.touches_at_every_step;
    return *this;
  }
};

}  // namespace dem
