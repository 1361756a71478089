// The moments of the jams themselves: frames at a fine interval from shortly before each jam until shortly after it, in a file of their own, while
// of the rest of the run nothing more is stored than its usual frames.
#pragma once
#include <deque>
#include <filesystem>
#include <optional>

#include "libdem/case/case.hpp"
#include "libjam/snapshot/snapshot.hpp"
#include "libjam/snapshot/writer.hpp"

namespace jamscope {

// Keeps the last frames before a jam in memory, as many as `before` holds, and writes them when one begins; jams closer to each other than
// before + after share a window. Once the file has reached its limit nothing is written any more, and windows_left_out() counts the jams that came
// then: the first ones are kept, because what a jam looks like does not depend on when it comes.
class Capture {
 public:
  // `last_step`: nothing for a new run; that of the checkpoint for one that goes on, whose later frames are dropped.
  Capture(std::filesystem::path path, const jam::RunInfo& info, const dem::Capture& plan, std::optional<std::uint64_t> last_step);

  // A frame at each interval, and whether a grain was jammed at some step since the one before.
  void offer(jam::Snapshot frame, bool jammed);

  std::size_t windows() const { return windows_; }  // since this process began
  std::size_t windows_left_out() const { return left_out_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  void write(const jam::Snapshot& frame);
  bool full() const;

  std::filesystem::path path_;
  jam::RunInfo info_;
  dem::Capture plan_;
  std::optional<jam::SnapshotWriter> writer_;
  std::deque<jam::Snapshot> before_;
  double open_until_ = -1;  // s
  bool jammed_before_ = false;
  std::size_t windows_ = 0, left_out_ = 0;
};

}  // namespace jamscope
