#include "apps/jamscope/simulation_view.hpp"

#include <algorithm>
#include <numeric>

#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/sha256.hpp"
#include "apps/jamscope/version.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jamscope {
namespace {

jam::WallRole role_of(dem::WallRole role) {
  switch (role) {
    case dem::WallRole::blade:
      return jam::WallRole::blade;
    case dem::WallRole::vessel:
      return jam::WallRole::vessel;
    case dem::WallRole::other:
      break;
  }
  return jam::WallRole::other;
}

// The shape as the snapshot file has it.
std::string text_of(dem::FreeSide free) { return free == dem::FreeSide::inside ? "inside" : "outside"; }

void describe(const dem::Plane& plane, jam::Wall& info) {
  info.kind = "plane";
  info.point = plane.point;
  info.axis = plane.normal;
}
void describe(const dem::Cylinder& cylinder, jam::Wall& info) {
  info.kind = "cylinder";
  info.point = cylinder.point;
  info.axis = cylinder.axis;
  info.radius = cylinder.radius;
  info.free_side = text_of(cylinder.free);
  info.low = cylinder.low;
  info.high = cylinder.high;
}
void describe(const dem::Cone& cone, jam::Wall& info) {
  info.kind = "cone";
  info.point = cone.point;
  info.axis = cone.axis;
  info.radius = cone.low_radius;
  info.high_radius = cone.high_radius;
  info.free_side = text_of(cone.free);
  info.low = 0;
  info.high = cone.length;
}
void describe(const dem::Disc& disc, jam::Wall& info) {
  info.kind = "disc";
  info.point = disc.point;
  info.axis = disc.normal;
  info.radius = disc.radius;
  info.hole_radius = disc.hole_radius;
}
void describe(const dem::GluedGrains& glued, jam::Wall& info) {
  info.kind = "spheres";
  info.sphere_centre.assign(glued.spheres->centres().begin(), glued.spheres->centres().end());
  info.sphere_radius.assign(glued.spheres->radii().begin(), glued.spheres->radii().end());
}
void describe(const dem::MeshWall& wall, jam::Wall& info) {
  info.kind = "mesh";
  const dem::TriangleMesh& mesh = wall.finder->mesh();
  info.vertices = mesh.vertices;
  info.triangles = mesh.triangles;
  for (const dem::FacetLabel label : mesh.labels) info.triangle_label.push_back(std::uint8_t(label));
}

jam::Wall wall_info(const dem::Wall& wall, jam::WallRole role, const std::string& material) {
  jam::Wall info;
  info.name = wall.name;
  info.role = role;
  info.material = material;
  std::visit([&](const auto& shape) { describe(shape, info); }, wall.shape);
  return info;
}

std::uint8_t contact_flags(bool sliding, double overlap) {
  return std::uint8_t((sliding ? jam::contact_sliding : 0) | (overlap < 0 ? jam::contact_neck : 0));
}

jam::Vec3f single(const dem::Vec3& v) { return v.cast<float>(); }

std::array<double, 12> by_label(const dem::Window::Load& load, dem::Vec3 dem::WallLoad::*member) {
  std::array<double, 12> row{};
  for (std::size_t l = 0; l < dem::facet_labels; ++l)
    for (std::size_t k = 0; k < 3; ++k) row[3 * l + k] = (load.of_label[l].*member)[Eigen::Index(k)];
  return row;
}

void append(jam::Excursions& rows, const dem::Excursion& e, bool open) {
  rows.particle.push_back(e.id);
  rows.first_step.push_back(e.first_step);
  rows.last_step.push_back(e.last_step);
  rows.peak_step.push_back(e.peak_step);
  rows.peak_force.push_back(float(e.peak_force));
  rows.impulse.push_back(float(e.impulse));
  rows.work.push_back(float(e.work));
  rows.path.push_back(float(e.path));
  rows.turned.push_back(float(e.turned));
  rows.first_position.push_back(single(e.first_position));
  rows.peak_position.push_back(single(e.peak_position));
  rows.last_position.push_back(single(e.last_position));
  rows.open.push_back(open ? 1 : 0);
}

void append(jam::Series::Energy& e, const dem::Ledger& l) {
  e.kinetic.push_back(l.kinetic);
  e.rotational.push_back(l.rotational);
  e.gravitational.push_back(l.gravitational);
  e.elastic.push_back(l.stored.normal - l.stored.surface);
  e.adhesive.push_back(l.stored.surface);
  e.tangential.push_back(l.stored.tangential);
  e.rolling.push_back(l.stored.rolling);
  e.normal_damping.push_back(l.spent.normal_damping);
  e.tangential_damping.push_back(l.spent.tangential_damping);
  e.sliding.push_back(l.spent.sliding);
  e.rolling_resistance.push_back(l.spent.rolling);
  e.detachment.push_back(l.spent.detachment);
  e.stiffness_change.push_back(l.spent.stiffness_change);
  e.time_stepping.push_back(l.spent.time_stepping);
  e.residual.push_back(l.residual());
}

}  // namespace

std::string wall_kind(const dem::WallShape& shape) {
  jam::Wall info;
  std::visit([&](const auto& s) { describe(s, info); }, shape);
  return info.kind;
}

Watched watched(const CaseFile& file) {
  const jam::Criteria& criteria = file.criteria;
  if (jam::criterion_of(criteria).unit == "N") return {criteria.end_force.value_or(criteria.jam_force), 0};
  const dem::Material& m = file.physics.materials[dem::material_index(file.physics, file.physics.bed.material)];
  const double radius = file.physics.bed.mean_diameter / 2;
  return {jam::threshold_of(criteria) * jam::hertz_scale({m.name, m.density, m.young, m.poisson}, radius), radius};
}

jam::RunInfo run_info(const CaseFile& file, const dem::Scene& scene, const std::vector<std::string>& argv) {
  const dem::Setup& setup = scene.setup;
  jam::RunInfo info;
  info.creator = "jamscope";
  info.creator_version = version;
  info.commit = commit;
  info.created_utc = utc_now();
  info.case_toml = file.text;
  info.case_sha256 = sha256_hex(file.text);
  info.argv = argv;
  info.seed = file.physics.bed.seed;
  info.gravity = setup.gravity;
  info.dt = setup.step;
  for (const dem::Material& m : setup.materials) info.materials.push_back({m.name, m.density, m.young, m.poisson});
  for (const auto& row : setup.interactions) {
    info.interactions.emplace_back();
    for (const dem::Interaction& i : row)
      info.interactions.back().push_back({i.restitution, i.friction, i.rolling_friction, i.work_of_adhesion});
  }
  for (std::size_t w = 0; w < setup.walls.size(); ++w)
    info.walls.push_back(wall_info(setup.walls[w], role_of(scene.roles[w]), setup.materials[setup.walls[w].material].name));
  info.watch_force = watched(file).force;
  info.watch_radius = watched(file).radius;
  info.watch_stride = std::uint64_t{1} << file.physics.levels;
  if (const auto& gap = scene.gap) info.gap = {gap->tip_radius, gap->vessel_radius, gap->blade_low, gap->blade_high};
  return info;
}

jam::Snapshot snapshot(const dem::View& view) {
  jam::Snapshot s;
  s.time = view.time;
  s.step = view.step;
  jam::Particles& p = s.particles;
  p.id = view.id;
  p.material = view.material;
  p.radius.assign(view.radius.begin(), view.radius.end());
  p.compressive_force.assign(view.compressive_force.begin(), view.compressive_force.end());
  for (std::size_t i = 0; i < view.id.size(); ++i) {
    p.position.push_back(single(view.position[i]));
    p.velocity.push_back(single(view.velocity[i]));
    p.angular_velocity.push_back(single(view.angular_velocity[i]));
  }
  for (const dem::PairRecord& c : view.pairs) {
    s.pp.row.push_back({c.i, c.j});
    s.pp.normal_force.push_back(float(c.elastic));
    s.pp.damping_force.push_back(float(c.damping));
    s.pp.tangential_force.push_back(single(c.tangential));
    s.pp.overlap.push_back(float(c.overlap));
    s.pp.birth_step.push_back(c.birth_step);
    s.pp.flags.push_back(contact_flags(c.sliding, c.overlap));
  }
  std::vector<std::size_t> order(view.wall_pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const dem::WallRecord &x = view.wall_pairs[a], &y = view.wall_pairs[b];
    return std::tie(x.i, x.wall, x.facet) < std::tie(y.i, y.wall, y.facet);
  });
  for (const std::size_t k : order) {
    const dem::WallRecord& c = view.wall_pairs[k];
    s.pw.row.push_back(c.i);
    s.pw.wall.push_back(std::uint8_t(c.wall));
    s.pw.facet.push_back(c.facet);
    s.pw.feature.push_back(std::uint8_t(c.feature));
    s.pw.point.push_back(single(c.point));
    s.pw.normal.push_back(single(c.normal));
    s.pw.normal_force.push_back(float(c.elastic));
    s.pw.damping_force.push_back(float(c.damping));
    s.pw.tangential_force.push_back(single(c.tangential));
    s.pw.overlap.push_back(float(c.overlap));
    s.pw.birth_step.push_back(c.birth_step);
    s.pw.flags.push_back(contact_flags(c.sliding, c.overlap));
  }
  for (const dem::WallInstant& w : view.walls)
    s.walls.push_back({w.pose.position, w.pose.orientation, w.pose.velocity, w.pose.angular_velocity, w.force, w.torque});
  return s;
}

void append_open(jam::Series& series, const std::vector<dem::Excursion>& excursions) {
  if (series.excursion_count.empty()) return;
  series.excursion_count.back() += std::uint32_t(excursions.size());
  for (const dem::Excursion& e : excursions) append(series.excursions, e, true);
}

void append(jam::Series& series, const dem::Window& window) {
  series.time.push_back(window.time);
  series.step.push_back(window.last_step);
  series.largest_compressive_force.push_back(float(window.largest_compressive_force));
  series.jammed_count.push_back(window.most_watched);
  series.kinetic_energy.push_back(window.kinetic_energy);
  series.largest_overlap.push_back(window.largest_overlap);
  series.ended_pp.push_back(window.ended_pairs.count);
  series.ended_pw.push_back(window.ended_wall_pairs.count);
  series.excursion_count.push_back(std::uint32_t(window.excursions.size()));
  for (const dem::Excursion& e : window.excursions) append(series.excursions, e, false);
  series.walls.resize(window.walls.size());
  for (std::size_t w = 0; w < window.walls.size(); ++w) {
    const dem::Window::Load& load = window.walls[w];
    jam::Series::WallSeries& wall = series.walls[w];
    wall.force.push_back(load.force);
    wall.torque.push_back(load.torque);
    wall.force_min.push_back(load.force_min);
    wall.force_max.push_back(load.force_max);
    wall.torque_min.push_back(load.torque_min);
    wall.torque_max.push_back(load.torque_max);
    wall.power.push_back(load.power);
    if (window.is_mesh[w]) {
      wall.label_force.push_back(by_label(load, &dem::WallLoad::force));
      wall.label_torque.push_back(by_label(load, &dem::WallLoad::torque));
    }
    if (window.ledger) wall.work.push_back(window.ledger->wall_work[w]);
  }
  if (window.ledger) append(series.energy, *window.ledger);
}

}  // namespace jamscope
