#include "apps/jamscope/checkpoint.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "apps/jamscope/sha256.hpp"
#include "libjam/errors.hpp"
#include "libjam/snapshot/hdf5.hpp"

namespace jamscope {
namespace {

using Vec3 = dem::Vec3;
constexpr const char* checkpoint_format = "jamscope-checkpoint";
constexpr const char* bed_format = "jamscope-bed";
constexpr std::uint32_t state_version = 1;

// One column of a table of structs.
template <class Row, class Get>
auto column(const std::vector<Row>& rows, Get get) {
  std::vector<std::decay_t<decltype(get(rows[0]))>> values;
  values.reserve(rows.size());
  for (const Row& row : rows) values.push_back(get(row));
  return values;
}

void write_state(jam::h5::File& f, const dem::State& s) {
  f.make_group("/state");
  f.set_attribute("/state", "step", s.step);
  const dem::Particles& p = s.particles;
  f.write("/state/particles/id", p.id, "1", "persistent id");
  f.write("/state/particles/material", p.material, "1", "index of the material");
  f.write("/state/particles/radius", p.radius, "m", "radius");
  f.write("/state/particles/position", p.position, "m", "centre");
  f.write("/state/particles/velocity", p.velocity, "m/s", "velocity, half a step before the positions");
  f.write("/state/particles/angular_velocity", p.angular_velocity, "rad/s", "angular velocity, likewise");
  f.write("/state/particles/force", s.force, "N", "sum of forces; empty before the first step");
  f.write("/state/particles/torque", s.torque, "N m", "sum of torques; empty before the first step");
  f.write("/state/pairs/i", column(s.pairs, [](const auto& c) { return c.i; }), "1", "row of the first grain");
  f.write("/state/pairs/j", column(s.pairs, [](const auto& c) { return c.j; }), "1", "row of the second grain");
  f.write("/state/pairs/spring", column(s.pairs, [](const auto& c) { return c.spring; }), "m", "tangential spring");
  f.write("/state/pairs/birth_step", column(s.pairs, [](const auto& c) { return c.birth_step; }), "1", "step of forming");
  const auto& w = s.wall_pairs;
  f.write("/state/walls/i", column(w, [](const auto& c) { return c.i; }), "1", "row of the grain");
  f.write("/state/walls/wall", column(w, [](const auto& c) { return c.wall; }), "1", "index of the wall");
  f.write("/state/walls/feature", column(w, [](const auto& c) { return c.feature; }), "1", "touched part of the wall");
  f.write("/state/walls/normal", column(w, [](const auto& c) { return c.normal; }), "1", "from the grain to the wall");
  f.write("/state/walls/spring", column(w, [](const auto& c) { return c.spring; }), "m", "tangential spring");
  f.write("/state/walls/birth_step", column(w, [](const auto& c) { return c.birth_step; }), "1", "step of forming");
}

dem::State read_state(const jam::h5::File& f) {
  dem::State s;
  s.step = f.attribute<std::uint64_t>("/state", "step");
  dem::Particles& p = s.particles;
  p.id = f.read<std::uint32_t>("/state/particles/id");
  p.material = f.read<std::uint8_t>("/state/particles/material");
  p.radius = f.read<double>("/state/particles/radius");
  p.position = f.read<Vec3>("/state/particles/position");
  p.velocity = f.read<Vec3>("/state/particles/velocity");
  p.angular_velocity = f.read<Vec3>("/state/particles/angular_velocity");
  s.force = f.read<Vec3>("/state/particles/force");
  s.torque = f.read<Vec3>("/state/particles/torque");
  const std::size_t n = p.size();
  for (const std::size_t size : {p.material.size(), p.radius.size(), p.position.size(), p.velocity.size(),
                                 p.angular_velocity.size(), s.force.empty() ? n : s.force.size(), s.torque.empty() ? n : s.torque.size()})
    if (size != n) f.fail("/state/particles", "columns of different length, expected " + std::to_string(n) + " rows");
  const auto i = f.read<std::uint32_t>("/state/pairs/i"), j = f.read<std::uint32_t>("/state/pairs/j");
  const auto spring = f.read<Vec3>("/state/pairs/spring");
  const auto birth = f.read<std::uint64_t>("/state/pairs/birth_step");
  if (j.size() != i.size() || spring.size() != i.size() || birth.size() != i.size())
    f.fail("/state/pairs", "columns of different length");
  for (std::size_t k = 0; k < i.size(); ++k) s.pairs.push_back({i[k], j[k], spring[k], birth[k]});
  const auto row = f.read<std::uint32_t>("/state/walls/i"), wall = f.read<std::uint32_t>("/state/walls/wall");
  const auto feature = f.read<std::uint64_t>("/state/walls/feature");
  const auto normal = f.read<Vec3>("/state/walls/normal"), wall_spring = f.read<Vec3>("/state/walls/spring");
  const auto wall_birth = f.read<std::uint64_t>("/state/walls/birth_step");
  const std::size_t m = row.size();
  if (wall.size() != m || feature.size() != m || normal.size() != m || wall_spring.size() != m || wall_birth.size() != m)
    f.fail("/state/walls", "columns of different length");
  for (std::size_t k = 0; k < m; ++k)
    s.wall_pairs.push_back({row[k], wall[k], feature[k], normal[k], wall_spring[k], wall_birth[k]});
  return s;
}

void write_series(jam::h5::File& f, const jam::Series& s) {
  f.write("/pending/time", s.time, "s", "end of the window");
  f.write("/pending/step", s.step, "1", "end of the window");
  f.write("/pending/largest_compressive_force", s.largest_compressive_force, "N", "over grains and steps");
  f.write("/pending/jammed_count", s.jammed_count, "1", "largest number above the threshold");
  f.write("/pending/kinetic_energy", s.kinetic_energy, "J", "at the end of the window");
  f.write("/pending/largest_overlap", s.largest_overlap, "1", "over radius");
  f.set_attribute("/pending", "walls", std::uint32_t(s.walls.size()));
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    const std::string group = "/pending/wall" + std::to_string(w) + "/";
    const jam::Series::WallSeries& x = s.walls[w];
    f.write(group + "force", x.force, "N", "mean");
    f.write(group + "torque", x.torque, "N m", "mean");
    f.write(group + "force_min", x.force_min, "N", "least");
    f.write(group + "force_max", x.force_max, "N", "most");
    f.write(group + "torque_min", x.torque_min, "N m", "least");
    f.write(group + "torque_max", x.torque_max, "N m", "most");
    f.write(group + "power", x.power, "W", "mean");
  }
}

jam::Series read_series(const jam::h5::File& f) {
  jam::Series s;
  s.time = f.read<double>("/pending/time");
  s.step = f.read<std::uint64_t>("/pending/step");
  s.largest_compressive_force = f.read<float>("/pending/largest_compressive_force");
  s.jammed_count = f.read<std::uint32_t>("/pending/jammed_count");
  s.kinetic_energy = f.read<double>("/pending/kinetic_energy");
  s.largest_overlap = f.read<double>("/pending/largest_overlap");
  const auto walls = f.attribute<std::uint32_t>("/pending", "walls");
  if (walls > 255) f.fail("/pending", "claims " + std::to_string(walls) + " walls, expected at most 255");
  for (std::uint32_t w = 0; w < walls; ++w) {
    const std::string group = "/pending/wall" + std::to_string(w) + "/";
    jam::Series::WallSeries x;
    x.force = f.read<Vec3>(group + "force");
    x.torque = f.read<Vec3>(group + "torque");
    x.force_min = f.read<Vec3>(group + "force_min");
    x.force_max = f.read<Vec3>(group + "force_max");
    x.torque_min = f.read<Vec3>(group + "torque_min");
    x.torque_max = f.read<Vec3>(group + "torque_max");
    x.power = f.read<double>(group + "power");
    s.walls.push_back(std::move(x));
  }
  return s;
}

// The numbers of a report with the names of their attributes, for writing and for reading.
template <class Report, class Visit>
void for_each_number(Report& r, Visit visit) {
  visit("solid_fraction", r.solid_fraction);
  visit("coordination", r.coordination);
  visit("mechanical_coordination", r.mechanical_coordination);
  visit("largest_overlap", r.largest_overlap);
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
      for (const double x : {i.restitution, i.friction, i.rolling_friction, i.work_of_adhesion}) number(x);
  for (const dem::Wall& w : setup.walls) {
    number(double(w.material));
    vector(w.motion.start);
    number(double(w.shape.index()));
    if (const auto* plane = std::get_if<dem::Plane>(&w.shape)) {
      vector(plane->point);
      vector(plane->normal);
    }
    if (const auto* cylinder = std::get_if<dem::CylinderInside>(&w.shape)) {
      vector(cylinder->point);
      vector(cylinder->axis);
      number(cylinder->radius);
    }
    if (const auto* mesh = std::get_if<dem::MeshWall>(&w.shape)) {
      for (const Vec3& v : mesh->finder->mesh().vertices) vector(v);
      for (const auto& t : mesh->finder->mesh().triangles)
        for (const std::uint32_t v : t) number(v);
    }
  }
  vector(setup.gravity);
  for (const double x : {bed.mean_diameter, bed.size_low, bed.size_high, bed.depth}) number(x);
  number(double(region.index()));
  if (const auto* circle = std::get_if<dem::CylinderRegion>(&region)) number(circle->radius);
  if (const auto* box = std::get_if<dem::BoxRegion>(&region))
    for (const double x : {box->x_low, box->x_high, box->y_low, box->y_high}) number(x);
  bytes += bed.material + (bed.sizes == dem::Bed::Sizes::by_mass ? ";by mass;" : ";by number;") +
           std::to_string(bed.seed) + ";law " + std::to_string(setup.law);
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
