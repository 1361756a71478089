// Walls of foreign data: where they are at a time, how far a particle is from them, and what one touch of them is.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Pose and velocity at time t (s); force and torque zero.
WallState wall_state(const ImportWall& wall, double time);

// Nearest point of an analytic wall ("plane", "cylinder"; either side of it). Points on a cylinder's axis have no
// nearest point: the distance is then infinite.
struct Nearest {
  double distance;  // m
  Vec3 point;       // m
  Vec3 normal;      // unit, from x to the wall
};
Nearest nearest_point(const Wall& wall, const Vec3& x);

// Nearest part of one triangle, body frame.
struct NearestOnTriangle {
  double distance;  // m
  WallFeature feature;
};
// A point is on an edge or a vertex when it is within `tolerance` (m) of it.
NearestOnTriangle nearest_on_triangle(const Wall& wall, std::uint32_t triangle, const Vec3& x, double tolerance);

// One wall contact in double precision, before it becomes a row of WallContacts.
struct WallRecord {
  std::uint32_t row = 0;  // of the particle
  std::uint8_t wall = 0;
  std::uint32_t facet = 0;
  std::uint8_t feature = 0;
  std::uint8_t flags = 0;
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
  double normal_force = 0;               // N, > 0 repulsive
  Vec3 tangential_force = Vec3::Zero();  // N, on the particle
  double damping_force = 0;              // N, > 0 pushes apart; 0 where normal_force has it or it is not known
  double overlap = 0;                    // m
  std::uint64_t birth_step = 0;
  bool flags_known = false;              // `flags` are the source's
};

// One touch, one record: merges the records of one particle on one mesh wall whose contact points coincide within
// 1e-3 radius, or whose triangles share an edge or vertex on which one of the points lies (by the definition of a touch
// as an isolated minimum of the distance to the surface, that record is no touch of its own).
//
// Finding from LIGGGHTS 3.8 dumps (force balance f - m g - sum of contacts of particles that touch no unlisted wall, 5
// particles with two records of one edge): the particle really gets BOTH forces, the balance closes to the printed
// digits only with the two. So the merged record carries the sum of the forces: normal = mean normal weighted by normal
// force, normal force = along it, the rest tangential; point = mean weighted likewise; facet = smaller; overlap =
// larger; flag contact_merged. Records must be sorted by (row, wall); keeps that order. radius: of every particle;
// states: pose of every wall.
void merge_shared_edges(std::vector<WallRecord>& records, const std::vector<Wall>& walls,
                        const std::vector<WallState>& states, const std::vector<double>& radius);

// What is left of a particle's force balance.
struct Residual {
  Vec3 force;        // N, total force - weight - listed contacts
  double magnitude;  // N, sum of the magnitudes of all these
};

// Contacts with walls whose contacts the source does not list (ImportWall::recover), from the residuals of the
// particles within radius (1 + tolerance) of them. Residuals below `printed_precision` times the magnitude are no
// contact. With several walls touched, the normal forces are the least-squares solution of sum_k F_k n_k = -residual (a
// wall that would have to pull is left out, unless it is the only one), and what they leave is shared as tangential
// force in proportion to them. Appends records with flag contact_recovered; sets touches[row] for every particle that
// is near such a wall.
constexpr double printed_precision = 1e-5;  // six digits, as dumps have by default, in three components
void recover_contacts(const std::vector<ImportWall>& walls, const std::vector<Vec3>& position,
                      const std::vector<double>& radius, const std::vector<Residual>& residual, double tolerance,
                      std::vector<WallRecord>& records, std::vector<char>& touches);

}  // namespace jam
