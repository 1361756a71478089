// Is a packing at rest? Energy alone does not tell: a grain that has just begun to fall has none.
//
// So all grains are stopped and set free, at the true stiffness and undamped, for the time T in which a free one falls by
// a thousandth of its diameter, g T^2/2 = d/1000. A grain whose forces balance only trembles: an unbalanced force of its own
// weight moves it by m g/k, some 1e-10 m for glass. A grain that nothing holds moves by its share of g T^2/2: its mean
// acceleration over the probe is 2 s/T^2 for a displacement s, and its mean unbalanced force over its weight 2 s/(g T^2).
#pragma once
#include <algorithm>
#include <cstdint>

#include "libdem/simulation/simulation.hpp"

namespace dem {

// A grain that moved as if a tenth of its weight were unbalanced, or that touches nothing, is not supported. The tenth lies
// between the trembling of supported grains (below 1e-2) and a grain that rolls off a slope of 8 degrees, (5/7) g sin 8 deg.
inline constexpr double unsupported_share = 0.1;

// So many grains of a packing at rest may be unsupported, and one in any case: some roll on the surface or turn about a single
// adhesive contact for tens of milliseconds, and carry nobody. Their number falls off like the inverse of the time only.
inline constexpr double tolerated_share = 5e-3;

struct RestProbe {
  double interval = 0;               // s, T
  double free_fall = 0;              // m, g T^2/2
  double largest_displacement = 0;   // m
  std::size_t unsupported = 0;       // grains
  std::size_t worst = 0;             // row of the grain that moved farthest
  std::size_t grains = 0;
  double kinetic_energy = 0;         // J, at the end
  double rest_scale = 0;             // J, N m g d/1e5: a hundredth of what it would be if all grains had fallen freely
  State state;                       // at the end
  View view;                         // likewise
  bool at_rest() const { return double(unsupported) <= std::max(1.0, tolerated_share * double(grains)) && kinetic_energy < rest_scale; }
};

// `setup` without local damping and with its walls at rest; its step is used. Empty packings are at rest. Condition: gravity > 0.
RestProbe probe_rest(const Setup& setup, State state);

}  // namespace dem
