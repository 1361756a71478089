// The smallest sum of capacities that parts a source from a sink, in any directed network.
//
// Boost.Graph has the same by Boykov and Kolmogorov and by pushes, on its own containers: on a network of 37,000 nodes that joins two faces
// they take ten and four times as long (tests/bench/jam/network_bench.cpp, `flow`), and this is asked for every frame. The tests hold the
// two against each other.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace jam {

struct FlowLink {
  std::uint32_t from, to;
  std::int64_t forth, back;  // capacities >= 0, from -> to and to -> from
};

struct MinimumCut {
  std::int64_t value = 0;                 // equals the maximum flow from source to sink (Ford and Fulkerson, 1956)
  std::vector<std::uint8_t> source_side;  // [nodes] 1 on the smallest side of the source that a minimum cut leaves, which is unique
};

// Nodes are 0 to nodes - 1; links from a node to itself and double ones may occur. No capacity may exceed 2^61,
// nor the sum of those into the sink 2^62.
// Exact, as capacities are whole numbers. Pushes along exact distances from the source, from the sink on, highest first, with gaps
// (Goldberg and Tarjan, J. ACM 35, 921, 1988; Cherkassky and Goldberg, Algorithmica 19, 390, 1997); as only the cut is asked for,
// what cannot reach the source is left where it is. Time O(nodes^2 sqrt(links)) at worst, some 2e-7 s per link in contact networks.
MinimumCut minimum_cut(std::uint32_t nodes, std::span<const FlowLink> links, std::uint32_t source, std::uint32_t sink);

}  // namespace jam
