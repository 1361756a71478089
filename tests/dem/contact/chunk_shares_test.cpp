#include "libdem/contact/chunk_shares.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

namespace dem {
namespace {

// One thread takes its share from the first on, then the next thread's, and so on around, from the last on.
TEST(ChunkShares, AreTakenFromTheFirstOnAndOthersFromTheLastOn) {
  constexpr std::array<std::uint32_t, 4> begin{0, 3, 3, 5};
  const auto taken_by = [&](std::size_t thread) {
    ChunkShares shares(3, [&](std::size_t t) { return begin[t]; });
    std::vector<std::uint32_t> rows;
    shares.take(thread, [&](std::uint32_t row) { rows.push_back(row); });
    return rows;
  };
  EXPECT_EQ(taken_by(0), (std::vector<std::uint32_t>{0, 1, 2, 4, 3}));
  EXPECT_EQ(taken_by(1), (std::vector<std::uint32_t>{4, 3, 2, 1, 0}));
  EXPECT_EQ(taken_by(2), (std::vector<std::uint32_t>{3, 4, 2, 1, 0}));
}

// However threads race, and if only some of them come.
TEST(ChunkShares, HandOutEveryRowOnce) {
  constexpr std::size_t rows = 1001;
  for (const std::size_t threads : {1, 2, 3, 8})
    for (const std::size_t coming : {std::size_t{1}, threads}) {
      ChunkShares shares(threads, [&](std::size_t t) { return rows * t / threads; });
      std::vector<std::atomic<int>> uses(rows);
      std::vector<std::thread> team;
      for (std::size_t t = 0; t < coming; ++t) team.emplace_back([&, t] { shares.take(t, [&](std::uint32_t row) { ++uses[row]; }); });
      for (std::thread& thread : team) thread.join();
      for (std::size_t row = 0; row < rows; ++row) ASSERT_EQ(uses[row], 1) << row << " of " << threads << " threads";
    }
}

TEST(ChunkShares, MayBeEmpty) {
  ChunkShares shares(2, [](std::size_t) { return 0; });
  for (const std::size_t thread : {0, 1}) shares.take(thread, [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace dem
