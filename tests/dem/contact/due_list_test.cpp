#include "libdem/contact/due_list.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

// All lengths around whole registers, all limits, from any place on.
TEST(DueList, HoldsAllPlacesUpToTheLimitAscending) {
  std::mt19937_64 random(7);
  std::vector<std::uint32_t> places;
  for (std::size_t size = 0; size <= 200; ++size)
    for (const int due : {0, 1, 3, 5, 254, 255}) {
      std::vector<std::uint8_t> from(size + 1);
      for (std::uint8_t& level : from) level = random() % 2 ? std::uint8_t(random() % 6) : std::uint8_t(random());
      const std::span<const std::uint8_t> part = std::span<const std::uint8_t>(from).subspan(1);
      std::vector<std::uint32_t> expected;
      for (std::size_t k = 0; k < size; ++k)
        if (part[k] <= due) expected.push_back(std::uint32_t(1000 + k));
      const std::span<const std::uint32_t> found = dem::list_due(part, std::uint8_t(due), 1000, places);
      EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected) << size << " bytes up to " << due;
    }
}

}  // namespace
