// A settled bed of grains in a vessel, a box or a heap: settled from a random suspension while soft, cut, stiffened in stages
// to the true modulus, cut again as it swells, and brought to rest, which is proved and not assumed (libdem/bed/rest.hpp).
#pragma once
#include <functional>
#include <string>

#include "libdem/bed/packing.hpp"
#include "libdem/case/bed_region.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// Changes whenever the recipe below would give other grains, so that stored beds of an older recipe are not taken for new.
inline constexpr int bed_recipe = 3;

struct BedProgress {
  std::string stage;         // "placing", "pouring", "cutting", "stiffening to 2.4 GPa", "resting", "probing"
  double time = 0, end = 0;  // s within the stage; it may be over before `end`
  std::size_t grains = 0;
  double kinetic_energy = 0;  // J, mean of a grain
  std::uint64_t steps = 0;    // of this stage so far
};

struct BedReport {
  std::size_t grains = 0;
  double solid_fraction = 0;           // in the slice between one and (depth - one) grain diameters, blade's volume not deducted
  double coordination = 0;             // 2 N_pp / N
  double mechanical_coordination = 0;  // contacts, walls included, per grain that has two or more
  std::size_t rattlers = 0;            // grains of no or one contact
  Overlaps overlaps;                   // squeezed grains stay as far as pouring, when grains are soft, pressed them in
  double top = 0;                      // m, highest grain centre
  // Of the probe that showed the bed at rest.
  std::size_t unsupported = 0;      // grains; at most five in a thousand, or there would be no bed
  double probe_interval = 0;        // s
  double largest_displacement = 0;  // m, of any grain over the probe
  double free_fall = 0;             // m, of an unsupported grain over the probe
  double kinetic_energy = 0;        // J, whole bed, at the end of the probe
  double rest_scale = 0;            // J, N m g d / 1e5: what the kinetic energy had to stay below
  double grain_steps = 0;           // what the bed cost: steps times grains, all stages
};

struct SettledBed {
  State state;  // step 0, at rest
  BedReport report;
};

// `setup` is that of the run to come: its walls stand still at their starting poses while the bed settles around them. Its
// step is not used, so that one bed serves runs of different steps; the recipe knows how large a step its stages bear.
// `progress` may be empty; it is called a few times a second at most. If `interrupted` says true the function throws
// BedInterrupted. Throws CaseError for a bed that is empty, does not fit or has no gravity, PhysicsError for one that does not
// come to rest.
SettledBed make_bed(const Setup& setup, const Bed& bed, std::uint8_t material, const BedRegion& region,
                    const std::function<void(const BedProgress&)>& progress = {},
                    const std::function<bool()>& interrupted = {});

struct BedInterrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dem
