#include "libdem/geometry/mesh_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "libdem/geometry/mesh_topology.hpp"
#include "libdem/geometry/mesh_tree.hpp"
#include "libdem/particles/ask_memory.hpp"

namespace dem {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Features that tie are told apart by quantities that carry rounding errors of about 1e-16 of the coordinates.
// Everything within this much larger fraction of them is accepted by every feature that ties, so that no touch falls
// between two features, and the copies, whose normals agree, are merged.
constexpr double tie_fraction = 1e-12;
constexpr double smallest_merge_angle = 1e-6;  // rad

struct alignas(64) Face {
  Vec3 corner, normal;
  std::array<Vec3, 3> inward;  // unit, in the plane, perpendicular to side k, from side k into the triangle
  double side1_offset;         // (corner 1 - corner 0) . inward[1]; sides 0 and 2 pass through corner 0
  // The edges and vertices that are tested with this face: each once, with the smallest of its faces.
  std::array<std::uint32_t, 3> edges, vertices;

  // m, to the line of each side, < 0 beyond it.
  std::array<double, 3> side_distances(const Vec3& from_corner) const {
    return {inward[0].dot(from_corner), inward[1].dot(from_corner) - side1_offset, inward[2].dot(from_corner)};
  }
  // m^2; beyond a side the triangle is at least as far in its plane as the side's line is.
  double squared_distance_at_least(const Vec3& x) const {
    const Vec3 from_corner = x - corner;
    const double height = normal.dot(from_corner), aside = std::min(std::ranges::min(side_distances(from_corner)), 0.0);
    return height * height + aside * aside;
  }
};

struct Edge {
  Vec3 start, direction;
  double length;
  std::array<Vec3, 2> inward;  // of its two faces, see Face
  Vec3 outward;                // sum of its faces' normals
};

struct Vertex {
  Vec3 outward;  // angle-weighted sum of its faces' normals: tells inside from outside (Baerentzen, Aanaes 2005)
  std::uint32_t first, last;  // its range in `directions`
  std::uint32_t facet;
};

}  // namespace

struct MeshContactFinder::Impl {
  TriangleMesh mesh;
  MeshTree tree;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  std::vector<Vec3> directions;  // unit, along the edges that leave a vertex
  double tie = 0;                // m
  // m. Over what lies further than this from all sides of a face none of its vertices is touched: of the unit vectors along its two sides
  // there one has a product with the way x from the vertex of at least |x|^2 over twice the longest side, which is more than a tie.
  double well_inside = 0;
  double merge_cosine = 1;

  Impl(TriangleMesh m, double merge_angle) : mesh(std::move(m)), tree(mesh) {
    merge_cosine = std::cos(std::max(merge_angle, smallest_merge_angle));
    for (const Vec3& p : mesh.vertices) tie = std::max(tie, tie_fraction * p.cwiseAbs().maxCoeff());
    build_faces();
    build_edges();
    double longest = 0;
    for (const Edge& edge : edges) longest = std::max(longest, edge.length);
    well_inside = 2 * std::sqrt(2 * longest * tie) + 2 * tie;
    build_vertices();
  }

  const Vec3& corner(std::uint32_t f, std::size_t k) const { return mesh.vertices[mesh.triangles[f][k % 3]]; }

  void build_faces() {
    faces.resize(mesh.triangles.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      Face& face = faces[f];
      face.corner = corner(f, 0);
      face.normal = (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).normalized();
      for (std::size_t k = 0; k < 3; ++k)
        face.inward[k] = face.normal.cross(corner(f, k + 1) - corner(f, k)).normalized();
      face.side1_offset = (corner(f, 1) - corner(f, 0)).dot(face.inward[1]);
      face.edges.fill(none);
      face.vertices.fill(none);
    }
  }

  void build_edges() {
    const std::vector<MeshEdge> unique = unique_edges(mesh);
    edges.resize(unique.size());
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      const MeshEdge& u = unique[e];
      const Face &a = faces[u.facets[0]], &b = faces[u.facets[1]];
      const Vec3 along = mesh.vertices[u.vertices[1]] - mesh.vertices[u.vertices[0]];
      edges[e] = {mesh.vertices[u.vertices[0]],
                  along.normalized(),
                  along.norm(),
                  {a.inward[u.sides[0]], b.inward[u.sides[1]]},
                  a.normal + b.normal};
      // A centre in front of a flat or concave edge never has the edge as an isolated minimum: one of the faces is at
      // least as near.
      const bool convex = edges[e].inward[1].dot(a.normal) < 0;
      if (convex) faces[u.facets[0]].edges[u.sides[0]] = e;
    }
  }

  void build_vertices() {
    std::vector<std::array<std::uint32_t, 2>>
        incident;  // (vertex, the vertex at the other end of a side that leaves it)
    vertices.assign(mesh.vertices.size(), {Vec3::Zero(), 0, 0, none});
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[f][k];
        const Vec3 next = corner(f, k + 1) - corner(f, k), previous = corner(f, k + 2) - corner(f, k);
        vertices[v].outward += std::atan2(next.cross(previous).norm(), next.dot(previous)) * faces[f].normal;
        if (vertices[v].facet == none) {
          vertices[v].facet = f;
          faces[f].vertices[k] = v;
        }
        // On a closed surface every edge at v leaves it in exactly one of its triangles.
        incident.push_back({v, mesh.triangles[f][(k + 1) % 3]});
      }
    std::ranges::sort(incident);
    for (const auto& [v, other] : incident) {
      if (vertices[v].last == 0) vertices[v].first = static_cast<std::uint32_t>(directions.size());
      directions.push_back((mesh.vertices[other] - mesh.vertices[v]).normalized());
      vertices[v].last = static_cast<std::uint32_t>(directions.size());
    }
  }

  void touch_face(std::uint32_t f, const Vec3& centre, double height, std::vector<MeshTouch>& out) const {
    const Vec3& normal = faces[f].normal;
    out.push_back({MeshFeature::face, f, f, centre - height * normal, -normal, height});
  }

  static Vec3 unit_to(const Vec3& from_surface, double distance, const Vec3& outward) {
    return distance > 0 ? Vec3(from_surface / -distance) : Vec3(-outward.normalized());
  }

  void touch_edge(std::uint32_t e, std::uint32_t facet, const Vec3& centre, double reach,
                  std::vector<MeshTouch>& out) const {
    const Edge& edge = edges[e];
    const Vec3 from_start = centre - edge.start;
    const double along = edge.direction.dot(from_start);
    if (along < -tie || along > edge.length + tie) return;
    if (edge.inward[0].dot(from_start) > tie || edge.inward[1].dot(from_start) > tie) return;
    const Vec3 from_edge = from_start - along * edge.direction;
    const double squared = from_edge.squaredNorm();
    if (squared > reach * reach || edge.outward.dot(from_edge) < 0) return;
    const double distance = std::sqrt(squared);
    out.push_back({MeshFeature::edge, e, facet, edge.start + along * edge.direction,
                   unit_to(from_edge, distance, edge.outward), distance});
  }

  void touch_vertex(std::uint32_t v, const Vec3& centre, double reach, std::vector<MeshTouch>& out) const {
    const Vertex& vertex = vertices[v];
    const Vec3 from_vertex = centre - mesh.vertices[v];
    const double squared = from_vertex.squaredNorm();
    if (squared > reach * reach || vertex.outward.dot(from_vertex) < 0) return;
    for (std::uint32_t d = vertex.first; d < vertex.last; ++d)
      if (directions[d].dot(from_vertex) > tie) return;
    const double distance = std::sqrt(squared);
    out.push_back({MeshFeature::vertex, v, vertex.facet, mesh.vertices[v],
                   unit_to(from_vertex, distance, vertex.outward), distance});
  }

  // Edges and vertices that are still to be tested: they are asked of memory when they are found, and tested when all are.
  class ToTest {
   public:
    ToTest(const Impl& mesh, const Vec3& centre, double reach, std::vector<MeshTouch>& out)
        : mesh_(mesh), centre_(centre), reach_(reach), out_(out) {}
    void edge(std::uint32_t e, std::uint32_t facet) {
      ask_memory_for(mesh_.edges[e]);
      add({e, facet});
    }
    void vertex(std::uint32_t v) {
      ask_memory_for(mesh_.vertices[v]);
      ask_memory_for(mesh_.mesh.vertices[v]);
      add({v, none});
    }
    void test() {
      for (std::size_t k = 0; k < count_; ++k)
        if (const auto [id, facet] = found_[k]; facet == none)
          mesh_.touch_vertex(id, centre_, reach_, out_);
        else
          mesh_.touch_edge(id, facet, centre_, reach_, out_);
      count_ = 0;
    }

   private:
    struct Found {
      std::uint32_t id, facet;  // of a vertex none
    };
    void add(const Found& found) {
      found_[count_++] = found;
      if (count_ == found_.size()) test();
    }
    const Impl& mesh_;
    const Vec3& centre_;
    double reach_;
    std::vector<MeshTouch>& out_;
    std::array<Found, 32> found_;
    std::size_t count_ = 0;
  };

  // Keeps, nearest first, each touch whose normal is not within the merge angle of one kept before.
  void merge(std::vector<MeshTouch>& out) const {
    const auto nearness = [this](const MeshTouch& t) {
      return std::tuple(t.distance + tie * static_cast<int>(t.feature), t.feature, t.feature_id);
    };
    std::ranges::sort(out, {}, nearness);
    auto kept = out.begin();
    for (const MeshTouch& t : out) {
      const bool same =
          std::any_of(out.begin(), kept, [&](const MeshTouch& k) { return k.normal.dot(t.normal) > merge_cosine; });
      if (!same) *kept++ = t;
    }
    out.erase(kept, out.end());
    std::ranges::sort(out, {}, [](const MeshTouch& t) { return std::tuple(t.feature, t.feature_id); });
  }
};

MeshContactFinder::MeshContactFinder(TriangleMesh mesh, double merge_angle)
    : impl_(std::make_unique<const Impl>(std::move(mesh), merge_angle)) {}
MeshContactFinder::~MeshContactFinder() = default;
MeshContactFinder::MeshContactFinder(MeshContactFinder&&) noexcept = default;
MeshContactFinder& MeshContactFinder::operator=(MeshContactFinder&&) noexcept = default;

const TriangleMesh& MeshContactFinder::mesh() const {
  return impl_->mesh;
}

void MeshContactFinder::candidate_triangles(const Vec3& centre, double reach, std::vector<std::uint32_t>& out) const {
  const double margin = reach * (1 + 1e-9) + impl_->tie;
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  impl_->tree.triangles_in_box(centre.array() - margin, centre.array() + margin, out);
  // The box holds slanted triangles that the sphere cannot touch.
  const auto beyond = [&](std::uint32_t f) { return impl_->faces[f].squared_distance_at_least(centre) > margin * margin; };
  out.erase(std::remove_if(out.begin() + first, out.end(), beyond), out.end());
  std::sort(out.begin() + first, out.end());
}

std::size_t MeshContactFinder::triangles_within(const Vec3& centre, double reach, std::span<const std::uint32_t> candidates,
                                                std::span<std::uint32_t> out) const {
  const double margin = reach * (1 + 1e-9) + impl_->tie;
  std::size_t count = 0;
  for (const std::uint32_t f : candidates)
    if (impl_->faces[f].squared_distance_at_least(centre) <= margin * margin) out[count++] = f;
  return count;
}

void MeshContactFinder::touches(const Vec3& centre, double reach, std::span<const std::uint32_t> candidates,
                                std::vector<MeshTouch>& out) const {
  out.clear();
  const double tie = impl_->tie;
  for (const std::uint32_t f : candidates) ask_memory_for(impl_->faces[f]);
  Impl::ToTest features(*impl_, centre, reach, out);
  for (const std::uint32_t f : candidates) {
    const Face& face = impl_->faces[f];
    const Vec3 r = centre - face.corner;
    const double height = face.normal.dot(r);
    if (std::abs(height) > reach) continue;
    const std::array<double, 3> side = face.side_distances(r);
    const double nearest_side = std::ranges::min(side);
    if (nearest_side < -reach) continue;
    if (height >= 0 && nearest_side >= -tie) impl_->touch_face(f, centre, height, out);
    if (nearest_side > impl_->well_inside) continue;
    // What is out of reach of a side's line, or this side of it, need not be loaded.
    const double far = reach * reach * (1 + 1e-9) - height * height;
    for (std::size_t k = 0; k < 3; ++k) {
      if (side[k] * side[k] > far) continue;
      if (face.edges[k] != none && side[k] <= 2 * tie) features.edge(face.edges[k], f);
      const double before = side[(k + 2) % 3];  // the other side at corner k
      if (face.vertices[k] != none && before * before <= far) features.vertex(face.vertices[k]);
    }
  }
  features.test();
  if (out.size() > 1) impl_->merge(out);
}

}  // namespace dem
