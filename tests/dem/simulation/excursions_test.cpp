#include "libdem/simulation/excursions.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "libdem/simulation/simulation.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

State fresh(Particles grains) {
  State state;
  state.particles = std::move(grains);
  return state;
}

// A closed box, one of whose sides pushes.
Setup box(double half, double watch_force) {
  Setup setup = support::glass_setup(1e-7);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal = Vec3::Zero();
      normal[axis] = -side;
      setup.walls.push_back(Wall{"side", 0, Plane{-half * normal, normal}, {}});
    }
  setup.walls[0].motion.velocity = Vec3(0.2, 0, 0);
  setup.watch_force = watch_force;
  return setup;
}

auto key(const Excursion& e) { return std::tuple(e.last_step, e.id, e.first_step, e.peak_step); }

// What each step's view says, put together by hand.
struct ByHand {
  double watch_force, watch_radius;
  std::map<std::uint32_t, Excursion> open;
  std::vector<Excursion> ended;
  void look(const View& view, double step) {
    std::map<std::uint32_t, Excursion> now;
    for (std::size_t i = 0; i < view.id.size(); ++i) {
      const double force = view.compressive_force[i];
      const double limit = watch_radius > 0 ? watch_force * view.radius[i] * view.radius[i] / (watch_radius * watch_radius) : watch_force;
      if (!(force > limit)) continue;
      Excursion& e = now[view.id[i]];
      if (const auto before = open.find(view.id[i]); before != open.end()) {
        e = before->second;
        open.erase(before);
      } else {
        e.id = view.id[i];
        e.first_step = view.step;
        e.first_position = view.position[i];
      }
      e.last_step = view.step;
      e.last_position = view.position[i];
      e.impulse += step * force;
      if (force > e.peak_force) e.peak_force = force, e.peak_step = view.step, e.peak_position = view.position[i];
    }
    for (const auto& [id, e] : open) ended.push_back(e);
    open = std::move(now);
  }
};

// One limit for all, or one that goes with the square of the radius.
class ExcursionLimits : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Of, ExcursionLimits, ::testing::Values(0.0, 0.5e-3));

TEST_P(ExcursionLimits, AreWhatTheStaysInEachStepsForcesAreAbove) {
  omp_set_num_threads(1);
  constexpr double watch_force = 0.3;
  Particles grains = support::packed_cube(6, 1e-7, 1.0, 5);
  for (std::size_t i = 0; i < grains.size(); ++i) grains.radius[i] *= 0.9 + 0.1 * double(i % 2);
  dem::Setup setup = box(2.9e-3, watch_force);
  setup.watch_radius = GetParam();
  Simulation single(setup, fresh(grains)), whole(setup, fresh(grains));
  ByHand by_hand{watch_force, GetParam(), {}, {}};
  constexpr std::uint64_t steps = 2000;
  for (std::uint64_t k = 0; k <= steps; ++k) {
    if (k > 0) single.advance(1);
    by_hand.look(single.view(), 1e-7);
  }
  // In windows of uneven length, and over a restart in the midst of some.
  std::vector<Excursion> ended;
  bool restarted_in_one = false;
  for (const std::uint64_t stop : {1, 700, 331, 968}) {
    whole.advance(stop);
    const auto more = whole.take_window().excursions;
    ended.insert(ended.end(), more.begin(), more.end());
    restarted_in_one = restarted_in_one || !whole.excursions().empty();
    whole = Simulation(whole.setup(), whole.state());
  }
  EXPECT_TRUE(restarted_in_one);
  ASSERT_GT(ended.size(), 50u);
  ASSERT_EQ(ended.size(), by_hand.ended.size());
  ASSERT_EQ(whole.excursions().size(), by_hand.open.size());
  const auto order = [](const Excursion& a, const Excursion& b) { return key(a) < key(b); };
  EXPECT_TRUE(std::is_sorted(ended.begin(), ended.end(), order));
  std::sort(by_hand.ended.begin(), by_hand.ended.end(), order);
  for (std::size_t k = 0; k < ended.size(); ++k) {
    const Excursion &a = ended[k], &b = by_hand.ended[k];
    EXPECT_EQ(key(a), key(b));
    EXPECT_EQ(a.peak_force, b.peak_force);
    EXPECT_NEAR(a.impulse, b.impulse, 1e-12 * b.impulse);
    EXPECT_EQ(a.first_position, b.first_position);
    EXPECT_EQ(a.peak_position, b.peak_position);
    EXPECT_EQ(a.last_position, b.last_position);
  }
}

// Where every grain is followed always, the work of the walls is what their loads and motion say.
TEST(Excursions, ShareTheWorkOfTheWallsAmongThem) {
  omp_set_num_threads(1);
  Simulation sim(box(2.8e-3, -1), fresh(support::packed_cube(6, 1e-7, 0.1, 5)));
  const std::vector<Excursion> before = sim.excursions();
  sim.advance(3000);
  const Window window = sim.take_window();
  ASSERT_EQ(sim.excursions().size(), 216u);
  EXPECT_TRUE(window.excursions.empty());
  double work = 0, by_loads = 0;
  for (std::size_t k = 0; k < before.size(); ++k) work += sim.excursions()[k].work - before[k].work;
  for (const Window::Load& wall : window.walls) by_loads += 3000 * 1e-7 * wall.power;
  EXPECT_GT(by_loads, 1e-9);
  EXPECT_NEAR(work, by_loads, 1e-9 * by_loads);
}

// A grain that rolls along without slip: path = radius times turned.
TEST(Excursions, MeasurePathAndTurningOfARollingGrain) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(1e-7);
  setup.gravity = Vec3(0, 0, -9.81);
  setup.interactions[0][0].rolling_friction = 0;
  setup.walls.push_back(Wall{"floor", 0, Plane{Vec3::Zero(), Vec3(0, 0, 1)}, {}});
  setup.watch_force = 1e-9;
  Particles grains;
  const double radius = 0.5e-3, speed = 0.2;
  grains.add(7, 0, radius, Vec3(0, 0, radius - 1e-9), Vec3(speed, 0, 0), Vec3(0, speed / radius, 0));
  Simulation sim(setup, fresh(grains));
  sim.advance(20000);
  std::vector<Excursion> all = sim.take_window().excursions;
  all.insert(all.end(), sim.excursions().begin(), sim.excursions().end());
  double path = 0, turned = 0;
  for (const Excursion& e : all) path += e.path, turned += e.turned;
  EXPECT_GT(path, 0.2 * 20000 * 1e-7 * speed);
  EXPECT_NEAR(path, radius * turned, 0.01 * path);
}

}  // namespace
}  // namespace dem
