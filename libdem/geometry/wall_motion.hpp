// How walls move: steadily, or from row to row of a table of poses.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// A wall's body frame at one instant, laboratory frame.
struct WallPose {
  Vec3 position = Vec3::Zero();  // m, of the body frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m/s of the origin, rad/s
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();         // of `orientation`
};

struct PoseRow {
  double time = 0;               // s
  Vec3 position = Vec3::Zero();  // m, of the body frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

// Between two rows the origin moves straight at constant speed and the body turns at a constant angular velocity by the
// smaller of the two angles (spherical linear interpolation; Shoemake, SIGGRAPH 1985), so that velocity and angular
// velocity are constant from a row on until the next one. Before the first row and from the last one on the wall rests.
class PoseTable {
 public:
  // What holds from row k to row k + 1.
  struct Leg {
    Vec3 velocity, angular_velocity;  // m/s, rad/s
  };

  // Quaternions need not be of unit length. Throws CaseError for fewer than two rows, times that do not rise, numbers
  // that are not finite, quaternions of length 0, and half a turn from one row to the next (which way?).
  explicit PoseTable(std::vector<PoseRow> rows);

  std::span<const PoseRow> rows() const { return rows_; }  // with unit quaternions
  std::span<const Leg> legs() const { return legs_; }      // one fewer
  WallPose at(double time) const;

 private:
  std::vector<PoseRow> rows_;
  std::vector<Leg> legs_;
};

// Constant velocity and angular velocity from step 0 on, about a pose; or a table. The pivot, a point of the body,
// moves straight with `velocity` while the body turns about it: position = start + velocity t + (R(0) - R(t)) pivot
// with R(t) = rotation by angular_velocity t, after `orientation`.
struct WallMotion {
  Vec3 start = Vec3::Zero();                                        // m, of the body frame's origin at t = 0
  Vec3 velocity = Vec3::Zero();                                     // m/s, of the pivot
  Vec3 angular_velocity = Vec3::Zero();                             // rad/s
  Vec3 pivot = Vec3::Zero();                                        // m, body frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // unit, at t = 0
  std::shared_ptr<const PoseTable> table = nullptr;                 // if there is one it alone says where the wall is
};
WallPose pose_at(const WallMotion& motion, double time);

// Stays for ever where `motion` is at `time`.
WallMotion resting_at(const WallMotion& motion, double time);

// Throws CaseError for numbers that are not finite and an orientation that is not of unit length (to 1e-9).
void validate_motion(const WallMotion& motion);

}  // namespace dem
