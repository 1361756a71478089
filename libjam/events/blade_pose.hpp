// Where the blade is, and places as seen from it.
#pragma once
#include <span>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// The blade at a time, from which it turns and moves on steadily.
struct BladePose {
  double time = 0;  // s
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

// Of the first wall that is a blade; where there is none, that of a blade at rest in the origin.
BladePose blade_of(const Snapshot& snapshot, const std::vector<Wall>& walls);

// m, in the frame of the blade at that time. Poses ascend by time; the last one before the time counts, or the first of all. Without poses
// the position as it is.
Vec3 in_blade_frame(std::span<const BladePose> poses, double time, const Vec3& position);

// m/s, of the blade's tip: sqrt((omega R)^2 + v^2) with the angular velocity omega and the velocity v of its body, R from its axis.
double tip_speed(const BladePose& blade, double tip_radius);

}  // namespace jam
