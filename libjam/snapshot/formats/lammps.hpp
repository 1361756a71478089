// Text dumps of LAMMPS and LIGGGHTS: particles ("dump custom"), contacts ("dump local"), walls as meshes ("dump local"
// of LIGGGHTS' compute wall/gran/local) or as groups of columns a particle (LAMMPS fix wall/gran ... contacts).
#pragma once
#include <string>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/formats/text_input.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

bool is_lammps(const std::vector<InputHead>& inputs, const ImportMap* map);

// Sorts the inputs by the columns in their headers, see ImportTable. Throws DataError where there is no map, where a
// file fits no table of it (naming what is missing and what is there), and as open_tables.
SnapshotSource open_lammps(const std::vector<InputHead>& inputs, const ImportMap* map);

}  // namespace jam
