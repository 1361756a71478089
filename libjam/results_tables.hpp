// How libjam's structs stand in its result files, for results_file.cpp and partial_file.cpp. A table is a group with one array per column.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "libjam/analysis.hpp"
#include "libjam/snapshot/hdf5.hpp"

namespace jam {

// The columns of each table are listed once, in a function that hands name, member, unit and doc to a visitor. Writing
// and reading are two visitors, so they cannot disagree. To store one more member: add its line to the list.

template <class Visit>
void columns_of(FrameSummary*, Visit&& column) {
  column("time", &FrameSummary::time, "s", "time of the frame");
  column("step", &FrameSummary::step, "1", "step of the source's own time stepping");
  column("particles", &FrameSummary::particles, "1", "particles in the frame");
  column("particle_contacts", &FrameSummary::particle_contacts, "1", "contacts between particles");
  column("wall_contacts", &FrameSummary::wall_contacts, "1", "contacts of particles with walls");
  column("coordination", &FrameSummary::coordination, "1", "2 N_pp / N, walls not counted");
  column("coordination_with_walls", &FrameSummary::coordination_with_walls, "1", "(2 N_pp + N_pw) / N");
  column("largest_compressive_force", &FrameSummary::largest_compressive_force, "N", "over all particles");
  column("mean_compressive_force", &FrameSummary::mean_compressive_force, "N", "over all particles");
  column("largest_particle", &FrameSummary::largest_particle, "1", "id of the particle with the largest force");
  column("jammed", &FrameSummary::jammed, "1", "particles above the jam force");
  column("jammed_in_gap", &FrameSummary::jammed_in_gap, "1", "of those, in the gap between blade tip and vessel");
  column("bridges", &FrameSummary::bridges, "1", "clusters that carry force from a blade to a vessel");
  column("largest_bridge", &FrameSummary::largest_bridge, "1", "particles in the largest bridge");
  column("blade_force", &FrameSummary::blade_force, "N", "on the first blade, along z; NaN where loads of walls are not recorded");
  column("blade_torque", &FrameSummary::blade_torque, "N m", "on the first blade, about z through its axis");
}

template <class Visit>
void columns_of(Cluster*, Visit&& column) {
  column("frame", &Cluster::frame, "1", "row of /frames");
  column("bridges", &Cluster::bridges, "1", "carries force from a blade to a vessel");
  column("blade_force", &Cluster::blade_force, "N", "sum of the repulsive normal forces with blades");
  column("vessel_force", &Cluster::vessel_force, "N", "sum of the repulsive normal forces with vessel walls");
  column("largest_compressive_force", &Cluster::largest_compressive_force, "N", "over the members");
  column("in_gap", &Cluster::in_gap, "1", "members in the gap");
  column("least_gap", &Cluster::least_gap, "m", "between a point where a blade and one where a vessel carries it; NaN where it does not bridge");
}

template <class Visit>
void columns_of(JammedSample*, Visit&& column) {
  column("particle", &JammedSample::particle, "1", "id");
  column("position", &JammedSample::position, "m", "centre");
  column("velocity", &JammedSample::velocity, "m/s", "of the centre; NaN where the source has none");
  column("angular_velocity", &JammedSample::angular_velocity, "rad/s", "NaN where the source has none");
  column("from_blade", &JammedSample::from_blade, "m", "centre in the blade's body frame, z along its axis");
  column("speed_over_tip", &JammedSample::speed_over_tip, "1", "of the centre, over that of the blade's tip");
  column("compressive_force", &JammedSample::compressive_force, "N", "of the particle");
  column("pushed_by", &JammedSample::pushed_by, "1", "particles and walls that push it");
  column("in_gap", &JammedSample::in_gap, "1", "in the gap between blade tip and vessel");
  column("bridged", &JammedSample::bridged, "1", "belongs to a cluster from blade to vessel");
  column("least_gap", &JammedSample::least_gap, "m", "of that cluster; NaN where there is none");
}

// HDF5 has no truth values: stored as 0 and 1.
template <class T>
using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

// `row_of(element)` is the struct whose members are the columns.
template <class Row, class Elements, class RowOf>
void write_table(h5::File& file, const std::string& group, const Elements& elements, RowOf row_of) {
  file.make_group(group);
  columns_of(static_cast<Row*>(nullptr),
             [&]<class T>(const char* name, T Row::*member, const char* unit, const char* doc) {
               std::vector<Stored<T>> values;
               values.reserve(elements.size());
               for (const auto& element : elements) values.push_back(row_of(element).*member);
               file.write(group + "/" + name, values, unit, doc);
             });
}

template <class Row>
void write_table(h5::File& file, const std::string& group, const std::vector<Row>& rows) {
  write_table<Row>(file, group, rows, [](const Row& row) -> const Row& { return row; });
}

template <class Row>
std::vector<Row> read_table(const h5::File& file, const std::string& group) {
  std::vector<Row> rows;
  bool first = true;
  columns_of(static_cast<Row*>(nullptr), [&]<class T>(const char* name, T Row::*member, const char*, const char*) {
    const std::string path = group + "/" + name;
    const std::vector<Stored<T>> values = file.read<Stored<T>>(path);
    if (first) rows.resize(values.size());
    first = false;
    if (values.size() != rows.size()) {
      file.fail(path, "has " + std::to_string(values.size()) + " rows, expected " + std::to_string(rows.size()) +
                          " as in the group's first column");
    }
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].*member = static_cast<T>(values[k]);
  });
  return rows;
}

// Lists of different length, one per row, stored end to end: `PREFIX_start` and `PREFIX_count` say which part is whose.
template <class Lists, class ListOf>
auto write_parts(h5::File& file, const std::string& group, const std::string& prefix, const std::string& target,
                 const Lists& lists, ListOf list_of) {
  std::vector<std::uint64_t> start, count;
  std::remove_cvref_t<decltype(list_of(lists.front()))> all;
  for (const auto& owner : lists) {
    const auto& list = list_of(owner);
    start.push_back(all.size());
    count.push_back(list.size());
    all.insert(all.end(), list.begin(), list.end());
  }
  file.write(group + "/" + prefix + "_start", start, "1", "first row in " + target);
  file.write(group + "/" + prefix + "_count", count, "1", "rows in " + target);
  return all;
}

template <class T>
std::vector<std::vector<T>> read_parts(const h5::File& file, const std::string& group, const std::string& prefix,
                                       const std::vector<T>& all, std::size_t owners) {
  const std::string start_name = group + "/" + prefix + "_start", count_name = group + "/" + prefix + "_count";
  const auto start = file.read<std::uint64_t>(start_name), count = file.read<std::uint64_t>(count_name);
  if (start.size() != owners) file.fail(start_name, "expected " + std::to_string(owners) + " rows");
  if (count.size() != owners) file.fail(count_name, "expected " + std::to_string(owners) + " rows");
  std::vector<std::vector<T>> lists(owners);
  std::uint64_t end = 0;
  for (std::size_t k = 0; k < owners; ++k) {
    // End to end, so that no file can make many lists out of the same few rows.
    if (start[k] != end || count[k] > all.size() - end) {
      file.fail(start_name, "row " + std::to_string(k) + " claims [" + std::to_string(start[k]) + ", +" +
                                std::to_string(count[k]) + "), expected parts end to end within " +
                                std::to_string(all.size()) + " rows");
    }
    end += count[k];
    lists[k].assign(all.begin() + static_cast<std::ptrdiff_t>(start[k]),
                    all.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return lists;
}

template <class T>
T read_one(const h5::File& file, const std::string& path) {
  const std::vector<T> values = file.read<T>(path);
  if (values.size() != 1) file.fail(path, "has " + std::to_string(values.size()) + " rows, expected 1");
  return values.front();
}

template <class Row>
void write_with_members(h5::File& file, const std::string& group, const std::vector<Row>& rows) {
  write_table(file, group, rows);
  const auto members = write_parts(file, group, "member", group + "/members", rows,
                                   [](const Row& row) -> const std::vector<ParticleId>& { return row.members; });
  file.write(group + "/members", members, "1", "particle ids, ascending within each part");
}

template <class Row>
std::vector<Row> read_with_members(const h5::File& file, const std::string& group) {
  std::vector<Row> rows = read_table<Row>(file, group);
  auto members = read_parts(file, group, "member", file.read<ParticleId>(group + "/members"), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].members = std::move(members[k]);
  return rows;
}

void write_criteria(h5::File& file, const Criteria& criteria);
Criteria read_criteria(const h5::File& file);

}  // namespace jam
