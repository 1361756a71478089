// How grains move: the kick and drift of the leapfrog scheme (simulation.hpp), a grain at a time.
#pragma once
#include <cstdint>

#include "libdem/contact/forces.hpp"

namespace dem {

// What a pass over the grains needs of a run. By value, as the compiler would read members anew after whatever it writes.
struct MotionColumns {
  GrainRow* rows;
  Vec4* spun;
  std::uint8_t *level, *asked;
  double step, local_damping;  // s, 1 (Setup)
  std::uint8_t highest;
};

// Largest components of velocities, m/s, and of what changes them until all are due again.
struct ChunkMotion {
  Vec4 speed = Vec4::Zero(), jolt = Vec4::Zero();
};

// The change of a velocity in one step under local damping; the velocity in the middle of the step says which way it goes.
inline Vec4 damped(double local_damping, const Vec4& velocity, const Vec4& change) {
  const double speeding_up = change.head<3>().dot((velocity + 0.5 * change).head<3>());
  const double share = speeding_up > 0 ? 1 - local_damping : 1 + local_damping;
  return share * change;
}

// Takes what acts on a grain, and leaves nothing of it. Levels: grains have them.
template <bool Levels>
[[gnu::always_inline]] inline void kick_and_drift(const MotionColumns& on, std::size_t i, ForceRow& acting, ChunkMotion& motion) {
  const Vec4 three(1, 1, 1, 0);
  GrainRow& grain = on.rows[i];
  const double kick = on.step / grain.mass(), turn = inverse_sphere_inertia(kick, grain.motion[3]);
  Vec4 faster = kick * three.cwiseProduct(acting.force), spun = turn * acting.torque;
  if (on.local_damping != 0) {
    faster = damped(on.local_damping, grain.motion, faster);
    spun = damped(on.local_damping, grain.spin, spun);
  }
  grain.motion += faster;
  grain.spin += spun;
  const Vec4 velocity = three.cwiseProduct(grain.motion);
  motion.speed = motion.speed.cwiseMax(velocity.cwiseAbs());
  grain.arrival = velocity + 0.5 * three.cwiseProduct(faster);
  if constexpr (Levels) {
    const std::uint8_t level = on.level[i];
    grain.place += on.step * stride(level) * velocity;
    grain.arrival[3] = per_stride(level);
    on.spun[i] = 0.5 * spun;
    motion.jolt = motion.jolt.cwiseMax(stride(std::uint8_t(on.highest - level)) * faster.cwiseAbs());
  } else {
    grain.place += on.step * velocity;
  }
  acting = ForceRow{};
  on.asked[i] = ForceOutput::nothing_asked;
}

}  // namespace dem
