#include "libjam/graph/widest_path.hpp"

#include <algorithm>
#include <limits>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/disjoint_sets.hpp"

namespace jam {
namespace {

constexpr ContactGraph::Vertex nobody = std::numeric_limits<ContactGraph::Vertex>::max();

// N, on the particle by walls of a role: its strongest contact.
double strongest(const ContactGraph& graph, ContactGraph::Vertex v, WallRole role) {
  double most = 0;
  for (const std::uint32_t c : graph.wall_contacts(v, role)) most = std::max(most, repulsive_force(graph.snapshot().pw, c));
  return most;
}

// Sets of particles, and which of the two ends each reaches.
class Sets {
 public:
  explicit Sets(std::size_t n) : sets_(n), ends_(n, 0) {}
  // Do these now reach both ends?
  bool reach(std::uint32_t v, std::uint8_t end) { return (ends_[sets_.of(v)] |= end) == both; }
  bool join(std::uint32_t a, std::uint32_t b) {
    const std::uint8_t ends = ends_[sets_.of(a)] | ends_[sets_.of(b)];
    sets_.join(a, b);
    return (ends_[sets_.of(a)] = ends) == both;
  }
  static constexpr std::uint8_t blade = 1, vessel = 2, both = 3;

 private:
  DisjointSets sets_;
  std::vector<std::uint8_t> ends_;  // of each set, at the particle that stands for it
};

// A contact with an end.
struct EndContact {
  double force;
  ContactGraph::Vertex particle;
  std::uint8_t end;
};

// N, at which blade and vessel come together.
double strength(const ContactGraph& graph, const RankedContacts& ranked) {
  std::vector<EndContact> ends;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    if (const double force = strongest(graph, v, WallRole::blade); force > 0) ends.push_back({force, v, Sets::blade});
    if (const double force = strongest(graph, v, WallRole::vessel); force > 0) ends.push_back({force, v, Sets::vessel});
  }
  std::sort(ends.begin(), ends.end(), [](const EndContact& x, const EndContact& y) { return x.force > y.force; });
  Sets sets(graph.vertex_count());
  auto contact = ranked.begin();
  auto end = ends.begin();
  while (end != ends.end() || contact != ranked.end()) {
    if (end == ends.end() || (contact != ranked.end() && contact->force >= end->force)) {
      if (sets.join(contact->a, contact->b)) return contact->force;
      ++contact;
    } else {
      if (sets.reach(end->particle, end->end)) return end->force;
      ++end;
    }
  }
  return 0;
}

}  // namespace

WidestPath widest_path(const ContactGraph& graph, const RankedContacts& ranked) {
  WidestPath path;
  path.strength = strength(graph, ranked);
  if (path.strength == 0) return path;
  // Breadth first over the contacts that are as strong, from the blade; partners come in ascending order.
  std::vector<ContactGraph::Vertex> before(graph.vertex_count(), nobody), front;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (strongest(graph, v, WallRole::blade) >= path.strength) {
      before[v] = v;
      front.push_back(v);
    }
  for (std::size_t k = 0; k < front.size(); ++k) {
    ContactGraph::Vertex v = front[k];
    if (strongest(graph, v, WallRole::vessel) >= path.strength) {
      for (; before[v] != v; v = before[v]) path.particles.push_back(v);
      path.particles.push_back(v);
      std::reverse(path.particles.begin(), path.particles.end());
      break;
    }
    for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
      if (before[neighbor.vertex] != nobody || repulsive_force(graph.snapshot().pp, neighbor.contact) < path.strength) continue;
      before[neighbor.vertex] = v;
      front.push_back(neighbor.vertex);
    }
  }
  return path;
}

}  // namespace jam
