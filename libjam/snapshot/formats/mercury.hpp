// MercuryDPM's NAME.data (particles) and NAME.fstat (contacts).
//
// Formats: MercuryDPM documentation, "Output Files" (docs.mercurydpm.org). For each time
//
//   .data   N time xmin ymin zmin xmax ymax zmax, then N lines x y z vx vy vz radius, three angles, wx wy wz, xi
//           (in two dimensions N time xmin ymin xmax ymax, then x y vx vy radius angle w xi)
//   .fstat  three lines that begin with '#', the first with the time, then a line a contact: time i j x y z overlap
//           tangential-overlap fn ft nx ny nz tx ty tz
//
// i and j are places in the list of particles, from 0; j < 0 is wall -j-1. A contact of two particles is listed twice, once
// for each (once where the other one is fixed), of which one is read. fn > 0 repels. Between particles ft (tx, ty, tz) is
// the force on i, and n points from j to i; for walls n points from the particle to the wall and the force on the particle is
// -ft (tx, ty, tz). Checked with a self-test of MercuryDPM itself (PolydisperseInsertionBoundarySelfTest, two dimensions, no
// friction): 1246 rows of particles have the overlap of their positions to 1e-11 and n as said, 217 rows of walls likewise. The
// signs of tangential forces are those of its source (BaseInteraction::writeToFStat).
//
// A particle has no other name than its place in the list, so that ids are persistent only while no particle is deleted.
// Contacts with periodic images name particles that the list has not, and are refused. With a map, walls get roles, shapes and
// motion, and `type` of a material is the particles' xi (the species); without one walls are called wall_0, wall_1, ...
#pragma once
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/formats/text_input.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

bool is_mercury(const std::vector<InputHead>& inputs, const ImportMap* map);
SnapshotSource open_mercury(const std::vector<InputHead>& inputs, const ImportMap* map);

}  // namespace jam
