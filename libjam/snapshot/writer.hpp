// Writes the snapshot file of schema.hpp so that a kill at any moment costs at most the frame being written.
#pragma once
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Between two appends the file is closed and consistent, so that other programs can read it. Which optional columns a
// file has follows from the first frame in which its particles, contacts or series have rows; later frames must have
// the same. All functions throw DataError: for data that fail validate(), before anything is written; and where
// the file cannot be written (a full disk), which leaves the frames committed before intact: make room and go on with
// resume().
class SnapshotWriter {
 public:
  // A new file without frames in place of whatever is there.
  static SnapshotWriter create(const std::filesystem::path& path, const RunInfo& info);
  // Continues a file after its last frame with step <= last_step; what follows that frame is removed, also where a
  // killed writer left the file unclosed. The repaired file is written aside and renamed.
  static SnapshotWriter resume(const std::filesystem::path& path, std::uint64_t last_step);

  // Adds one frame, and the rows of /series since the last one. Time and step must be larger than the last frame's.
  void append(const Snapshot& snapshot, const Series& new_rows = {});

  std::size_t frames() const { return frames_; }
  std::uint64_t last_step() const { return last_.step; }  // of the last frame
  const RunInfo& info() const { return info_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  SnapshotWriter(std::filesystem::path path, RunInfo info);
  static SnapshotWriter attach(const std::filesystem::path& path);
  void make_missing_columns(const Snapshot& snapshot, const Series& new_rows);
  void check_columns(const Snapshot& snapshot, const Series& new_rows, const std::string& place) const;
  void check_space(const Snapshot& snapshot, const Series& new_rows) const;

  std::filesystem::path path_;
  RunInfo info_;
  std::size_t frames_ = 0;
  schema::FrameRow last_;        // of the last frame
  double last_series_time_ = 0;  // of the last row of /series
  std::uint64_t last_series_step_ = 0;
  std::uint64_t excursions_ = 0;  // rows of /excursions
  std::set<std::string> columns_;  // that grow with particles, contacts and series, as made so far
  std::uint64_t particle_chunk_ = 0, pp_chunk_ = 0, pw_chunk_ = 0;  // rows; 0 while there are no such columns
};

}  // namespace jam
