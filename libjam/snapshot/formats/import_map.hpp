// What must be known about another code's dumps before they can be read: which column is what, units, walls, motion.
//
// A plain description without a file format of its own; apps/jamscope/map_file reads it from TOML. All numbers are in
// SI units except the file's columns, which `units` scales to SI.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// SI value of one unit of the file. A file in mm, s and mN has length = force = 1e-3.
struct ImportUnits {
  double length = 1, time = 1, velocity = 1, angular_velocity = 1, force = 1, torque = 1;
};

// Name of a field -> name of the column that holds it. Known fields, (r) = required:
//   particles      id(r) x(r) y(r) z(r), radius or diameter or volume(r), vx vy vz, wx wy wz, material, fx fy fz (total
//                  force), compressive_force
//   pair_contacts  id1(r) id2(r); the force on id1 as f_x f_y f_z (all of it) or its normal part fn_x fn_y fn_z or fn
//                  (a number, > 0 repulsive)(r); ft_x ft_y ft_z (on id1), overlap or distance (of the centres), damping
//                  (the dissipative part of the normal force, where the column of fn leaves it out), birth_step, flags
//                  (the sum of those of ContactFlag)
//   wall_contacts  id(r); the force on the particle as f_x.. or fn_x.. or fn(r), ft_x ft_y ft_z; mesh (a number, see
//                  ImportWall::mesh_id) or wall (a name), facet (triangle), px py pz (contact point), nx ny nz (from
//                  the particle to the wall), overlap, damping, birth_step, flags, feature (WallFeature)
//   wall_arrays    id(r)
//   wall_states    mesh or wall(r); x y z(r) of the wall's origin, qw qx qy qz(r) from its frame to the laboratory's,
//                  vx vy vz, wx wy wz; fx fy fz and tx ty tz on the wall, about its origin; a row a wall in every frame
//   wall_loads     time(r) fx(r) fy(r) fz(r) tx(r) ty(r) tz(r), on the wall
// csv files also have frame(r), and their particles time.
using ColumnMap = std::map<std::string, std::string>;

// One kind of input. A file is of this kind when its header has every column of the map and, where `file` is not empty,
// its name contains `file`; so the order of the inputs does not matter.
struct ImportTable {
  ColumnMap columns;  // empty: this kind is not part of the data
  std::string file;
  bool used() const { return !columns.empty(); }
};

// A wall of the foreign run. `wall` is what the analysis will see; the rest says where its contacts come from.
struct ImportWall {
  Wall wall;
  // Mesh walls of `wall_contacts`: the number in the column `mesh`, or the text in the column `wall` (default:
  // wall.name).
  int mesh_id = -1;
  // So many numbers from mesh_id on belong to this wall, one a triangle, in the order of its mesh (codes that number
  // triangles as walls of their own).
  int mesh_count = 1;
  std::string source_name;
  // Walls recorded as one group of columns a particle (LAMMPS `fix wall/gran ... contacts`): the columns are
  // array[1..8] = flag, force on the particle, contact point, radius. Empty: not recorded so.
  std::string array;
  // Motion, where there is no table `wall_states`: rigid, with constant velocity and angular velocity from
  // `motion_start` on. The angular velocity is about an axis through the body frame's origin, which is at `position`
  // (with the identity orientation) until then.
  Vec3 position = Vec3::Zero();          // m
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  double motion_start = 0;               // s
  // The table `wall_loads` is about this wall.
  bool has_load_series = false;
  // The source lists no contacts of this wall: they follow from the force balance of the particles that touch it
  // (total force - weight - listed contacts). Analytic walls only; needs fx fy fz and a density.
  bool recover = false;
};

struct ImportMaterial {
  Material material;
  // Value of the particles' column `material` (LAMMPS `type`). -1: particles without such a column are of this
  // material.
  int type = -1;
};

struct ImportMap {
  std::string origin;             // file that this map was read from, for messages; may be empty
  std::string format = "lammps";  // a name in the table of open_source.cpp
  std::string creator;            // the code that made the data, for provenance
  double dt = 0;                  // s per step: time = step * dt; dumps that carry ITEM: TIME do without
  Vec3 gravity{0, 0, -9.81};      // m/s^2
  ImportUnits units;
  ImportTable particles, pair_contacts, wall_contacts, wall_arrays, wall_states, wall_loads;
  std::vector<ImportWall> walls;
  std::vector<ImportMaterial> materials;
  std::vector<std::vector<Interaction>> interactions;  // [M][M] in the order of `materials`, or empty
  Gap gap;
  // Particles farther than this times their radius from an analytic wall do not touch it when forces are recovered.
  double touch_tolerance = 1e-3;
  // The source lists each touch of a mesh once; else records of one edge are made one, see merge_shared_edges.
  bool one_record_a_touch = false;
  // The case file that the data come from, whose [analysis] then holds for them, and its SHA-256; or empty.
  std::string case_toml, case_sha256;
};

}  // namespace jam
