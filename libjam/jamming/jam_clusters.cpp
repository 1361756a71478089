#include "libjam/jamming/jam_clusters.hpp"

#include <algorithm>

#include "libjam/graph/components.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/jamming/gap.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jam {
namespace {

struct WallLoad {
  double force = 0;      // N, all repulsive contacts
  bool carries = false;  // one of them is on the load path
};

WallLoad wall_load(const ContactGraph& graph, ContactGraph::Vertex v, WallRole role, double load_path_force) {
  WallLoad load;
  for (const std::uint32_t c : graph.wall_contacts(v, role)) {
    const double force = repulsive_force(graph.snapshot().pw, c);
    load.force += force;
    load.carries = load.carries || force > load_path_force;
  }
  return load;
}

}  // namespace

std::vector<JammedParticle> jammed_particles(const ContactGraph& graph, const std::vector<double>& compressive_force,
                                             const RunInfo& info, const Criteria& criteria) {
  std::vector<JammedParticle> jammed;
  const std::vector<double> limit = jam_limits(graph, info, criteria);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    if (compressive_force[v] > limit[v]) {
      jammed.push_back({v, compressive_force[v], in_gap(graph.snapshot(), v, info, criteria), limit[v]});
    }
  }
  return jammed;
}

std::vector<Cluster> jam_clusters(const ContactGraph& graph, const std::vector<JammedParticle>& jammed,
                                  const Criteria& criteria, std::uint32_t frame) {
  if (jammed.empty()) return {};
  std::vector<std::uint8_t> is_jammed(graph.vertex_count(), 0), on_load_path(graph.edge_count(), 1);
  for (const JammedParticle& p : jammed) {
    is_jammed[p.row] = 1;
    for (const ContactGraph::Neighbor& n : graph.neighbors(p.row)) {
      on_load_path[n.contact] &= repulsive_force(graph.snapshot().pp, n.contact) > criteria.bridge_contact_share * p.limit;
    }
  }
  const Components components = connected_components(graph, is_jammed, on_load_path);

  std::vector<Cluster> clusters(components.size.size());
  std::vector<std::uint8_t> blade_carries(clusters.size(), 0), vessel_carries(clusters.size(), 0);
  for (const JammedParticle& p : jammed) {
    const std::uint32_t label = components.label[p.row];
    Cluster& cluster = clusters[label];
    cluster.frame = frame;
    cluster.members.push_back(graph.snapshot().particles.id[p.row]);
    cluster.largest_compressive_force = std::max(cluster.largest_compressive_force, p.compressive_force);
    cluster.in_gap += p.in_gap;
    const double load_path_force = criteria.bridge_contact_share * p.limit;
    const WallLoad blade = wall_load(graph, p.row, WallRole::blade, load_path_force);
    const WallLoad vessel = wall_load(graph, p.row, WallRole::vessel, load_path_force);
    cluster.blade_force += blade.force;
    cluster.vessel_force += vessel.force;
    blade_carries[label] |= blade.carries;
    vessel_carries[label] |= vessel.carries;
  }
  for (std::size_t k = 0; k < clusters.size(); ++k) clusters[k].bridges = blade_carries[k] && vessel_carries[k];
  return clusters;
}

}  // namespace jam
