#include <gtest/gtest.h>

#include "libdem/particles/grain_rows.hpp"

namespace dem {
namespace {

// Every row is in one chunk, at its place; no chunk is empty or too large for a sheet of forces.
TEST(RowChunks, CoverAllRowsOnce) {
  constexpr std::size_t large = RowChunks::many * RowChunks::most_rows;
  for (const std::size_t grains : {std::size_t{0}, std::size_t{1}, std::size_t{512}, std::size_t{513}, large - 1, large, large + 1, 3 * large}) {
    const RowChunks chunks(grains);
    EXPECT_LE(chunks.rows(), RowChunks::most_rows);
    std::size_t row = 0;
    for (std::size_t c = 0; c < chunks.count(); ++c) {
      ASSERT_EQ(chunks.begin(c), row);
      ASSERT_LT(row, chunks.end(c));
      for (; row < chunks.end(c); ++row) {
        ASSERT_EQ(chunks.of(row), c);
        ASSERT_EQ(chunks.place(row), row - chunks.begin(c));
      }
    }
    EXPECT_EQ(row, grains);
  }
}

// Many chunks for many threads: fewer grains are in smaller ones.
TEST(RowChunks, AreManyInLargeBeds) {
  EXPECT_EQ(RowChunks(2993).count(), 6u);
  for (std::size_t rows = RowChunks::least_rows; rows <= RowChunks::most_rows; rows *= 2) {
    EXPECT_EQ(RowChunks(RowChunks::many * rows).rows(), rows);
    EXPECT_EQ(RowChunks(RowChunks::many * rows).count(), RowChunks::many);
    EXPECT_EQ(RowChunks(RowChunks::many * rows - 1).rows(), std::max(rows / 2, RowChunks::least_rows));
  }
  EXPECT_EQ(RowChunks(1'000'000).rows(), RowChunks::most_rows);
}

}  // namespace
}  // namespace dem
