// Bodies made from a few numbers: the straight blade of a recoater, and the rough plate it spreads over.
#pragma once
#include <cstdint>

#include "libdem/geometry/mesh.hpp"
#include "libdem/geometry/walls.hpp"

namespace dem {

// A closed cuboid of the given edges, m, about the origin, twelve triangles. Labels: `tip` below (normal -z: the side that a
// recoater's gap is under), `face` elsewhere. Throws CaseError for edges that are not positive and finite.
TriangleMesh make_box(const Vec3& size);

// A monolayer of grains glued to a plane.
struct RoughPlate {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  // m, of the centres
  double top = 0;        // m, highest point of the highest possible grain
  double diameter = 0;   // m
  double roughness = 0;  // 1, in [0, 1]: grains are lowered by random shares of this times their diameter
  std::uint64_t seed = 1;
};
// Grains on a hexagonal lattice of touching spheres, rows along x, each lowered by a random depth. The same seed gives the same
// plate on every platform. Throws CaseError for an area without grains, more than ten million of them, and numbers out of range.
GluedGrains make_rough_plate(const RoughPlate& plate);

}  // namespace dem
