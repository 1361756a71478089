// One recorded instant of a granular flow, and what is known about the run it belongs to.
//
// The arrays have the precision of the snapshot file (schema.hpp), so that an analysis of a running simulation and one of
// the stored file see the same numbers. SI units throughout. A quantity that its source cannot know is an EMPTY array,
// never zeros: ask present().
//
// Signs, once for the whole library: overlap > 0 in contact, < 0 in an adhesive neck; the normal of a contact points from
// particle `row[0]` to particle `row[1]`, or from the particle to the wall; normal force > 0 is repulsive; a tangential
// force is the one on particle `row[0]`, or on the particle that touches the wall; a wall's force and torque are those ON
// THE WALL.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace jam {

using ParticleId = std::uint32_t;  // persistent through the whole run
using Vec3f = Eigen::Vector3f;
using Vec3 = Eigen::Vector3d;

enum ContactFlag : std::uint8_t {
  contact_sliding = 1,    // tangential force at its Coulomb limit
  contact_neck = 2,       // held together by adhesion at negative overlap
  contact_recovered = 4,  // not in the source: recovered from the force balance of the particle
  contact_merged = 8,     // several records of one touch (facets that share an edge) merged into one
};

// Which part of a wall was touched.
enum class WallFeature : std::uint8_t { face = 0, edge = 1, vertex = 2 };

struct Particles {
  std::vector<ParticleId> id;            // [N], ascending
  std::vector<Vec3f> position;           // [N] m
  std::vector<Vec3f> velocity;           // [N] m/s, or absent
  std::vector<Vec3f> angular_velocity;   // [N] rad/s, or absent
  std::vector<float> radius;             // [N] m
  std::vector<std::uint8_t> material;    // [N] index into RunInfo::materials, or absent
  std::vector<float> compressive_force;  // [N] N, sum over contacts of the repulsive normal force, or absent
  std::size_t size() const { return id.size(); }
};

struct ParticleContacts {
  std::vector<std::array<std::uint32_t, 2>> row;  // [C] rows of the two particles in this frame, row[0] < row[1], sorted
  std::vector<float> normal_force;                // [C] N, elastic and adhesive (and damping where damping_force is absent)
  std::vector<float> damping_force;               // [C] N along the normal, > 0 pushes apart, or absent
  std::vector<Vec3f> tangential_force;            // [C] N on row[0], or absent
  std::vector<float> overlap;                     // [C] m, or absent
  std::vector<std::uint64_t> birth_step;          // [C] step in which the contact formed, or absent
  std::vector<std::uint8_t> flags;                // [C] of ContactFlag, or absent
  std::size_t size() const { return row.size(); }
};

struct WallContacts {
  std::vector<std::uint32_t> row;         // [W] row of the particle; sorted by (row, wall, facet)
  std::vector<std::uint8_t> wall;         // [W] index into RunInfo::walls
  std::vector<std::uint32_t> facet;       // [W] triangle of a mesh, sphere of glued ones, else 0; or absent
  std::vector<std::uint8_t> feature;      // [W] WallFeature, or absent
  std::vector<Vec3f> point;               // [W] m, contact point on the wall, or absent
  std::vector<Vec3f> normal;              // [W] unit, from the particle to the wall, or absent
  std::vector<float> normal_force;        // [W] N, as for particles
  std::vector<float> damping_force;       // [W] N, or absent
  std::vector<Vec3f> tangential_force;    // [W] N on the particle, or absent
  std::vector<float> overlap;             // [W] m, or absent
  std::vector<std::uint64_t> birth_step;  // [W] or absent
  std::vector<std::uint8_t> flags;        // [W] of ContactFlag, or absent
  std::size_t size() const { return row.size(); }
};

struct WallState {
  Vec3 position = Vec3::Zero();                                    // m, of the body frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // body frame to laboratory frame
  Vec3 velocity = Vec3::Zero();                                    // m/s, of the body frame's origin
  Vec3 angular_velocity = Vec3::Zero();                            // rad/s
  Vec3 force = Vec3::Zero();                                       // N on the wall; see RunInfo::wall_loads_known
  Vec3 torque = Vec3::Zero();                                      // N m on the wall, about `position`
};

struct Snapshot {
  double time = 0;         // s
  std::uint64_t step = 0;  // of the source's own time stepping
  Particles particles;
  ParticleContacts pp;
  WallContacts pw;
  std::vector<WallState> walls;  // one per RunInfo::walls
};

template <class T>
bool present(const std::vector<T>& column, std::size_t rows) {
  return column.size() == rows;
}

// What a wall is to the analysis: jams are bridges from a blade to a vessel.
enum class WallRole : std::uint8_t { other = 0, blade = 1, vessel = 2 };

struct Wall {
  std::string name;
  std::string kind;  // "plane", "cylinder", "cone", "disc", "spheres", "mesh"
  WallRole role = WallRole::other;
  std::string material;                  // name in RunInfo::materials, or empty
  // Analytic walls, in the body frame. plane: point and unit normal into the material-free side. cylinder and cone: point
  // on the axis, axis, radius (of the cone at `low`), ends along the axis from `point`. disc: centre, normal, radii.
  Vec3 point = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  double radius = 0;       // m
  double high_radius = 0;  // m, of a cone at `high`
  double hole_radius = 0;  // m, of a disc
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // m
  std::string free_side;   // of cylinders and cones: "inside", "outside", or empty if unknown
  // Spheres that are glued to each other, in the body frame.
  std::vector<Vec3> sphere_centre;    // m
  std::vector<double> sphere_radius;  // m
  // Meshes, in the body frame.
  std::vector<Vec3> vertices;                          // m
  std::vector<std::array<std::uint32_t, 3>> triangles;  // rows of `vertices`
  std::vector<std::uint8_t> triangle_label;             // per triangle: 0 face, 1 edge, 2 tip, 3 hub; or absent
};

struct Material {
  std::string name;
  double density = 0;  // kg/m^3
  double young = 0;    // Pa
  double poisson = 0;  // 1
};

struct Interaction {
  double restitution = 0, friction = 0, rolling = 0;  // 1
  double work_of_adhesion = 0;                         // J/m^2
};

// The clearance in which jams are looked for: between the circle swept by the blade tip and the vessel.
struct Gap {
  double tip_radius = 0;     // m, largest distance of the blade from its axis
  double vessel_radius = 0;  // m
  double z_low = 0, z_high = 0;  // m, extent of the blade along the axis, relative to its body-frame origin
};

struct RunInfo {
  std::string creator, creator_version, commit, created_utc;
  std::string case_toml, case_sha256;  // the exact case file, empty for foreign data
  std::vector<std::string> argv;
  std::uint64_t seed = 0;
  Vec3 gravity{0, 0, -9.81};  // m/s^2
  double dt = 0;              // s, 0 if unknown
  std::vector<Material> materials;
  std::vector<std::vector<Interaction>> interactions;  // [M][M], symmetric; or empty
  std::vector<Wall> walls;
  Gap gap;
  double watch_force = 0;  // N, excursions are stays above it; 0 where there are none
  double watch_radius = 0;  // m; 0: that is the same for all particles; else it is for this radius, and goes with the square of the radius
  std::uint64_t watch_stride = 1;  // steps between two looks at the particles
  bool wall_loads_known = true;  // WallState::force and torque were recorded, not left at zero
};

// Particles under a compressive force above the one that the source watched, from every step: each row is one uninterrupted stay. A row that
// is `open` is a stay that had not ended when it was written; a later row with the same particle and first_step takes its place.
struct Excursions {
  std::vector<ParticleId> particle;                            // [E]
  std::vector<std::uint64_t> first_step, last_step, peak_step;  // [E] first and last above
  std::vector<float> peak_force;                               // [E] N
  std::vector<float> impulse;                                  // [E] N s, integral of the compressive force
  std::vector<float> work;                                     // [E] J, that walls did on the particle at its contacts
  std::vector<float> path, turned;                             // [E] m, rad, integrals of speed and angular speed
  std::vector<Vec3f> first_position, peak_position, last_position;  // [E] m, centre
  std::vector<std::uint8_t> open;                              // [E] 1 where it had not ended
  std::size_t size() const { return particle.size(); }
};

// Scalars of one window of steps, so that nothing between two snapshots is lost. Row r covers the steps in
// (step[r-1], step[r]].
struct Series {
  std::vector<double> time;         // [S] s, end of the window
  std::vector<std::uint64_t> step;  // [S]
  std::vector<float> largest_compressive_force;  // [S] N, maximum over all particles and all steps of the window
  std::vector<std::uint32_t> jammed_count;       // [S] largest number of particles above the threshold in one step
  std::vector<double> kinetic_energy;            // [S] J at the end of the window
  std::vector<double> largest_overlap;           // [S] overlap over particle radius, maximum over the window
  // [S] contacts that ended within the window, by the octave of their life: column k lasted 2^k steps or more and less than 2^(k+1),
  // the last one was there when the run began; or absent. What slips from one triangle of a wall to the next goes on.
  using EndedContacts = std::array<std::uint32_t, 32>;
  std::vector<EndedContacts> ended_pp, ended_pw;
  std::vector<std::uint32_t> excursion_count;  // [S] rows of `excursions` that came with the window, or absent
  Excursions excursions;
  // [S] J at the end of the window, or absent: where the energy is, then where it went since the start of the run.
  struct Energy {
    std::vector<double> kinetic, rotational;  // of the leapfrog scheme
    std::vector<double> gravitational;
    std::vector<double> elastic, adhesive;    // normal contacts: strain energy; energy of closed surfaces, <= 0
    std::vector<double> tangential, rolling;  // in springs
    std::vector<double> normal_damping, tangential_damping, sliding, rolling_resistance;
    std::vector<double> detachment;        // lost by forming and breaking contacts
    std::vector<double> stiffness_change;  // gained by tangential springs from their changing stiffness
    std::vector<double> time_stepping;     // lost (> 0) or made (< 0) by the finite time step
    std::vector<double> residual;          // what is left unexplained
  } energy;
  struct WallSeries {
    std::vector<Vec3> force, torque;  // [S] mean over the window's steps, N and N m
    std::vector<Vec3> force_min, force_max, torque_min, torque_max;  // [S] per component, over the window's steps
    std::vector<double> power;  // [S] W, mean of the power the wall puts INTO the grains
    std::vector<double> work;   // [S] J, put into the grains since the start, or absent
    // [S] mean over the window, x, y, z on triangles of each label (0 face, 1 edge, 2 tip, 3 hub); meshes only, or absent
    std::vector<std::array<double, 12>> label_force, label_torque;
  };
  std::vector<WallSeries> walls;  // one per RunInfo::walls
  std::size_t size() const { return time.size(); }
};

// Frames of a stored or imported run, in order of time. read(k) may be called in any order and throws DataError.
struct SnapshotSource {
  RunInfo info;
  std::size_t frames = 0;
  std::function<Snapshot(std::size_t)> read;
  Series series;                      // size() == 0 where the source has none
  std::vector<std::string> warnings;  // for example "12 trailing bytes of an uncommitted frame ignored"
};

}  // namespace jam
