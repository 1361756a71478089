// How libjam's structs stand in its result files, for results_file.cpp and partial_file.cpp, and in the arrays of the Python module. A table is a
// group with one array per column.
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

template <class Visit>
void columns_of(JamEvent*, Visit&& column) {
  column("first_frame", &JamEvent::first_frame, "1", "row of /frames");
  column("last_frame", &JamEvent::last_frame, "1", "row of /frames, inclusive");
  column("samples", &JamEvent::samples, "1", "frames above the threshold, n");
  column("start", &JamEvent::start, "s", "time of the first sample above the threshold");
  column("end", &JamEvent::end, "s", "time of the last sample above the threshold");
  column("survival_time", &JamEvent::survival_time, "s", "n times the sampling interval");
  column("shortest", &JamEvent::shortest, "s", "lower bound of the duration, (n-1) sampling intervals");
  column("longest", &JamEvent::longest, "s", "upper bound, (n+1) sampling intervals; infinite where cut off");
  column("open_at_start", &JamEvent::open_at_start, "1", "the record begins inside the event");
  column("open_at_end", &JamEvent::open_at_end, "1", "the record ends inside the event");
  column("peak_force", &JamEvent::peak_force, "N", "largest compressive force of a particle");
  column("peak_time", &JamEvent::peak_time, "s", "when");
  column("peak_particle", &JamEvent::peak_particle, "1", "id of the particle that carried it");
  column("peak_in_gap", &JamEvent::peak_in_gap, "1", "that particle sat in the gap then");
  column("bridged", &JamEvent::bridged, "1", "force went from a blade to a vessel in one of its frames or more");
  column("least_gap", &JamEvent::least_gap, "m", "the smallest of the clusters that bridged; NaN where none did");
}

template <class Visit>
void columns_of(ClusterLink*, Visit&& column) {
  column("from", &ClusterLink::from, "1", "row of /clusters");
  column("to", &ClusterLink::to, "1", "row of /clusters, in the next frame");
  column("shared", &ClusterLink::shared, "1", "particles that both have; 0: a hand-over at the same site");
}

template <class Visit>
void columns_of(LoadedGrain*, Visit&& column) {
  column("particle", &LoadedGrain::particle, "1", "id");
  column("force", &LoadedGrain::force, "N", "compressive");
  column("position", &LoadedGrain::position, "m", "centre");
  column("speed", &LoadedGrain::speed, "m/s", "of the centre; NaN where the source has no velocities");
  column("in_gap", &LoadedGrain::in_gap, "1", "in the gap between blade tip and vessel");
}

template <class Visit>
void columns_of(FlowBin*, Visit&& column) {
  column("radius_low", &FlowBin::radius_low, "m", "distances from the vertical axis through the blade's origin from here");
  column("radius_high", &FlowBin::radius_high, "m", "to below here");
  column("height_low", &FlowBin::height_low, "m", "heights above the blade's origin from here");
  column("height_high", &FlowBin::height_high, "m", "to below here");
  column("samples", &FlowBin::samples, "1", "particles, not in the gap, summed over frames");
  column("azimuthal", &FlowBin::azimuthal, "1", "mean velocity around the axis in the blade's own sense, by solid volume, over that of the tip; NaN in rarely visited bins");
  column("radial", &FlowBin::radial, "1", "likewise, outward");
  column("vertical", &FlowBin::vertical, "1", "likewise, upward");
}

template <class Visit>
void columns_of(FlowSums::Bin*, Visit&& column) {
  column("samples", &FlowSums::Bin::samples, "1", "particles, not in the gap, summed over frames");
  column("tip", &FlowSums::Bin::tip, "m/s", "sum of (radius / tip radius)^3 times the tip's speed, in 2^-80, two's complement, low word first");
  column("azimuthal", &FlowSums::Bin::azimuthal, "m/s", "likewise, with the particles' velocities around the axis in the blade's own sense");
  column("radial", &FlowSums::Bin::radial, "m/s", "likewise, outward");
  column("vertical", &FlowSums::Bin::vertical, "m/s", "likewise, upward");
}

// A pose, flat.
struct BladeRow {
  double time = 0;
  Vec3 position, velocity, angular_velocity;
  std::array<double, 4> orientation{};  // w, x, y, z
};
inline BladeRow row_of(const BladePose& p) {
  const Eigen::Quaterniond& q = p.orientation;
  return {p.time, p.position, p.velocity, p.angular_velocity, {q.w(), q.x(), q.y(), q.z()}};
}
inline BladePose pose_of(const BladeRow& r) {
  const auto& q = r.orientation;
  return {r.time, r.position, r.velocity, r.angular_velocity, Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}
template <class Visit>
void columns_of(BladeRow*, Visit&& column) {
  column("time", &BladeRow::time, "s", "of the pose");
  column("position", &BladeRow::position, "m", "of the blade's body frame");
  column("velocity", &BladeRow::velocity, "m/s", "of the blade's body frame");
  column("angular_velocity", &BladeRow::angular_velocity, "rad/s", "of the blade");
  column("orientation", &BladeRow::orientation, "1", "w, x, y, z");
}

template <class Visit>
void columns_of(Track::Point*, Visit&& column) {
  column("frame", &Track::Point::frame, "1", "row of /frames");
  columns_of(static_cast<JammedSample*>(nullptr), [&]<class T>(const char* name, T JammedSample::*member, const char* unit, const char* doc) {
    column(name, static_cast<T Track::Point::*>(member), unit, doc);
  });
}

template <class Visit>
void columns_of(SurvivalClass*, Visit&& column) {
  column("low", &SurvivalClass::low, "s", "survival times from here");
  column("high", &SurvivalClass::high, "s", "to below here");
  column("events", &SurvivalClass::events, "1", "global events in the class");
  column("frequency", &SurvivalClass::frequency, "1/s", "events over observed time");
  column("share_of_jam_time", &SurvivalClass::share_of_jam_time, "1", "of the summed survival times");
}

// One octave of life, flat.
struct ContactLifeRow {
  double from = 0, to = 0;
  std::uint32_t ended_pp = 0, alive_pp = 0, ended_pw = 0, alive_pw = 0;
  double together_pp = 0, together_pw = 0;
};

template <class Visit>
void columns_of(ContactLifeRow*, Visit&& column) {
  column("from", &ContactLifeRow::from, "s", "life of a contact from here");
  column("to", &ContactLifeRow::to, "s", "to below here");
  column("ended_pp", &ContactLifeRow::ended_pp, "1", "contacts of particles that lasted so long");
  column("alive_pp", &ContactLifeRow::alive_pp, "1", "contacts of particles that are so old in the last frame");
  column("together_pp", &ContactLifeRow::together_pp, "1", "share of contacts of particles that is still there at `from`");
  column("ended_pw", &ContactLifeRow::ended_pw, "1", "contacts with walls that lasted so long");
  column("alive_pw", &ContactLifeRow::alive_pw, "1", "contacts with walls that are so old in the last frame");
  column("together_pw", &ContactLifeRow::together_pw, "1", "share of contacts with walls that is still there at `from`");
}

template <class Visit>
void columns_of(FlowEnergy*, Visit&& column) {
  column("time", &FlowEnergy::time, "s", "end of the window, or time of the frame");
  column("power", &FlowEnergy::power, "W", "power that the blades put into the grains");
  column("energy", &FlowEnergy::energy, "J", "work done up to this time");
}

template <class Visit>
void columns_of(StepJam*, Visit&& column) {
  column("start", &StepJam::start, "s", "first step above");
  column("end", &StepJam::end, "s", "last step above");
  column("duration", &StepJam::duration, "s", "steps above and pauses between them");
  column("open_at_start", &StepJam::open_at_start, "1", "it was there when the record began");
  column("open_at_end", &StepJam::open_at_end, "1", "it is there where the record ends");
  column("peak_force", &StepJam::peak_force, "N", "largest compressive force of a particle");
  column("peak_time", &StepJam::peak_time, "s", "when");
  column("peak_particle", &StepJam::peak_particle, "1", "id of the particle that carried it");
  column("site", &StepJam::site, "1", "sector + 2 layer of the blade, where that was");
  column("impulse", &StepJam::impulse, "N s", "integral of the members' compressive forces");
  column("work", &StepJam::work, "J", "that walls did on the members at their contacts");
  column("share_of_flow_energy", &StepJam::share_of_flow_energy, "1", "that work over the blades' in the whole record");
  column("path", &StepJam::path, "m", "integral of the speed of the particle with the peak, in its stay");
  column("turned", &StepJam::turned, "rad", "integral of its angular speed");
  column("stays", &StepJam::stays, "1", "stays of particles above the force");
}

inline std::vector<ContactLifeRow> rows_of(const std::vector<ContactLife>& life) {
  std::vector<ContactLifeRow> rows;
  for (const ContactLife& l : life)
    rows.push_back({l.from, l.to, l.particles.ended, l.particles.alive, l.walls.ended, l.walls.alive, l.particles.together, l.walls.together});
  return rows;
}

template <class Visit>
void scalars_of(Analysis*, Visit&& scalar) {
  scalar("observed_time", &Analysis::observed_time, "s", "frames times sampling interval");
  scalar("sampling_interval", &Analysis::sampling_interval, "s", "median distance of frames");
  scalar("jammed_time", &Analysis::jammed_time, "s", "summed survival times of the global events");
  scalar("jam_frequency", &Analysis::jam_frequency, "1/s", "global events over observed time");
  scalar("jammed_in_gap_share", &Analysis::jammed_in_gap_share, "1", "of all jammed particle samples");
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
