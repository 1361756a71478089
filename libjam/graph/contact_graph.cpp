#include "libjam/graph/contact_graph.hpp"

#include <cmath>
#include <sstream>

#include "libjam/errors.hpp"
#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

template <class... Parts>
[[noreturn]] void broken(const Snapshot& snapshot, const Parts&... parts) {
  std::ostringstream text;
  text << "frame at t = " << snapshot.time << " s: ";
  (text << ... << parts);
  throw DataError(text.str());
}

template <class T>
void expect_rows(const Snapshot& snapshot, const char* name, const std::vector<T>& column, std::size_t rows) {
  if (column.size() != rows) broken(snapshot, name, " has ", column.size(), " rows, expected ", rows);
}

void check_particles(const Snapshot& snapshot) {
  const Particles& p = snapshot.particles;
  expect_rows(snapshot, "particles/position", p.position, p.size());
  expect_rows(snapshot, "particles/radius", p.radius, p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i > 0 && p.id[i] <= p.id[i - 1]) {
      broken(snapshot, "particles/id[", i, "] = ", p.id[i], " after ", p.id[i - 1],
             ", expected strictly ascending ids");
    }
    if (!p.position[i].allFinite()) broken(snapshot, "particles/position of id ", p.id[i], " is not finite");
    if (!(p.radius[i] > 0) || !std::isfinite(p.radius[i])) {
      broken(snapshot, "particles/radius of id ", p.id[i], " is ", p.radius[i], ", expected > 0");
    }
  }
}

template <class Contacts>
void check_forces(const Snapshot& snapshot, const char* name, const Contacts& contacts) {
  if (contacts.normal_force.size() != contacts.size()) {
    broken(snapshot, name, "/normal_force has ", contacts.normal_force.size(), " rows, expected ", contacts.size());
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!std::isfinite(normal_force(contacts, c))) {
      broken(snapshot, name, " contact ", c, ": the normal force is not finite");
    }
  }
}

void check_particle_contacts(const Snapshot& snapshot) {
  const auto& row = snapshot.pp.row;
  const std::size_t particles = snapshot.particles.size();
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (row[c][0] >= row[c][1] || row[c][1] >= particles) {
      broken(snapshot, "contacts/pp/row[", c, "] = {", row[c][0], ", ", row[c][1],
             "}, expected two rows in ascending order below ", particles);
    }
    if (c > 0 && row[c] <= row[c - 1]) {
      broken(snapshot, "contacts/pp/row[", c, "] is out of order or repeated, expected strictly ascending pairs");
    }
  }
  check_forces(snapshot, "contacts/pp", snapshot.pp);
}

void check_wall_contacts(const Snapshot& snapshot, std::size_t walls) {
  const WallContacts& pw = snapshot.pw;
  const std::size_t particles = snapshot.particles.size();
  expect_rows(snapshot, "contacts/pw/wall", pw.wall, pw.size());
  for (std::size_t c = 0; c < pw.size(); ++c) {
    if (pw.row[c] >= particles) {
      broken(snapshot, "contacts/pw/row[", c, "] = ", pw.row[c], ", expected a row below ", particles);
    }
    if (pw.wall[c] >= walls) {
      broken(snapshot, "contacts/pw/wall[", c, "] = ", int{pw.wall[c]}, ", expected a wall below ", walls);
    }
  }
  check_forces(snapshot, "contacts/pw", pw);
}

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
  check_particles(snapshot);
  check_particle_contacts(snapshot);
  check_wall_contacts(snapshot, walls.size());

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
