// The one way into libjam for stored data: a jamscope file, or another code's dumps.
#pragma once
#include <string>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Opens the files as one source of frames. The kind of each file is found from its content, never from its name or its
// place in the list; text may be plain, gzip or xz.
// map: needed for dumps, nullptr otherwise.
// Throws DataError where no known format fits, naming the file and what was looked for.
SnapshotSource open_source(const std::vector<std::string>& paths, const ImportMap* map = nullptr);

}  // namespace jam
