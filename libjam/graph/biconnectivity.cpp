#include "libjam/graph/biconnectivity.hpp"

#include <boost/graph/biconnected_components.hpp>
#include <boost/property_map/property_map.hpp>
#include <iterator>

#include "libjam/graph/boost_adaptor.hpp"

namespace jam {

Biconnectivity biconnectivity(const ContactGraph& graph) {
  Biconnectivity found{std::vector<std::uint8_t>(graph.edge_count(), 0), std::vector<std::uint8_t>(graph.vertex_count(), 0)};
  std::vector<std::uint32_t> block(graph.edge_count());
  std::vector<ContactGraph::Vertex> cuts;
  const auto of_contact = boost::make_iterator_property_map(block.begin(), ContactEdgeIndexMap{});
  const std::size_t blocks = boost::biconnected_components(graph, of_contact, std::back_inserter(cuts)).first;
  for (const ContactGraph::Vertex v : cuts) found.articulation_point[v] = 1;
  // A block of one contact lies on no cycle.
  std::vector<std::uint32_t> size(blocks, 0);
  for (const std::uint32_t b : block) ++size[b];
  for (std::size_t c = 0; c < block.size(); ++c) found.cut_edge[c] = size[block[c]] == 1;
  return found;
}

}  // namespace jam
