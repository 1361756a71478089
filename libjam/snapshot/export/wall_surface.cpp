#include "libjam/snapshot/export/wall_surface.hpp"

#include <cmath>
#include <numbers>

namespace jam {
namespace {

constexpr std::uint32_t strips = 96;
constexpr double margin = 1.05;  // by which endless walls are larger than what is shown

// Two unit vectors across an axis, right-handed with it.
std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

// A band between two circles about the axis; a radius of 0 makes it a fan.
void add_band(WallSurface& surface, const Vec3& axis, const Vec3& from, double from_radius, const Vec3& to, double to_radius) {
  const auto [a, b] = across(axis);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::uint32_t k = 0; k < strips; ++k) {
    const double angle = 2 * std::numbers::pi * k / strips;
    const Vec3 out = std::cos(angle) * a + std::sin(angle) * b;
    surface.vertices.push_back(from + from_radius * out);
    surface.vertices.push_back(to + to_radius * out);
  }
  for (std::uint32_t k = 0; k < strips; ++k) {
    const std::uint32_t here = first + 2 * k, next = first + 2 * ((k + 1) % strips);
    if (from_radius > 0) surface.triangles.push_back({here, next, here + 1});
    if (to_radius > 0) surface.triangles.push_back({next, next + 1, here + 1});
  }
}

void add_plane(WallSurface& surface, const Wall& wall, const Eigen::AlignedBox3d& shown) {
  const Vec3 axis = wall.axis.normalized(), centre = shown.center();
  const Vec3 foot = centre - (centre - wall.point).dot(axis) * axis;
  const double half = margin * shown.diagonal().norm() / 2;
  const auto [a, b] = across(axis);
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    surface.vertices.push_back(foot + half * (u * a + v * b));
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
}

void add_tube(WallSurface& surface, const Wall& wall, const Eigen::AlignedBox3d& shown) {
  const Vec3 axis = wall.axis.normalized();
  const double middle = (shown.center() - wall.point).dot(axis), half = margin * shown.diagonal().norm() / 2;
  const double low = std::isfinite(wall.low) ? wall.low : middle - half;
  const double high = std::isfinite(wall.high) ? wall.high : middle + half;
  const double high_radius = wall.kind == "cone" ? wall.high_radius : wall.radius;
  add_band(surface, axis, wall.point + low * axis, wall.radius, wall.point + high * axis, high_radius);
}

void add_spheres(WallSurface& surface, const Wall& wall) {
  const double g = std::numbers::phi, scale = 1 / std::sqrt(1 + g * g);
  const Vec3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  constexpr std::uint32_t faces[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                          {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8},
                                          {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (std::size_t s = 0; s < wall.sphere_centre.size(); ++s) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (const Vec3& corner : corners)
      surface.vertices.push_back(wall.sphere_centre[s] + wall.sphere_radius[s] * scale * corner);
    for (const auto& face : faces) {
      surface.triangles.push_back({first + face[0], first + face[1], first + face[2]});
      surface.facet.push_back(static_cast<std::uint32_t>(s));
    }
  }
}

}  // namespace

WallSurface surface_of(const Wall& wall, const Eigen::AlignedBox3d& shown) {
  WallSurface surface;
  if (wall.kind == "mesh") {
    surface.vertices = wall.vertices;
    surface.triangles = wall.triangles;
    for (std::uint32_t t = 0; t < wall.triangles.size(); ++t) surface.facet.push_back(t);
  } else if (wall.kind == "spheres") {
    add_spheres(surface, wall);
  } else if (wall.kind == "plane") {
    add_plane(surface, wall, shown);
  } else if (wall.kind == "disc") {
    const Vec3 axis = wall.axis.normalized();
    add_band(surface, axis, wall.point, wall.hole_radius, wall.point, wall.radius);
  } else if (wall.kind == "cylinder" || wall.kind == "cone") {
    add_tube(surface, wall, shown);
  }
  surface.facet.resize(surface.triangles.size(), 0);
  return surface;
}

}  // namespace jam
