// Frames of a stored run, worked on several at a time and handed over in order.
#pragma once
#include <omp.h>

#include <deque>
#include <future>
#include <memory>
#include <type_traits>

#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

// For each frame of [first, last) calls work(frame, snapshot before it, snapshot), with more than one thread on threads of their own, up to
// `threads` at the same time, and take(result) on this one, in order. This one reads, because HDF5 does one thing at a time. Of a single frame
// the parts of its work share the threads. The snapshot before is null at the first frame of the run, and everywhere unless `with_before`.
// What work or take throws comes out here.
template <class Work, class Take>
void for_frames_in_flight(const jam::SnapshotSource& source, std::size_t first, std::size_t last, int threads, bool with_before, Work work,
                          Take take) {
  using Snapshot = std::shared_ptr<const jam::Snapshot>;
  const bool single = last - first < 2;
  std::deque<std::future<std::invoke_result_t<Work, std::size_t, const jam::Snapshot*, const jam::Snapshot&>>> under_way;
  const auto take_next = [&] {
    auto next = std::move(under_way.front());
    under_way.pop_front();
    take(next.get());
  };
  Snapshot before;
  if (with_before && first > 0 && first < last) before = std::make_shared<const jam::Snapshot>(source.read(first - 1));
  for (std::size_t frame = first; frame < last; ++frame) {
    auto snapshot = std::make_shared<const jam::Snapshot>(source.read(frame));
    if (under_way.size() == std::size_t(threads)) take_next();
    under_way.push_back(std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&work, frame, before, snapshot, single, threads] {
      omp_set_num_threads(single ? threads : 1);  // of this thread only
      return work(frame, before.get(), *snapshot);
    }));
    if (with_before) before = std::move(snapshot);
  }
  while (!under_way.empty()) take_next();
}

}  // namespace jamscope
