// How much of the space around the particles they fill, from the cells of the power tessellation (libjam/tessellation/power_cells.hpp).
//
//   local_solid_fraction     V_sphere / V_cell of each particle; NaN where its cell is open
//   solid_fraction           sum of V_sphere over sum of V_cell of the particles whose cell is closed; NaN without any
#pragma once
#include <cmath>
#include <limits>

#include "libjam/graph/particle_stress.hpp"

namespace jam {

inline std::vector<double> local_solid_fraction(const Snapshot& snapshot, const std::vector<double>& cells) {
  std::vector<double> fraction = sphere_volumes(snapshot);
  for (std::size_t v = 0; v < fraction.size(); ++v)
    fraction[v] = cells[v] > 0 ? fraction[v] / cells[v] : std::numeric_limits<double>::quiet_NaN();
  return fraction;
}

inline double solid_fraction(const Snapshot& snapshot, const std::vector<double>& cells) {
  const std::vector<double> volume = sphere_volumes(snapshot);
  double filled = 0, space = 0;
  for (std::size_t v = 0; v < volume.size(); ++v)
    if (cells[v] > 0) filled += volume[v], space += cells[v];
  return filled / (space > 0 ? space : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace jam
