#include "libjam/graph/betweenness.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <random>

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;

// Particles under numbers that follow the network breadth first, so that partners lie near each other in memory.
struct Numbering {
  std::vector<Vertex> vertex;          // [N] by number
  std::vector<std::uint32_t> number;   // [N] by vertex
  std::vector<std::uint32_t> first;    // [N + 1] into `to` and `contact`
  std::vector<std::uint32_t> to;       // [2 C] numbers
  std::vector<std::uint32_t> contact;  // [2 C]

  explicit Numbering(const ContactGraph& graph) : number(graph.vertex_count(), std::numeric_limits<std::uint32_t>::max()) {
    const std::size_t n = graph.vertex_count();
    vertex.reserve(n);
    const auto give = [&](Vertex v) {
      if (number[v] != std::numeric_limits<std::uint32_t>::max()) return;
      number[v] = std::uint32_t(vertex.size());
      vertex.push_back(v);
    };
    for (Vertex start = 0; start < n; ++start) {
      const std::size_t begin = vertex.size();
      give(start);
      for (std::size_t k = begin; k < vertex.size(); ++k)
        for (const ContactGraph::Neighbor& neighbor : graph.neighbors(vertex[k])) give(neighbor.vertex);
    }
    first.reserve(n + 1);
    first.push_back(0);
    to.reserve(2 * graph.edge_count());
    contact.reserve(2 * graph.edge_count());
    for (const Vertex v : vertex) {
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
        to.push_back(number[neighbor.vertex]);
        contact.push_back(neighbor.contact);
      }
      first.push_back(std::uint32_t(to.size()));
    }
  }
  std::size_t size() const { return vertex.size(); }
};

constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();

// Shortest paths by length from one source after the other, and what hangs on them. After from(s), `order` holds the particles reached,
// nearest first, and dependency(v) the sum over the targets t of the share of the paths from s to t that lead through v.
class PathsByLength {
 public:
  PathsByLength(const Numbering& numbering, const std::vector<double>& wanted, std::span<const double> length)
      : net_(numbering), wanted_(wanted), length_(length), node_(net_.size()) {}

  std::vector<std::uint32_t> order;
  double dependency(std::uint32_t v) const { return node_[v].dependency; }

  // over(contact, share) for each contact on a path.
  template <class Over>
  void from(std::uint32_t source, Over over) {
    node_.assign(net_.size(), {});
    order.clear();
    walk(source);
    // From the farthest back: a particle hands to each of those before it its part of the paths that end at it or behind it.
    for (std::size_t k = order.size(); k-- > 0;) {
      const std::uint32_t u = order[k];
      const double each = (wanted_[u] + node_[u].dependency) / node_[u].paths;
      for (std::uint32_t e = net_.first[u]; e < net_.first[u + 1]; ++e) {
        const std::uint32_t v = net_.to[e], c = net_.contact[e];
        if (!leads(v, u, c)) continue;
        const double share = node_[v].paths * each;
        node_[v].dependency += share;
        over(c, share);
      }
    }
  }

 private:
  static constexpr double same = 1e-10;
  struct Node {
    double paths = 0, dependency = 0;
    double away = std::numeric_limits<double>::infinity();
    std::uint32_t rank = unreached;  // in `order`
  };

  bool walkable(std::uint32_t contact) const { return length_[contact] > 0 && std::isfinite(length_[contact]); }
  bool leads(std::uint32_t v, std::uint32_t u, std::uint32_t contact) const {
    return node_[v].rank < node_[u].rank && walkable(contact) &&
           std::abs(node_[v].away + length_[contact] - node_[u].away) <= same * node_[u].away;
  }

  void walk(std::uint32_t source) {
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    node_[source].away = 0;
    front.emplace(0.0, source);
    while (!front.empty()) {
      const std::uint32_t v = front.top().second;
      front.pop();
      if (node_[v].rank != unreached) continue;
      node_[v].rank = std::uint32_t(order.size());
      order.push_back(v);
      double paths = v == source;
      for (std::uint32_t e = net_.first[v]; e < net_.first[v + 1]; ++e) {
        const std::uint32_t u = net_.to[e], c = net_.contact[e];
        if (!walkable(c)) continue;
        if (leads(u, v, c)) paths += node_[u].paths;
        const double reach = node_[v].away + length_[c];
        if (node_[u].rank == unreached && reach < node_[u].away) {
          node_[u].away = reach;
          front.emplace(reach, u);
        }
      }
      node_[v].paths = paths;
    }
  }

  const Numbering& net_;
  const std::vector<double>& wanted_;
  std::span<const double> length_;
  std::vector<Node> node_;
};

// Eight searches side by side: what neighbouring sources see at a particle differs by few steps, so they walk most contacts together.
constexpr std::size_t lanes = 8;
using Lanes = std::array<double, lanes>;

// 1 in the lanes of a mask, 0 elsewhere.
constexpr auto ones = [] {
  std::array<Lanes, 256> table{};
  for (std::size_t mask = 0; mask < 256; ++mask)
    for (std::size_t k = 0; k < lanes; ++k) table[mask][k] = double(mask >> k & 1);
  return table;
}();

// The same for paths counted in contacts. After from(sources), `reached` holds the particles with the lanes that reach them.
class PathsByContacts {
 public:
  PathsByContacts(const Numbering& numbering, const std::vector<double>& wanted)
      : net_(numbering), wanted_(wanted), node_(net_.size()), seen_(net_.size(), 0), next_(net_.size(), 0) {}

  struct Reached {
    std::uint32_t vertex;
    std::uint8_t lanes;
  };
  std::span<const Reached> reached() const { return {list_.data() + level_[1], list_.data() + list_.size()}; }  // without the sources
  const Lanes& dependency(std::uint32_t v) const { return node_[v].dependency; }

  template <class Over>
  void from(std::span<const std::uint32_t> sources, Over over) {
    for (const Reached& r : list_) node_[r.vertex] = {}, seen_[r.vertex] = 0;
    list_.clear();
    level_.assign(1, 0);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      node_[sources[k]].paths[k] = 1;
      if (next_[sources[k]] == 0) list_.push_back({sources[k], 0});
      next_[sources[k]] = std::uint8_t(next_[sources[k]] | 1u << k);
    }
    take_level();
    while (level_.back() != list_.size()) walk_level();
    hand_back(over);
  }

 private:
  struct Node {
    Lanes paths{}, dependency{};
  };

  // The particles put on the list since the last level make the next one.
  void take_level() {
    for (std::size_t k = level_.back(); k < list_.size(); ++k) {
      Reached& r = list_[k];
      r.lanes = next_[r.vertex];
      seen_[r.vertex] |= r.lanes;
      next_[r.vertex] = 0;
    }
  }

  void walk_level() {
    const std::size_t first = level_.back(), last = list_.size();
    level_.push_back(last);
    for (std::size_t k = first; k < last; ++k) {
      const auto [v, in] = list_[k];
      for (std::uint32_t e = net_.first[v]; e < net_.first[v + 1]; ++e) {
        const std::uint32_t u = net_.to[e];
        const std::uint8_t new_lanes = in & std::uint8_t(~seen_[u]);
        if (new_lanes == 0) continue;
        if (next_[u] == 0) list_.push_back({u, 0});
        next_[u] |= new_lanes;
        for (std::size_t l = 0; l < lanes; ++l) node_[u].paths[l] += ones[new_lanes][l] * node_[v].paths[l];
      }
    }
    take_level();
  }

  template <class Over>
  void hand_back(Over over) {
    for (std::size_t level = level_.size(); level-- > 1;) {
      const std::size_t last = level + 1 < level_.size() ? level_[level + 1] : list_.size();
      for (std::size_t k = level_[level - 1]; k < level_[level]; ++k) next_[list_[k].vertex] = list_[k].lanes;
      for (std::size_t k = level_[level]; k < last; ++k) {
        const auto [u, in] = list_[k];
        Lanes each;
        for (std::size_t l = 0; l < lanes; ++l) {
          const double here = ones[in][l];
          each[l] = here * (wanted_[u] + node_[u].dependency[l]) / (node_[u].paths[l] + (1 - here));
        }
        for (std::uint32_t e = net_.first[u]; e < net_.first[u + 1]; ++e) {
          const std::uint32_t v = net_.to[e];
          const std::uint8_t before = next_[v] & in;
          if (before == 0) continue;
          Lanes share;
          for (std::size_t l = 0; l < lanes; ++l) share[l] = ones[before][l] * node_[v].paths[l] * each[l];
          for (std::size_t l = 0; l < lanes; ++l) node_[v].dependency[l] += share[l];
          over(net_.contact[e], share);
        }
      }
      for (std::size_t k = level_[level - 1]; k < level_[level]; ++k) next_[list_[k].vertex] = 0;
    }
  }

  const Numbering& net_;
  const std::vector<double>& wanted_;
  std::vector<Node> node_;
  std::vector<std::uint8_t> seen_, next_;  // lanes that have come to each particle; that come to it on the level at hand
  std::vector<Reached> list_;              // by level; a particle is on as many as its lanes take
  std::vector<std::size_t> level_;         // first of each level
};

double sum_of(const Lanes& values) {
  return ((values[0] + values[1]) + (values[2] + values[3])) + ((values[4] + values[5]) + (values[6] + values[7]));
}

// Sources in groups of as many as there are lanes, near each other in the network.
std::vector<std::vector<std::uint32_t>> groups_of(const Numbering& net, const std::vector<std::uint32_t>& sources) {
  std::vector<std::uint32_t> count(net.size(), 0);  // a sample may draw one twice
  for (const std::uint32_t s : sources) ++count[s];
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> front, visit(net.size(), unreached);
  for (std::uint32_t s = 0; s < net.size(); ++s) {
    while (count[s] > 0) {
      std::vector<std::uint32_t> group;
      const std::uint32_t number = std::uint32_t(groups.size());
      front.assign(1, s);
      visit[s] = number;
      // Not farther than a few hundred particles around the first.
      for (std::size_t k = 0; k < front.size() && front.size() < 512 && group.size() < lanes; ++k) {
        const std::uint32_t v = front[k];
        for (; count[v] > 0 && group.size() < lanes; --count[v]) group.push_back(v);
        for (std::uint32_t e = net.first[v]; e < net.first[v + 1]; ++e)
          if (visit[net.to[e]] != number) visit[net.to[e]] = number, front.push_back(net.to[e]);
      }
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

// f(portion, first, last) for portions of 0 .. count-1, the same for any number of threads, and how many there are.
constexpr std::size_t portions = 32;
template <class F>
void in_portions(std::size_t count, F f) {
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t p = 0; p < portions; ++p) f(p, p * count / portions, (p + 1) * count / portions);
}

std::vector<double> sum_of(const std::vector<std::vector<double>>& parts, std::size_t size) {
  std::vector<double> sum(size, 0.0);
  for (const std::vector<double>& part : parts)
    for (std::size_t k = 0; k < part.size(); ++k) sum[k] += part[k];
  return sum;
}

std::vector<double> by_vertex(const Numbering& net, const std::vector<double>& values) {
  std::vector<double> sorted(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) sorted[net.vertex[k]] = values[k];
  return sorted;
}

std::vector<Vertex> particles_at(const ContactGraph& graph, WallRole role) {
  std::vector<Vertex> touching;
  for (Vertex v = 0; v < graph.vertex_count(); ++v)
    if (!graph.wall_contacts(v, role).empty()) touching.push_back(v);
  return touching;
}

}  // namespace

Betweenness betweenness(const ContactGraph& graph, std::span<const Vertex> sources, std::span<const Vertex> targets,
                        std::span<const double> length) {
  const Numbering net(graph);
  std::vector<std::uint32_t> from;
  for (const Vertex s : sources) from.push_back(net.number[s]);
  std::vector<double> wanted(net.size(), 0.0);
  for (const Vertex t : targets) wanted[net.number[t]] = 1;
  std::vector<std::vector<double>> through(portions), over(portions);
  const auto groups = length.empty() ? groups_of(net, from) : std::vector<std::vector<std::uint32_t>>{};
  in_portions(length.empty() ? groups.size() : from.size(), [&](std::size_t p, std::size_t first, std::size_t last) {
    if (first == last) return;
    through[p].resize(net.size(), 0.0);
    over[p].resize(graph.edge_count(), 0.0);
    if (length.empty()) {
      PathsByContacts paths(net, wanted);
      for (std::size_t k = first; k < last; ++k) {
        paths.from(groups[k], [contacts = over[p].data()](std::uint32_t c, const Lanes& share) { contacts[c] += sum_of(share); });
        for (const auto& [v, in] : paths.reached())
          for (std::size_t l = 0; l < lanes; ++l) through[p][v] += ones[in][l] * paths.dependency(v)[l];
      }
    } else {
      PathsByLength paths(net, wanted, length);
      for (std::size_t k = first; k < last; ++k) {
        paths.from(from[k], [contacts = over[p].data()](std::uint32_t c, double share) { contacts[c] += share; });
        for (std::size_t r = 1; r < paths.order.size(); ++r) through[p][paths.order[r]] += paths.dependency(paths.order[r]);
      }
    }
  });
  return {by_vertex(net, sum_of(through, net.size())), sum_of(over, graph.edge_count())};
}

Betweenness betweenness(const ContactGraph& graph, std::span<const double> length) {
  std::vector<Vertex> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0u);
  Betweenness both_ways = betweenness(graph, all, all, length);
  for (double& value : both_ways.particle) value /= 2;
  for (double& value : both_ways.contact) value /= 2;
  return both_ways;
}

Betweenness bridge_betweenness(const ContactGraph& graph, std::span<const double> length) {
  return betweenness(graph, particles_at(graph, WallRole::blade), particles_at(graph, WallRole::vessel), length);
}

SampledBetweenness sampled_betweenness(const ContactGraph& graph, std::size_t samples, std::uint64_t seed, double confidence) {
  const Numbering net(graph);
  const std::size_t n = net.size();
  if (n < 3) return {std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::mt19937_64 random(seed);
  std::vector<std::uint32_t> sources(samples);
  // By remainder: distributions differ between standard libraries, and 2^64 is far above any number of particles.
  for (std::uint32_t& source : sources) source = std::uint32_t(random() % n);
  const std::vector<double> wanted(n, 1.0);
  const auto groups = groups_of(net, sources);
  std::vector<std::vector<double>> sums(portions), squares(portions);
  in_portions(groups.size(), [&](std::size_t p, std::size_t first, std::size_t last) {
    if (first == last) return;
    sums[p].resize(n, 0.0);
    squares[p].resize(n, 0.0);
    PathsByContacts paths(net, wanted);
    for (std::size_t k = first; k < last; ++k) {
      paths.from(groups[k], [](std::uint32_t, const Lanes&) {});
      for (const auto& [v, in] : paths.reached())
        for (std::size_t l = 0; l < lanes; ++l) {
          const double dependency = ones[in][l] * paths.dependency(v)[l];
          sums[p][v] += dependency;
          squares[p][v] += dependency * dependency;
        }
    }
  });
  SampledBetweenness found{by_vertex(net, sum_of(sums, n)), by_vertex(net, sum_of(squares, n))};
  const double count = double(samples), most = double(n - 2);  // one source's part of a particle is at most n - 2
  const double log_term = std::log(3 * double(n) / (1 - confidence));
  for (std::size_t v = 0; v < n; ++v) {
    const double mean = found.particle[v] / count, variance = std::max(found.error[v] / count - mean * mean, 0.0);
    found.particle[v] = double(n) / 2 * mean;
    found.error[v] = double(n) / 2 * (std::sqrt(2 * variance * log_term / count) + 3 * most * log_term / count);
  }
  return found;
}

}  // namespace jam
