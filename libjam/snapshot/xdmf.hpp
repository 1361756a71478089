// A small text file beside a snapshot file that opens in ParaView ("XDMF Reader", not the Xdmf3 ones) and VisIt.
#pragma once
#include <filesystem>

namespace jam {

// Writes an XDMF 2 file that points into the snapshot file: per complete frame the particles as points and, where there
// are any, their contacts as lines, each with every scalar and vector that the snapshot file has (64-bit integers
// aside, which XDMF 2 does not know unsigned). Names the snapshot file relative to itself; is written aside and
// renamed, so a viewer may reload it while the simulation runs. Throws DataError.
void write_xdmf(const std::filesystem::path& xdmf, const std::filesystem::path& snapshots);

}  // namespace jam
