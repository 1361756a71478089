#include "libjam/graph/betweenness.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <random>

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;

// Particles under numbers that follow the network breadth first, so that partners lie near each other in memory. Each has its links in
// pairs, an odd one filled up with a link to nobody, the number size(): loops over pairs more often end where the processor expects it
// (6 % faster in a packing; blocks of 3, 4 and 8 are slower).
class Numbering {
 public:
  static constexpr std::uint32_t block = 2;
  std::vector<Vertex> vertex;              // [N] by number
  std::vector<std::uint32_t> number;       // [N] by vertex
  std::vector<std::uint32_t> first_link;   // [N + 1] by number, into the next two
  std::vector<std::uint32_t> to, contact;  // of each link: a number, and which contact it is; apart, as searches often need but the first

  explicit Numbering(const ContactGraph& graph) : number(graph.vertex_count(), none) {
    const std::size_t n = graph.vertex_count();
    vertex.reserve(n);
    const auto give = [&](Vertex v) {
      if (number[v] != none) return;
      number[v] = std::uint32_t(vertex.size());
      vertex.push_back(v);
    };
    for (Vertex start = 0; start < n; ++start) {
      const std::size_t begin = vertex.size();
      give(start);
      for (std::size_t k = begin; k < vertex.size(); ++k)
        for (const ContactGraph::Neighbor& neighbor : graph.neighbors(vertex[k])) give(neighbor.vertex);
    }
    first_link.reserve(n + 1);
    first_link.push_back(0);
    for (const Vertex v : vertex) {
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) add_link(number[neighbor.vertex], neighbor.contact);
      while (to.size() % block != 0) add_link(nobody(), 0);
      first_link.push_back(std::uint32_t(to.size()));
    }
  }
  std::size_t size() const { return vertex.size(); }
  std::uint32_t nobody() const { return std::uint32_t(vertex.size()); }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void add_link(std::uint32_t to_number, std::uint32_t over_contact) {
    to.push_back(to_number);
    contact.push_back(over_contact);
  }
};

constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();

// Shortest paths by length from one source after the other, and what hangs on them. After from(s), order() holds the particles reached,
// nearest first, and dependency(v) the sum over the targets t of the share of the paths from s to t that lead through v.
class PathsByLength {
 public:
  PathsByLength(const Numbering& numbering, const std::vector<double>& wanted, std::span<const double> length)
      : net_(numbering), wanted_(wanted), length_(length), node_(net_.size()) {}

  std::span<const std::uint32_t> order() const { return order_; }
  double dependency(std::uint32_t v) const { return node_[v].dependency; }

  void from(std::uint32_t source) {
    from(source, [](std::uint32_t, double) {});
  }
  // over(contact, share) for each contact on a path.
  template <class Over>
  void from(std::uint32_t source, Over over) {
    node_.assign(net_.size(), {});
    order_.clear();
    walk(source);
    // From the farthest back: a particle hands to each of those before it its part of the paths that end at it or behind it.
    for (std::size_t k = order_.size(); k-- > 0;) {
      const std::uint32_t u = order_[k];
      const double each = (wanted_[u] + node_[u].dependency) / node_[u].paths;
      for (std::uint32_t l = net_.first_link[u]; l < net_.first_link[u + 1]; ++l) {
        const std::uint32_t v = net_.to[l], c = net_.contact[l];
        if (v == net_.nobody() || !leads(v, u, c)) continue;
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
    std::uint32_t rank = unreached;  // in order()
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
      node_[v].rank = std::uint32_t(order_.size());
      order_.push_back(v);
      double paths = v == source;
      for (std::uint32_t l = net_.first_link[v]; l < net_.first_link[v + 1]; ++l) {
        const std::uint32_t u = net_.to[l], c = net_.contact[l];
        if (u == net_.nobody() || !walkable(c)) continue;
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
  std::vector<std::uint32_t> order_;
};

// The same for paths counted in contacts. With n_v the number of shortest paths from the source to v, the dependency d_v of v and
// c_v = (wanted_v + d_v)/n_v, Brandes' sum reads d_v = n_v (sum of c_u over the partners u one step farther). No branch is decided by data:
// every write is made, and the next one goes over it or not.
class PathsByContacts {
 public:
  PathsByContacts(const Numbering& numbering, const std::vector<double>& wanted)
      : net_(numbering), wanted_(wanted), node_(net_.size() + 1), order_(net_.size() + 1), steps_(net_.to.size() + 1),
        each_(net_.size()) {
    node_[net_.nobody()].away = 0;
  }

  std::span<const std::uint32_t> order() const { return {order_.data(), reached_}; }  // nearest first, the source itself at the head
  // What was added to c_v on top of wanted_v/n_v: exactly nothing where nothing was.
  double dependency(std::uint32_t v) const { return node_[v].paths * (each_[v] - wanted_[v] / node_[v].paths); }

  void from(std::uint32_t source) {
    start(source);
    walk([](std::size_t, std::size_t) {});
    hand_back([](std::size_t, double) {});
  }
  // over(contact, share) for each contact on a path.
  template <class Over>
  void from(std::uint32_t source, Over over) {
    start(source);
    step_contact_.resize(steps_.size());
    walk([this](std::size_t step, std::size_t link) { step_contact_[step] = net_.contact[link]; });
    hand_back([&](std::size_t step, double share) { over(step_contact_[step], share); });
  }

 private:
  struct Node {
    double paths = 0;
    std::uint32_t away = unreached;  // contacts from the source
  };
  struct Step {
    std::uint32_t from, to;
  };
  void start(std::uint32_t source) {
    for (const std::uint32_t v : order()) node_[v] = {};
    order_[0] = source;
    node_[source] = {1, 0};
  }

  // keep(step, link) for each link that may be a step; the next one takes its place if it is none.
  template <class Keep>
  void walk(Keep keep) {
    Node* const node = node_.data();
    std::uint32_t* const order = order_.data();
    Step* const steps = steps_.data();
    const std::uint32_t *const first_link = net_.first_link.data(), *const to_of = net_.to.data();
    std::size_t reached = 1, step = 0;
    for (std::size_t k = 0; k < reached; ++k) {
      const std::uint32_t v = order[k], next = node[v].away + 1;
      const double paths = node[v].paths;
      for (const std::uint32_t *link = to_of + first_link[v], *const end = to_of + first_link[v + 1]; link != end; link += Numbering::block)
        for (std::uint32_t l = 0; l < Numbering::block; ++l) {
          const std::uint32_t u = link[l];
          Node& to = node[u];
          order[reached] = u;
          reached += to.away == unreached;
          const std::uint32_t away = std::min(to.away, next);
          const bool ahead = away == next;
          to.away = away;
          to.paths += double(ahead) * paths;
          steps[step] = {v, u};
          keep(step, std::size_t(link + l - to_of));
          step += ahead;
        }
    }
    reached_ = reached;
    steps_taken_ = step;
  }

  // Back from the farthest: all steps from a particle are behind all steps to it. over(step, share) for each.
  template <class Over>
  void hand_back(Over over) {
    double* const each = each_.data();
    for (const std::uint32_t v : order()) each[v] = wanted_[v] / node_[v].paths;
    for (std::size_t s = steps_taken_; s-- > 0;) {
      const auto [v, u] = steps_[s];
      const double ahead = each[u];
      each[v] += ahead;
      over(s, node_[v].paths * ahead);
    }
  }

  const Numbering& net_;
  const std::vector<double>& wanted_;
  std::vector<Node> node_;
  std::vector<std::uint32_t> order_;
  std::vector<Step> steps_;                  // on shortest paths, away from the source
  std::vector<std::uint32_t> step_contact_;  // over which contact, where that is asked for
  std::vector<double> each_;                 // c, for each of the paths to a particle: what ends there, and what leads through it
  std::size_t reached_ = 0, steps_taken_ = 0;
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
                        std::span<const double> length, BetweennessOf of) {
  const Numbering net(graph);
  std::vector<double> wanted(net.size(), 0.0);
  for (const Vertex t : targets) wanted[net.number[t]] = 1;
  std::vector<std::vector<double>> through(portions), over(portions);
  in_portions(sources.size(), [&](std::size_t p, std::size_t first, std::size_t last) {
    if (first == last) return;
    through[p].resize(net.size(), 0.0);
    if (of == BetweennessOf::particles_and_contacts) over[p].resize(graph.edge_count(), 0.0);
    const auto add_all = [&](auto paths) {
      for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t source = net.number[sources[k]];
        if (of == BetweennessOf::particles) {
          paths.from(source);
        } else {
          paths.from(source, [contacts = over[p].data()](std::uint32_t c, double share) { contacts[c] += share; });
        }
        for (const std::uint32_t v : paths.order().subspan(1)) through[p][v] += paths.dependency(v);
      }
    };
    if (length.empty()) {
      add_all(PathsByContacts(net, wanted));
    } else {
      add_all(PathsByLength(net, wanted, length));
    }
  });
  return {by_vertex(net, sum_of(through, net.size())), of == BetweennessOf::particles ? std::vector<double>{} : sum_of(over, graph.edge_count())};
}

Betweenness betweenness(const ContactGraph& graph, std::span<const double> length, BetweennessOf of) {
  std::vector<Vertex> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0u);
  Betweenness both_ways = betweenness(graph, all, all, length, of);
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
    PathsByContacts paths(net, wanted);
    for (std::size_t k = first; k < last; ++k) {
      paths.from(sources[k]);
      for (const std::uint32_t v : paths.order().subspan(1)) {
        sums[p][v] += paths.dependency(v);
        squares[p][v] += paths.dependency(v) * paths.dependency(v);
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
