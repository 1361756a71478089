// What is known about a run, to and from the snapshot file: everything in it that does not grow.
#pragma once
#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Root attributes, /run, /case, /materials, /interactions and the constant part of /walls. Empty texts, dt = 0, an
// all-zero gap and empty tables are left out. Throws DataError where the file cannot be written.
void write_run_info(h5::File& file, const RunInfo& info);

// Throws DataError where something is missing, of another type, or fails validate().
RunInfo read_run_info(const h5::File& file);

}  // namespace jam
