#include "libdem/case/bed_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {

BedRegion bed_region(const Case& c) {
  if (c.bed.box) return *c.bed.box;
  return CylinderRegion{0.5 * c.vessel.diameter};
}

double cross_section(const BedRegion& region) {
  if (const auto* circle = std::get_if<CylinderRegion>(&region))
    return std::numbers::pi * circle->radius * circle->radius;
  const auto& box = std::get<BoxRegion>(region);
  return (box.x_high - box.x_low) * (box.y_high - box.y_low);
}

double clear_radius(const BedRegion& region) {
  if (const auto* circle = std::get_if<CylinderRegion>(&region)) return circle->radius;
  const auto& box = std::get<BoxRegion>(region);
  return 0.5 * std::min(box.x_high - box.x_low, box.y_high - box.y_low);
}

Vec3 held_inside(const BedRegion& region, const Vec3& x, double margin) {
  if (const auto* circle = std::get_if<CylinderRegion>(&region)) {
    const double r = std::hypot(x.x(), x.y()), most = circle->radius - margin;
    if (r <= most) return x;
    return {x.x() * (most / r), x.y() * (most / r), x.z()};
  }
  const auto& box = std::get<BoxRegion>(region);
  return {std::clamp(x.x(), box.x_low + margin, box.x_high - margin),
          std::clamp(x.y(), box.y_low + margin, box.y_high - margin), x.z()};
}

Vec3 point_inside(const BedRegion& region, double u, double v, double margin) {
  if (const auto* circle = std::get_if<CylinderRegion>(&region)) {
    const double r = (circle->radius - margin) * std::sqrt(u), angle = 2 * std::numbers::pi * v;
    return {r * std::cos(angle), r * std::sin(angle), 0};
  }
  const auto& box = std::get<BoxRegion>(region);
  return {box.x_low + margin + u * (box.x_high - box.x_low - 2 * margin),
          box.y_low + margin + v * (box.y_high - box.y_low - 2 * margin), 0};
}

}  // namespace dem
