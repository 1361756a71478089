// The six runs of the paper as plain structs, for tests that want no case file.
#pragma once
#include <cmath>

#include "libdem/case/case.hpp"

namespace dem {

// test: 'a', 'b' or 'c'; downward. materials: 0 glass, 1 steel.
inline Case ft4(char test) {
  const double young = test == 'a' ? 63e9 : 63e6;
  const double adhesion = test == 'c' ? 0.274 * std::pow(1000.0, -0.4) : 0.274;
  Case c;
  c.name = "ft4";
  c.materials = {{"glass", 2500, young, 0.2}, {"steel", 7800, 210e9, 0.3}};
  const Interaction bead{0.9, 0.5, 0.01, adhesion}, blade{0.9, 0.3, 0.01, adhesion};
  c.interactions = {{bead, blade}, {blade, bead}};
  c.bed = {"glass", 0.925e-3, 0.8, 1.2, 52e-3, 1};
  c.vessel = {"glass", 25e-3};
  TwistedBlade plate;
  plate.diameter = 23.5e-3;
  c.blade = {"steel", plate, 52e-3};
  c.motion = {0.25, -5 * std::acos(-1.0) / 180, false};
  c.duration = 2;
  c.step = 5e-8;
  c.output = {2e-3, 1e-4, 20e-3, false, {}};
  return c;
}

}  // namespace dem
