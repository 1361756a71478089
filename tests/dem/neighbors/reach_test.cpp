#include "libdem/neighbors/reach.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dem {
namespace {

using testing::Each;

TEST(Reaches, AreHalfTheSkinWhereNothingIsKnownOrNothingMoved) {
  EXPECT_THAT(reaches({}, 700, 0.4, 0.1), Each(0.2));
  EXPECT_THAT(reaches(std::vector<double>(700, 0.0), 700, 0.4, 0.1), Each(0.2));
  EXPECT_EQ(reaches({}, 700, 0.4, 0.1).size(), 700u);
  EXPECT_TRUE(reaches({}, 0, 0.4, 0.1).empty());
}

// Three groups of 512 rows, the last cut short. One grain of the first went 0.1, one of the second 0.05, none of the third: half the
// skin, three quarters of it (1.5 times the half that it went in proportion), a fifth.
TEST(Reaches, FollowTheFurthestOfEachGroup) {
  std::vector<double> travelled(1100, 0.0);
  travelled[17] = 0.1;
  travelled[800] = 0.05;
  travelled[801] = 0.01;
  const std::vector<double> reach = reaches(travelled, travelled.size(), 0.4, 0.001);
  for (std::size_t r = 0; r < reach.size(); ++r)
    EXPECT_DOUBLE_EQ(reach[r], r < 512 ? 0.2 : r < 1024 ? 0.15 : 0.04) << r;
}

TEST(Reaches, AreNeverBelowHalfTheThinnestSkinNorAboveHalfTheirOwn) {
  std::vector<double> travelled(1024, 0.0);
  travelled[0] = 3;
  EXPECT_DOUBLE_EQ(reaches(travelled, 1024, 0.4, 0.3)[1000], 0.15);
  EXPECT_DOUBLE_EQ(reaches(travelled, 1024, 0.4, 9.0)[1000], 0.2);
}

}  // namespace
}  // namespace dem
