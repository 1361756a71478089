#include "libdem/simulation/motion.hpp"

#include <gtest/gtest.h>

#include "libdem/particles/particles.hpp"

namespace dem {
namespace {

constexpr double radius = 0.5e-3, mass = 2e-6, step = 1e-6;

struct Grain {
  GrainRow row;
  Vec4 spun = Vec4::Zero();
  std::uint8_t level = 0, asked = 3;
  ChunkMotion seen;

  Grain() {
    row.place = Vec4(1e-3, 2e-3, 3e-3, radius);
    row.motion = Vec4(0.1, -0.2, 0.3, 1 / radius);
    row.spin = Vec4(5, -6, 7, mass);
  }
  // What is left of the forces.
  template <bool Levels>
  ForceRow move(ForceRow acting, double local_damping = 0) {
    kick_and_drift<Levels>({&row, &spun, &level, &asked, step, local_damping, 4}, 0, acting, seen);
    return acting;
  }
};

ForceRow acting() { return {Vec4(1e-3, 2e-3, -4e-3, 9e-3), Vec4(3e-8, -1e-8, 2e-8, 0)}; }

// v(n+1/2) = v(n-1/2) + h F/m, x(n+1) = x(n) + h v(n+1/2); arrival: v(n+1) if the force stays.
TEST(Motion, IsLeapfrog) {
  Grain g;
  const GrainRow before = g.row;
  const ForceRow left = g.move<false>(acting());
  const Vec3 change = step / mass * acting().force.head<3>();
  const Vec3 spun = step / sphere_inertia(mass, radius) * acting().torque.head<3>();
  const double rounding = 1e-15;
  EXPECT_LT((g.row.velocity() - before.velocity() - change).norm(), rounding);
  EXPECT_LT((g.row.angular_velocity() - before.angular_velocity() - spun).norm(), 10 * rounding);
  EXPECT_LT((g.row.position() - before.position() - step * g.row.velocity()).norm(), 1e-18);
  EXPECT_LT((g.row.arrival.head<3>() - g.row.velocity() - 0.5 * change).norm(), rounding);
  EXPECT_EQ(g.row.radius(), radius);
  EXPECT_EQ(g.row.mass(), mass);
  EXPECT_EQ(g.row.motion[3], 1 / radius);
  EXPECT_TRUE(left.force.isZero(0) && left.torque.isZero(0));
  EXPECT_EQ(g.asked, ForceOutput::nothing_asked);
  EXPECT_EQ(g.seen.speed, Vec4(quad(g.row.velocity().cwiseAbs(), 0)));
}

// A grain of level L gets the impulse as it is and drifts for 2^L steps; what changes its velocity may do so as often again as levels
// that are higher are not due.
TEST(Motion, OfAGrainWithALevelIsAStrideLong) {
  for (const std::uint8_t level : {0, 1, 3, 4}) {
    Grain plain, g;
    g.level = level;
    plain.move<false>(acting());
    g.move<true>(acting());
    EXPECT_EQ(g.row.motion, plain.row.motion);
    EXPECT_EQ(g.row.spin, plain.row.spin);
    const Vec3 went = g.row.position() - Grain().row.position();
    EXPECT_LT((went - std::pow(2.0, level) * step * g.row.velocity()).norm(), 1e-17);
    EXPECT_EQ(g.row.arrival[3], std::pow(2.0, -level));
    const Vec3 change = step / mass * acting().force.head<3>();
    EXPECT_LT((g.seen.jolt.head<3>() - std::pow(2.0, 4 - level) * change.cwiseAbs()).norm(), 1e-15);
    EXPECT_LT((g.spun.head<3>() - 0.5 * (g.row.angular_velocity() - Grain().row.angular_velocity())).norm(), 1e-14);
  }
}

// Cundall: what speeds a grain up is reduced by the share, what slows it down enlarged; a force across its way changes neither.
TEST(Motion, LocalDampingTakesFromWhatSpeedsUpAndAddsToWhatSlowsDown) {
  const Vec4 velocity(3, 0, 0, 7);
  EXPECT_EQ(damped(0.2, velocity, Vec4(1, 0, 0, 0)), Vec4(0.8, 0, 0, 0));
  EXPECT_EQ(damped(0.2, velocity, Vec4(-1, 0, 0, 0)), Vec4(-1.2, 0, 0, 0));
  EXPECT_EQ(damped(0.2, Vec4::Zero(), Vec4(0, 2, 0, 0)), Vec4(0, 1.6, 0, 0));  // from rest: it speeds up
  EXPECT_EQ(damped(0.2, velocity, Vec4(-8, 0, 0, 0)), Vec4(-6.4, 0, 0, 0));    // through rest, and faster back
}

}  // namespace
}  // namespace dem
