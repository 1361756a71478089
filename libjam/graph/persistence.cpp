#include "libjam/graph/persistence.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>

#include "libjam/graph/disjoint_sets.hpp"
#include "libjam/graph/modulo_two.hpp"
#include "libjam/graph/triangles.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// The network built up contact by contact.
struct Filtration {
  std::vector<std::uint8_t> closes;  // 1 for a contact that closes a loop with those before it
  PersistenceDiagram components;

  Filtration(const ContactGraph& graph, const RankedContacts& ranked) {
    // A particle comes in with the first of its contacts.
    DisjointSets parts(graph.vertex_count());
    std::vector<double> birth(graph.vertex_count(), 0.0);  // of each part, at the particle that stands for it
    closes.reserve(ranked.size());
    for (const auto& [force, a, b, contact] : ranked) {
      if (birth[a] == 0) birth[a] = force;
      if (birth[b] == 0) birth[b] = force;
      const Vertex one = parts.of(a), other = parts.of(b);
      closes.push_back(one == other);
      if (one == other) continue;
      const auto [younger, older] = std::minmax({birth[one], birth[other]});
      if (younger > force) components.push_back({younger, force});
      parts.join(one, other);
      birth[parts.of(one)] = older;
    }
    for (Vertex v = 0; v < birth.size(); ++v)
      if (parts.of(v) == v && birth[v] > 0) components.push_back({birth[v], 0});
    std::sort(components.begin(), components.end(), std::greater<>());
  }
};

// Ranks of the three contacts of a triangle, the last to enter first.
using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles_of(const ContactGraph& graph, const RankedContacts& ranked) {
  std::vector<std::uint32_t> rank(graph.edge_count(), none);
  for (std::uint32_t r = 0; r < ranked.size(); ++r) rank[ranked[r].contact] = r;
  std::vector<Triangle> triangles;
  for_each_triangle(graph, [&](const ContactTriangle& t) {
    Triangle ranks;
    for (std::size_t k = 0; k < 3; ++k) ranks[k] = rank[t.contact[k]];
    std::sort(ranks.begin(), ranks.end(), std::greater<>());
    if (ranks[0] != none) triangles.push_back(ranks);
  });
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

PersistenceDiagram persistence_of_components(const ContactGraph& graph, const RankedContacts& ranked) {
  return Filtration(graph, ranked).components;
}

PersistenceDiagram persistence_of_loops(const ContactGraph& graph, const RankedContacts& ranked) {
  const Filtration filtration(graph, ranked);
  PersistenceDiagram loops;
  for (std::size_t rank = 0; rank < ranked.size(); ++rank)
    if (filtration.closes[rank]) loops.push_back({ranked[rank].force, 0});
  return loops;
}

PersistenceDiagram persistence_of_loops_not_filled(const ContactGraph& graph, const RankedContacts& ranked) {
  const Filtration filtration(graph, ranked);
  const std::vector<Triangle> triangles = triangles_of(graph, ranked);
  // For each contact the column whose last contact it is: a triangle as it came, or one that had to be reduced.
  std::vector<std::uint32_t> triangle_at(ranked.size(), none), reduced_at(ranked.size(), none);
  std::vector<std::vector<std::uint32_t>> reduced;
  std::vector<double> death(ranked.size(), 0.0);
  std::vector<std::uint32_t> column, scratch;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t weakest = triangles[t][0];
    if (triangle_at[weakest] == none && reduced_at[weakest] == none) {
      triangle_at[weakest] = t;  // fills the loop in the moment in which its weakest contact closes it
      death[weakest] = ranked[weakest].force;
      continue;
    }
    column.assign(triangles[t].begin(), triangles[t].end());
    while (!column.empty()) {
      const std::uint32_t last = column.front();
      if (triangle_at[last] != none) {
        add_modulo_two(column, triangles[triangle_at[last]], scratch);
      } else if (reduced_at[last] != none) {
        add_modulo_two(column, reduced[reduced_at[last]], scratch);
      } else {
        reduced_at[last] = std::uint32_t(reduced.size());
        reduced.push_back(column);
        death[last] = ranked[weakest].force;
        break;
      }
    }
  }
  PersistenceDiagram loops;
  for (std::size_t rank = 0; rank < ranked.size(); ++rank)
    if (filtration.closes[rank] && ranked[rank].force > death[rank]) loops.push_back({ranked[rank].force, death[rank]});
  std::sort(loops.begin(), loops.end(), std::greater<>());
  return loops;
}

std::size_t betti_number(const PersistenceDiagram& diagram, double force) {
  return std::size_t(std::count_if(diagram.begin(), diagram.end(), [&](const PersistencePair& p) { return p.birth >= force && p.death < force; }));
}

double total_persistence(const PersistenceDiagram& diagram) {
  double sum = 0;
  for (const PersistencePair& pair : diagram) sum += pair.persistence();
  return sum;
}

}  // namespace jam
