#include "libdem/simulation/force_watch.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

#include "libdem/errors.hpp"

namespace dem {
namespace {

// Grains in a row, in two chunks, laid out back to front: row r is the caller's n - 1 - r.
GrainStore some_grains(std::size_t n) {
  Particles p;
  for (std::uint32_t i = 0; i < n; ++i) p.add(100 + i, 0, i % 2 ? 2e-3 : 1e-3, Vec3(i, 0, 0));
  GrainStore grains = make_grain_store(std::move(p), {Material{"a", 2500, 1e9, 0.2}});
  std::vector<std::uint32_t> order(n);
  for (std::uint32_t r = 0; r < n; ++r) order[r] = std::uint32_t(n - 1 - r);
  lay_out(grains, std::move(order));
  return grains;
}

WallContacts no_walls(const GrainStore& grains) {
  WallContacts walls;
  walls.chunk_begin.assign(grains.chunks().count() + 1, 0);
  return walls;
}

class Watched : public testing::Test {
 protected:
  static constexpr std::size_t n = 600;
  GrainStore grains = some_grains(n);
  WallContacts walls = no_walls(grains);
  std::unique_ptr<ForceSheet> sheet = std::make_unique<ForceSheet>();

  // Forces by the caller's grain.
  void look(ForceWatch& watch, const std::vector<std::pair<std::uint32_t, double>>& forces) {
    for (std::size_t c = 0; c < grains.chunks().count(); ++c) {
      const std::size_t begin = grains.chunks().begin(c), end = grains.chunks().end(c);
      sheet->fill({});
      for (const auto& [i, force] : forces)
        if (grains.chunks().of(grains.row_of[i]) == c) (*sheet)[grains.row_of[i] - begin].force[3] = force;
      std::vector<std::uint32_t> rows(end - begin);
      std::iota(rows.begin(), rows.end(), std::uint32_t(begin));
      watch.look(c, grains, rows, *sheet);
    }
  }
};

TEST_F(Watched, AreThoseAboveTheLimitByTheirIds) {
  ForceWatch watch(20, 0, 1e-3, {});
  watch.lay_out(grains.chunks().count());
  look(watch, {{5, 20.0}, {7, 20.1}, {400, 35}, {30, 19}});
  EXPECT_EQ(watch.largest(grains.chunks().of(grains.row_of[7])), 20.1);
  EXPECT_EQ(watch.largest(grains.chunks().of(grains.row_of[400])), 35);
  EXPECT_EQ(watch.follow(8, 1e-3, walls, {}), 2u);
  ASSERT_EQ(watch.excursions().open().size(), 2u);
  const Excursion &first = watch.excursions().open()[0], &second = watch.excursions().open()[1];
  EXPECT_EQ(first.id, 107u);
  EXPECT_EQ(first.first_position, Vec3(7, 0, 0));
  EXPECT_EQ(second.id, 500u);
  EXPECT_EQ(second.peak_force, 35);
  EXPECT_EQ(second.impulse, 35e-3);

  look(watch, {{400, 40}});
  EXPECT_EQ(watch.follow(9, 1e-3, walls, {}), 1u);
  EXPECT_EQ(watch.excursions().open().size(), 1u);
  const std::vector<Excursion> ended = watch.take_ended();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, 107u);
  EXPECT_EQ(ended[0].last_step, 8u);
}

// As the square of the radius: grains of 1 and 2 mm have 20 and 80 N.
TEST_F(Watched, HaveALimitByTheirSizeWhereOneIsNamed) {
  ForceWatch watch(20, 1e-3, 1e-3, {});
  watch.lay_out(grains.chunks().count());
  look(watch, {{0, 20.5}, {1, 79.5}, {2, 19.5}, {3, 80.5}});
  EXPECT_EQ(watch.follow(1, 1, walls, {}), 2u);
  EXPECT_EQ(watch.excursions().open()[0].id, 100u);
  EXPECT_EQ(watch.excursions().open()[1].id, 103u);
}

TEST_F(Watched, GoOnFromAStateInOrderOnly) {
  Excursion a, b;
  a.id = 3;
  b.id = 9;
  EXPECT_EQ(ForceWatch(20, 0, 1, {a, b}).excursions().open().size(), 2u);
  EXPECT_THROW(ForceWatch(20, 0, 1, {b, a}), CaseError);
  EXPECT_THROW(ForceWatch(20, 0, 1, {a, a}), CaseError);
}

}  // namespace
}  // namespace dem
