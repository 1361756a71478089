// The file given with --map: how another code's dumps are to be read, as TOML. data/maps holds commented examples.
#pragma once
#include <string>
#include <string_view>

#include "libjam/snapshot/formats/import_map.hpp"

namespace jamscope {

// Meshes are read from beside the map file. Throws dem::CaseError with every problem, "FILE:line:column: unknown key
// 'x' in [y]; did you mean 'z'?", and dem::GeometryError for a mesh that cannot be read.
jam::ImportMap read_map_file(const std::string& path);

// The same from a text; path names it in messages and is the place from which meshes are looked for.
jam::ImportMap read_map_text(std::string_view text, const std::string& path);

// Writes a map of data in SI units from which read_map_file makes the same one, with the meshes, glued spheres and the case
// file that it names beside it. how_to_read: the first line, as a comment. Of the ways to say where wall contacts come
// from, those that an exporter needs (columns, mesh_id, source_name, wall_states) are written. Throws jam::DataError where
// the disk refuses.
void write_map_file(const jam::ImportMap& map, const std::string& path, const std::string& how_to_read);

}  // namespace jamscope
