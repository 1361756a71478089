#include "libjam/graph/communities.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>

#include "libjam/graph/components.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/mean_repulsive_force.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;

struct Link {
  std::uint32_t to;
  double weight;
};
// A network of particles, or of groups of them, with weights of either sign. Vertices are visited in ascending order.
using Weighted = std::vector<std::vector<Link>>;
using Partition = std::vector<std::uint32_t>;

// N, what a contact must carry to hold a community together.
double null_force(const ContactGraph& graph, double resolution) {
  const double mean = mean_repulsive_force(graph);
  return std::isnan(mean) ? 0 : resolution * mean;
}

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of splitmix64
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

// Particles in an order that does not depend on their rows: by a number made of the forces on them, then on their partners, and so on
// (colour refinement, Weisfeiler and Leman, 1968). Only particles that no force tells apart are left to their rows.
// Each `attempt` gives another order.
std::vector<Vertex> order_by_forces(const ContactGraph& graph, std::uint64_t attempt) {
  const std::size_t n = graph.vertex_count();
  std::vector<std::uint64_t> colour(n, mixed(attempt + 1)), next(n);
  for (int round = 0; round < 4; ++round) {
    for (Vertex v = 0; v < n; ++v) {
      std::uint64_t sum = mixed(colour[v] + graph.wall_contacts(v).size());
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
        const float force = graph.snapshot().pp.normal_force[neighbor.contact];
        sum += mixed(colour[neighbor.vertex] ^ mixed(std::bit_cast<std::uint32_t>(force)));
      }
      next[v] = sum;
    }
    colour.swap(next);
  }
  std::vector<Vertex> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](Vertex a, Vertex b) { return colour[a] < colour[b]; });
  return order;
}

// Sums of the weights from one vertex to the groups around it.
class Sums {
 public:
  explicit Sums(std::size_t count) : sum_(count, 0.0), listed_(count, 0) {}
  void add(std::uint32_t group, double weight) {
    if (!listed_[group]) groups.push_back(group), listed_[group] = 1;
    sum_[group] += weight;
  }
  double operator[](std::uint32_t group) const { return sum_[group]; }
  void clear() {
    for (const std::uint32_t group : groups) sum_[group] = 0, listed_[group] = 0;
    groups.clear();
  }
  std::vector<std::uint32_t> groups;

 private:
  std::vector<double> sum_;
  std::vector<std::uint8_t> listed_;
};

// Orders in which the particles are visited; the best partition is taken.
constexpr std::uint64_t attempts = 8;

// What a move must gain, of the weights that take part, to be more than rounding.
constexpr double least_gain = 1e-12;

// Moves vertices to the group around them to which their weights are largest, or to none, until no move gains. Of equal groups the one
// whose label is smallest.
bool move_vertices(const Weighted& network, Partition& group) {
  const std::size_t n = network.size();
  std::vector<std::uint32_t> members(n, 0), empty;
  for (const std::uint32_t g : group) ++members[g];
  for (std::uint32_t g = std::uint32_t(n); g-- > 0;)
    if (members[g] == 0) empty.push_back(g);
  Sums sums(n);
  std::deque<std::uint32_t> queue(n);
  std::iota(queue.begin(), queue.end(), 0u);
  std::vector<std::uint8_t> queued(n, 1);
  bool moved = false;
  while (!queue.empty()) {
    const std::uint32_t v = queue.front();
    queue.pop_front();
    queued[v] = 0;
    sums.clear();
    double scale = 0;
    for (const Link& link : network[v]) sums.add(group[link.to], link.weight), scale += std::abs(link.weight);
    const std::uint32_t old = group[v];
    const double tie = least_gain * scale;
    // Staying counts what binds v to the others of its group; alone is 0.
    std::uint32_t best = old;
    double most = sums[old];
    if (0 > most + tie && members[old] > 1) {
      best = empty.back();
      most = 0;
    }
    for (const std::uint32_t g : sums.groups)
      if (sums[g] > most + tie || (best != old && std::abs(sums[g] - most) <= tie && most > 0 && g < best)) best = g, most = sums[g];
    if (best == old) continue;
    if (members[best] == 0) empty.pop_back();
    if (--members[old] == 0) empty.push_back(old);
    ++members[best];
    group[v] = best;
    moved = true;
    for (const Link& link : network[v])
      if (group[link.to] != best && !queued[link.to]) queue.push_back(link.to), queued[link.to] = 1;
  }
  return moved;
}

// Within each group again from single vertices: each that still stands alone joins the part of its group to which it is bound most.
Partition refined(const Weighted& network, const Partition& group) {
  const std::size_t n = network.size();
  Partition part(n);
  std::iota(part.begin(), part.end(), 0u);
  std::vector<std::uint32_t> members(n, 1);
  Sums sums(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (members[part[v]] != 1) continue;
    sums.clear();
    double scale = 0;
    for (const Link& link : network[v])
      if (group[link.to] == group[v]) sums.add(part[link.to], link.weight), scale += std::abs(link.weight);
    std::uint32_t best = part[v];
    double most = 0;
    for (const std::uint32_t p : sums.groups)
      if (sums[p] > most + least_gain * scale || (best != part[v] && std::abs(sums[p] - most) <= least_gain * scale && p < best))
        best = p, most = sums[p];
    if (best == part[v]) continue;
    --members[part[v]];
    ++members[best];
    part[v] = best;
  }
  return part;
}

// Labels 0 .. count-1 in the order in which they first come.
std::size_t number_again(Partition& partition) {
  const std::uint32_t labels = partition.empty() ? 0 : *std::max_element(partition.begin(), partition.end()) + 1;
  std::vector<std::uint32_t> label(labels, std::numeric_limits<std::uint32_t>::max());
  std::uint32_t count = 0;
  for (std::uint32_t& p : partition) {
    if (label[p] == std::numeric_limits<std::uint32_t>::max()) label[p] = count++;
    p = label[p];
  }
  return count;
}

Weighted aggregated(const Weighted& network, const Partition& part, std::size_t parts) {
  std::vector<std::vector<std::uint32_t>> members(parts);
  for (std::uint32_t v = 0; v < network.size(); ++v) members[part[v]].push_back(v);
  Weighted whole(parts);
  Sums sums(parts);
  for (std::uint32_t p = 0; p < parts; ++p) {
    sums.clear();
    for (const std::uint32_t v : members[p])
      for (const Link& link : network[v])
        if (part[link.to] != p) sums.add(part[link.to], link.weight);
    for (const std::uint32_t to : sums.groups) whole[p].push_back({to, sums[to]});
  }
  return whole;
}

// One descent through all levels of aggregation from a partition of the particles. True where it improved.
bool improve(const Weighted& particles, Partition& partition) {
  Weighted network = particles;
  Partition of_particle(particles.size());  // vertex of the level that holds each particle
  std::iota(of_particle.begin(), of_particle.end(), 0u);
  Partition group = partition;
  bool improved = false;
  for (;;) {
    improved = move_vertices(network, group) || improved;
    Partition part = refined(network, group);
    const std::size_t parts = number_again(part);
    for (std::size_t k = 0; k < of_particle.size(); ++k) partition[k] = group[of_particle[k]];
    if (parts == network.size()) break;
    Partition group_of_part(parts);
    for (std::uint32_t v = 0; v < network.size(); ++v) group_of_part[part[v]] = group[v];
    number_again(group_of_part);
    network = aggregated(network, part, parts);
    for (std::uint32_t& v : of_particle) v = part[v];
    group = std::move(group_of_part);
  }
  number_again(partition);
  return improved;
}

}  // namespace

double community_quality(const ContactGraph& graph, std::span<const std::uint32_t> label, double resolution) {
  const double null = null_force(graph, resolution);
  double quality = 0;
  for (std::size_t c = 0; c < graph.edge_count(); ++c)
    if (const auto [a, b] = graph.snapshot().pp.row[c]; label[a] == label[b]) quality += repulsive_force(graph.snapshot().pp, c) - null;
  return quality;
}

Communities communities(const ContactGraph& graph, double resolution) {
  const std::size_t n = graph.vertex_count();
  const double null = null_force(graph, resolution);
  std::vector<std::uint32_t> best;
  double best_quality = -1;
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    const std::vector<Vertex> order = order_by_forces(graph, attempt);
    std::vector<std::uint32_t> place(n), label(n);
    for (std::uint32_t k = 0; k < n; ++k) place[order[k]] = k;
    Weighted network(n);
    for (std::uint32_t k = 0; k < n; ++k) {
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(order[k]))
        network[k].push_back({place[neighbor.vertex], repulsive_force(graph.snapshot().pp, neighbor.contact) - null});
      std::sort(network[k].begin(), network[k].end(), [](const Link& a, const Link& b) { return a.to < b.to; });
    }
    Partition partition(n);
    std::iota(partition.begin(), partition.end(), 0u);
    while (improve(network, partition)) {
    }
    for (Vertex v = 0; v < n; ++v) label[v] = partition[place[v]];
    const double quality = community_quality(graph, label, resolution);
    if (quality > best_quality * (1 + least_gain)) best = label, best_quality = quality;
  }

  // A community that its moves have left in pieces is as good in pieces.
  std::vector<std::uint8_t> inside(graph.edge_count());
  for (std::size_t c = 0; c < inside.size(); ++c) {
    const auto [a, b] = graph.snapshot().pp.row[c];
    inside[c] = best[a] == best[b];
  }
  Components pieces = connected_components(graph, inside);
  Communities found{std::move(pieces.label), std::move(pieces.size)};
  found.quality = community_quality(graph, found.label, resolution);
  double sum = 0;
  for (std::size_t c = 0; c < graph.edge_count(); ++c) sum += repulsive_force(graph.snapshot().pp, c);
  found.modularity = sum > 0 ? found.quality / sum : std::numeric_limits<double>::quiet_NaN();
  return found;
}

}  // namespace jam
