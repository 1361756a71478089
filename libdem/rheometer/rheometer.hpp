// From a case to a run: the vessel, the blade and its helical motion.
#pragma once
#include "libdem/bed/bed.hpp"
#include "libdem/case/case.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// Walls of a rheometer, in this order.
enum RheometerWall : std::size_t { wall_floor = 0, wall_cylinder = 1, wall_blade = 2 };

struct Rheometer {
  Setup setup;
  double tip_radius = 0;             // m, of the blade
  double blade_low = 0, blade_high = 0;  // m, extent of the blade's plate along z, body frame
};

// Throws CaseError or GeometryError: a blade that is not a closed surface or that touches the vessel.
Rheometer make_rheometer(const Case& c);

}  // namespace dem
