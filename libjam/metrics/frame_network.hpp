// The network of one frame with what several of its metrics need, each found when the first metric asks for it and kept.
#pragma once
#include <optional>
#include <vector>

#include "libjam/graph/betweenness.hpp"
#include "libjam/graph/biconnectivity.hpp"
#include "libjam/graph/communities.hpp"
#include "libjam/graph/components.hpp"
#include "libjam/graph/core_numbers.hpp"
#include "libjam/graph/cycle_basis.hpp"
#include "libjam/graph/force_chains.hpp"
#include "libjam/graph/max_flow.hpp"
#include "libjam/graph/path_lengths.hpp"
#include "libjam/graph/persistence.hpp"
#include "libjam/graph/rattlers.hpp"
#include "libjam/graph/rigidity.hpp"
#include "libjam/graph/triangles.hpp"
#include "libjam/graph/widest_path.hpp"
#include "libjam/jamming/compressive_force.hpp"
#include "libjam/jamming/jam_clusters.hpp"
#include "libjam/graph/mean_repulsive_force.hpp"
#include "libjam/metrics/mobilisation.hpp"
#include "libjam/tessellation/power_cells.hpp"

namespace jam {

class FrameNetwork {
 public:
  // Refers to the graph and the run, which must outlive it. The run is the one that the graph's walls belong to.
  FrameNetwork(const ContactGraph& contacts, const RunInfo& of_run, const Criteria& jam_criteria = {})
      : graph(contacts), run(of_run), criteria(jam_criteria) {}
  FrameNetwork(ContactGraph&&, const RunInfo&, const Criteria& = {}) = delete;
  FrameNetwork(const ContactGraph&, RunInfo&&, const Criteria& = {}) = delete;

  const ContactGraph& graph;
  const RunInfo& run;
  const Criteria criteria;

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
  const RankedContacts& ranked() { return once(ranked_, [&] { return contacts_by_force(graph); }); }
  const WidestPath& bridge() { return once(bridge_, [&] { return widest_path(graph, ranked()); }); }
  const Betweenness& between() { return once(between_, [&] { return bridge_betweenness(graph); }); }
  const Biconnectivity& biconnected() { return once(biconnected_, [&] { return biconnectivity(graph); }); }
  const MaxFlow& flow() { return once(flow_, [&] { return max_force_flow(graph); }); }
  const PathLengths& paths() { return once(paths_, [&] { return path_lengths(graph); }); }
  // By length, up to six contacts.
  const std::vector<std::size_t>& basis_cycles() { return once(basis_cycles_, [&] { return basis_cycle_counts(graph, 6); }); }
  const Communities& groups() { return once(groups_, [&] { return communities(graph); }); }
  const Rigidity& rigid() { return once(rigid_, [&] { return rigidity(graph); }); }
  const PersistenceDiagram& parts() { return once(parts_, [&] { return persistence_of_components(graph, ranked()); }); }
  const PersistenceDiagram& loops() { return once(loops_, [&] { return persistence_of_loops_not_filled(graph, ranked()); }); }
  const std::vector<double>& mobilised() { return once(mobilised_, [&] { return mobilisation(graph, run); }); }
  // m^3, of the power cells.
  const std::vector<double>& cells() { return once(cells_, [&] { return power_cell_volumes(graph.snapshot(), run.walls); }); }
  const std::vector<double>& compressive() {
    return once(compressive_, [&] { return compressive_forces(graph, criteria.measure); });
  }
  const std::vector<JammedParticle>& jammed() {
    return once(jammed_, [&] { return jammed_particles(graph, compressive(), run, criteria); });
  }
  const std::vector<Cluster>& clusters() { return once(clusters_, [&] { return jam_clusters(graph, jammed(), criteria, 0); }); }

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
  std::optional<RankedContacts> ranked_;
  std::optional<WidestPath> bridge_;
  std::optional<Betweenness> between_;
  std::optional<Biconnectivity> biconnected_;
  std::optional<MaxFlow> flow_;
  std::optional<PathLengths> paths_;
  std::optional<std::vector<std::size_t>> basis_cycles_;
  std::optional<Communities> groups_;
  std::optional<Rigidity> rigid_;
  std::optional<PersistenceDiagram> parts_, loops_;
  std::optional<std::vector<double>> mobilised_, cells_, compressive_;
  std::optional<std::vector<JammedParticle>> jammed_;
  std::optional<std::vector<Cluster>> clusters_;
};

}  // namespace jam
