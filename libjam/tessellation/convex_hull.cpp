#include "libjam/tessellation/convex_hull.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

namespace jam {

double convex_hull_volume(const std::vector<Vec3>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  if (points.size() < 4) return 0;
  std::vector<Kernel::Point_3> corners;
  for (const Vec3& p : points) corners.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Kernel::Point_3> hull;
  CGAL::convex_hull_3(corners.begin(), corners.end(), hull);
  double volume = 0;
  for (const auto face : hull.faces()) {
    std::vector<Vec3> corner;
    for (const auto vertex : hull.vertices_around_face(hull.halfedge(face))) {
      const Kernel::Point_3& p = hull.point(vertex);
      corner.emplace_back(Vec3(p.x(), p.y(), p.z()) - points[0]);
    }
    for (std::size_t k = 2; k < corner.size(); ++k) volume += corner[0].dot(corner[k - 1].cross(corner[k])) / 6;
  }
  return std::abs(volume);
}

}  // namespace jam
