// Files of tables -> SnapshotSource: matches the frames of the files and checks the map on the first and last of them.
#pragma once
#include <string>
#include <vector>

#include "libjam/snapshot/formats/table.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

enum class TableKind { particles, pair_contacts, wall_contacts, wall_arrays, wall_states };

struct TableFile {
  TableKind kind;
  std::string path;
  std::vector<Field> fields;  // of its tables
  OpenFrames open;
};

// What stands in a text column for each wall: its source_name, or its name.
std::vector<std::string> wall_words(const ImportMap& map);

// Several files of one kind hold different steps of the same run (one file a frame, or a run in pieces).
// empty_frames_absent: a step without contacts is missing from the contact files (csv); otherwise every file kind must
// have the same steps.
// load_series: path of a table of wall loads, or empty.
// The source is not to be read from two threads at once. Throws DataError.
SnapshotSource open_tables(const std::vector<TableFile>& files, const ImportMap& map, bool empty_frames_absent,
                           const std::string& load_series);

// Loads of one wall at many times, text with blanks between the columns and their names in a first line that starts
// with
// '#', as LAMMPS `fix print` writes them. The values are taken as means over the time since the row before.
Series read_load_series(const std::string& path, const ImportMap& map);

}  // namespace jam
