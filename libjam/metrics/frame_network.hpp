// The network of one frame with what several of its metrics need, each found when the first metric asks for it and kept.
#pragma once
#include <optional>
#include <vector>

#include "libjam/graph/betweenness.hpp"
#include "libjam/graph/biconnectivity.hpp"
#include "libjam/graph/components.hpp"
#include "libjam/graph/core_numbers.hpp"
#include "libjam/graph/force_chains.hpp"
#include "libjam/graph/max_flow.hpp"
#include "libjam/graph/rattlers.hpp"
#include "libjam/graph/triangles.hpp"
#include "libjam/graph/widest_path.hpp"
#include "libjam/metrics/mean_repulsive_force.hpp"

namespace jam {

class FrameNetwork {
 public:
  // Refers to the graph, which must outlive it.
  explicit FrameNetwork(const ContactGraph& contacts) : graph(contacts) {}
  FrameNetwork(ContactGraph&&) = delete;

  const ContactGraph& graph;

  const Components& components() { return once(components_, [&] { return connected_components(graph); }); }
  const std::vector<std::uint32_t>& cores() { return once(cores_, [&] { return core_numbers(graph); }); }
  const std::vector<std::uint32_t>& corners() { return once(corners_, [&] { return triangles(graph); }); }
  const std::vector<std::uint8_t>& loose() { return once(loose_, [&] { return rattlers(graph); }); }
  double mean_force() { return once(mean_force_, [&] { return mean_repulsive_force(graph); }); }
  // Stress per volume of the sphere.
  const std::vector<Eigen::Matrix3d>& stress() {
    return once(stress_, [&] { return particle_stress(graph, sphere_volumes(graph.snapshot())); });
  }
  const std::vector<Load>& loads() { return once(loads_, [&] { return particle_loads(stress()); }); }
  // Linear ones by the usual rules.
  const std::vector<ForceChain>& chains() { return once(chains_, [&] { return force_chains(graph, loads()); }); }
  const WidestPath& bridge() { return once(bridge_, [&] { return widest_path(graph); }); }
  const std::vector<double>& between() { return once(between_, [&] { return bridge_betweenness(graph); }); }
  const Biconnectivity& biconnected() { return once(biconnected_, [&] { return biconnectivity(graph); }); }
  const MaxFlow& flow() { return once(flow_, [&] { return max_force_flow(graph); }); }

 private:
  template <class Value, class Find>
  static const Value& once(std::optional<Value>& kept, Find find) {
    if (!kept) kept = find();
    return *kept;
  }

  std::optional<Components> components_;
  std::optional<std::vector<std::uint32_t>> cores_, corners_;
  std::optional<std::vector<std::uint8_t>> loose_;
  std::optional<double> mean_force_;
  std::optional<std::vector<Eigen::Matrix3d>> stress_;
  std::optional<std::vector<Load>> loads_;
  std::optional<std::vector<ForceChain>> chains_;
  std::optional<WidestPath> bridge_;
  std::optional<std::vector<double>> between_;
  std::optional<Biconnectivity> biconnected_;
  std::optional<MaxFlow> flow_;
};

}  // namespace jam
