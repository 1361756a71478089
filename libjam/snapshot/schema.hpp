// The snapshot file, schema 1.2, as one table. Writer, reader, validation, inspection and SCHEMA.md all follow it.
// SCHEMA.md says in prose what the table cannot: the append protocol, the checksum, the compatibility rule.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam::schema {

inline constexpr std::string_view format = "jamscope-snapshots";
inline constexpr std::array<std::uint32_t, 2> version{1, 2};  // a larger second number only adds optional items

// What the rows of an item are.
enum class Axis : std::uint8_t {
  attribute,    // of the file, a group or a wall
  text,         // one text
  argument,     // A words of the command line
  material,     // M materials
  interaction,  // M x M pairs of materials
  vertex,       // V mesh vertices of a wall
  triangle,     // F mesh triangles of a wall
  sphere,       // G glued spheres of a wall
  frame,        // T frames
  particle,     // P rows, a frame's are [particle_start, particle_start + particle_count)
  pp,           // C rows, a frame's are [pp_start, pp_start + pp_count)
  pw,           // W rows, a frame's are [pw_start, pw_start + pw_count)
  series,       // S windows of steps, complete up to frame f are the first series_count[f]
  excursion,    // E stays of particles above a force, those of the windows one after the other
};

enum class Need : std::uint8_t { required, optional };

struct Item {
  std::string_view path;  // '*' stands for a wall's name; an attribute's name follows '@'
  h5::Type type;
  unsigned width;  // components per row
  Axis axis;
  Need need;
  std::string_view unit;
  std::string_view doc;
};

// A new quantity is one row here, one member in snapshot.hpp, one line in the visitor of its axis below, and its line
// in SCHEMA.md. A row that is added later must be optional and raises version[1].
using enum Axis;
using enum Need;
using T = h5::Type;
inline constexpr Item table[] = {
    {"/@format", T::text, 1, attribute, required, "1", "always 'jamscope-snapshots'"},
    {"/@schema_version", T::u4, 2, attribute, required, "1", "major, minor"},
    {"/@creator", T::text, 1, attribute, optional, "1", "program that computed the run"},
    {"/@creator_version", T::text, 1, attribute, optional, "1", "its version"},
    {"/@commit", T::text, 1, attribute, optional, "1", "its source revision"},
    {"/@created_utc", T::text, 1, attribute, optional, "1", "start of the run, ISO 8601"},
    {"/@case_sha256", T::text, 1, attribute, optional, "1", "SHA-256 of /case/toml, hexadecimal"},
    {"/@seed", T::u8, 1, attribute, required, "1", "seed of every random choice"},
    {"/@gravity", T::f8, 3, attribute, required, "m/s^2", "gravitational acceleration"},
    {"/@dt", T::f8, 1, attribute, optional, "s", "time step of the source"},
    {"/run@wall_loads_known", T::u1, 1, attribute, required, "1", "1 if the walls' force and torque were recorded"},
    {"/run@watch_force", T::f8, 1, attribute, optional, "N", "/excursions are stays of particles above it"},
    {"/run@watch_radius", T::f8, 1, attribute, optional, "m", "watch_force is for this radius and goes with its square; absent: the same for all"},
    {"/run@watch_stride", T::u8, 1, attribute, optional, "1", "steps between two looks at the particles; absent: 1"},
    {"/run@gap_tip_radius", T::f8, 1, attribute, optional, "m", "largest distance of the blade from its axis"},
    {"/run@gap_vessel_radius", T::f8, 1, attribute, optional, "m", "inner radius of the vessel"},
    {"/run@gap_z_low", T::f8, 1, attribute, optional, "m", "lower end of the blade, relative to its pose position"},
    {"/run@gap_z_high", T::f8, 1, attribute, optional, "m", "upper end of the blade, relative to its pose position"},
    {"/case/toml", T::text, 1, text, optional, "1", "the exact case file"},
    {"/case/argv", T::text, 1, argument, optional, "1", "command line of the run"},
    {"/materials/name", T::text, 1, material, optional, "1", "name of the material"},
    {"/materials/density", T::f8, 1, material, optional, "kg/m^3", "density"},
    {"/materials/young", T::f8, 1, material, optional, "Pa", "Young's modulus"},
    {"/materials/poisson", T::f8, 1, material, optional, "1", "Poisson's ratio"},
    {"/interactions/restitution", T::f8, 1, interaction, optional, "1", "coefficient of restitution"},
    {"/interactions/friction", T::f8, 1, interaction, optional, "1", "Coulomb friction coefficient"},
    {"/interactions/rolling", T::f8, 1, interaction, optional, "1", "rolling friction coefficient"},
    {"/interactions/work_of_adhesion", T::f8, 1, interaction, optional, "J/m^2", "work of adhesion of the pair"},

    {"/walls/*@id", T::u1, 1, attribute, required, "1", "number of the wall in /contacts/pw/wall"},
    {"/walls/*@kind", T::text, 1, attribute, required, "1", "plane, cylinder, cone, disc, spheres or mesh"},
    {"/walls/*@role", T::text, 1, attribute, required, "1", "blade, vessel or other"},
    {"/walls/*@material", T::text, 1, attribute, optional, "1", "name in /materials/name"},
    {"/walls/*@torque_origin", T::text, 1, attribute, required, "1", "always 'pose_position'"},
    {"/walls/*@point", T::f8, 3, attribute, optional, "m",
     "plane: a point of it; cylinder, cone: a point of its axis; disc: its centre"},
    {"/walls/*@axis", T::f8, 3, attribute, optional, "1",
     "plane: unit normal into the free side; cylinder, cone: its axis; disc: its normal"},
    {"/walls/*@radius", T::f8, 1, attribute, optional, "m", "cylinder, disc: radius; cone: radius at low"},
    {"/walls/*@high_radius", T::f8, 1, attribute, optional, "m", "cone: radius at high"},
    {"/walls/*@hole_radius", T::f8, 1, attribute, optional, "m", "disc: radius of its hole; absent: no hole"},
    {"/walls/*@low", T::f8, 1, attribute, optional, "m",
     "cylinder, cone: lower end along the axis from point; absent: endless"},
    {"/walls/*@high", T::f8, 1, attribute, optional, "m",
     "cylinder, cone: upper end along the axis from point; absent: endless"},
    {"/walls/*@free_side", T::text, 1, attribute, optional, "1", "cylinder, cone: inside or outside"},
    {"/walls/*/sphere_centre", T::f8, 3, sphere, optional, "m", "centres of glued spheres in the body frame"},
    {"/walls/*/sphere_radius", T::f8, 1, sphere, optional, "m", "radii of glued spheres"},
    {"/walls/*/vertices", T::f8, 3, vertex, optional, "m", "mesh vertices in the body frame"},
    {"/walls/*/triangles", T::u4, 3, triangle, optional, "1", "rows of vertices, counter-clockwise from outside"},
    {"/walls/*/triangle_label", T::u1, 1, triangle, optional, "1", "0 face, 1 edge, 2 tip, 3 hub"},
    {"/walls/*/pose_position", T::f8, 3, frame, required, "m", "origin of the body frame"},
    {"/walls/*/pose_quaternion", T::f8, 4, frame, required, "1", "w, x, y, z: body frame to laboratory frame"},
    {"/walls/*/velocity", T::f8, 3, frame, required, "m/s", "velocity of the body frame's origin"},
    {"/walls/*/angular_velocity", T::f8, 3, frame, required, "rad/s", "angular velocity"},
    {"/walls/*/force", T::f8, 3, frame, optional, "N", "force on the wall"},
    {"/walls/*/torque", T::f8, 3, frame, optional, "N m", "torque on the wall about pose_position"},

    {"/frames/time", T::f8, 1, frame, required, "s", "simulated time, strictly increasing"},
    {"/frames/step", T::u8, 1, frame, required, "1", "step of the source, strictly increasing"},
    {"/frames/particle_start", T::u8, 1, frame, required, "1", "first row of the frame in /particles"},
    {"/frames/particle_count", T::u4, 1, frame, required, "1", "rows of the frame in /particles"},
    {"/frames/pp_start", T::u8, 1, frame, required, "1", "first row of the frame in /contacts/pp"},
    {"/frames/pp_count", T::u4, 1, frame, required, "1", "rows of the frame in /contacts/pp"},
    {"/frames/pw_start", T::u8, 1, frame, required, "1", "first row of the frame in /contacts/pw"},
    {"/frames/pw_count", T::u4, 1, frame, required, "1", "rows of the frame in /contacts/pw"},
    {"/frames/series_count", T::u8, 1, frame, required, "1", "rows of /series written up to and with this frame"},
    {"/frames/commit", T::u4, 1, frame, required, "1", "CRC-32C of the frame, written last: its length counts frames"},

    {"/particles/id", T::u4, 1, particle, required, "1", "persistent number, ascending in a frame"},
    {"/particles/position", T::f4, 3, particle, required, "m", "centre"},
    {"/particles/velocity", T::f4, 3, particle, optional, "m/s", "velocity of the centre"},
    {"/particles/angular_velocity", T::f4, 3, particle, optional, "rad/s", "angular velocity"},
    {"/particles/radius", T::f4, 1, particle, required, "m", "radius"},
    {"/particles/material", T::u1, 1, particle, optional, "1", "row of /materials"},
    {"/particles/compressive_force", T::f4, 1, particle, optional, "N",
     "sum of the repulsive normal forces of all contacts, walls included"},

    {"/contacts/pp/row", T::u4, 2, pp, required, "1",
     "rows of the two particles, counted from particle_start; first < second, sorted"},
    {"/contacts/pp/normal_force", T::f4, 1, pp, required, "N",
     "elastic and adhesive, > 0 repulsive; with damping where damping_force is absent"},
    {"/contacts/pp/damping_force", T::f4, 1, pp, optional, "N", "dissipative part along the normal, > 0 pushes apart"},
    {"/contacts/pp/tangential_force", T::f4, 3, pp, optional, "N", "on the first particle"},
    {"/contacts/pp/overlap", T::f4, 1, pp, optional, "m", "> 0 in contact, < 0 in an adhesive neck"},
    {"/contacts/pp/birth_step", T::u8, 1, pp, optional, "1", "step in which the contact formed"},
    {"/contacts/pp/flags", T::u1, 1, pp, optional, "1", "bits: 1 sliding, 2 neck, 4 recovered, 8 merged"},

    {"/contacts/pw/row", T::u4, 1, pw, required, "1", "row of the particle, counted from particle_start"},
    {"/contacts/pw/wall", T::u1, 1, pw, required, "1", "id of the wall; sorted by row, wall, facet"},
    {"/contacts/pw/facet", T::u4, 1, pw, optional, "1", "triangle of a mesh, number of a glued sphere, 0 for other walls"},
    {"/contacts/pw/feature", T::u1, 1, pw, optional, "1", "0 face, 1 edge or rim, 2 vertex was touched"},
    {"/contacts/pw/point", T::f4, 3, pw, optional, "m", "contact point on the wall"},
    {"/contacts/pw/normal", T::f4, 3, pw, optional, "1", "unit vector from the particle to the wall"},
    {"/contacts/pw/normal_force", T::f4, 1, pw, required, "N",
     "elastic and adhesive, > 0 repulsive; with damping where damping_force is absent"},
    {"/contacts/pw/damping_force", T::f4, 1, pw, optional, "N", "dissipative part along the normal, > 0 pushes apart"},
    {"/contacts/pw/tangential_force", T::f4, 3, pw, optional, "N", "on the particle"},
    {"/contacts/pw/overlap", T::f4, 1, pw, optional, "m", "> 0 in contact, < 0 in an adhesive neck"},
    {"/contacts/pw/birth_step", T::u8, 1, pw, optional, "1", "step in which the contact formed"},
    {"/contacts/pw/flags", T::u1, 1, pw, optional, "1", "bits: 1 sliding, 2 neck, 4 recovered, 8 merged"},

    {"/series/time", T::f8, 1, series, optional, "s", "end of the window of steps"},
    {"/series/step", T::u8, 1, series, optional, "1", "last step of the window"},
    {"/series/largest_compressive_force", T::f4, 1, series, optional, "N",
     "over all particles and steps of the window"},
    {"/series/jammed_count", T::u4, 1, series, optional, "1", "most particles above the threshold in one step"},
    {"/series/kinetic_energy", T::f8, 1, series, optional, "J", "at the end of the window"},
    {"/series/largest_overlap", T::f8, 1, series, optional, "1", "overlap over particle radius, over the window"},
    {"/series/ended_pp", T::u4, 32, series, optional, "1",
     "contacts of particles that ended: lasted 2^k <= steps < 2^(k+1), column 31: was there when the run began"},
    {"/series/ended_pw", T::u4, 32, series, optional, "1", "the same of contacts with walls"},
    {"/series/excursion_count", T::u4, 1, series, optional, "1", "rows of /excursions that came with the window"},
    {"/series/energy/kinetic", T::f8, 1, series, optional, "J", "kinetic energy of translation, of the leapfrog scheme"},
    {"/series/energy/rotational", T::f8, 1, series, optional, "J", "kinetic energy of rotation"},
    {"/series/energy/gravitational", T::f8, 1, series, optional, "J", "-m g.x"},
    {"/series/energy/elastic", T::f8, 1, series, optional, "J", "strain energy of the normal contacts"},
    {"/series/energy/adhesive", T::f8, 1, series, optional, "J", "energy of closed surfaces, <= 0"},
    {"/series/energy/tangential", T::f8, 1, series, optional, "J", "in tangential springs"},
    {"/series/energy/rolling", T::f8, 1, series, optional, "J", "in rolling springs"},
    {"/series/energy/normal_damping", T::f8, 1, series, optional, "J", "taken by normal damping since the start"},
    {"/series/energy/tangential_damping", T::f8, 1, series, optional, "J", "taken by tangential damping since the start"},
    {"/series/energy/sliding", T::f8, 1, series, optional, "J", "taken by sliding since the start"},
    {"/series/energy/rolling_resistance", T::f8, 1, series, optional, "J", "taken by rolling resistance since the start"},
    {"/series/energy/detachment", T::f8, 1, series, optional, "J", "lost by forming and breaking contacts since the start"},
    {"/series/energy/stiffness_change", T::f8, 1, series, optional, "J", "gained by tangential springs from their changing stiffness since the start"},
    {"/series/energy/time_stepping", T::f8, 1, series, optional, "J", "lost by the finite time step since the start"},
    {"/series/energy/residual", T::f8, 1, series, optional, "J", "what the ledger does not explain"},
    {"/series/walls/*/force", T::f8, 3, series, optional, "N", "on the wall, mean over the window"},
    {"/series/walls/*/torque", T::f8, 3, series, optional, "N m", "on the wall about its pose position, mean"},
    {"/series/walls/*/force_min", T::f8, 3, series, optional, "N", "smallest per component"},
    {"/series/walls/*/force_max", T::f8, 3, series, optional, "N", "largest per component"},
    {"/series/walls/*/torque_min", T::f8, 3, series, optional, "N m", "smallest per component"},
    {"/series/walls/*/torque_max", T::f8, 3, series, optional, "N m", "largest per component"},
    {"/series/walls/*/power", T::f8, 1, series, optional, "W", "mean power that the wall puts into the grains"},
    {"/series/walls/*/work", T::f8, 1, series, optional, "J", "that the wall put into the grains since the start"},
    {"/series/walls/*/label_force", T::f8, 12, series, optional, "N", "mean force on triangles of label 0, 1, 2, 3"},
    {"/series/walls/*/label_torque", T::f8, 12, series, optional, "N m", "mean torque, likewise"},

    {"/excursions/particle", T::u4, 1, excursion, optional, "1", "id of a particle that stayed above the watched compressive force"},
    {"/excursions/first_step", T::u8, 1, excursion, optional, "1", "first step above"},
    {"/excursions/last_step", T::u8, 1, excursion, optional, "1", "last step above"},
    {"/excursions/peak_step", T::u8, 1, excursion, optional, "1", "step of the largest force"},
    {"/excursions/peak_force", T::f4, 1, excursion, optional, "N", "largest compressive force"},
    {"/excursions/impulse", T::f4, 1, excursion, optional, "N s", "integral of the compressive force"},
    {"/excursions/work", T::f4, 1, excursion, optional, "J", "that walls did on the particle at its contacts"},
    {"/excursions/path", T::f4, 1, excursion, optional, "m", "integral of the speed"},
    {"/excursions/turned", T::f4, 1, excursion, optional, "rad", "integral of the angular speed"},
    {"/excursions/first_position", T::f4, 3, excursion, optional, "m", "centre in the first step"},
    {"/excursions/peak_position", T::f4, 3, excursion, optional, "m", "centre in the step of the largest force"},
    {"/excursions/last_position", T::f4, 3, excursion, optional, "m", "centre in the last step"},
    {"/excursions/open", T::u1, 1, excursion, optional, "1",
     "1: had not ended; a later row with the same particle and first_step takes its place"},
};

constexpr const Item& find(std::string_view path) {
  for (const Item& i : table) {
    if (i.path == path) return i;
  }
  throw "no such item in the schema";
}

// The row of the table with this path; does not compile where there is none.
consteval const Item& item(std::string_view path) { return find(path); }

// The same, and does not compile where the table has another type or width than Value.
template <class Value>
consteval const Item& column(std::string_view path) {
  const Item& i = find(path);
  if (i.type != h5::Row<Value>::type || i.width != h5::Row<Value>::width) throw "type differs from the schema";
  return i;
}

// The item's path in a file; `wall` replaces '*'.
std::string path_of(const Item& item, std::string_view wall = {});
// The parts of an attribute's path: the object before '@', the name after it.
std::string object_of(const Item& item, std::string_view wall = {});
std::string attribute_of(const Item& item);

// One row of /frames, without the commit.
struct FrameRow {
  double time = 0;
  std::uint64_t step = 0, particle_start = 0;
  std::uint32_t particle_count = 0;
  std::uint64_t pp_start = 0;
  std::uint32_t pp_count = 0;
  std::uint64_t pw_start = 0;
  std::uint32_t pw_count = 0;
  std::uint64_t series_count = 0;
};

// A wall's state as stored.
struct WallRow {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  std::array<double, 4> quaternion{1, 0, 0, 0};  // w, x, y, z
};
WallRow row_of(const WallState& state);
WallState state_of(const WallRow& row);

// Visitors: f(item, member) for every item of an axis, in the order of the table. The members of the two row types come
// as pointers to members, all others as const or mutable references.
template <class F>
void visit_frame(F&& f) {
  f(column<double>("/frames/time"), &FrameRow::time);
  f(column<std::uint64_t>("/frames/step"), &FrameRow::step);
  f(column<std::uint64_t>("/frames/particle_start"), &FrameRow::particle_start);
  f(column<std::uint32_t>("/frames/particle_count"), &FrameRow::particle_count);
  f(column<std::uint64_t>("/frames/pp_start"), &FrameRow::pp_start);
  f(column<std::uint32_t>("/frames/pp_count"), &FrameRow::pp_count);
  f(column<std::uint64_t>("/frames/pw_start"), &FrameRow::pw_start);
  f(column<std::uint32_t>("/frames/pw_count"), &FrameRow::pw_count);
  f(column<std::uint64_t>("/frames/series_count"), &FrameRow::series_count);
}

template <class F>
void visit_wall(F&& f) {
  f(column<Vec3>("/walls/*/pose_position"), &WallRow::position);
  f(column<std::array<double, 4>>("/walls/*/pose_quaternion"), &WallRow::quaternion);
  f(column<Vec3>("/walls/*/velocity"), &WallRow::velocity);
  f(column<Vec3>("/walls/*/angular_velocity"), &WallRow::angular_velocity);
  f(column<Vec3>("/walls/*/force"), &WallRow::force);
  f(column<Vec3>("/walls/*/torque"), &WallRow::torque);
}

template <class P, class F>
void visit_particles(P& p, F&& f) {
  f(column<ParticleId>("/particles/id"), p.id);
  f(column<Vec3f>("/particles/position"), p.position);
  f(column<Vec3f>("/particles/velocity"), p.velocity);
  f(column<Vec3f>("/particles/angular_velocity"), p.angular_velocity);
  f(column<float>("/particles/radius"), p.radius);
  f(column<std::uint8_t>("/particles/material"), p.material);
  f(column<float>("/particles/compressive_force"), p.compressive_force);
}

template <class C, class F>
void visit_pp(C& c, F&& f) {
  f(column<std::array<std::uint32_t, 2>>("/contacts/pp/row"), c.row);
  f(column<float>("/contacts/pp/normal_force"), c.normal_force);
  f(column<float>("/contacts/pp/damping_force"), c.damping_force);
  f(column<Vec3f>("/contacts/pp/tangential_force"), c.tangential_force);
  f(column<float>("/contacts/pp/overlap"), c.overlap);
  f(column<std::uint64_t>("/contacts/pp/birth_step"), c.birth_step);
  f(column<std::uint8_t>("/contacts/pp/flags"), c.flags);
}

template <class C, class F>
void visit_pw(C& c, F&& f) {
  f(column<std::uint32_t>("/contacts/pw/row"), c.row);
  f(column<std::uint8_t>("/contacts/pw/wall"), c.wall);
  f(column<std::uint32_t>("/contacts/pw/facet"), c.facet);
  f(column<std::uint8_t>("/contacts/pw/feature"), c.feature);
  f(column<Vec3f>("/contacts/pw/point"), c.point);
  f(column<Vec3f>("/contacts/pw/normal"), c.normal);
  f(column<float>("/contacts/pw/normal_force"), c.normal_force);
  f(column<float>("/contacts/pw/damping_force"), c.damping_force);
  f(column<Vec3f>("/contacts/pw/tangential_force"), c.tangential_force);
  f(column<float>("/contacts/pw/overlap"), c.overlap);
  f(column<std::uint64_t>("/contacts/pw/birth_step"), c.birth_step);
  f(column<std::uint8_t>("/contacts/pw/flags"), c.flags);
}

template <class S, class F>
void visit_series(S& s, F&& f) {
  f(column<double>("/series/time"), s.time);
  f(column<std::uint64_t>("/series/step"), s.step);
  f(column<float>("/series/largest_compressive_force"), s.largest_compressive_force);
  f(column<std::uint32_t>("/series/jammed_count"), s.jammed_count);
  f(column<double>("/series/kinetic_energy"), s.kinetic_energy);
  f(column<double>("/series/largest_overlap"), s.largest_overlap);
  f(column<Series::EndedContacts>("/series/ended_pp"), s.ended_pp);
  f(column<Series::EndedContacts>("/series/ended_pw"), s.ended_pw);
  f(column<std::uint32_t>("/series/excursion_count"), s.excursion_count);
  f(column<double>("/series/energy/kinetic"), s.energy.kinetic);
  f(column<double>("/series/energy/rotational"), s.energy.rotational);
  f(column<double>("/series/energy/gravitational"), s.energy.gravitational);
  f(column<double>("/series/energy/elastic"), s.energy.elastic);
  f(column<double>("/series/energy/adhesive"), s.energy.adhesive);
  f(column<double>("/series/energy/tangential"), s.energy.tangential);
  f(column<double>("/series/energy/rolling"), s.energy.rolling);
  f(column<double>("/series/energy/normal_damping"), s.energy.normal_damping);
  f(column<double>("/series/energy/tangential_damping"), s.energy.tangential_damping);
  f(column<double>("/series/energy/sliding"), s.energy.sliding);
  f(column<double>("/series/energy/rolling_resistance"), s.energy.rolling_resistance);
  f(column<double>("/series/energy/detachment"), s.energy.detachment);
  f(column<double>("/series/energy/stiffness_change"), s.energy.stiffness_change);
  f(column<double>("/series/energy/time_stepping"), s.energy.time_stepping);
  f(column<double>("/series/energy/residual"), s.energy.residual);
}

template <class W, class F>
void visit_wall_series(W& w, F&& f) {
  f(column<Vec3>("/series/walls/*/force"), w.force);
  f(column<Vec3>("/series/walls/*/torque"), w.torque);
  f(column<Vec3>("/series/walls/*/force_min"), w.force_min);
  f(column<Vec3>("/series/walls/*/force_max"), w.force_max);
  f(column<Vec3>("/series/walls/*/torque_min"), w.torque_min);
  f(column<Vec3>("/series/walls/*/torque_max"), w.torque_max);
  f(column<double>("/series/walls/*/power"), w.power);
  f(column<double>("/series/walls/*/work"), w.work);
  f(column<std::array<double, 12>>("/series/walls/*/label_force"), w.label_force);
  f(column<std::array<double, 12>>("/series/walls/*/label_torque"), w.label_torque);
}

template <class E, class F>
void visit_excursions(E& e, F&& f) {
  f(column<ParticleId>("/excursions/particle"), e.particle);
  f(column<std::uint64_t>("/excursions/first_step"), e.first_step);
  f(column<std::uint64_t>("/excursions/last_step"), e.last_step);
  f(column<std::uint64_t>("/excursions/peak_step"), e.peak_step);
  f(column<float>("/excursions/peak_force"), e.peak_force);
  f(column<float>("/excursions/impulse"), e.impulse);
  f(column<float>("/excursions/work"), e.work);
  f(column<float>("/excursions/path"), e.path);
  f(column<float>("/excursions/turned"), e.turned);
  f(column<Vec3f>("/excursions/first_position"), e.first_position);
  f(column<Vec3f>("/excursions/peak_position"), e.peak_position);
  f(column<Vec3f>("/excursions/last_position"), e.last_position);
  f(column<std::uint8_t>("/excursions/open"), e.open);
}

// Rows of the excursions of the first `windows` windows.
std::uint64_t excursion_rows(const Series& series, std::size_t windows);

// f(path in the file, item, member) for every growing column of a series with one row per window; walls beyond s.walls are skipped.
template <class S, class F>
void visit_all_series(S& s, const std::vector<Wall>& walls, F&& f) {
  visit_series(s, [&](const Item& i, auto& values) { f(path_of(i), i, values); });
  for (std::size_t w = 0; w < walls.size() && w < s.walls.size(); ++w) {
    visit_wall_series(s.walls[w], [&](const Item& i, auto& values) { f(path_of(i, walls[w].name), i, values); });
  }
}

// Rows [first, last) of a series.
Series rows_of(const Series& series, std::size_t first, std::size_t last);

// Appends the rows of `more`, which has the same columns.
void append(Series& series, const Series& more);

// CRC-32C (Castagnoli) of what a frame adds to the file: the row of /frames, the walls' states in order of their ids,
// the rows of /particles, /contacts/pp, /contacts/pw, and the new rows of /series; each item in the order of the table,
// then those of /excursions; only items that the file has, little-endian bytes as stored.
std::uint32_t checksum(const FrameRow& row, const Snapshot& snapshot, bool wall_loads, const Series& new_rows,
                       const std::vector<Wall>& walls);

}  // namespace jam::schema
