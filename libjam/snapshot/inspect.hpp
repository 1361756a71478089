// What is in a file, is it valid, and what is missing: for people and scripts.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct FileReport {
  struct Range {
    std::uint64_t min = 0, max = 0;
    double mean = 0;
  };
  std::string path;
  std::string format;   // "jamscope-snapshots"; what another HDF5 file calls itself; "HDF5", or "unknown"
  std::string version;  // of the schema, "1.0"
  std::uint64_t bytes = 0;
  bool closed = true;                          // false: a writer is at work, or was killed
  std::uint64_t frames = 0, frames_begun = 0;  // complete ones; complete or not
  double time_first = 0, time_last = 0;        // s, of the complete frames
  std::uint64_t step_first = 0, step_last = 0;
  double interval = 0;                                // s, mean distance of frames; 0 with fewer than two
  Range particles, particle_contacts, wall_contacts;  // per frame
  std::uint64_t series_rows = 0;
  std::vector<std::string> present, absent;  // data sets of the schema, as paths in the file
  RunInfo info;                              // provenance, materials, walls
  std::vector<std::string> warnings;         // the file can be used, but
  std::vector<std::string> problems;         // the file is damaged or not what it should be, one line each
  bool valid() const { return problems.empty(); }
};

// Reads the whole file: every complete frame is compared with its checksum and validated. Never throws for what a file
// may contain; a file that cannot be read at all has one problem, which says why.
FileReport inspect_file(const std::filesystem::path& path);

}  // namespace jam
