// A bounding-volume tree over the triangles of a mesh (CGAL's AABB tree behind a pointer).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "libdem/geometry/mesh.hpp"

namespace dem {

class MeshTree {
 public:
  explicit MeshTree(const TriangleMesh& mesh);
  ~MeshTree();
  MeshTree(MeshTree&&) noexcept;
  MeshTree& operator=(MeshTree&&) noexcept;

  // Appends the triangles that meet the box [low, high], in no stated order. Safe to call from several threads.
  void triangles_in_box(const Vec3& low, const Vec3& high, std::vector<std::uint32_t>& out) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace dem
