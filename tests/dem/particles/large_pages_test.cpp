#include "libdem/particles/large_pages.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "libdem/particles/grain_rows.hpp"

namespace dem {
namespace {

TEST(LargeArray, KeepsItsElementsWhileItGrowsAcrossAPage) {
  LargeArray<std::uint64_t> array;
  for (std::uint64_t i = 0; i < 3 * LargePageAllocator<std::uint64_t>::page / sizeof(i); ++i) array.push_back(i);
  for (std::uint64_t i = 0; i < array.size(); ++i) ASSERT_EQ(array[i], i);
}

TEST(LargeArray, StartsAtAPageWhenItFillsOneAndAtTheTypesAlignmentElse) {
  const auto address = [](const auto& array) { return reinterpret_cast<std::uintptr_t>(array.data()); };
  constexpr std::size_t page = LargePageAllocator<GrainRow>::page, rows = page / sizeof(GrainRow);
  for (const std::size_t n : {rows, rows + 1, 5 * rows}) EXPECT_EQ(address(LargeArray<GrainRow>(n)) % page, 0U) << n;
  for (const std::size_t n : {std::size_t{1}, rows - 1}) EXPECT_EQ(address(LargeArray<GrainRow>(n)) % alignof(GrainRow), 0U) << n;
}

}  // namespace
}  // namespace dem
