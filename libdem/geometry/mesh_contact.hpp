// Where a sphere touches a triangle mesh: the local minima of the distance from its centre to the surface.
//
// A face counts where the centre projects into its interior; an edge where it is the nearest part of BOTH its faces; a
// vertex where it is the nearest part of ALL its faces. So a sphere over two coplanar triangles has one touch, a sphere
// in a concave corner two, a sphere beyond a convex edge one, and the touch moves continuously as the sphere rolls
// across edges and vertices. The reference for the rule: it is the definition of an isolated minimum of a piecewise
// smooth function. Only the parts of the surface that face the centre count, so the far side of a thin plate does not;
// a centre inside the solid touches nothing.
//
// Minima whose normals differ by less than a merge angle g are one contact, the nearest of them: a smooth hollow
// surface meshed with facets has its two nearest facets as minima wherever a sphere passes an edge, and would push
// twice there. The overlap then stays continuous (it is the larger of the two) across every edge; across a concave edge
// that turns the surface by more than g a second contact appears with no jump as long as the overlap is below R (1 /
// cos g - 1) (3.5 % of R for the default).
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "libdem/geometry/mesh.hpp"

namespace dem {

enum class MeshFeature : std::uint8_t { face = 0, edge = 1, vertex = 2 };

struct MeshTouch {
  MeshFeature feature;
  std::uint32_t
      feature_id;       // triangle, unique edge or vertex number; (feature, feature_id) names the feature for history
  std::uint32_t facet;  // the touched triangle; for edges and vertices the smallest adjacent one
  Vec3 point;           // m, nearest point of the surface, body frame
  Vec3 normal;          // unit, from the sphere's centre to `point`
  double distance;      // m, centre to point
};

inline constexpr double default_merge_angle = 0.2617993877991494;  // rad, 15 degrees

class MeshContactFinder {
 public:
  // The mesh must have passed validate_mesh. `merge_angle` in rad; 0 keeps every minimum apart (but for rounding).
  explicit MeshContactFinder(TriangleMesh mesh, double merge_angle = default_merge_angle);
  ~MeshContactFinder();
  MeshContactFinder(MeshContactFinder&&) noexcept;
  MeshContactFinder& operator=(MeshContactFinder&&) noexcept;

  const TriangleMesh& mesh() const;

  // Triangles whose distance to `centre` is at most `reach` (a superset is allowed), ascending. Appends to `out`.
  void candidate_triangles(const Vec3& centre, double reach, std::vector<std::uint32_t>& out) const;

  // Those of `candidates` whose distance to `centre` is at most `reach` (a superset is allowed), in their order: written to `out`, which
  // has room for all. Returns how many.
  std::size_t triangles_within(const Vec3& centre, double reach, std::span<const std::uint32_t> candidates,
                               std::span<std::uint32_t> out) const;

  // Touches with distance <= reach among `candidates`, which must contain every triangle within `reach`, each once.
  // Sorted by (feature, feature_id). Clears `out` first. Safe to call from several threads; allocates only when `out`
  // must grow. Where features tie to within rounding, the face is taken before the edge before the vertex, then the
  // smaller number.
  void touches(const Vec3& centre, double reach, std::span<const std::uint32_t> candidates,
               std::vector<MeshTouch>& out) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace dem
