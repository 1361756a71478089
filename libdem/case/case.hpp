// Everything a run needs but its additional walls, as plain data in SI units. Read from TOML by apps/jamscope/case_file; checked by
// check_case (libdem/case/check_case.hpp).
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace dem {

using Vec3 = Eigen::Vector3d;

struct Material {
  std::string name;
  double density = 0;  // kg/m^3
  double young = 0;    // Pa, Young's modulus
  double poisson = 0;  // 1, Poisson's ratio
};

struct Interaction {
  double restitution = 1;       // 1, of a damped Hertz impact without adhesion
  double friction = 0;          // 1, Coulomb
  double rolling_friction = 0;  // 1
  double work_of_adhesion = 0;  // J/m^2, W of the pair (twice a surface energy)
  double rolling_damping = 0.3;  // 1, share of critical damping; for elastic_plastic rolling only (Ai et al. 2011 use 0.3)
};

// The parts of the contact law by their names in the tables of libdem/contact/laws.hpp.
struct ContactModel {
  std::string normal = "jkr";
  std::string damping = "contact_radius";
  std::string friction_limit = "edem";
  std::string tangential = "total";
  std::string rolling = "constant_torque";
  // Walls' curvature enters the effective radius; without it walls are flat where they are touched, as in codes whose
  // walls are meshes.
  bool wall_curvature = false;
};

// A circle about the z axis.
struct CylinderRegion {
  double radius = 0;  // m
};

// A rectangle.
struct BoxRegion {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  // m
};

using BedRegion = std::variant<CylinderRegion, BoxRegion>;

// A bed of spheres, diameters uniform by number or by mass in [size_low, size_high] * mean_diameter
// (libdem/case/size_distribution.hpp), poured, settled, relaxed at the true stiffness and cut at `depth`.
struct Bed {
  // What is uniform over the diameters: how many grains have them, or what those grains weigh together.
  enum class Sizes { by_number, by_mass };

  std::string material;
  double mean_diameter = 0;  // m, mean of the uniform distribution: over the grains, or over their mass
  double size_low = 0.8, size_high = 1.2;
  double depth = 0;  // m, height of the cut above the vessel floor
  std::uint64_t seed = 1;
  Sizes sizes = Sizes::by_number;
  std::optional<BoxRegion> box = std::nullopt;  // where grains are placed; without it in the vessel
};

struct Vessel {
  std::string material;
  double diameter = 0;  // m; a cylinder about +z with its flat floor at z = 0, open above
};

// Two arms, C2-symmetric about z; the section at radius r is a rectangle height x thickness whose plane is turned about
// the radial axis by tip_twist * (r / tip radius)^twist_exponent; the tip surface is coaxial with the vessel (uniform
// gap) or cut flat.
struct TwistedBlade {
  double diameter = 0;                    // m, twice the tip radius
  double height = 6e-3;                   // m, of the plate
  double thickness = 1.5e-3;              // m
  double tip_twist = 0.5235987755982988;  // rad, from the vertical
  double twist_exponent = 1;
  double shaft_diameter = 5e-3;  // m, 0 for none
  double shaft_length = 0;       // m above the plate's mid plane; 0: up to where the bed cannot reach
  enum class TipCut { cylindrical, flat } tip_cut = TipCut::cylindrical;
};

struct MeshFile {
  std::string path;  // STL, ASCII or binary
  double scale = 1;  // m per file unit
};

struct Blade {
  std::string material;
  std::variant<TwistedBlade, MeshFile> shape;
  double start_height = 0;  // m, lowest point of the blade above the vessel floor at t = 0
};

// The blade turns about +z and moves along z: angular velocity omega = v cos(alpha) / R_tip (positive:
// counter-clockwise seen from above), axial velocity u = v sin(alpha) (negative: downward).
struct Motion {
  double tip_speed = 0;    // m/s, along the helix
  double helix_angle = 0;  // rad, negative: downward
  bool clockwise = false;
};

// Fine frames around jams.
struct Capture {
  double interval = 0;                  // s, between frames; 0: none
  double before = 5e-4, after = 5e-4;   // s, of a jam
  double most_bytes = 2e9;              // of the file
};

struct Output {
  double frame_interval = 0;       // s
  double series_interval = 0;      // s
  double checkpoint_interval = 0;  // s of simulated time
  bool energy_ledger = false;      // book where the energy goes
  Capture capture;
};

// Of the levels at which contacts step (libdem/contact/levels.hpp).
inline constexpr double default_accuracy = 0.2, most_accuracy = 0.5;
inline constexpr std::uint8_t most_levels = 10;

struct Case {
  std::string name, description;
  std::vector<Material> materials;
  std::vector<std::vector<Interaction>> interactions;  // [M][M], symmetric, order of `materials`
  ContactModel contact;
  Bed bed;
  // A rheometer has a vessel, a blade and the blade's motion; of other scenes, whose walls are all given one by one
  // (libdem/scene), these three mean nothing.
  bool rheometer = true;
  Vessel vessel;
  Blade blade;
  Motion motion;
  // m, grains outside of it are lost; not used for a rheometer, whose vessel says.
  Vec3 domain_low = Vec3::Zero(), domain_high = Vec3::Zero();
  double duration = 0;        // s
  bool automatic_step = false;  // the next two follow from the rest (libdem/case/automatic_step.hpp)
  double step = 0;              // s, of level 0
  // Contacts step at their own rate, up to every 2^levels steps (libdem/contact/levels.hpp); 0: all at every step.
  std::uint8_t levels = 0;
  double accuracy = default_accuracy;  // 1, of the levels
  Vec3 gravity{0, 0, -9.81};  // m/s^2
  Output output;
};

// Throws CaseError where no material has this name.
std::size_t material_index(const Case& c, const std::string& name);

}  // namespace dem
