#include "libjam/graph/persistence.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <span>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/triangles.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// The repulsive contacts from the strongest to the weakest. Among equal ones the order does not change the diagram.
struct Filtration {
  struct Entry {
    double force;
    Vertex a, b;
    std::uint32_t contact;
  };
  std::vector<Entry> contacts;
  std::vector<std::uint32_t> rank;   // [C] place of each contact, none for those that do not push
  std::vector<std::uint8_t> closes;  // 1 for a contact that closes a loop with those before it
  PersistenceDiagram components;

  explicit Filtration(const ContactGraph& graph) {
    const ParticleContacts& pp = graph.snapshot().pp;
    contacts.reserve(pp.size());
    for (std::uint32_t c = 0; c < pp.size(); ++c)
      if (const double force = repulsive_force(pp, c); force > 0) contacts.push_back({force, pp.row[c][0], pp.row[c][1], c});
    std::stable_sort(contacts.begin(), contacts.end(), [](const Entry& x, const Entry& y) { return x.force > y.force; });
    rank.assign(pp.size(), none);
    for (std::uint32_t r = 0; r < contacts.size(); ++r) rank[contacts[r].contact] = r;

    // A particle comes in with the first of its contacts.
    std::vector<Vertex> parent(graph.vertex_count());
    std::iota(parent.begin(), parent.end(), 0u);
    std::vector<double> birth(graph.vertex_count(), 0.0);
    const auto root = [&](Vertex v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    closes.reserve(contacts.size());
    for (const auto& [force, a, b, contact] : contacts) {
      if (birth[a] == 0) birth[a] = force;
      if (birth[b] == 0) birth[b] = force;
      Vertex older = root(a), younger = root(b);
      closes.push_back(older == younger);
      if (older == younger) continue;
      if (birth[older] < birth[younger]) std::swap(older, younger);
      if (birth[younger] > force) components.push_back({birth[younger], force});
      parent[younger] = older;
    }
    for (Vertex v = 0; v < parent.size(); ++v)
      if (parent[v] == v && birth[v] > 0) components.push_back({birth[v], 0});
    std::sort(components.begin(), components.end(), std::greater<>());
  }
};

// Ranks of the three contacts of a triangle, the last to enter first.
using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles_of(const ContactGraph& graph, const Filtration& filtration) {
  std::vector<Triangle> triangles;
  for_each_triangle(graph, [&](const ContactTriangle& t) {
    Triangle ranks;
    for (std::size_t k = 0; k < 3; ++k) ranks[k] = filtration.rank[t.contact[k]];
    std::sort(ranks.begin(), ranks.end(), std::greater<>());
    if (ranks[0] != none) triangles.push_back(ranks);
  });
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Columns of contacts' ranks, descending, over the field of two elements.
void add_to(std::vector<std::uint32_t>& column, std::span<const std::uint32_t> other, std::vector<std::uint32_t>& scratch) {
  scratch.clear();
  std::set_symmetric_difference(column.begin(), column.end(), other.begin(), other.end(), std::back_inserter(scratch), std::greater<>());
  column.swap(scratch);
}

}  // namespace

PersistenceDiagram persistence_of_components(const ContactGraph& graph) {
  return Filtration(graph).components;
}

PersistenceDiagram persistence_of_loops(const ContactGraph& graph) {
  const Filtration filtration(graph);
  PersistenceDiagram loops;
  for (std::size_t rank = 0; rank < filtration.contacts.size(); ++rank)
    if (filtration.closes[rank]) loops.push_back({filtration.contacts[rank].force, 0});
  return loops;
}

PersistenceDiagram persistence_of_loops_not_filled(const ContactGraph& graph) {
  const Filtration filtration(graph);
  const auto& contacts = filtration.contacts;
  const std::vector<Triangle> triangles = triangles_of(graph, filtration);
  // For each contact the column whose last contact it is: a triangle as it came, or one that had to be reduced.
  std::vector<std::uint32_t> triangle_at(contacts.size(), none), reduced_at(contacts.size(), none);
  std::vector<std::vector<std::uint32_t>> reduced;
  std::vector<double> death(contacts.size(), 0.0);
  std::vector<std::uint32_t> column, scratch;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t weakest = triangles[t][0];
    if (triangle_at[weakest] == none && reduced_at[weakest] == none) {
      triangle_at[weakest] = t;  // fills the loop in the moment in which its weakest contact closes it
      death[weakest] = contacts[weakest].force;
      continue;
    }
    column.assign(triangles[t].begin(), triangles[t].end());
    while (!column.empty()) {
      const std::uint32_t last = column.front();
      if (triangle_at[last] != none) {
        add_to(column, triangles[triangle_at[last]], scratch);
      } else if (reduced_at[last] != none) {
        add_to(column, reduced[reduced_at[last]], scratch);
      } else {
        reduced_at[last] = std::uint32_t(reduced.size());
        reduced.push_back(column);
        death[last] = contacts[weakest].force;
        break;
      }
    }
  }
  PersistenceDiagram loops;
  for (std::size_t rank = 0; rank < contacts.size(); ++rank)
    if (filtration.closes[rank] && contacts[rank].force > death[rank]) loops.push_back({contacts[rank].force, death[rank]});
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
