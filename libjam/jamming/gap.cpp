#include "libjam/jamming/gap.hpp"

#include <cmath>

namespace jam {

bool gap_known(const RunInfo& info) {
  return info.gap.tip_radius > 0;
}

bool in_gap(const Snapshot& snapshot, std::size_t row, const RunInfo& info, const Criteria& criteria) {
  if (!gap_known(info)) return false;
  const double diameter = 2 * double{snapshot.particles.radius[row]};
  for (std::size_t w = 0; w < info.walls.size(); ++w) {
    if (info.walls[w].role != WallRole::blade) continue;
    const Vec3 from_blade = snapshot.particles.position[row].cast<double>() - snapshot.walls[w].position;
    if (beside_tip(std::hypot(from_blade.x(), from_blade.y()), from_blade.z(), diameter, info.gap, criteria)) return true;
  }
  return false;
}

}  // namespace jam
