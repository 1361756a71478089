// A settled bed of grains in a cylindrical vessel: poured from a loose column while soft, cut, then stiffened in stages to the
// true modulus and brought to rest.
#pragma once
#include <functional>
#include <string>

#include "libdem/simulation/simulation.hpp"

namespace dem {

// Changes whenever the recipe below would give other grains, so that stored beds of an older recipe are not taken for new.
inline constexpr int bed_recipe = 1;

struct BedProgress {
  std::string stage;   // "pouring", "cutting", "stiffening to 2.4 GPa", "resting"
  double time = 0, end = 0;  // s within the stage
  std::size_t grains = 0;
  double kinetic_energy = 0;  // J
};

struct BedReport {
  std::size_t grains = 0;
  double solid_fraction = 0;       // in the slice between one and (depth - one) grain diameters, blade's volume not deducted
  double coordination = 0;         // 2 N_pp / N
  double kinetic_energy = 0;       // J, whole bed, at the end of the last stage
  double rest_scale = 0;           // J, grains * m g d / 1000: what the kinetic energy had to fall below
  double largest_overlap = 0;      // 1, over radius
  double top = 0;                  // m, highest grain centre
};

struct SettledBed {
  State state;  // step 0, at rest
  BedReport report;
};

// `setup` is that of the run to come: its walls stand still at their starting poses while the bed settles around them.
// vessel_radius in m. `progress` may be empty; it is called a few times a second at most. If `interrupted` says true the
// function throws BedInterrupted. Throws CaseError for an empty bed, PhysicsError for a bed that does not come to rest.
SettledBed make_bed(const Setup& setup, const Bed& bed, std::uint8_t material, double vessel_radius,
                    const std::function<void(const BedProgress&)>& progress = {},
                    const std::function<bool()>& interrupted = {});

struct BedInterrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dem
