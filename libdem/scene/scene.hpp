// From a case to a run: its walls, what each of them is to the jam analysis, and where its bed stands.
#pragma once
#include <optional>
#include <vector>

#include "libdem/case/bed_region.hpp"
#include "libdem/case/case.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// Grains jam between what moves, blades, and what holds against it, the vessel.
enum class WallRole : std::uint8_t { other, blade, vessel };

struct SceneWall {
  Wall wall;
  WallRole role = WallRole::vessel;
};

// The annulus in which the grains of a rheometer jam.
struct RheometerGap {
  double tip_radius = 0;                 // m, of the blade
  double vessel_radius = 0;              // m
  double blade_low = 0, blade_high = 0;  // m, extent of the blade's plate along z, body frame
};

struct Scene {
  Setup setup;
  std::vector<WallRole> roles;  // [walls]
  BedRegion region;
  std::optional<RheometerGap> gap;
};

// The walls of the case's rheometer, if it has one ("floor", "cylinder", "blade"), then the given ones. Throws CaseError or
// GeometryError: a blade that is not a closed surface or that touches the vessel, two walls of one name, walls that are
// none (validate_wall).
Scene make_scene(const Case& c, std::vector<SceneWall> walls = {});

}  // namespace dem
