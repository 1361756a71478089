// The simplest way into libjam: three comma separated files.
//
//   particles.csv      frame,time,id,x,y,z,radius      and as wanted  vx,vy,vz,wx,wy,wz,material,fx,fy,fz
//   contacts.csv       frame,id1,id2,fn                and as wanted  ft_x,ft_y,ft_z,overlap
//   wall_contacts.csv  frame,id,wall,fn                and as wanted  px,py,pz,nx,ny,nz,ft_x,ft_y,ft_z,facet,overlap
//   walls.csv          frame,wall,x,y,z,qw,qx,qy,qz    and as wanted  vx,vy,vz,wx,wy,wz,fx,fy,fz,tx,ty,tz; may be absent
//
// Files are told apart by these headers, not by their names. SI units. Rows of a frame stand together, frames count up;
// a frame without contacts has no rows. Signs as in snapshot.hpp: fn > 0 repulsive, ft on id1 or on the particle, n
// from the particle to the wall.
//
// Without a map walls get their role from their names, see role_from_name, and are of kind "mesh" without triangles; a
// map adds their geometry, materials, other column names and units.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/formats/text_input.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// blade: the name contains (in any case) blade, impeller, paddle, rotor, wing, stirrer, screw or geometry;
// otherwise vessel: vessel, cylinder, wall, container, casing, drum or housing; otherwise other (floor, lid, ...).
WallRole role_from_name(std::string_view name);

bool is_csv(const std::vector<InputHead>& inputs, const ImportMap* map);
SnapshotSource open_csv(const std::vector<InputHead>& inputs, const ImportMap* map);

}  // namespace jam
