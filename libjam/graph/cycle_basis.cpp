#include "libjam/graph/cycle_basis.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>

#include "libjam/graph/modulo_two.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
using Cycle = std::vector<std::uint32_t>;  // contacts, descending
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Cycles of shortest paths from one particle after the other.
class Horton {
 public:
  explicit Horton(const ContactGraph& graph) : graph_(graph), at_(graph.vertex_count()) {}

  // found(cycle) for each cycle of up to `longest` contacts through `root` and a contact that leads from one shortest path from it to another.
  template <class Found>
  void cycles_through(Vertex root, std::size_t longest, Found found) {
    order_.assign(1, root);
    at_[root] = {0, none, none};
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const Vertex v = order_[k];
      const Place place = at_[v];
      if (2 * std::size_t{place.away} >= longest) break;  // no cycle reaches farther
      for (const ContactGraph::Neighbor& n : graph_.neighbors(v)) {
        if (at_[n.vertex].away != none) continue;
        at_[n.vertex] = {place.away + 1, n.contact, k == 0 ? n.vertex : place.branch};
        order_.push_back(n.vertex);
      }
    }
    for (const Vertex x : order_)
      for (const ContactGraph::Neighbor& n : graph_.neighbors(x)) {
        const Vertex y = n.vertex;
        if (y < x || x == root || y == root || at_[y].away == none || at_[x].branch == at_[y].branch) continue;
        if (std::size_t{at_[x].away} + at_[y].away + 1 > longest) continue;
        cycle_.assign(1, n.contact);
        add_path(x, root);
        add_path(y, root);
        std::sort(cycle_.begin(), cycle_.end(), std::greater<>());
        found(cycle_);
      }
    for (const Vertex v : order_) at_[v] = {};
  }

 private:
  struct Place {
    std::uint32_t away = none;
    std::uint32_t contact = none;  // by which the search came
    Vertex branch = none;          // the partner of the root that the path leads through
  };

  void add_path(Vertex v, Vertex root) {
    while (v != root) {
      const std::uint32_t contact = at_[v].contact;
      cycle_.push_back(contact);
      const auto [a, b] = graph_.snapshot().pp.row[contact];
      v = a == v ? b : a;
    }
  }

  const ContactGraph& graph_;
  std::vector<Place> at_;
  std::vector<Vertex> order_;
  Cycle cycle_;
};

}  // namespace

std::vector<std::size_t> basis_cycle_counts(const ContactGraph& graph, std::size_t longest) {
  std::vector<std::vector<Cycle>> by_length(longest + 1);
  Horton horton(graph);
  for (Vertex v = 0; v < graph.vertex_count(); ++v)
    horton.cycles_through(v, longest, [&](const Cycle& cycle) { by_length[cycle.size()].push_back(cycle); });

  std::vector<std::size_t> count(longest + 1, 0);
  std::vector<Cycle> owner(graph.edge_count());  // of each contact: the reduced cycle of which it is the first
  Cycle rest, scratch;
  for (std::size_t length = 3; length <= longest; ++length) {
    std::vector<Cycle>& cycles = by_length[length];
    std::sort(cycles.begin(), cycles.end());
    cycles.erase(std::unique(cycles.begin(), cycles.end()), cycles.end());
    for (const Cycle& cycle : cycles) {
      rest = cycle;
      while (!rest.empty() && !owner[rest.front()].empty()) add_modulo_two(rest, owner[rest.front()], scratch);
      if (rest.empty()) continue;
      ++count[length];
      owner[rest.front()] = rest;
    }
  }
  return count;
}

}  // namespace jam
