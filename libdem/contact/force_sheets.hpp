// Working space of the threads that evaluate contacts. Few, so that they stay in the caches.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "libdem/particles/grain_rows.hpp"

namespace dem {

// Sheets of one thread after another, and those that chunks keep while they wait for others' forces. All that are handed out are zero,
// and are zero when they come back.
class ForceSheets {
 public:
  // Before threads begin.
  void prepare(std::size_t threads) {
    while (of_thread_.size() < threads) of_thread_.push_back(std::make_unique<ForceSheet>());
  }
  // The sheet that the thread has at hand; others do not touch it.
  std::unique_ptr<ForceSheet>& of_thread(std::size_t thread) { return of_thread_[thread]; }

  // From any thread.
  std::unique_ptr<ForceSheet> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!spare_.empty()) {
        std::unique_ptr<ForceSheet> sheet = std::move(spare_.back());
        spare_.pop_back();
        return sheet;
      }
    }
    return std::make_unique<ForceSheet>();
  }
  void give_back(std::unique_ptr<ForceSheet> sheet) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(sheet));
  }

  std::size_t bytes() const { return (of_thread_.size() + spare_.size()) * sizeof(ForceSheet); }

 private:
  std::vector<std::unique_ptr<ForceSheet>> of_thread_, spare_;
  std::mutex mutex_;
};

}  // namespace dem
