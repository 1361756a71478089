// Meshes and independent (slow, obvious) geometry for the tests of this room.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "libdem/geometry/mesh.hpp"

namespace dem::test {

inline double uniform(std::mt19937_64& rng, double low, double high) {
  return low + (high - low) * static_cast<double>(rng() >> 11) * 0x1p-53;
}

inline Vec3 random_direction(std::mt19937_64& rng) {
  for (;;) {
    const Vec3 v(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

inline Eigen::Isometry3d random_motion(std::mt19937_64& rng, double shift) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(uniform(rng, 0, 6), random_direction(rng)));
  motion.pretranslate(Vec3(shift * random_direction(rng)));
  return motion;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Vec3& p : mesh.vertices) p = motion * p;
  return mesh;
}

// The same surface with vertices and triangles in another order and triangles beginning at another corner.
inline TriangleMesh shuffled(const TriangleMesh& mesh, std::mt19937_64& rng) {
  const auto shuffle = [&](std::vector<std::uint32_t>& v) {
    for (std::size_t i = v.size(); i > 1; --i) std::swap(v[i - 1], v[rng() % i]);
  };
  std::vector<std::uint32_t> vertex(mesh.vertices.size()), triangle(mesh.triangles.size());
  std::iota(vertex.begin(), vertex.end(), 0U);
  std::iota(triangle.begin(), triangle.end(), 0U);
  shuffle(vertex);
  shuffle(triangle);
  TriangleMesh out;
  out.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < vertex.size(); ++v) out.vertices[vertex[v]] = mesh.vertices[v];
  for (const std::uint32_t t : triangle) {
    std::array<std::uint32_t, 3> corners{};
    const std::size_t turn = rng() % 3;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = vertex[mesh.triangles[t][(k + turn) % 3]];
    out.triangles.push_back(corners);
    out.labels.push_back(mesh.labels[t]);
  }
  return out;
}

// The prism over a closed polygon (counter-clockwise, given with its triangulation) from z = low to z = high.
inline TriangleMesh prism(const std::vector<Eigen::Vector2d>& points,
                          const std::vector<std::array<std::uint32_t, 3>>& cover,
                          const std::vector<std::uint32_t>& outline, double low, double high) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (const Eigen::Vector2d& p : points) mesh.vertices.emplace_back(p.x(), p.y(), high);
  for (const Eigen::Vector2d& p : points) mesh.vertices.emplace_back(p.x(), p.y(), low);
  for (const auto& t : cover) mesh.triangles.push_back(t);
  for (const auto& t : cover) mesh.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::uint32_t a = outline[i], b = outline[(i + 1) % outline.size()];
    mesh.triangles.push_back({a, a + n, b + n});
    mesh.triangles.push_back({a, b + n, b});
  }
  mesh.labels.assign(mesh.triangles.size(), FacetLabel::face);
  return mesh;
}

// A slab with its upper side, z = 0, |x|, |y| < half, cut into 2 n^2 triangles; inner grid points are moved at random.
inline TriangleMesh slab(std::size_t n, double half, double depth, std::mt19937_64& rng, double jitter = 0.3) {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<std::uint32_t, 3>> cover;
  std::vector<std::uint32_t> outline;
  const double cell = 2 * half / static_cast<double>(n);
  const auto at = [&](std::size_t i, std::size_t k) { return static_cast<std::uint32_t>(i * (n + 1) + k); };
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t k = 0; k <= n; ++k) {
      const bool inner = i > 0 && k > 0 && i < n && k < n;
      const double move = inner ? jitter * cell : 0;
      points.emplace_back(-half + cell * static_cast<double>(i) + uniform(rng, -move, move),
                          -half + cell * static_cast<double>(k) + uniform(rng, -move, move));
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if (rng() % 2 == 0) {
        cover.push_back({a, b, c});
        cover.push_back({a, c, d});
      } else {
        cover.push_back({a, b, d});
        cover.push_back({b, c, d});
      }
    }
  for (std::size_t i = 0; i < n; ++i) outline.push_back(at(i, 0));
  for (std::size_t k = 0; k < n; ++k) outline.push_back(at(n, k));
  for (std::size_t i = n; i > 0; --i) outline.push_back(at(i, n));
  for (std::size_t k = n; k > 0; --k) outline.push_back(at(0, k));
  return prism(points, cover, outline, -depth, 0);
}

inline TriangleMesh box(double x, double y, double z) {
  return prism({{-x / 2, -y / 2}, {x / 2, -y / 2}, {x / 2, y / 2}, {-x / 2, y / 2}}, {{0, 1, 2}, {0, 2, 3}},
               {0, 1, 2, 3}, -z / 2, z / 2);
}

// Two plates at the inner angle `opening` (rad), like an open book along z: the sphere's side is the space between
// them. Each plate is `length` long; the back closes it off.
inline TriangleMesh book(double opening, double length, double z) {
  const double half = opening / 2;
  const Eigen::Vector2d a(length * std::sin(half), length * std::cos(half)), b(-a.x(), a.y());
  const Eigen::Vector2d down(0, -length);
  // Counter-clockwise: valley, left end, left back, bottom, right back, right end.
  return prism({{0, 0}, b, b + down * 2, down * 2, a + down * 2, a}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}},
               {0, 1, 2, 3, 4, 5}, -z / 2, z / 2);
}

inline TriangleMesh cylinder(std::size_t sides, double radius, double height) {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<std::uint32_t, 3>> cover;
  std::vector<std::uint32_t> outline;
  for (std::size_t s = 0; s < sides; ++s) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(s) / static_cast<double>(sides);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    outline.push_back(static_cast<std::uint32_t>(s));
    if (s > 1) cover.push_back({0, static_cast<std::uint32_t>(s - 1), static_cast<std::uint32_t>(s)});
  }
  return prism(points, cover, outline, -height / 2, height / 2);
}

// Convex hull of random points, by trying every triple.
inline TriangleMesh random_hull(std::size_t n, double size, std::mt19937_64& rng) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < n; ++i) mesh.vertices.push_back(size * uniform(rng, 0.7, 1) * random_direction(rng));
  const auto& v = mesh.vertices;
  for (std::uint32_t a = 0; a < n; ++a)
    for (std::uint32_t b = 0; b < n; ++b)
      for (std::uint32_t c = a + 1; c < n; ++c) {
        if (b <= a || b == c) continue;
        const Vec3 normal = (v[b] - v[a]).cross(v[c] - v[a]);
        bool facet = true;
        for (std::uint32_t d = 0; d < n; ++d)
          if (d != a && d != b && d != c && normal.dot(v[d] - v[a]) > 0) facet = false;
        if (facet) mesh.triangles.push_back({a, b, c});
      }
  mesh.labels.assign(mesh.triangles.size(), FacetLabel::face);
  return mesh;
}

// Nearest point of a triangle, by projecting onto the plane and, if that is outside, onto the three sides in turn.
inline Vec3 nearest_point(const TriangleMesh& mesh, std::size_t t, const Vec3& centre) {
  const Vec3 &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
             &c = mesh.vertices[mesh.triangles[t][2]];
  const Vec3 normal = (b - a).cross(c - a);
  const Vec3 foot = centre - normal * (normal.dot(centre - a) / normal.squaredNorm());
  if (normal.dot((b - a).cross(foot - a)) >= 0 && normal.dot((c - b).cross(foot - b)) >= 0 &&
      normal.dot((a - c).cross(foot - c)) >= 0)
    return foot;
  Vec3 best = a;
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vec3 s = p + std::clamp((centre - p).dot(q - p) / (q - p).squaredNorm(), 0., 1.) * (q - p);
    if ((s - centre).squaredNorm() < (best - centre).squaredNorm()) best = s;
  }
  return best;
}

inline double nearest_distance(const TriangleMesh& mesh, const Vec3& centre) {
  double nearest = 1e300;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    nearest = std::min(nearest, (nearest_point(mesh, t, centre) - centre).norm());
  return nearest;
}

// Solid angle of the surface over 4 pi: 1 inside, 0 outside (Van Oosterom and Strackee 1983).
inline bool is_inside(const TriangleMesh& mesh, const Vec3& centre) {
  double angle = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - centre, b = mesh.vertices[t[1]] - centre, c = mesh.vertices[t[2]] - centre;
    angle += 2 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                   b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle > 2 * std::numbers::pi;
}

// Random point outside the body, at most `reach` from one of its triangles.
inline Vec3 random_outside_point(const TriangleMesh& mesh, double reach, std::mt19937_64& rng) {
  for (;;) {
    const auto& t = mesh.triangles[rng() % mesh.triangles.size()];
    double u = uniform(rng, 0, 1), w = uniform(rng, 0, 1);
    if (u + w > 1) u = 1 - u, w = 1 - w;
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 p = a + u * (mesh.vertices[t[1]] - a) + w * (mesh.vertices[t[2]] - a) +
                   uniform(rng, 0.01, 1) * reach * random_direction(rng);
    if (!is_inside(mesh, p)) return p;
  }
}

}  // namespace dem::test
