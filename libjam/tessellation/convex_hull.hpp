// Volume of the convex hull of points, m^3; 0 where fewer than four do not lie in one plane.
#pragma once
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

double convex_hull_volume(const std::vector<Vec3>& points);

}  // namespace jam
