#include "libdem/geometry/mesh_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <boost/iterator/function_output_iterator.hpp>

namespace dem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

Triangles to_cgal(const TriangleMesh& mesh) {
  Triangles triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]), point(mesh.vertices[t[2]]));
  return triangles;
}

}  // namespace

struct MeshTree::Impl {
  Triangles triangles;
  Tree tree;

  explicit Impl(const TriangleMesh& mesh) : triangles(to_cgal(mesh)), tree(triangles.begin(), triangles.end()) {
    tree.build();  // now, not at the first query, which may come from several threads
  }
};

MeshTree::MeshTree(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}
MeshTree::~MeshTree() = default;
MeshTree::MeshTree(MeshTree&&) noexcept = default;
MeshTree& MeshTree::operator=(MeshTree&&) noexcept = default;

void MeshTree::triangles_in_box(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& out) const {
  if (impl_->triangles.empty()) return;
  const CGAL::Bbox_3 box(low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  impl_->tree.all_intersected_primitives(
      box, boost::make_function_output_iterator([&](Triangles::const_iterator triangle) {
        out.push_back(static_cast<std::uint32_t>(triangle - impl_->triangles.begin()));
      }));
}

}  // namespace dem
