// Reads the snapshot file of schema.hpp, also while it is being written and after its writer was killed.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// True if the file is HDF5 and calls itself a snapshot file. Never throws.
bool is_jamscope_file(const std::filesystem::path& path);

// The committed frames of a snapshot file. Every frame that is read is compared with its checksum and validated, so
// what read() returns is what was written. An unclosed file (a writer at work, or killed) or one that was cut short
// gives the frames that are complete, and says so in `warnings`. Throws DataError where the file is damaged in another
// way. Reading opens the file for the moment only; a writer may append meanwhile.
SnapshotSource open_jamscope_file(const std::filesystem::path& path);

// The parts of open_jamscope_file, for those who need the layout of the file.
struct SnapshotIndex {
  std::string path;
  std::array<std::uint32_t, 2> version{};
  RunInfo info;
  std::vector<schema::FrameRow> frames;  // complete ones
  std::vector<std::uint32_t> commit;     // their checksums
  std::uint64_t frames_begun = 0;        // complete or not
  Series series;                         // of the complete frames
  h5::Condition condition;
  std::vector<std::string> warnings;
};
SnapshotIndex read_index(const std::filesystem::path& path);
Snapshot read_frame(const SnapshotIndex& index, std::size_t frame);

}  // namespace jam
