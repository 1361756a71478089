// Makes ContactGraph a model of Boost.Graph's BidirectionalGraph, AdjacencyGraph, VertexListGraph and EdgeListGraph,
// with the interior properties vertex_index (the row) and edge_index (the contact), so that
// boost::connected_components, boost::filtered_graph and the rest work on it as they are. The only header of libjam
// that shows Boost types; include it from .cpp files.
#pragma once
#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <boost/property_map/property_map.hpp>
#include <compare>
#include <utility>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// An edge as seen from one of its ends. Both views of one contact are the same edge.
struct ContactEdge {
  ContactGraph::Vertex from = 0, to = 0;
  std::uint32_t contact = 0;
  friend bool operator==(const ContactEdge& a, const ContactEdge& b) { return a.contact == b.contact; }
  friend std::strong_ordering operator<=>(const ContactEdge& a, const ContactEdge& b) {
    return a.contact <=> b.contact;
  }
};

struct EdgeFromNeighbor {
  ContactGraph::Vertex from = 0;
  ContactEdge operator()(const ContactGraph::Neighbor& n) const { return {from, n.vertex, n.contact}; }
};

// The same edge seen from the other end, which the algorithms for directed graphs call an in-edge.
struct EdgeToVertex {
  ContactGraph::Vertex to = 0;
  ContactEdge operator()(const ContactGraph::Neighbor& n) const { return {n.vertex, to, n.contact}; }
};

struct EdgeFromContact {
  const ContactGraph* graph = nullptr;
  ContactEdge operator()(std::uint32_t contact) const {
    const auto& pair = graph->snapshot().pp.row[contact];
    return {pair[0], pair[1], contact};
  }
};

struct VertexFromNeighbor {
  ContactGraph::Vertex operator()(const ContactGraph::Neighbor& n) const { return n.vertex; }
};

struct ContactEdgeIndexMap {
  using key_type = ContactEdge;
  using value_type = std::uint32_t;
  using reference = std::uint32_t;
  using category = boost::readable_property_map_tag;
  friend std::uint32_t get(const ContactEdgeIndexMap&, const ContactEdge& e) { return e.contact; }
};

}  // namespace jam

namespace boost {

template <>
struct graph_traits<jam::ContactGraph> {
  struct traversal_category : bidirectional_graph_tag,
                              adjacency_graph_tag,
                              vertex_list_graph_tag,
                              edge_list_graph_tag {};
  using vertex_descriptor = jam::ContactGraph::Vertex;
  using edge_descriptor = jam::ContactEdge;
  using directed_category = undirected_tag;
  using edge_parallel_category = disallow_parallel_edge_tag;
  using vertex_iterator = counting_iterator<vertex_descriptor>;
  using edge_iterator = transform_iterator<jam::EdgeFromContact, counting_iterator<std::uint32_t>>;
  using out_edge_iterator = transform_iterator<jam::EdgeFromNeighbor, const jam::ContactGraph::Neighbor*>;
  using in_edge_iterator = transform_iterator<jam::EdgeToVertex, const jam::ContactGraph::Neighbor*>;
  using adjacency_iterator = transform_iterator<jam::VertexFromNeighbor, const jam::ContactGraph::Neighbor*>;
  using vertices_size_type = std::size_t;
  using edges_size_type = std::size_t;
  using degree_size_type = std::size_t;
  static vertex_descriptor null_vertex() { return static_cast<vertex_descriptor>(-1); }
};

// Some of Boost's visitors are handed a const graph as the type of the graph.
template <>
struct graph_traits<const jam::ContactGraph> : graph_traits<jam::ContactGraph> {};

template <>
struct property_map<jam::ContactGraph, vertex_index_t> {
  using type = typed_identity_property_map<jam::ContactGraph::Vertex>;
  using const_type = type;
};

template <>
struct property_map<jam::ContactGraph, edge_index_t> {
  using type = jam::ContactEdgeIndexMap;
  using const_type = type;
};

}  // namespace boost

namespace jam {

using ContactGraphTraits = boost::graph_traits<ContactGraph>;

inline std::size_t num_vertices(const ContactGraph& g) {
  return g.vertex_count();
}
inline std::size_t num_edges(const ContactGraph& g) {
  return g.edge_count();
}

inline std::pair<ContactGraphTraits::vertex_iterator, ContactGraphTraits::vertex_iterator> vertices(
    const ContactGraph& g) {
  using Iterator = ContactGraphTraits::vertex_iterator;
  return {Iterator(0), Iterator(static_cast<ContactGraph::Vertex>(g.vertex_count()))};
}

inline std::pair<ContactGraphTraits::edge_iterator, ContactGraphTraits::edge_iterator> edges(const ContactGraph& g) {
  using Count = boost::counting_iterator<std::uint32_t>;
  using Iterator = ContactGraphTraits::edge_iterator;
  const EdgeFromContact edge{&g};
  return {Iterator(Count(0), edge), Iterator(Count(static_cast<std::uint32_t>(g.edge_count())), edge)};
}

inline std::pair<ContactGraphTraits::out_edge_iterator, ContactGraphTraits::out_edge_iterator> out_edges(
    ContactGraph::Vertex v, const ContactGraph& g) {
  using Iterator = ContactGraphTraits::out_edge_iterator;
  const auto neighbors = g.neighbors(v);
  const EdgeFromNeighbor edge{v};
  return {Iterator(neighbors.data(), edge), Iterator(neighbors.data() + neighbors.size(), edge)};
}

inline std::pair<ContactGraphTraits::in_edge_iterator, ContactGraphTraits::in_edge_iterator> in_edges(
    ContactGraph::Vertex v, const ContactGraph& g) {
  using Iterator = ContactGraphTraits::in_edge_iterator;
  const auto neighbors = g.neighbors(v);
  const EdgeToVertex edge{v};
  return {Iterator(neighbors.data(), edge), Iterator(neighbors.data() + neighbors.size(), edge)};
}

inline std::pair<ContactGraphTraits::adjacency_iterator, ContactGraphTraits::adjacency_iterator> adjacent_vertices(
    ContactGraph::Vertex v, const ContactGraph& g) {
  using Iterator = ContactGraphTraits::adjacency_iterator;
  const auto neighbors = g.neighbors(v);
  return {Iterator(neighbors.data()), Iterator(neighbors.data() + neighbors.size())};
}

inline std::size_t out_degree(ContactGraph::Vertex v, const ContactGraph& g) {
  return g.degree(v);
}
inline std::size_t in_degree(ContactGraph::Vertex v, const ContactGraph& g) {
  return g.degree(v);
}
inline std::size_t degree(ContactGraph::Vertex v, const ContactGraph& g) {
  return g.degree(v);
}
inline ContactGraph::Vertex source(const ContactEdge& e, const ContactGraph&) {
  return e.from;
}
inline ContactGraph::Vertex target(const ContactEdge& e, const ContactGraph&) {
  return e.to;
}

inline boost::typed_identity_property_map<ContactGraph::Vertex> get(boost::vertex_index_t, const ContactGraph&) {
  return {};
}
inline ContactGraph::Vertex get(boost::vertex_index_t, const ContactGraph&, ContactGraph::Vertex v) {
  return v;
}
inline ContactEdgeIndexMap get(boost::edge_index_t, const ContactGraph&) {
  return {};
}
inline std::uint32_t get(boost::edge_index_t, const ContactGraph&, const ContactEdge& e) {
  return e.contact;
}

}  // namespace jam
