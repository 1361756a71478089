#include "libjam/graph/contact_graph.hpp"

namespace jam {
namespace {

// Counts to offsets: afterwards first[k] is where slot k begins and first.back() the total.
void accumulate_offsets(std::vector<std::uint32_t>& first) {
  std::uint32_t total = 0;
  for (std::uint32_t& entry : first) {
    const std::uint32_t count = entry;
    entry = total;
    total += count;
  }
}

}  // namespace

ContactGraph::ContactGraph(const Snapshot& snapshot, const std::vector<Wall>& walls) : snapshot_(&snapshot) {
  const auto& row = snapshot.pp.row;
  first_neighbor_.assign(vertex_count() + 1, 0);
  for (const auto& pair : row) {
    ++first_neighbor_[pair[0]];
    ++first_neighbor_[pair[1]];
  }
  accumulate_offsets(first_neighbor_);
  neighbors_.resize(2 * row.size());
  std::vector<std::uint32_t> next = first_neighbor_;
  // Contacts are sorted by (smaller row, larger row), so filling in their order leaves every list ascending by vertex:
  // first the partners with smaller rows, then those with larger ones.
  for (std::uint32_t c = 0; c < row.size(); ++c) {
    neighbors_[next[row[c][0]]++] = {row[c][1], c};
    neighbors_[next[row[c][1]]++] = {row[c][0], c};
  }

  const WallContacts& pw = snapshot.pw;
  const auto slot = [&](std::size_t c) { return roles * pw.row[c] + static_cast<std::size_t>(walls[pw.wall[c]].role); };
  first_wall_contact_.assign(roles * vertex_count() + 1, 0);
  for (std::size_t c = 0; c < pw.size(); ++c) ++first_wall_contact_[slot(c)];
  accumulate_offsets(first_wall_contact_);
  wall_contacts_.resize(pw.size());
  next = first_wall_contact_;
  for (std::uint32_t c = 0; c < pw.size(); ++c) wall_contacts_[next[slot(c)]++] = c;
}

}  // namespace jam
