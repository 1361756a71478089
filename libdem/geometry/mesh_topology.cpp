#include "libdem/geometry/mesh_topology.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "libdem/errors.hpp"

namespace dem {

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint8_t side = 0; side < 3; ++side) {
      const std::uint32_t from = mesh.triangles[f][side], to = mesh.triangles[f][(side + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), f, side, from < to});
    }
  std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::tuple(e.low, e.high, e.facet, e.side); });
  return edges;
}

std::vector<MeshEdge> unique_edges(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> half = sorted_half_edges(mesh);
  std::vector<MeshEdge> edges;
  edges.reserve(half.size() / 2);
  for (std::size_t first = 0, last = 0; first < half.size(); first = last) {
    const HalfEdge& e = half[first];
    while (last < half.size() && half[last].low == e.low && half[last].high == e.high) ++last;
    if (last - first != 2)
      throw GeometryError("mesh: the edge between vertices " + std::to_string(e.low) + " and " +
                          std::to_string(e.high) + " belongs to " + std::to_string(last - first) +
                          " triangles; in a closed surface each edge belongs to exactly two");
    edges.push_back({{e.low, e.high}, {e.facet, half[first + 1].facet}, {e.side, half[first + 1].side}});
  }
  return edges;
}

}  // namespace dem
