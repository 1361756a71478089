// One or more walls of every shape, each with an independent description of its surface, for tests over all shapes.
#pragma once
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "libdem/geometry/walls.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem::test {

inline constexpr double pi = std::numbers::pi;

// A piece of surface: its part over the unit square is where centres are put near. Outside that square it goes on, or,
// where the surface ends, takes its arguments back to the border.
using Patch = std::function<Vec3(double&, double&)>;

struct WallSample {
  std::string name;
  WallShape shape;
  std::vector<Patch> patches;  // of infinite shapes the part that centres are put near
  bool solid;                  // bounds a solid: centres are only put outside
  bool round;                  // a surface of revolution: one touch
};

// The surface around (point, axis) whose radius changes linearly from low to high.
inline Patch revolved_patch(const Vec3& point, const Vec3& axis, double low_radius, double high_radius, double low,
                            double high, bool endless = false) {
  const Vec3 u = axis.unitOrthogonal(), w = axis.cross(u);
  return [=](double& a, double& b) -> Vec3 {
    if (!endless) a = std::clamp(a, 0.0, 1.0);
    const double z = low + (high - low) * a, r = low_radius + (high_radius - low_radius) * a, angle = 2 * pi * b;
    return point + z * axis + r * (std::cos(angle) * u + std::sin(angle) * w);
  };
}

inline Patch sphere_patch(const Vec3& centre, double radius) {
  return [=](double& a, double& b) -> Vec3 {
    const double polar = pi * a, angle = 2 * pi * b;
    return centre +
           radius * Vec3(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
  };
}

inline Patch triangle_patch(const Vec3& p, const Vec3& q, const Vec3& r) {
  return [=](double& a, double& b) -> Vec3 {
    a = std::clamp(a, 0.0, 1.0);
    b = std::clamp(b, 0.0, 1.0);
    return p + a * ((1 - b) * (q - p) + b * (r - p));
  };
}

// Sizes about 1 (m); the tests scale with nothing else.
inline std::vector<WallSample> wall_samples() {
  const Vec3 point(0.3, -0.2, 0.1), axis = Vec3(1, 2, 2) / 3.0, u = axis.unitOrthogonal(), w = axis.cross(u);
  const double inf = std::numeric_limits<double>::infinity();
  std::mt19937_64 rng(5);
  std::vector<WallSample> samples;
  samples.push_back({"plane",
                     Plane{point, axis},
                     {[=](double& a, double& b) -> Vec3 { return point + 4 * (a - 0.5) * u + 4 * (b - 0.5) * w; }},
                     true,
                     false});
  const auto cylinder = [&](const std::string& name, FreeSide free, double low, double high) {
    samples.push_back(
        {name,
         Cylinder{point, axis, 0.8, free, low, high},
         {revolved_patch(point, axis, 0.8, 0.8, std::max(low, -2.0), std::min(high, 2.0), std::isinf(low))},
         std::isinf(low),
         true});
  };
  cylinder("bore", FreeSide::inside, -inf, inf);
  cylinder("rod", FreeSide::outside, -inf, inf);
  cylinder("tube", FreeSide::inside, -0.4, 0.7);
  cylinder("ring", FreeSide::outside, 0.1, 0.2);
  const auto cone = [&](const std::string& name, FreeSide free, double low, double high) {
    samples.push_back(
        {name, Cone{point, axis, low, high, 0.7, free}, {revolved_patch(point, axis, low, high, 0, 0.7)}, false, true});
  };
  cone("hopper", FreeSide::inside, 0.3, 1.0);
  cone("spike", FreeSide::outside, 0.5, 0.0);
  cone("cup", FreeSide::inside, 0.0, 0.6);
  samples.push_back({"disc", Disc{point, axis, 0.9, 0}, {revolved_patch(point, axis, 0, 0.9, 0, 0)}, false, true});
  samples.push_back({"lid", Disc{point, axis, 0.9, 0.4}, {revolved_patch(point, axis, 0.4, 0.9, 0, 0)}, false, true});

  std::vector<Vec3> centres;
  std::vector<double> radii;
  std::vector<Patch> spheres;
  for (int k = 0; k < 40; ++k) {
    centres.push_back(Vec3(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -0.1, 0.1)));
    radii.push_back(uniform(rng, 0.1, 0.25));
    spheres.push_back(sphere_patch(centres.back(), radii.back()));
  }
  samples.push_back({"glued grains", make_glued_grains(centres, radii), spheres, true, false});

  const TriangleMesh hull = random_hull(12, 1, rng);
  std::vector<Patch> triangles;
  for (const auto& t : hull.triangles)
    triangles.push_back(triangle_patch(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]]));
  samples.push_back({"mesh", make_mesh_wall(hull), triangles, true, false});
  return samples;
}

// Distance from x to a patch: from the best of a grid a search goes to the best of eight neighbours and halves its step
// where none is better; once from the whole grid and once from inside it, as it may not find its way from an apex.
inline double distance_to(const Patch& patch, const Vec3& x) {
  constexpr int grid = 30;
  double nearest = 1e300;
  for (const int border : {0, 1}) {
    double a = 0.5, b = 0.5, best = 1e300;
    const auto look = [&](double at, double bt, double& best_a, double& best_b) {
      const double distance = (patch(at, bt) - x).norm();
      if (distance < best) best = distance, best_a = at, best_b = bt;
    };
    for (int i = border; i <= grid - border; ++i)
      for (int k = 0; k <= grid; ++k) look(double(i) / grid, double(k) / grid, a, b);
    for (double step = 1.0 / grid; step > 1e-13;) {
      double next_a = a, next_b = b;
      for (int i = -1; i <= 1; ++i)
        for (int k = -1; k <= 1; ++k) look(a + i * step, b + k * step, next_a, next_b);
      if (next_a == a && next_b == b) step *= 0.5;
      a = next_a;
      b = next_b;
    }
    nearest = std::min(nearest, best);
  }
  return nearest;
}
inline double distance_to(const WallSample& wall, const Vec3& x) {
  double best = 1e300;
  for (const Patch& patch : wall.patches) best = std::min(best, distance_to(patch, x));
  return best;
}

inline std::vector<WallTouch> touches_of(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach) {
  std::vector<std::uint32_t> parts;
  candidate_parts(wall, pose, centre, reach, parts);
  std::vector<WallTouch> out;
  std::vector<MeshTouch> scratch;
  nearest(wall, pose, centre, reach, parts, out, scratch);
  return out;
}

inline const WallTouch* nearest_of(const std::vector<WallTouch>& touches) {
  const auto found = std::ranges::min_element(touches, {}, &WallTouch::distance);
  return found == touches.end() ? nullptr : &*found;
}

// A point at most `reach` from the surface, on the free side of solids. Body frame.
inline Vec3 random_centre(const WallSample& sample, double reach, std::mt19937_64& rng) {
  for (;;) {
    const Patch& patch = sample.patches[rng() % sample.patches.size()];
    double a = uniform(rng, 0, 1), b = uniform(rng, 0, 1);
    const Vec3 x = patch(a, b) + uniform(rng, 0.05, 1) * reach * random_direction(rng);
    if (!sample.solid || !inside_material({"", 0, sample.shape, {}}, {}, x)) return x;
  }
}

}  // namespace dem::test
