// What grains do to a wall.
#pragma once
#include "libdem/case/case.hpp"

namespace dem {

struct WallLoad {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m on the wall, torque about the pose position
  WallLoad& operator+=(const WallLoad& more) {
    force += more.force;
    torque += more.torque;
    return *this;
  }
};

}  // namespace dem
