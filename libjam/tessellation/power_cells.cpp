#include "libjam/tessellation/power_cells.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "libjam/tessellation/wall_planes.hpp"

namespace jam {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;

constexpr double open = std::numeric_limits<double>::quiet_NaN();

struct Site {
  Vec3 centre;
  double radius;
};

// The part of a polygon in which normal . x <= distance.
void clip(std::vector<Vec3>& polygon, const BoundingPlane& plane, std::vector<Vec3>& scratch) {
  scratch.clear();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double beyond_a = plane.normal.dot(a) - plane.distance, beyond_b = plane.normal.dot(b) - plane.distance;
    if (beyond_a <= 0) scratch.push_back(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
      scratch.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
  }
  polygon.swap(scratch);
}

// Volume of the convex cell that the planes bound, as the sum of the pyramids from the centre to its faces. Open if a face of the cube of
// half edge `reach` around the centre is left.
double cell_volume(std::vector<BoundingPlane>& planes, double reach) {
  const std::size_t closed = planes.size();
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) planes.push_back({side * Vec3::Unit(axis), reach});
  std::vector<Vec3> face, scratch;
  double volume = 0;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Vec3& normal = planes[k].normal;
    const Vec3 u = 2 * reach * normal.unitOrthogonal(), v = normal.cross(u), middle = planes[k].distance * normal;
    face.assign({middle + u + v, middle - u + v, middle - u - v, middle + u - v});
    for (std::size_t other = 0; other < planes.size() && !face.empty(); ++other)
      if (other != k) clip(face, planes[other], scratch);
    Vec3 area = Vec3::Zero();
    for (std::size_t c = 2; c < face.size(); ++c) area += (face[c - 1] - face[0]).cross(face[c] - face[0]) / 2;
    if (k >= closed && area.norm() > 1e-12 * reach * reach) return open;
    volume += planes[k].distance * area.norm() / 3;
  }
  return volume;
}

}  // namespace

std::vector<double> power_cell_volumes(const Snapshot& snapshot, const std::vector<Wall>& walls) {
  const Particles& p = snapshot.particles;
  std::vector<Site> sites;
  double largest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    sites.push_back({p.position[i].cast<double>(), p.radius[i]});
    largest = std::max(largest, double{p.radius[i]});
  }
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (std::size_t k = 0; k < walls[w].sphere_centre.size(); ++k)
      sites.push_back({snapshot.walls[w].position + snapshot.walls[w].orientation * walls[w].sphere_centre[k], walls[w].sphere_radius[k]});

  std::vector<std::pair<Kernel::Weighted_point_3, std::uint32_t>> weighted;
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    const Vec3& x = sites[s].centre;
    weighted.emplace_back(Kernel::Weighted_point_3({x.x(), x.y(), x.z()}, sites[s].radius * sites[s].radius), s);
  }
  const Triangulation triangulation(weighted.begin(), weighted.end());
  std::vector<std::vector<std::uint32_t>> partners(sites.size());
  for (const auto& edge : triangulation.finite_edges()) {
    const std::uint32_t a = edge.first->vertex(edge.second)->info(), b = edge.first->vertex(edge.third)->info();
    partners[a].push_back(b);
    partners[b].push_back(a);
  }
  std::vector<std::uint8_t> has_cell(sites.size(), 0);
  for (const auto& vertex : triangulation.finite_vertex_handles()) has_cell[vertex->info()] = 1;

  const WallPlanes wall_planes(walls, snapshot.walls);
  const double reach = 4 * largest;
  std::vector<double> volume(p.size(), 0.0);
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!has_cell[i]) continue;  // inside others: nothing is left for it
    std::vector<BoundingPlane> planes;
    std::sort(partners[i].begin(), partners[i].end());
    for (const std::uint32_t j : partners[i]) {
      const Vec3 branch = sites[j].centre - sites[i].centre;
      const double length = branch.norm();
      const double distance = (length * length + sites[i].radius * sites[i].radius - sites[j].radius * sites[j].radius) / (2 * length);
      planes.push_back({branch / length, distance});
    }
    wall_planes.around(sites[i].centre, reach, planes);
    // Nearest first: they cut most away.
    std::stable_sort(planes.begin(), planes.end(), [](const BoundingPlane& a, const BoundingPlane& b) { return a.distance < b.distance; });
    volume[i] = cell_volume(planes, reach);
  }
  return volume;
}

}  // namespace jam
