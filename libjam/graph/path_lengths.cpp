#include "libjam/graph/path_lengths.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

constexpr std::size_t words = 8;
using Sources = std::array<std::uint64_t, words>;  // one bit for each of 512 sources

// Adds to at[d] the number of pairs of a source in [first, last) and a particle d > 0 contacts away.
void count_distances(const ContactGraph& graph, std::size_t first, std::size_t last, std::vector<std::uint64_t>& at) {
  const std::size_t n = graph.vertex_count();
  std::vector<Sources> seen(n, Sources{}), front(n, Sources{}), next(n, Sources{});
  for (std::size_t k = first; k < last; ++k) front[k][(k - first) / 64] = seen[k][(k - first) / 64] = 1ull << (k - first) % 64;
  for (std::size_t distance = 1;; ++distance) {
    std::uint64_t found = 0;
    for (Vertex v = 0; v < n; ++v) {
      Sources reached{};
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v))
        for (std::size_t w = 0; w < words; ++w) reached[w] |= front[neighbor.vertex][w];
      for (std::size_t w = 0; w < words; ++w) {
        reached[w] &= ~seen[v][w];
        seen[v][w] |= reached[w];
        found += std::uint64_t(std::popcount(reached[w]));
      }
      next[v] = reached;
    }
    if (found == 0) return;
    if (at.size() <= distance) at.resize(distance + 1, 0);
    at[distance] += found;
    front.swap(next);
  }
}

PathLengths summary(double inverse_sum, double sum, double pairs, double longest, double n) {
  return {n > 1 ? inverse_sum / (n * (n - 1)) : unknown, pairs > 0 ? sum / pairs : unknown, pairs > 0 ? longest : unknown};
}

}  // namespace

PathLengths path_lengths(const ContactGraph& graph) {
  const std::size_t n = graph.vertex_count(), batch = 64 * words, batches = (n + batch - 1) / batch;
  std::vector<std::uint64_t> at;
#pragma omp parallel
  {
    std::vector<std::uint64_t> mine;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t b = 0; b < batches; ++b) count_distances(graph, b * batch, std::min((b + 1) * batch, n), mine);
#pragma omp critical
    {
      at.resize(std::max(at.size(), mine.size()), 0);
      for (std::size_t d = 0; d < mine.size(); ++d) at[d] += mine[d];
    }
  }
  double inverse_sum = 0, sum = 0, pairs = 0;
  for (std::size_t d = 1; d < at.size(); ++d) {
    inverse_sum += double(at[d]) / double(d);
    sum += double(at[d]) * double(d);
    pairs += double(at[d]);
  }
  return summary(inverse_sum, sum, pairs, at.empty() ? 0 : double(at.size() - 1), double(n));
}

PathLengths path_lengths(const ContactGraph& graph, std::span<const double> length) {
  const std::size_t n = graph.vertex_count();
  struct Sums {
    double inverse = 0, plain = 0, pairs = 0, longest = 0;
  };
  std::vector<Sums> of(n);
#pragma omp parallel
  {
    std::vector<double> away(n);
    using Entry = std::pair<double, Vertex>;
#pragma omp for schedule(dynamic, 16)
    for (std::size_t source = 0; source < n; ++source) {
      away.assign(n, std::numeric_limits<double>::infinity());
      std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
      away[source] = 0;
      front.emplace(0.0, Vertex(source));
      while (!front.empty()) {
        const auto [reach, v] = front.top();
        front.pop();
        if (reach > away[v]) continue;
        for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
          const double l = length[neighbor.contact];
          if (!(l > 0) || !std::isfinite(l) || !(reach + l < away[neighbor.vertex])) continue;
          away[neighbor.vertex] = reach + l;
          front.emplace(reach + l, neighbor.vertex);
        }
      }
      Sums& sums = of[source];
      for (std::size_t v = 0; v < n; ++v) {
        if (v == source || !std::isfinite(away[v])) continue;
        sums.inverse += 1 / away[v];
        sums.plain += away[v];
        sums.pairs += 1;
        sums.longest = std::max(sums.longest, away[v]);
      }
    }
  }
  Sums all;
  for (const Sums& sums : of) {
    all.inverse += sums.inverse;
    all.plain += sums.plain;
    all.pairs += sums.pairs;
    all.longest = std::max(all.longest, sums.longest);
  }
  return summary(all.inverse, all.plain, all.pairs, all.longest, double(n));
}

}  // namespace jam
