// Snapshots in the formats of other programs, written one frame at a time.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Writes frames into a folder and keeps none of them. Files get their names when they are complete; until then they end in
// ".part". All functions throw DataError, naming the file, where the disk refuses or the frames do not fit together.
class SnapshotExporter {
 public:
  SnapshotExporter() = default;
  virtual ~SnapshotExporter() = default;
  SnapshotExporter(const SnapshotExporter&) = delete;
  SnapshotExporter& operator=(const SnapshotExporter&) = delete;

  // number: of the frame in its source. In order of time; a snapshot has passed validate().
  virtual void add(std::size_t number, const Snapshot& snapshot) = 0;
  // After the last frame: completes the files. Returns those that a user opens, the most important first.
  virtual std::vector<std::filesystem::path> finish() = 0;
  // The map with which open_source reads the files back, for formats that can be read back; its meshes and case are to be
  // stored with it. After finish().
  virtual std::optional<ImportMap> map() const { return std::nullopt; }
};

struct ExportFormat {
  const char* name;    // for --to
  const char* doc;     // what it is for, half a line
  std::unique_ptr<SnapshotExporter> (*open)(const RunInfo& info, const std::filesystem::path& folder);
};

// The table of formats. The folder must exist; `info` is copied.
std::span<const ExportFormat> export_formats();

}  // namespace jam
