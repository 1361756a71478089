#include "libjam/tessellation/wall_planes.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <numbers>

namespace jam {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;

constexpr double tangent_step = 2 * std::numbers::pi / 180;

Kernel::Point_3 point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}
Vec3 vector(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

// Takes points of one wall, given as seen from the centre, for planes: nearest first, while the planes so far leave them in sight.
void lean_on(std::vector<Vec3>& points, double reach, std::vector<BoundingPlane>& planes) {
  std::stable_sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
  const std::size_t first = planes.size();
  for (const Vec3& p : points) {
    const double distance = p.norm();
    if (!(distance < reach)) return;
    if (distance == 0) continue;
    const bool hidden = std::any_of(planes.begin() + std::ptrdiff_t(first), planes.end(), [&](const BoundingPlane& plane) {
      return plane.normal.dot(p) >= plane.distance * (1 - 1e-9);
    });
    if (!hidden) planes.push_back({p / distance, distance});
  }
}

// `centre` in the body frame of a cylinder or cone; planes in that frame.
void around_axis(const Wall& wall, const Vec3& centre, double reach, std::vector<BoundingPlane>& planes) {
  const Vec3 axis = wall.axis.normalized(), from_point = centre - wall.point;
  const double along = from_point.dot(axis);
  if (along < wall.low || along > wall.high) return;
  const Vec3 across = from_point - along * axis;
  const double away = across.norm();
  // Of a cone the radius changes along the axis; its wall leans by the angle `lean`.
  const bool cone = wall.kind == "cone";
  const double slope = cone ? (wall.high_radius - wall.radius) / (wall.high - wall.low) : 0;
  const double radius = cone ? wall.radius + slope * (along - wall.low) : wall.radius, lean = std::atan(slope);
  const Vec3 ahead = away > 0 ? Vec3(across / away) : Vec3(axis.unitOrthogonal());
  const Vec3 aside = axis.cross(ahead);
  if (away > radius) {
    const double distance = (away - radius) * std::cos(lean);
    if (distance < reach) planes.push_back({-(std::cos(lean) * ahead - std::sin(lean) * axis), distance});
    return;
  }
  for (int k = 0; k <= 90; ++k)
    for (const int side : {1, -1}) {
      const double turn = side * k * tangent_step, distance = (radius - away * std::cos(turn)) * std::cos(lean);
      if (!(distance < reach) || (side < 0 && (k == 0 || k == 90))) continue;
      planes.push_back({std::cos(lean) * (std::cos(turn) * ahead + std::sin(turn) * aside) - std::sin(lean) * axis, distance});
    }
}

}  // namespace

struct WallPlanes::Mesh {
  Triangles triangles;
  Tree tree;
  explicit Mesh(const Wall& wall) {
    for (const auto& t : wall.triangles)
      triangles.emplace_back(point(wall.vertices[t[0]]), point(wall.vertices[t[1]]), point(wall.vertices[t[2]]));
    tree.insert(triangles.cbegin(), triangles.cend());
    tree.build();
  }
  void nearest_points(const Vec3& centre, double reach, std::vector<Vec3>& points) const {
    const Kernel::Point_3 from = point(centre), far(centre.x() + 1e6 * reach, centre.y(), centre.z());
    const CGAL::Bbox_3 box(centre.x() - reach, centre.y() - reach, centre.z() - reach, centre.x() + reach, centre.y() + reach,
                           centre.z() + reach);
    const auto nearest = tree.traits().closest_point_object();
    tree.all_intersected_primitives(box, boost::make_function_output_iterator([&](Triangles::const_iterator triangle) {
      points.push_back(vector(nearest(from, Primitive(triangle), far)) - centre);
    }));
  }
};

WallPlanes::WallPlanes(const std::vector<Wall>& walls, const std::vector<WallState>& state) : walls_(walls), state_(state) {
  for (const Wall& wall : walls_) mesh_.push_back(wall.triangles.empty() ? nullptr : std::make_unique<const Mesh>(wall));
}
WallPlanes::~WallPlanes() = default;

void WallPlanes::around(const Vec3& centre, double reach, std::vector<BoundingPlane>& planes) const {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    const Eigen::Quaterniond& turn = state_[w].orientation;
    const Vec3 body = turn.conjugate() * (centre - state_[w].position);
    const std::size_t first = planes.size();
    if (mesh_[w]) {
      std::vector<Vec3> points;
      mesh_[w]->nearest_points(body, reach, points);
      lean_on(points, reach, planes);
    } else if (wall.kind == "plane") {
      const double distance = wall.axis.normalized().dot(body - wall.point);
      if (distance < reach) planes.push_back({-wall.axis.normalized(), distance});
    } else if (wall.kind == "cylinder" || wall.kind == "cone") {
      around_axis(wall, body, reach, planes);
    } else if (wall.kind == "disc") {
      const Vec3 axis = wall.axis.normalized(), from_point = body - wall.point;
      const double above = from_point.dot(axis), away = (from_point - above * axis).norm();
      if (std::abs(above) < reach && away <= wall.radius && away >= wall.hole_radius)
        planes.push_back({above > 0 ? Vec3(-axis) : axis, std::abs(above)});
    }
    for (std::size_t k = first; k < planes.size(); ++k) planes[k].normal = turn * planes[k].normal;
  }
}

}  // namespace jam
