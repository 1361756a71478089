// What a packing of grains is like: how densely it fills its region and how well its grains are connected.
#pragma once
#include <vector>

#include "libdem/case/bed_region.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// Share of the slice [low, high] of the region that spheres fill, counting those whose centre is in the region; exact for each
// sphere by its two caps. Bodies in the slice (a blade) are not deducted. 0 for an empty slice.
double solid_fraction(const Particles& p, const BedRegion& region, double low, double high);

// Contacts of each grain with grains and with walls; several touches of one wall count once each.
std::vector<std::uint32_t> contact_counts(const View& view);

// Mean number of contacts of the grains that take part in carrying the bed, walls included (Thornton, Geotechnique 50 (2000)
// 43): (sum of contacts - N_1)/(N - N_0 - N_1) with N_0, N_1 grains of no and of one contact, the rattlers. 0 where all are.
double mechanical_coordination(const std::vector<std::uint32_t>& contacts);

// Overlaps of acting contacts over the radius, of a pair over the smaller one. Grains that walls press from two sides, their normals more than
// 90 degrees apart, as between a blade's tip and the vessel, are squeezed: friction may hold them pressed by more than the weight of the bed
// does others. Their contacts, with grains too, count for them alone.
struct Overlaps {
  double largest = 0;           // 1, of contacts of other grains
  std::size_t squeezed = 0;     // grains
  double largest_squeezed = 0;  // 1, of contacts of squeezed grains; 0 where there are none
};
Overlaps overlaps_of(const State& state);

}  // namespace dem
