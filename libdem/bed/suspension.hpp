// Grains at random places that touch neither each other nor a wall: what a bed settles from.
//
// Centres are drawn at random over a column, overlaps and all; then every grain is pushed out of those it overlaps, again and
// again, until none does (the "force-biased" generation of Moscinski et al., Molecular Simulation 3 (1989) 201, without its
// growth of the grains). A suspension of 0.45 is far below the 0.64 at which this would stop working and below the 0.49
// at which spheres begin to order, so it is random; grains then have centimetres to fall instead of decimetres from a
// lattice.
#pragma once
#include <functional>

#include "libdem/case/bed_region.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// `count` grains with the sizes of the bed, ids from 1 on, at rest, the walls of the setup at their starting poses. The same
// seed gives the same grains, whatever the number of threads. Throws CaseError where they do not fit.
// `interrupted` (may be empty) is asked now and then; once it says true no grains come back.
Particles random_suspension(const Setup& setup, const Bed& bed, std::uint8_t material, const BedRegion& region,
                            std::size_t count, const std::function<bool()>& interrupted);

}  // namespace dem
