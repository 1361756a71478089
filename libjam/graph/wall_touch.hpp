// Where a contact with a wall is, as far as the source knows it: the point where it knows one, else one radius away along the normal.
#pragma once
#include <optional>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct WallTouch {
  Vec3 arm;     // m, from the centre of the particle to the contact point
  Vec3 normal;  // unit, to the wall
};

// Nothing where the source knows neither point nor normal.
inline std::optional<WallTouch> wall_touch(const Snapshot& s, std::size_t contact) {
  const std::uint32_t i = s.pw.row[contact];
  const bool has_normal = present(s.pw.normal, s.pw.size());
  if (present(s.pw.point, s.pw.size())) {
    const Vec3 arm = s.pw.point[contact].cast<double>() - s.particles.position[i].cast<double>();
    return WallTouch{arm, has_normal ? Vec3(s.pw.normal[contact].cast<double>()) : Vec3(arm.normalized())};
  }
  if (!has_normal) return std::nullopt;
  const Vec3 normal = s.pw.normal[contact].cast<double>();
  return WallTouch{double{s.particles.radius[i]} * normal, normal};
}

}  // namespace jam
