#include "libjam/graph/components.hpp"

#include <algorithm>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/filtered_graph.hpp>
#include <numeric>

#include "libjam/graph/boost_adaptor.hpp"

namespace jam {
namespace {

struct KeepVertex {
  const std::uint8_t* keep = nullptr;
  bool operator()(ContactGraph::Vertex v) const { return keep[v] != 0; }
};

struct KeepEdge {
  const std::uint8_t* keep = nullptr;
  bool operator()(const ContactEdge& e) const { return keep[e.contact] != 0; }
};

template <class Graph>
Components by_rule(const Graph& graph, std::size_t vertices) {
  std::vector<std::uint32_t> found(vertices, Components::none);
  const auto index = get(boost::vertex_index, graph);
  const std::size_t count = boost::connected_components(graph, boost::make_iterator_property_map(found.begin(), index));

  std::vector<std::uint32_t> size(count, 0), smallest(count, Components::none);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (found[v] == Components::none) continue;
    ++size[found[v]];
    smallest[found[v]] = std::min(smallest[found[v]], v);
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return size[a] != size[b] ? size[a] > size[b] : smallest[a] < smallest[b];
  });

  Components result;
  result.label.assign(vertices, Components::none);
  std::vector<std::uint32_t> rank(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    rank[order[k]] = k;
    result.size.push_back(size[order[k]]);
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (found[v] != Components::none) result.label[v] = rank[found[v]];
  }
  return result;
}

}  // namespace

Components connected_components(const ContactGraph& graph) {
  return by_rule(graph, graph.vertex_count());
}

Components connected_components(const ContactGraph& graph, std::span<const std::uint8_t> keep_vertex,
                                std::span<const std::uint8_t> keep_contact) {
  const boost::filtered_graph<ContactGraph, KeepEdge, KeepVertex> part(graph, KeepEdge{keep_contact.data()},
                                                                       KeepVertex{keep_vertex.data()});
  return by_rule(part, graph.vertex_count());
}

}  // namespace jam
