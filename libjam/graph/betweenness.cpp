#include "libjam/graph/betweenness.hpp"

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

// The shortest paths from one source after the other, and what hangs on them. After from(s), `order` holds the particles reached, nearest
// first, and `dependency` for each the sum over the targets t of the share of the paths from s to t that lead through it.
class Paths {
 public:
  Paths(const Numbering& numbering, const std::vector<double>& wanted, std::span<const double> length)
      : net_(numbering), wanted_(wanted), length_(length), node_(net_.size()), far_(net_.size(), unreached) {
    order.reserve(net_.size());
  }

  std::vector<std::uint32_t> order;
  double dependency(std::uint32_t v) const { return node_[v].dependency; }

  // over(contact, share) for each contact on a path.
  template <class Over>
  void from(std::uint32_t source, Over over) {
    for (const std::uint32_t v : order) node_[v] = {}, far_[v] = unreached;
    order.clear();
    if (length_.empty()) {
      walk(source);
      hand_back([&](std::uint32_t u, std::uint32_t v, std::uint32_t) { return far_[v] + 1 == far_[u]; }, over);
    } else {
      walk_by_length(source);
      hand_back([&](std::uint32_t u, std::uint32_t v, std::uint32_t c) { return leads(v, u, c); }, over);
    }
  }

 private:
  static constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max() - 1;
  static constexpr double same = 1e-10;
  struct Node {
    double paths = 0, dependency = 0;
  };

  void walk(std::uint32_t source) {
    order.push_back(source);
    far_[source] = 0;
    node_[source].paths = 1;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::uint32_t v = order[k], next = far_[v] + 1;
      const double paths = node_[v].paths;
      for (std::uint32_t e = net_.first[v]; e < net_.first[v + 1]; ++e) {
        const std::uint32_t u = net_.to[e];
        if (far_[u] == unreached) {
          far_[u] = next;
          order.push_back(u);
        }
        if (far_[u] == next) node_[u].paths += paths;
      }
    }
  }

  bool walkable(std::uint32_t contact) const { return length_[contact] > 0 && std::isfinite(length_[contact]); }
  // far_ is the rank in `order` here.
  bool leads(std::uint32_t v, std::uint32_t u, std::uint32_t contact) const {
    return far_[v] < far_[u] && walkable(contact) && std::abs(away_[v] + length_[contact] - away_[u]) <= same * away_[u];
  }

  void walk_by_length(std::uint32_t source) {
    away_.assign(net_.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    away_[source] = 0;
    front.emplace(0.0, source);
    while (!front.empty()) {
      const std::uint32_t v = front.top().second;
      front.pop();
      if (far_[v] != unreached) continue;
      far_[v] = std::uint32_t(order.size());
      order.push_back(v);
      double paths = v == source;
      for (std::uint32_t e = net_.first[v]; e < net_.first[v + 1]; ++e) {
        const std::uint32_t u = net_.to[e], c = net_.contact[e];
        if (!walkable(c)) continue;
        if (leads(u, v, c)) paths += node_[u].paths;
        const double reach = away_[v] + length_[c];
        if (far_[u] == unreached && reach < away_[u]) {
          away_[u] = reach;
          front.emplace(reach, u);
        }
      }
      node_[v].paths = paths;
    }
  }

  // From the farthest back: a particle hands to each of those before it its part of the paths that end at it or behind it.
  template <class Before, class Over>
  void hand_back(Before before, Over over) {
    for (std::size_t k = order.size(); k-- > 0;) {
      const std::uint32_t u = order[k];
      const double each = (wanted_[u] + node_[u].dependency) / node_[u].paths;
      for (std::uint32_t e = net_.first[u]; e < net_.first[u + 1]; ++e) {
        const std::uint32_t v = net_.to[e], c = net_.contact[e];
        if (!before(u, v, c)) continue;
        const double share = node_[v].paths * each;
        node_[v].dependency += share;
        over(c, share);
      }
    }
  }

  const Numbering& net_;
  const std::vector<double>& wanted_;
  std::span<const double> length_;
  std::vector<Node> node_;
  std::vector<std::uint32_t> far_;  // contacts away from the source, or rank by length
  std::vector<double> away_;        // by length
};

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
  std::vector<double> wanted(net.size(), 0.0);
  for (const Vertex t : targets) wanted[net.number[t]] = 1;
  std::vector<std::vector<double>> through(portions), over(portions);
  in_portions(sources.size(), [&](std::size_t p, std::size_t first, std::size_t last) {
    if (first == last) return;
    through[p].resize(net.size(), 0.0);
    over[p].resize(graph.edge_count(), 0.0);
    Paths paths(net, wanted, length);
    for (std::size_t k = first; k < last; ++k) {
      paths.from(net.number[sources[k]], [&, contacts = over[p].data()](std::uint32_t c, double share) { contacts[c] += share; });
      for (std::size_t r = 1; r < paths.order.size(); ++r) through[p][paths.order[r]] += paths.dependency(paths.order[r]);
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
  std::vector<std::vector<double>> sums(portions), squares(portions);
  in_portions(samples, [&](std::size_t p, std::size_t first, std::size_t last) {
    if (first == last) return;
    sums[p].resize(n, 0.0);
    squares[p].resize(n, 0.0);
    Paths paths(net, wanted, {});
    for (std::size_t k = first; k < last; ++k) {
      paths.from(net.number[sources[k]], [](std::uint32_t, double) {});
      for (std::size_t r = 1; r < paths.order.size(); ++r) {
        const double dependency = paths.dependency(paths.order[r]);
        sums[p][paths.order[r]] += dependency;
        squares[p][paths.order[r]] += dependency * dependency;
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
