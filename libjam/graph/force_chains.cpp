#include "libjam/graph/force_chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "libjam/graph/components.hpp"
#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

Vec3 place(const ContactGraph& graph, Vertex v) { return graph.snapshot().particles.position[v].cast<double>(); }

std::vector<std::uint8_t> loaded(const std::vector<Load>& load, double level) {
  double sum = 0;
  std::size_t compressed = 0;
  for (const Load& l : load) {
    sum += l.pressure;
    compressed += l.pressure > 0;
  }
  std::vector<std::uint8_t> above(load.size(), 0);
  for (std::size_t v = 0; v < load.size(); ++v) above[v] = load[v].pressure * double(compressed) > level * sum;
  return above;
}

// Cosines of the angles between a contact's branch and the loads of its two particles, each seen from that particle: > 0 where the partner
// is ahead of it, < 0 behind.
std::array<double, 2> along(const ContactGraph& graph, const std::vector<Load>& load, const std::array<std::uint32_t, 2>& row) {
  const Vec3 branch = place(graph, row[1]) - place(graph, row[0]);
  const double length = branch.norm();
  return {branch.dot(load[row[0]].direction) / length, -branch.dot(load[row[1]].direction) / length};
}

// [C] 1 where a contact is a link of a chain.
std::vector<std::uint8_t> find_links(const ContactGraph& graph, const std::vector<Load>& load, const std::vector<std::uint8_t>& above,
                                     const ChainRules& rules) {
  const auto& rows = graph.snapshot().pp.row;
  const double least = std::cos(rules.angle);
  std::vector<std::uint8_t> link(rows.size(), 0);
  std::vector<std::array<double, 2>> cosine(rows.size());  // of links
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (!above[rows[c][0]] || !above[rows[c][1]]) continue;
    cosine[c] = along(graph, load, rows[c]);
    link[c] = std::abs(cosine[c][0]) >= least && std::abs(cosine[c][1]) >= least;
  }
  if (rules.branching) return link;

  // Each particle's best link ahead of it and behind.
  std::vector<std::array<std::uint32_t, 2>> best(graph.vertex_count(), {none, none});
  for (Vertex v = 0; v < graph.vertex_count(); ++v) {
    if (!above[v]) continue;
    std::array<double, 2> most{0, 0};
    for (const ContactGraph::Neighbor& n : graph.neighbors(v)) {  // ascending, so that ties go to the smaller row
      if (!link[n.contact]) continue;
      const double seen = cosine[n.contact][rows[n.contact][0] != v];
      const std::size_t side = seen < 0;
      if (!(std::abs(seen) > most[side])) continue;
      most[side] = std::abs(seen);
      best[v][side] = n.contact;
    }
  }
  const auto keeps = [&](Vertex v, std::uint32_t c) { return best[v][0] == c || best[v][1] == c; };
  for (std::uint32_t c = 0; c < rows.size(); ++c) link[c] = link[c] && keeps(rows[c][0], c) && keeps(rows[c][1], c);
  return link;
}

// The particles of a component of links in the order in which a line runs through them.
std::vector<Vertex> in_line(const ContactGraph& graph, const std::vector<std::uint8_t>& link, const std::vector<Vertex>& members) {
  struct Partners {
    std::array<Vertex, 2> vertex{none, none};
    std::size_t count = 0;
  };
  const auto linked = [&](Vertex v) {
    Partners partners;  // ascending; at most one ahead and one behind
    for (const ContactGraph::Neighbor& n : graph.neighbors(v))
      if (link[n.contact]) partners.vertex[partners.count++] = n.vertex;
    return partners;
  };
  Vertex at = members.front();
  for (const Vertex v : members)
    if (linked(v).count == 1) {
      at = v;
      break;
    }
  std::vector<Vertex> line{at};
  line.reserve(members.size());
  for (Vertex before = none; line.size() < members.size();) {
    const auto [first, second] = linked(at).vertex;
    const Vertex next = first != before ? first : second;
    before = std::exchange(at, next);
    line.push_back(at);
  }
  return line;
}

bool pressed_by(const ContactGraph& graph, Vertex v, WallRole role) {
  const auto contacts = graph.wall_contacts(v, role);
  return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t c) { return repulsive_force(graph.snapshot().pw, c) > 0; });
}

}  // namespace

std::vector<ForceChain> force_chains(const ContactGraph& graph, const std::vector<Load>& load, const ChainRules& rules) {
  const std::vector<std::uint8_t> above = loaded(load, rules.level), link = find_links(graph, load, above, rules);
  const Components components = connected_components(graph, above, link);
  // Largest first, so those that are long enough come first.
  const auto end = std::partition_point(components.size.begin(), components.size.end(), [&](std::uint32_t s) { return s >= rules.least; });
  std::vector<std::vector<Vertex>> members(std::size_t(end - components.size.begin()));
  for (Vertex v = 0; v < graph.vertex_count(); ++v)
    if (components.label[v] < members.size()) members[components.label[v]].push_back(v);

  std::vector<ForceChain> chains;
  for (std::size_t k = 0; k < members.size(); ++k) {
    ForceChain chain;
    chain.particles = rules.branching ? members[k] : in_line(graph, link, members[k]);
    for (const Vertex v : chain.particles) {
      chain.at_blade = chain.at_blade || pressed_by(graph, v, WallRole::blade);
      chain.at_vessel = chain.at_vessel || pressed_by(graph, v, WallRole::vessel);
      for (const ContactGraph::Neighbor& n : graph.neighbors(v))
        if (link[n.contact] && n.vertex > v) {
          ++chain.links;
          chain.contour += (place(graph, n.vertex) - place(graph, v)).norm();
        }
    }
    if (rules.branching) {
      for (std::size_t a = 0; a < chain.particles.size(); ++a)
        for (std::size_t b = a + 1; b < chain.particles.size(); ++b)
          chain.end_to_end =
              std::max(chain.end_to_end, (place(graph, chain.particles[a]) - place(graph, chain.particles[b])).norm());
    } else {
      chain.end_to_end = (place(graph, chain.particles.back()) - place(graph, chain.particles.front())).norm();
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace jam
