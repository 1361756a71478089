#include "libjam/graph/components.hpp"

#include <algorithm>

#include "libjam/graph/disjoint_sets.hpp"

namespace jam {
namespace {

// keep_vertex(v) and keep_contact(c) say what takes part.
template <class KeepVertex, class KeepContact>
Components find_components(const ContactGraph& graph, KeepVertex keep_vertex, KeepContact keep_contact) {
  const std::uint32_t n = std::uint32_t(graph.vertex_count());
  DisjointSets sets(n);
  const auto& rows = graph.snapshot().pp.row;
  for (std::size_t c = 0; c < rows.size(); ++c)
    if (const auto [a, b] = rows[c]; keep_contact(c) && keep_vertex(a) && keep_vertex(b)) sets.join(a, b);

  std::vector<std::uint32_t> size(n, 0), root(n), order, rank(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (!keep_vertex(v)) continue;
    root[v] = sets.of(v);
    if (size[root[v]]++ == 0) order.push_back(root[v]);
  }
  // They come by their smallest row already; a stable sort leaves ties so.
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return size[a] > size[b]; });

  Components result;
  result.label.assign(n, Components::none);
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = k;
    result.size.push_back(size[order[k]]);
  }
  for (std::uint32_t v = 0; v < n; ++v)
    if (keep_vertex(v)) result.label[v] = rank[root[v]];
  return result;
}

}  // namespace

Components connected_components(const ContactGraph& graph) {
  const auto all = [](std::size_t) { return true; };
  return find_components(graph, all, all);
}

Components connected_components(const ContactGraph& graph, std::span<const std::uint8_t> keep_contact) {
  return find_components(
      graph, [](std::size_t) { return true; }, [&](std::size_t c) { return keep_contact[c] != 0; });
}

Components connected_components(const ContactGraph& graph, std::span<const std::uint8_t> keep_vertex,
                                std::span<const std::uint8_t> keep_contact) {
  return find_components(
      graph, [&](std::size_t v) { return keep_vertex[v] != 0; }, [&](std::size_t c) { return keep_contact[c] != 0; });
}

}  // namespace jam
