#include "apps/jamscope/capture.hpp"

#include <cmath>

namespace jamscope {

Capture::Capture(std::filesystem::path path, const jam::RunInfo& info, const dem::Capture& plan, std::optional<std::uint64_t> last_step)
    : path_(std::move(path)), info_(info), plan_(plan) {
  info_.watch_force = 0;  // the stays of every step are in the run's own file
  if (last_step && std::filesystem::exists(path_)) writer_.emplace(jam::SnapshotWriter::resume(path_, *last_step));
}

bool Capture::full() const {
  std::error_code error;
  const std::uintmax_t bytes = writer_ ? std::filesystem::file_size(path_, error) : 0;
  return !error && double(bytes) >= plan_.most_bytes;
}

void Capture::write(const jam::Snapshot& frame) {
  if (!writer_) writer_.emplace(jam::SnapshotWriter::create(path_, info_));
  if (writer_->frames() > 0 && frame.step <= writer_->last_step()) return;  // again after a checkpoint
  writer_->append(frame, {});
}

void Capture::offer(jam::Snapshot frame, bool jammed) {
  const double time = frame.time;
  const bool open = time <= open_until_;
  if (jammed) {
    if (!open && full()) {
      left_out_ += !jammed_before_;
    } else {
      if (!open) ++windows_;
      open_until_ = time + plan_.after * (1 + 1e-9);
    }
  }
  jammed_before_ = jammed;
  if (time <= open_until_ && full()) open_until_ = -1;
  if (time <= open_until_) {
    for (const jam::Snapshot& earlier : before_) write(earlier);
    before_.clear();
    write(frame);
    return;
  }
  before_.push_back(std::move(frame));
  // What began within the interval before this frame is a jam of this frame, so one more reaches `before` back.
  const auto most = std::size_t(std::ceil(plan_.before / plan_.interval)) + 1;
  while (before_.size() > most) before_.pop_front();
}

}  // namespace jamscope
