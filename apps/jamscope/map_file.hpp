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

}  // namespace jamscope
