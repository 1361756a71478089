#include "libdem/geometry/mesh_processing.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "libdem/errors.hpp"

namespace dem {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Mesh::Face_index;
using Labels = Mesh::Property_map<Face, FacetLabel>;

Mesh to_cgal(const TriangleMesh& mesh) {
  Mesh out;
  out.reserve(static_cast<Mesh::size_type>(mesh.vertices.size()),
              static_cast<Mesh::size_type>(3 * mesh.triangles.size()),
              static_cast<Mesh::size_type>(mesh.triangles.size()));
  for (const Vec3& p : mesh.vertices) out.add_vertex({p.x(), p.y(), p.z()});
  Labels labels = out.add_property_map<Face, FacetLabel>("f:label", FacetLabel::face).first;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Face face = out.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
    if (face == Mesh::null_face())
      throw GeometryError("mesh: triangle " + std::to_string(t) + " does not fit a manifold surface");
    if (t < mesh.labels.size()) labels[face] = mesh.labels[t];
  }
  return out;
}

TriangleMesh from_cgal(const Mesh& mesh) {
  const auto position = [&](Mesh::Vertex_index v) {
    const Kernel::Point_3& p = mesh.point(v);
    return Vec3(p.x(), p.y(), p.z());
  };
  std::vector<Mesh::Vertex_index> order(mesh.vertices().begin(), mesh.vertices().end());
  std::ranges::sort(order, {}, [&](Mesh::Vertex_index v) {
    const Vec3 p = position(v);
    return std::tuple(p.x(), p.y(), p.z(), v.idx());
  });
  TriangleMesh out;
  std::map<Mesh::Vertex_index, std::uint32_t> number;
  for (const Mesh::Vertex_index v : order) {
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(position(v));
  }
  const auto labels = mesh.property_map<Face, FacetLabel>("f:label").first;
  std::vector<std::pair<std::array<std::uint32_t, 3>, FacetLabel>> triangles;
  for (const Face f : mesh.faces()) {
    std::array<std::uint32_t, 3> t{};
    std::size_t k = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = number[v];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.emplace_back(t, labels[f]);
  }
  std::ranges::sort(triangles);
  for (const auto& [t, label] : triangles) {
    out.triangles.push_back(t);
    out.labels.push_back(label);
  }
  return out;
}

// Hands the label of a triangle to the pieces that corefinement cuts it into and to its copy in the result.
struct KeepLabels : pmp::Corefinement::Default_visitor<Mesh> {
  std::map<const Mesh*, Labels>* labels;
  FacetLabel current = FacetLabel::face;

  explicit KeepLabels(std::map<const Mesh*, Labels>& l) : labels(&l) {}
  void before_subface_creations(Face split, const Mesh& mesh) { current = labels->at(&mesh)[split]; }
  void after_subface_created(Face piece, const Mesh& mesh) { labels->at(&mesh)[piece] = current; }
  void after_face_copy(Face source, const Mesh& source_mesh, Face target, const Mesh& target_mesh) {
    labels->at(&target_mesh)[target] = labels->at(&source_mesh)[source];
  }
};

}  // namespace

TriangleMesh mesh_union(const TriangleMesh& a, const TriangleMesh& b) {
  Mesh first = to_cgal(a), second = to_cgal(b), result;
  std::map<const Mesh*, Labels> labels{{&first, first.property_map<Face, FacetLabel>("f:label").first},
                                       {&second, second.property_map<Face, FacetLabel>("f:label").first},
                                       {&result, result.add_property_map<Face, FacetLabel>("f:label").first}};
  if (!pmp::corefine_and_compute_union(first, second, result, CGAL::parameters::visitor(KeepLabels(labels))))
    throw GeometryError("mesh: the union of two bodies is not bounded by a manifold surface");
  return from_cgal(result);
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const TriangleMesh& mesh) {
  std::vector<std::pair<Face, Face>> pairs;
  pmp::self_intersections(to_cgal(mesh), std::back_inserter(pairs));
  std::vector<std::array<std::uint32_t, 2>> out;
  for (const auto& [f, g] : pairs) out.push_back({std::min(f.idx(), g.idx()), std::max(f.idx(), g.idx())});
  std::ranges::sort(out);
  return out;
}

std::vector<std::uint32_t> orient_consistently(TriangleMesh& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& t : mesh.triangles) polygons.push_back({t[0], t[1], t[2]});
  pmp::orient_polygon_soup(points, polygons);

  mesh.vertices.clear();
  for (const Kernel::Point_3& p : points) mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::uint32_t> turned;
  for (std::uint32_t t = 0; t < polygons.size(); ++t) {
    const std::vector<std::size_t>& p = polygons[t];
    const std::array<std::uint32_t, 3> now{static_cast<std::uint32_t>(p[0]), static_cast<std::uint32_t>(p[1]),
                                           static_cast<std::uint32_t>(p[2])};
    const Vec3 normal =
        (mesh.vertices[now[1]] - mesh.vertices[now[0]]).cross(mesh.vertices[now[2]] - mesh.vertices[now[0]]);
    const auto& before = mesh.triangles[t];
    const Vec3 old_normal = (mesh.vertices[before[1]] - mesh.vertices[before[0]])
                                .cross(mesh.vertices[before[2]] - mesh.vertices[before[0]]);
    if (normal.dot(old_normal) < 0) turned.push_back(t);
    mesh.triangles[t] = now;
  }
  return turned;
}

}  // namespace dem
