// VTK's XML files of points, lines and triangles (.vtp), one a frame, with an index of their times (.pvd) that ParaView opens.
//
// particles.pvd  a point a particle: id, radius, velocity, compressive_force, coordination and what else the source has
// contacts.pvd   a line a contact: between the centres of two particles, or from a centre to the contact point on a wall
//                (without contact points in the source: to the surface of the particle along the contact's normal)
// blade.pvd      triangles of the walls with the role of the blade, in their pose; walls.pvd: of all others
//
// Arrays have the names and units of the snapshot schema (SI). Numbers are raw binary behind the XML ("appended"), as the
// VTK file format documentation describes: no VTK library is needed to write it.
#pragma once
#include <filesystem>
#include <memory>

#include "libjam/snapshot/export/export_formats.hpp"

namespace jam {

std::unique_ptr<SnapshotExporter> export_vtp(const RunInfo& info, const std::filesystem::path& folder);

}  // namespace jam
