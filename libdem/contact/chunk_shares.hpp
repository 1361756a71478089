// How threads share the chunks of a bed.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace dem {

// Rows of a list of chunks in the order of space. Each thread begins with a share of its own: neighbours in space, so that it finds in its own
// caches what pairs that cross chunks share, and the same at every pass, so that it finds there what it wrote. It takes them from the first
// on; when it has none left, it takes others' from the last on.
class ChunkShares {
 public:
  // Thread t's share begins at row first_of(t) and ends at first_of(t + 1), which is called for t = 0 to `threads`.
  template <class FirstOf>
  ChunkShares(std::size_t threads, FirstOf first_of) : left_(threads) {
    for (std::size_t t = 0; t < threads; ++t)
      left_[t].rows.store(pack(std::uint32_t(first_of(t)), std::uint32_t(first_of(t + 1))), std::memory_order_relaxed);
  }

  // Calls use(row) for what is left to take; every row is used once, by one thread. For all threads, in a parallel region.
  template <class Use>
  void take(std::size_t thread, Use use) {
    for (std::size_t turn = 0; turn < left_.size(); ++turn)
      while (const std::optional<std::uint32_t> row = take_one(left_[(thread + turn) % left_.size()].rows, turn == 0)) use(*row);
  }

 private:
  struct alignas(64) Share {
    std::atomic<std::uint64_t> rows;  // [begin, end) in one, so that both ends can be taken from
  };
  static std::uint64_t pack(std::uint32_t begin, std::uint32_t end) { return std::uint64_t{end} << 32 | begin; }
  static std::optional<std::uint32_t> take_one(std::atomic<std::uint64_t>& rows, bool first) {
    std::uint64_t seen = rows.load(std::memory_order_relaxed);
    while (true) {
      std::uint32_t begin = std::uint32_t(seen), end = std::uint32_t(seen >> 32);
      if (begin == end) return std::nullopt;
      const std::uint32_t taken = first ? begin++ : --end;
      if (rows.compare_exchange_weak(seen, pack(begin, end), std::memory_order_relaxed)) return taken;
    }
  }
  std::vector<Share> left_;
};

}  // namespace dem
