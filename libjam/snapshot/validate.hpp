// The gate: every snapshot that enters the library, from whichever format, passes here once.
//
// Each function throws DataError "PLACE: problem, expected ..." at the first violation, naming the item of the schema,
// the row, its value and what was expected. `place` is the file and frame, for example "run.h5:frame 12".
#pragma once
#include <string>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Names unique and usable as HDF5 names, at most 256 walls, known kinds, unit axes, positive radii, mesh rows in range,
// numbers finite, interaction tables square.
void validate(const RunInfo& info, const std::string& place = "run");

// Columns of equal length (optional ones may be absent), finite numbers, ascending unique ids, positive radii, rows and
// walls and facets in range, contacts sorted and pairs unique, unit normals and quaternions.
void validate(const Snapshot& snapshot, const RunInfo& info, const std::string& place = "snapshot");

// Columns of equal length (optional ones may be absent), finite numbers, time and step strictly increasing.
void validate(const Series& series, const RunInfo& info, const std::string& place = "series");

}  // namespace jam
