// Jammed particles of a frame and the clusters they form.
//
// A particle is jammed when its compressive force exceeds its limit (jam_criteria.hpp), in the paper criteria.jam_force. A cluster is a connected component of the
// contact graph restricted to jammed particles, in which two of them are joined only by a contact on the load path: one
// whose repulsive normal force exceeds bridge_contact_share * limit, of both. Two jammed neighbours that merely touch, or
// that only adhesion holds together, each carry their own load to the walls; they are two jams. The threshold is a
// share of the limit and not zero, so that the weak contacts around a jam (micronewtons against tens of newtons) do not
// weld neighbouring jams into one.
//
// A cluster bridges when some member is pressed by a wall of role blade and some member (the same or another) by a wall
// of role vessel, each with a contact on the load path.
#pragma once
#include <vector>

#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/cluster.hpp"
#include "libjam/jamming/criteria.hpp"

namespace jam {

struct JammedParticle {
  ContactGraph::Vertex row = 0;
  double compressive_force = 0;  // N
  bool in_gap = false;           // see gap.hpp
  double limit = 0;              // N, that it is above (jam_criteria.hpp)
};

// Rows with a compressive force above their limit, ascending. `compressive_force` is [N], see compressive_force.hpp.
std::vector<JammedParticle> jammed_particles(const ContactGraph& graph, const std::vector<double>& compressive_force,
                                             const RunInfo& info, const Criteria& criteria);

// The clusters of these particles: largest first, ties by smallest id.
std::vector<Cluster> jam_clusters(const ContactGraph& graph, const std::vector<JammedParticle>& jammed,
                                  const Criteria& criteria, std::uint32_t frame);

}  // namespace jam
