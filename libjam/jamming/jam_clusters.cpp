#include "libjam/jamming/jam_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libjam/graph/components.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/wall_touch.hpp"
#include "libjam/jamming/gap.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jam {
namespace {

// What walls of one role do to a cluster.
struct WallLoad {
  double force = 0;          // N, all repulsive contacts
  bool carries = false;      // one of them is on the load path
  std::vector<Vec3> points;  // m, of those on the load path

  void add(const ContactGraph& graph, ContactGraph::Vertex v, WallRole role, double load_path_force) {
    const Snapshot& s = graph.snapshot();
    for (const std::uint32_t c : graph.wall_contacts(v, role)) {
      const double push = repulsive_force(s.pw, c);
      force += push;
      if (!(push > load_path_force)) continue;
      carries = true;
      if (const auto touch = wall_touch(s, c)) points.push_back(s.particles.position[v].cast<double>() + touch->arm);
    }
  }
};

double least_distance(const std::vector<Vec3>& some, const std::vector<Vec3>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& a : some)
    for (const Vec3& b : others) least = std::min(least, (a - b).norm());
  return std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN();
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
  std::vector<WallLoad> blade(clusters.size()), vessel(clusters.size());
  for (const JammedParticle& p : jammed) {
    const std::uint32_t label = components.label[p.row];
    Cluster& cluster = clusters[label];
    cluster.frame = frame;
    cluster.members.push_back(graph.snapshot().particles.id[p.row]);
    cluster.largest_compressive_force = std::max(cluster.largest_compressive_force, p.compressive_force);
    cluster.in_gap += p.in_gap;
    const double load_path_force = criteria.bridge_contact_share * p.limit;
    blade[label].add(graph, p.row, WallRole::blade, load_path_force);
    vessel[label].add(graph, p.row, WallRole::vessel, load_path_force);
  }
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    clusters[k].blade_force = blade[k].force;
    clusters[k].vessel_force = vessel[k].force;
    clusters[k].bridges = blade[k].carries && vessel[k].carries;
    if (clusters[k].bridges) clusters[k].least_gap = least_distance(blade[k].points, vessel[k].points);
  }
  return clusters;
}

}  // namespace jam
