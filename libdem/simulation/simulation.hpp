// A running simulation: grains, walls, contacts, stepped by leapfrog (velocity Verlet with half-step velocities, as in Allen and
// Tildesley, "Computer Simulation of Liquids", section 3.2). Contacts are evaluated at the new positions with the half-step velocities;
// normal dampers with velocities extrapolated to the same instant as the positions, as a lag of half a step h is an error of first order
// in h: of the share zeta omega h in the peak force of an impact (zeta: share of critical damping). The same setup and state give the
// same bytes for any number of threads, and a state taken at any step continues exactly.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libdem/case/case.hpp"
#include "libdem/contact/ended_contacts.hpp"
#include "libdem/contact/laws.hpp"
#include "libdem/contact/ledger.hpp"
#include "libdem/contact/levels.hpp"
#include "libdem/contact/wall_load.hpp"
#include "libdem/geometry/walls.hpp"
#include "libdem/particles/particles.hpp"
#include "libdem/simulation/excursions.hpp"

namespace dem {

// What does not change during a run.
struct Setup {
  std::vector<Material> materials;
  std::vector<std::vector<Interaction>> interactions;  // [M][M], symmetric
  std::vector<Wall> walls;
  Vec3 gravity{0, 0, -9.81};  // m/s^2
  double step = 0;            // s, of level 0
  // Contacts step at their own rate (libdem/contact/levels.hpp): every 2^level-th step, up to this level. 0: at every step.
  std::uint8_t levels = 0;
  double accuracy = default_accuracy;  // 1, of the levels
  // 1, in [0, 1), Cundall's local damping; settles beds. The sum of forces on a grain is reduced by this share while it speeds
  // the grain up and enlarged while it slows it down, torques likewise: vibrations of every frequency lose the same share per
  // period, a falling grain falls with less than gravity, and forces in balance are left alone (Cundall, Proc. Symp. Rock
  // Mechanics, 1987; here along the force and not axis by axis, so that it does not depend on the axes).
  double local_damping = 0;
  // Grains under a compressive force above their limit are counted and followed (excursions.hpp): watch_force, N, the same for all; or
  // that of a grain of radius watch_radius, m, and of others as the square of their radius, as the forces of equal indentations are.
  double watch_force = 20;
  double watch_radius = 0;
  LawChoice law;              // parts of the contact law (libdem/contact/laws.hpp)
  bool wall_curvature = false;  // the curvature of walls enters the effective radius (on_curved_wall); else they count as flat
  bool keep_ledger = false;   // book where the energy goes (class Ledger); slower. Not with local damping
  // A grain whose centre leaves this box is lost and stops the run.
  Vec3 low = Vec3::Constant(-std::numeric_limits<double>::infinity());  // m
  Vec3 high = Vec3::Constant(std::numeric_limits<double>::infinity());  // m

  Resolution resolution() const { return {step, accuracy, levels}; }
};

// What must be remembered to continue exactly. Contacts in ascending order of rows (and wall, feature).
struct State {
  struct Pair {
    std::uint32_t i, j;  // rows, i < j
    Vec3 spring;         // m
    std::uint64_t birth_step;
    double contact_radius = 0;    // m
    Vec3 rolling = Vec3::Zero();  // N m
    std::uint8_t level = 0;
  };
  struct WallPair {
    std::uint32_t i, wall;
    std::uint64_t feature;
    Vec3 normal, spring;
    std::uint64_t birth_step;
    double contact_radius = 0;
    Vec3 rolling = Vec3::Zero();
    double distance = 0;  // m, from the centre to the wall
    std::array<double, 2> curvature{};  // 1/m, of the wall at the contact
    std::uint8_t level = 0;
  };
  // Of a run that keeps one; `last_power` empty otherwise.
  struct Ledger {
    LedgerSums spent;
    double initial = 0;                         // J
    std::vector<double> wall_work, last_power;  // [walls] J; W of the last evaluation
    std::vector<LastForces> pairs, wall_pairs;  // of the contacts below
  };
  // How the run keeps its grains and pairs: sums go in this order. Only read together with `force`.
  struct Layout {
    std::uint64_t chunk_rows = 0;              // of the program that wrote it: another lays the state out anew, with sums in another order
    std::vector<std::uint32_t> order;          // [N] row of `particles` for each row of the run
    std::vector<Vec3> listed;                  // [N] m, where the grains were when the lists were built; rows of the run
    std::vector<double> reach;                 // [N] m, how far they may go until they must be built again (neighbors/reach.hpp)
    std::vector<std::uint32_t> first, second;  // [lanes] rows of the run (PairContacts)
    std::uint64_t listed_step = 0;
    double skin = 0;                           // m, of the lists
    double odometer = 0, next_look = 0;        // m
    // Of a run whose contacts step at their own rate; empty otherwise. Of blocks and wall candidates that do not act:
    // `asleep_level` where they are asleep.
    std::vector<std::uint8_t> grain_level;  // [N] rows of the run
    std::vector<std::uint8_t> block_level;  // [lanes / 8]
    std::vector<double> block_wake;         // [lanes / 8] m
    std::vector<std::uint32_t> block_quiet;  // [lanes / 8] steps (Activity::quiet_until)
    std::vector<std::uint32_t> wall_grain, wall;  // [C] row of the run, wall
    std::vector<std::uint8_t> wall_level;   // [C]
    std::vector<double> wall_wake;          // [C] m
    std::vector<std::uint32_t> wall_quiet;  // [C] steps
    double foresight = 0;                   // m, how far the odometer could come until all were due again
    std::vector<double> closing_jolt;       // [chunks] m/s, by how much speeds could change until then
    static constexpr std::uint8_t asleep_level = 255;
  };
  std::uint64_t step = 0;
  Particles particles;
  std::vector<Vec3> force, torque;  // [N] of the last evaluation; empty for a fresh start
  Layout layout;
  std::vector<Pair> pairs;
  std::vector<WallPair> wall_pairs;
  Ledger ledger;
  std::vector<Excursion> excursions;  // that have not ended, ascending by id
};

// J. Where the energy of a run is, and where it went since the run began.
struct Ledger {
  // Now. Kinetic energies are those of the leapfrog scheme, m/2 v(n-1/2).v(n+1/2): exactly conserved by a linear spring.
  double kinetic = 0, rotational = 0;
  double gravitational = 0;  // -m g.x
  StoredEnergy stored;
  // Since the beginning.
  LedgerSums spent;
  std::vector<double> wall_work;  // [walls] put into the grains, trapezoid rule over every step
  double initial = 0;             // total() at the beginning

  double total() const { return kinetic + rotational + gravitational + stored.total(); }
  double work() const;         // sum of wall_work
  double work_put_in() const;  // sum of those that are > 0
  // What the books do not explain, J: rounding, if nothing is forgotten.
  double residual() const;
};

// One instant, for recording. Contacts in ascending order of rows (and wall, feature).
struct PairRecord {
  std::uint32_t i, j;               // rows
  double overlap, elastic, damping;  // m, N, N
  Vec3 tangential;                  // N on i
  std::uint64_t birth_step;
  bool sliding;
};
struct WallRecord {
  std::uint32_t i, wall, facet;
  MeshFeature feature;
  Vec3 point, normal;  // m, unit from the grain to the wall
  double overlap, elastic, damping;
  Vec3 tangential;
  std::uint64_t birth_step;
  bool sliding;
};
struct WallInstant {
  WallPose pose;
  Vec3 force, torque;  // N, N m on the wall, torque about the pose position
  std::array<WallLoad, facet_labels> load_of_label;  // the parts on a mesh's triangles of each FacetLabel; 0 for other walls
};
struct View {
  std::uint64_t step = 0;
  double time = 0;  // s
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> material;
  std::vector<double> radius, compressive_force;         // m, N
  std::vector<Vec3> position, velocity, angular_velocity;  // velocities at the same instant as the positions
  std::vector<PairRecord> pairs;
  std::vector<WallRecord> wall_pairs;
  std::vector<WallInstant> walls;
};

// Means and extremes over the steps since the last window was taken.
struct Window {
  std::uint64_t first_step = 0, last_step = 0;  // steps (first, last]
  double time = 0;                              // s, of last_step
  // N, sum over a grain's contacts of the repulsive normal force. At steps at which not all contacts are evaluated (levels), over
  // those that are: the stiff and the fast ones.
  double largest_compressive_force = 0;
  std::uint32_t most_watched = 0;  // largest number of grains above their watched force in a step at which all contacts are evaluated
  double largest_overlap = 0;                   // 1, overlap over radius
  double kinetic_energy = 0;                    // J, of last_step
  EndedContacts ended_pairs, ended_wall_pairs;  // contacts that ended; with a wall: gave way to no other
  std::vector<Excursion> excursions;            // that have ended, in order of their ends, then by id
  struct Load {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // mean
    Vec3 force_min, force_max, torque_min, torque_max;  // over the steps at which all contacts are evaluated
    double power = 0;  // W, mean of the power that the wall puts into the grains
    std::array<WallLoad, facet_labels> of_label;  // mean, by FacetLabel of the triangle; meshes only
  };
  std::vector<Load> walls;
  std::vector<std::uint8_t> is_mesh;  // [walls] 1 where `of_label` means something
  std::optional<Ledger> ledger;       // of last_step, of a run that keeps one
};

// Since the run began or was resumed.
struct Effort {
  std::uint64_t steps = 0;
  Evaluations evaluations;
  std::uint64_t lists = 0;  // built
  // s of wall time: contacts and, with them, the motion of the grains; lists; the rest (walls' poses and loads, ledger).
  double stepping = 0, listing = 0, rest = 0;
  double total() const { return stepping + listing + rest; }
};

class Simulation {
 public:
  // Throws CaseError where setup and state do not fit together.
  Simulation(Setup setup, State state);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Where contacts step at their own rate, a multiple of 2^levels steps: then all are there. Throws PhysicsError, naming grain,
  // contact, time and likely cause: a number that is not finite, a runaway overlap, a lost grain, a step above the stable limit
  // of a grain between its contacts.
  void advance(std::uint64_t steps);

  std::uint64_t step() const;
  double time() const;  // s
  const Setup& setup() const;
  const Particles& particles() const;
  std::size_t contacts() const;  // acting now, walls included
  double kinetic_energy() const;  // J, translation and rotation
  const std::vector<Excursion>& excursions() const;  // that have not ended, ascending by id
  const std::vector<Excursion>& ended_excursions() const;  // since the last window was taken
  Ledger ledger() const;          // of a run that keeps one; else all zero
  // s, the smallest local limit of the step, 2/omega of a grain between its contacts as they are now (guards.hpp); infinity
  // where nothing touches. Costs a pass over the contacts.
  double stable_step() const;
  const Effort& effort() const;
  std::size_t bytes() const;  // that grains, contacts and lists occupy
  State state() const;
  View view() const;
  Window take_window();

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace dem
