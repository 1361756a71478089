// The contact network of one frame as an immutable compressed graph.
//
// Particles are the vertices; a vertex IS the particle's row in the snapshot, and rows ascend with the id, so "smallest
// row" and "smallest id" are the same rule. An edge is a contact of two particles and knows its index in Snapshot::pp.
// Walls are labelled ends, never vertices: a wall as a vertex would join everything that touches it into one component.
// Contacts with walls hang on their particle, grouped by the role of the wall.
//
// Every recorded contact is an edge, adhesive necks included; algorithms on loads filter by force themselves.
// boost_adaptor.hpp makes this class a Boost.Graph model.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

class ContactGraph {
 public:
  using Vertex = std::uint32_t;

  struct Neighbor {
    Vertex vertex;
    std::uint32_t contact;  // index into Snapshot::pp
  };

  // Refers to the snapshot, which must outlive the graph. `walls` are RunInfo::walls. The snapshot must have passed
  // validate() (libjam/snapshot/validate.hpp): every source of stored frames and Pipeline::add see to that.
  ContactGraph(const Snapshot& snapshot, const std::vector<Wall>& walls);
  ContactGraph(Snapshot&&, const std::vector<Wall>&) = delete;

  const Snapshot& snapshot() const { return *snapshot_; }
  std::size_t vertex_count() const { return snapshot_->particles.size(); }
  std::size_t edge_count() const { return snapshot_->pp.size(); }
  std::size_t wall_contact_count() const { return snapshot_->pw.size(); }

  // Ascending by vertex.
  std::span<const Neighbor> neighbors(Vertex v) const {
    return {neighbors_.data() + first_neighbor_[v], neighbors_.data() + first_neighbor_[v + 1]};
  }
  std::size_t degree(Vertex v) const { return first_neighbor_[v + 1] - first_neighbor_[v]; }

  // Indices into Snapshot::pw, by role, then ascending.
  std::span<const std::uint32_t> wall_contacts(Vertex v) const { return slice(roles * v, roles * (v + 1)); }
  std::span<const std::uint32_t> wall_contacts(Vertex v, WallRole role) const {
    const std::size_t slot = roles * v + static_cast<std::size_t>(role);
    return slice(slot, slot + 1);
  }

 private:
  static constexpr std::size_t roles = 3;  // of WallRole

  std::span<const std::uint32_t> slice(std::size_t first_slot, std::size_t last_slot) const {
    return {wall_contacts_.data() + first_wall_contact_[first_slot],
            wall_contacts_.data() + first_wall_contact_[last_slot]};
  }

  const Snapshot* snapshot_;
  std::vector<std::uint32_t> first_neighbor_;      // [N + 1] into neighbors_
  std::vector<Neighbor> neighbors_;                // [2 C]
  std::vector<std::uint32_t> first_wall_contact_;  // [3 N + 1] into wall_contacts_, per particle and role
  std::vector<std::uint32_t> wall_contacts_;       // [W]
};

}  // namespace jam
