#include "apps/jamscope/checkpoint.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <tuple>
#include <type_traits>

#include "apps/jamscope/sha256.hpp"
#include "libjam/errors.hpp"
#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/schema.hpp"

namespace jamscope {
namespace {

using Vec3 = dem::Vec3;
constexpr const char* checkpoint_format = "jamscope-checkpoint";
constexpr const char* bed_format = "jamscope-bed";
constexpr std::uint32_t state_version = 5;

// TABLES of what a state file stores of each row of a struct: data set, member, unit, meaning. A new member is one row here.
template <class Row, class Value>
struct Column {
  const char* name;
  Value Row::*member;
  const char *unit, *doc;
};
template <class Row, class Value>  // Clang 14 deduces none for aggregates
Column(const char*, Value Row::*, const char*, const char*) -> Column<Row, Value>;
using Pair = dem::State::Pair;
using WallPair = dem::State::WallPair;
using Last = dem::LastForces;
constexpr std::tuple pair_columns{
    Column{"i", &Pair::i, "1", "row of the first grain"},
    Column{"j", &Pair::j, "1", "row of the second grain"},
    Column{"spring", &Pair::spring, "m", "tangential spring"},
    Column{"birth_step", &Pair::birth_step, "1", "step of forming"},
    Column{"contact_radius", &Pair::contact_radius, "m", "contact radius"},
    Column{"rolling", &Pair::rolling, "N m", "elastic rolling torque on the first grain"},
    Column{"level", &Pair::level, "1", "evaluated every 2^level steps"},
};
constexpr std::tuple wall_pair_columns{
    Column{"i", &WallPair::i, "1", "row of the grain"},
    Column{"wall", &WallPair::wall, "1", "index of the wall"},
    Column{"feature", &WallPair::feature, "1", "touched part of the wall"},
    Column{"normal", &WallPair::normal, "1", "from the grain to the wall"},
    Column{"spring", &WallPair::spring, "m", "tangential spring"},
    Column{"birth_step", &WallPair::birth_step, "1", "step of forming"},
    Column{"contact_radius", &WallPair::contact_radius, "m", "contact radius"},
    Column{"rolling", &WallPair::rolling, "N m", "elastic rolling torque on the grain"},
    Column{"distance", &WallPair::distance, "m", "from the grain's centre to the wall"},
    Column{"curvature", &WallPair::curvature, "1/m", "principal curvatures of the wall, > 0 where it is hollow"},
    Column{"level", &WallPair::level, "1", "evaluated every 2^level steps"},
};
using dem::Excursion;
constexpr std::tuple excursion_columns{
    Column{"id", &Excursion::id, "1", "of the grain"},
    Column{"first_step", &Excursion::first_step, "1", "first step above the watched force"},
    Column{"last_step", &Excursion::last_step, "1", "last step above, so far"},
    Column{"peak_step", &Excursion::peak_step, "1", "step of the largest force"},
    Column{"peak_force", &Excursion::peak_force, "N", "largest compressive force"},
    Column{"impulse", &Excursion::impulse, "N s", "integral of the compressive force"},
    Column{"work", &Excursion::work, "J", "that walls did on the grain"},
    Column{"path", &Excursion::path, "m", "integral of the speed"},
    Column{"turned", &Excursion::turned, "rad", "integral of the angular speed"},
    Column{"first_position", &Excursion::first_position, "m", "centre in the first step"},
    Column{"peak_position", &Excursion::peak_position, "m", "centre at the largest force"},
    Column{"last_position", &Excursion::last_position, "m", "centre in the last step"},
};
// Of the evaluation before; the ledger needs them.
constexpr std::tuple last_columns{
    Column{"duration", &Last::duration, "s", "how long the impulses are"},
    Column{"normal", &Last::normal, "1", "from i to j or to the wall"},
    Column{"arm_i", &Last::arm_i, "m", "from i's centre to the contact"},
    Column{"arm_j", &Last::arm_j, "m", "from j's centre to the contact"},
    Column{"elastic", &Last::elastic, "N", "elastic normal force"},
    Column{"damping", &Last::damping, "N", "normal damping force"},
    Column{"tangential_elastic", &Last::tangential_elastic, "N", "elastic tangential force on i"},
    Column{"tangential_viscous", &Last::tangential_viscous, "N", "viscous tangential force on i"},
    Column{"rolling_i", &Last::rolling_i, "N m", "rolling torque on i"},
    Column{"rolling_j", &Last::rolling_j, "N m", "rolling torque on j"},
    Column{"wall_velocity", &Last::wall_velocity, "m/s", "of the wall's point"},
    Column{"wall_spin", &Last::wall_spin, "rad/s", "of the wall"},
    Column{"normal_energy", &Last::normal_energy, "J", "stored by the normal force"},
    Column{"surface_energy", &Last::surface_energy, "J", "the part of closed surfaces"},
    Column{"tangential_energy", &Last::tangential_energy, "J", "stored by the tangential spring"},
    Column{"rolling_energy", &Last::rolling_energy, "J", "stored by the rolling spring"},
};

// Likewise of a struct that holds whole arrays.
template <class Owner, class Value>
struct Array {
  const char* name;
  std::vector<Value> Owner::*member;
  const char *unit, *doc;
};
template <class Owner, class Value>
Array(const char*, std::vector<Value> Owner::*, const char*, const char*) -> Array<Owner, Value>;
using Layout = dem::State::Layout;
constexpr std::tuple particle_arrays{
    Array{"id", &dem::Particles::id, "1", "persistent id"},
    Array{"material", &dem::Particles::material, "1", "index of the material"},
    Array{"radius", &dem::Particles::radius, "m", "radius"},
    Array{"position", &dem::Particles::position, "m", "centre"},
    Array{"velocity", &dem::Particles::velocity, "m/s", "velocity, half a step before the positions"},
    Array{"angular_velocity", &dem::Particles::angular_velocity, "rad/s", "angular velocity, likewise"},
};
constexpr std::tuple force_arrays{
    Array{"force", &dem::State::force, "N", "sum of forces; empty before the first step"},
    Array{"torque", &dem::State::torque, "N m", "sum of torques; empty before the first step"},
};
constexpr std::tuple layout_arrays{
    Array{"order", &Layout::order, "1", "row in particles for each row of the run"},
    Array{"listed", &Layout::listed, "m", "centres when the lists were built, rows of the run"},
    Array{"first", &Layout::first, "1", "row of the run of each lane's first grain"},
    Array{"second", &Layout::second, "1", "row of the run of each lane's second grain"},
};
constexpr std::tuple level_arrays{
    Array{"grain", &Layout::grain_level, "1", "a grain moves every 2^level steps; rows of the run"},
    Array{"block", &Layout::block_level, "1", "likewise of each block of lanes; 255: asleep"},
    Array{"block_wake", &Layout::block_wake, "m", "odometer up to which the block is apart"},
    Array{"wall_grain", &Layout::wall_grain, "1", "row of the run of a grain near a wall"},
    Array{"wall", &Layout::wall, "1", "the wall"},
    Array{"wall_level", &Layout::wall_level, "1", "as for blocks"},
    Array{"wall_wake", &Layout::wall_wake, "m", "as for blocks"},
    Array{"closing_jolt", &Layout::closing_jolt, "m/s", "change of closing speeds to reckon with, by chunk of rows"},
};

template <class Owner, class Arrays>
void write_arrays(jam::h5::File& f, const std::string& folder, const Owner& owner, const Arrays& arrays) {
  std::apply([&](const auto&... a) { (f.write(folder + a.name, owner.*a.member, a.unit, a.doc), ...); }, arrays);
}

template <class Owner, class Arrays>
void read_arrays(const jam::h5::File& f, const std::string& folder, Owner& owner, const Arrays& arrays) {
  const auto read = [&](const auto& array) {
    using Value = typename std::decay_t<decltype(owner.*array.member)>::value_type;
    owner.*array.member = f.read<Value>(folder + array.name);
  };
  std::apply([&](const auto&... array) { (read(array), ...); }, arrays);
}

template <class Row, class Columns>
void write_columns(jam::h5::File& f, const std::string& folder, const std::vector<Row>& rows, const Columns& columns) {
  const auto write = [&](const auto& column) {
    std::vector<std::decay_t<decltype(rows[0].*column.member)>> values;
    values.reserve(rows.size());
    for (const Row& row : rows) values.push_back(row.*column.member);
    f.write(folder + column.name, values, column.unit, column.doc);
  };
  std::apply([&](const auto&... column) { (write(column), ...); }, columns);
}

template <class Row, class Columns>
void read_columns(const jam::h5::File& f, const std::string& folder, std::vector<Row>& rows, const Columns& columns) {
  bool first = true;
  const auto read = [&](const auto& column) {
    using Value = std::decay_t<decltype(std::declval<Row>().*column.member)>;
    const std::vector<Value> values = f.read<Value>(folder + column.name);
    if (first) rows.resize(values.size());
    first = false;
    if (values.size() != rows.size())
      f.fail(folder + column.name, "has " + std::to_string(values.size()) + " rows, expected " + std::to_string(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].*column.member = values[k];
  };
  std::apply([&](const auto&... column) { (read(column), ...); }, columns);
}

constexpr std::pair<const char*, double dem::LedgerSums::*> spent_columns[] = {
    {"normal_damping", &dem::LedgerSums::normal_damping},
    {"tangential_damping", &dem::LedgerSums::tangential_damping},
    {"sliding", &dem::LedgerSums::sliding},
    {"rolling", &dem::LedgerSums::rolling},
    {"detachment", &dem::LedgerSums::detachment},
    {"stiffness_change", &dem::LedgerSums::stiffness_change},
    {"time_stepping", &dem::LedgerSums::time_stepping},
};

void write_state(jam::h5::File& f, const dem::State& s) {
  f.make_group("/state");
  f.set_attribute("/state", "step", s.step);
  write_arrays(f, "/state/particles/", s.particles, particle_arrays);
  write_arrays(f, "/state/particles/", s, force_arrays);
  write_columns(f, "/state/pairs/", s.pairs, pair_columns);
  write_columns(f, "/state/walls/", s.wall_pairs, wall_pair_columns);
  write_columns(f, "/state/excursions/", s.excursions, excursion_columns);
  if (!s.force.empty()) {
    const Layout& layout = s.layout;
    f.make_group("/state/layout");
    f.set_attribute("/state/layout", "chunk_rows", layout.chunk_rows);
    f.set_attribute("/state/layout", "listed_step", layout.listed_step);
    f.set_attribute("/state/layout", "skin", layout.skin);
    f.set_attribute("/state/layout", "odometer", layout.odometer);
    f.set_attribute("/state/layout", "next_look", layout.next_look);
    write_arrays(f, "/state/layout/", layout, layout_arrays);
    f.write("/state/layout/reach", layout.reach, "m", "how far each grain may go until the lists must be built again, rows of the run");
    if (!layout.grain_level.empty()) {
      f.make_group("/state/layout/levels");
      f.set_attribute("/state/layout/levels", "foresight", layout.foresight);
      write_arrays(f, "/state/layout/levels/", layout, level_arrays);
      f.write("/state/layout/levels/block_quiet", layout.block_quiet, "1", "steps for which no contact forms in a block that is apart and awake");
      f.write("/state/layout/levels/wall_quiet", layout.wall_quiet, "1", "likewise of a grain near a wall");
    }
  }
  const dem::State::Ledger& l = s.ledger;
  if (l.last_power.empty()) return;
  f.make_group("/state/ledger");
  for (const auto& [name, member] : spent_columns) f.set_attribute("/state/ledger", name, l.spent.*member);
  f.set_attribute("/state/ledger", "initial", l.initial);
  f.write("/state/ledger/wall_work", l.wall_work, "J", "work of each wall since the beginning");
  f.write("/state/ledger/last_power", l.last_power, "W", "power of each wall in the last step");
  write_columns(f, "/state/ledger/pairs/", l.pairs, last_columns);
  write_columns(f, "/state/ledger/walls/", l.wall_pairs, last_columns);
}

dem::State read_state(const jam::h5::File& f) {
  dem::State s;
  s.step = f.attribute<std::uint64_t>("/state", "step");
  dem::Particles& p = s.particles;
  read_arrays(f, "/state/particles/", p, particle_arrays);
  read_arrays(f, "/state/particles/", s, force_arrays);
  const std::size_t n = p.size();
  for (const std::size_t size : {p.material.size(), p.radius.size(), p.position.size(), p.velocity.size(),
                                 p.angular_velocity.size(), s.force.empty() ? n : s.force.size(), s.torque.empty() ? n : s.torque.size()})
    if (size != n) f.fail("/state/particles", "columns of different length, expected " + std::to_string(n) + " rows");
  read_columns(f, "/state/pairs/", s.pairs, pair_columns);
  read_columns(f, "/state/walls/", s.wall_pairs, wall_pair_columns);
  read_columns(f, "/state/excursions/", s.excursions, excursion_columns);
  if (f.exists("/state/layout")) {
    Layout& layout = s.layout;
    if (f.has_attribute("/state/layout", "chunk_rows")) layout.chunk_rows = f.attribute<std::uint64_t>("/state/layout", "chunk_rows");
    layout.listed_step = f.attribute<std::uint64_t>("/state/layout", "listed_step");
    layout.skin = f.attribute<double>("/state/layout", "skin");
    layout.odometer = f.attribute<double>("/state/layout", "odometer");
    layout.next_look = f.attribute<double>("/state/layout", "next_look");
    read_arrays(f, "/state/layout/", layout, layout_arrays);
    // Programs up to 2026-11 built their lists with half the skin for each grain.
    layout.reach = f.exists("/state/layout/reach") ? f.read<double>("/state/layout/reach") : std::vector<double>(p.size(), 0.5 * layout.skin);
    if (f.exists("/state/layout/levels")) {
      layout.foresight = f.attribute<double>("/state/layout/levels", "foresight");
      read_arrays(f, "/state/layout/levels/", layout, level_arrays);
      // Files of before have none: then each is looked at.
      const auto quiet = [&](const std::string& path, std::size_t count) {
        return f.exists(path) ? f.read<std::uint32_t>(path) : std::vector<std::uint32_t>(count, 0);
      };
      layout.block_quiet = quiet("/state/layout/levels/block_quiet", layout.block_level.size());
      layout.wall_quiet = quiet("/state/layout/levels/wall_quiet", layout.wall_level.size());
    }
  }
  if (!f.exists("/state/ledger")) return s;
  dem::State::Ledger& l = s.ledger;
  for (const auto& [name, member] : spent_columns) l.spent.*member = f.attribute<double>("/state/ledger", name);
  l.initial = f.attribute<double>("/state/ledger", "initial");
  l.wall_work = f.read<double>("/state/ledger/wall_work");
  l.last_power = f.read<double>("/state/ledger/last_power");
  read_columns(f, "/state/ledger/pairs/", l.pairs, last_columns);
  read_columns(f, "/state/ledger/walls/", l.wall_pairs, last_columns);
  return s;
}

// Where a column of the series stands that is not in the snapshot file yet.
std::string pending_path(const jam::schema::Item& item, std::size_t wall) {
  return "/pending" + jam::schema::path_of(item, std::to_string(wall)).substr(std::strlen("/series"));
}

void write_series(jam::h5::File& f, const jam::Series& s) {
  const auto write = [&](const jam::schema::Item& item, const auto& values, std::size_t wall) {
    f.write(pending_path(item, wall), values, std::string(item.unit), std::string(item.doc));
  };
  jam::schema::visit_series(s, [&](const auto& item, const auto& values) { write(item, values, 0); });
  f.set_attribute("/pending", "walls", std::uint32_t(s.walls.size()));
  for (std::size_t w = 0; w < s.walls.size(); ++w)
    jam::schema::visit_wall_series(s.walls[w], [&](const auto& item, const auto& values) { write(item, values, w); });
  jam::schema::visit_excursions(s.excursions, [&](const auto& item, const auto& values) {
    f.write("/pending" + std::string(item.path), values, std::string(item.unit), std::string(item.doc));
  });
}

jam::Series read_series(const jam::h5::File& f) {
  jam::Series s;
  const auto read = [&]<class V>(const jam::schema::Item& item, std::vector<V>& values, std::size_t wall) {
    values = f.read<V>(pending_path(item, wall));
  };
  jam::schema::visit_series(s, [&](const auto& item, auto& values) { read(item, values, 0); });
  const auto walls = f.attribute<std::uint32_t>("/pending", "walls");
  if (walls > 255) f.fail("/pending", "claims " + std::to_string(walls) + " walls, expected at most 255");
  s.walls.resize(walls);
  for (std::size_t w = 0; w < walls; ++w)
    jam::schema::visit_wall_series(s.walls[w], [&](const auto& item, auto& values) { read(item, values, w); });
  jam::schema::visit_excursions(s.excursions, [&]<class V>(const auto& item, std::vector<V>& values) {
    values = f.read<V>("/pending" + std::string(item.path));
  });
  return s;
}

// The numbers of a report with the names of their attributes, for writing and for reading.
template <class Report, class Visit>
void for_each_number(Report& r, Visit visit) {
  visit("solid_fraction", r.solid_fraction);
  visit("coordination", r.coordination);
  visit("mechanical_coordination", r.mechanical_coordination);
  visit("top_m", r.top);
  visit("probe_interval_s", r.probe_interval);
  visit("largest_displacement_m", r.largest_displacement);
  visit("free_fall_m", r.free_fall);
  visit("kinetic_energy_J", r.kinetic_energy);
  visit("rest_scale_J", r.rest_scale);
  visit("grain_steps", r.grain_steps);
}

void mark(jam::h5::File& f, const char* format, const std::string& key) {
  f.set_attribute("/", "format", format);
  f.set_attribute("/", "state_version", state_version);
  f.set_attribute("/", "key", key);
}

// Is this file what its name says? Returns its key.
std::string check_mark(const jam::h5::File& f, const char* format) {
  if (!f.has_attribute("/", "format") || f.attribute<std::string>("/", "format") != format)
    f.fail("/", std::string("is not a ") + format + " file");
  const auto version = f.attribute<std::uint32_t>("/", "state_version");
  if (version != state_version)
    f.fail("/", "has state version " + std::to_string(version) + ", expected " + std::to_string(state_version));
  return f.attribute<std::string>("/", "key");
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  jam::h5::write_aside(path, [&](jam::h5::File& f) {
    mark(f, checkpoint_format, checkpoint.case_sha256);
    write_state(f, checkpoint.state);
    write_series(f, checkpoint.pending);
  });
}

Checkpoint read_checkpoint(const std::string& path) {
  const jam::h5::File f = jam::h5::File::open(path);
  Checkpoint checkpoint;
  checkpoint.case_sha256 = check_mark(f, checkpoint_format);
  checkpoint.state = read_state(f);
  checkpoint.pending = read_series(f);
  return checkpoint;
}

namespace {

// f(number) for everything that a shape is made of.
template <class F>
void visit_vector(const Vec3& v, F&& f) {
  for (const double x : v) f(x);
}
template <class F>
void visit_numbers(const dem::Plane& s, F&& f) {
  visit_vector(s.point, f);
  visit_vector(s.normal, f);
}
template <class F>
void visit_numbers(const dem::Cylinder& s, F&& f) {
  visit_vector(s.point, f);
  visit_vector(s.axis, f);
  for (const double x : {s.radius, s.low, s.high, double(s.free)}) f(x);
}
template <class F>
void visit_numbers(const dem::Cone& s, F&& f) {
  visit_vector(s.point, f);
  visit_vector(s.axis, f);
  for (const double x : {s.low_radius, s.high_radius, s.length, double(s.free)}) f(x);
}
template <class F>
void visit_numbers(const dem::Disc& s, F&& f) {
  visit_vector(s.point, f);
  visit_vector(s.normal, f);
  for (const double x : {s.radius, s.hole_radius}) f(x);
}
template <class F>
void visit_numbers(const dem::GluedGrains& s, F&& f) {
  for (const Vec3& centre : s.spheres->centres()) visit_vector(centre, f);
  for (const double radius : s.spheres->radii()) f(radius);
}
template <class F>
void visit_numbers(const dem::MeshWall& s, F&& f) {
  for (const Vec3& v : s.finder->mesh().vertices) visit_vector(v, f);
  for (const auto& t : s.finder->mesh().triangles)
    for (const std::uint32_t v : t) f(double(v));
}

}  // namespace

std::string bed_key(const dem::Setup& setup, const dem::Bed& bed, const dem::BedRegion& region) {
  std::string bytes = "bed recipe " + std::to_string(dem::bed_recipe) + ";";
  const auto number = [&bytes](double x) {
    char raw[sizeof x];
    std::memcpy(raw, &x, sizeof x);
    bytes.append(raw, sizeof x);
  };
  const auto vector = [&](const Vec3& v) {
    for (const double x : v) number(x);
  };
  for (const dem::Material& m : setup.materials)
    for (const double x : {m.density, m.young, m.poisson}) number(x);
  for (const auto& row : setup.interactions)
    for (const dem::Interaction& i : row)
      for (const double x : {i.restitution, i.friction, i.rolling_friction, i.work_of_adhesion, i.rolling_damping}) number(x);
  for (const dem::Wall& w : setup.walls) {
    number(double(w.material));
    // A bed settles with all walls where they are at the start.
    const dem::WallPose pose = dem::pose_at(w.motion, 0);
    vector(pose.position);
    for (const double x : pose.orientation.coeffs()) number(x);
    number(double(w.shape.index()));
    std::visit([&](const auto& shape) { visit_numbers(shape, number); }, w.shape);
  }
  vector(setup.gravity);
  for (const double x : {bed.mean_diameter, bed.size_low, bed.size_high, bed.depth}) number(x);
  number(double(region.index()));
  if (const auto* circle = std::get_if<dem::CylinderRegion>(&region)) number(circle->radius);
  if (const auto* box = std::get_if<dem::BoxRegion>(&region))
    for (const double x : {box->x_low, box->x_high, box->y_low, box->y_high}) number(x);
  bytes += bed.material + (bed.sizes == dem::Bed::Sizes::by_mass ? ";by mass;" : ";by number;") +
           std::to_string(bed.seed) + ";law";
  const dem::LawChoice& law = setup.law;
  for (const std::uint8_t row : {law.normal, law.damping, law.friction, law.tangential, law.rolling}) number(row);
  number(double(setup.wall_curvature));
  return sha256_hex(bytes);
}

void write_bed(const std::string& path, const dem::SettledBed& bed, const std::string& key) {
  std::error_code ignored;  // write_aside says what is wrong with the folder
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  jam::h5::write_aside(path, [&](jam::h5::File& f) {
    mark(f, bed_format, key);
    const dem::BedReport& r = bed.report;
    for_each_number(r, [&f](const char* name, const double& value) { f.set_attribute("/", name, value); });
    f.set_attribute("/", "rattlers", std::uint64_t(r.rattlers));
    f.set_attribute("/", "unsupported", std::uint64_t(r.unsupported));
    write_state(f, bed.state);
  });
}

std::optional<dem::SettledBed> read_bed(const std::string& path, const std::string& key) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const jam::h5::File f = jam::h5::File::open(path);
  if (check_mark(f, bed_format) != key) f.fail("/", "holds another bed than its name says");
  dem::SettledBed bed;
  bed.state = read_state(f);
  dem::BedReport& r = bed.report;
  r.grains = bed.state.particles.size();
  r.overlaps = dem::overlaps_of(bed.state);
  for_each_number(r, [&f](const char* name, double& value) { value = f.attribute<double>("/", name); });
  r.rattlers = f.attribute<std::uint64_t>("/", "rattlers");
  r.unsupported = f.attribute<std::uint64_t>("/", "unsupported");
  return bed;
}

std::string default_bed_cache() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return std::string(cache) + "/jamscope/beds";
  if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + "/.cache/jamscope/beds";
  return {};
}

}  // namespace jamscope
