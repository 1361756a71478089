#include "libdem/geometry/wall_motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libdem/errors.hpp"

namespace dem {
namespace {

// Cosine of half the angle of a rotation that is taken for half a turn.
constexpr double half_turn = 1e-9;

Eigen::Quaterniond turned(const Eigen::Quaterniond& from, const Vec3& angular_velocity, double time) {
  const double speed = angular_velocity.norm();
  if (speed == 0) return from;
  return Eigen::Quaterniond(Eigen::AngleAxisd(speed * time, angular_velocity / speed)) * from;
}

void orient(WallPose& pose, const Eigen::Quaterniond& orientation) {
  pose.orientation = orientation;
  pose.rotation = orientation.toRotationMatrix();
}

}  // namespace

PoseTable::PoseTable(std::vector<PoseRow> rows) : rows_(std::move(rows)) {
  if (rows_.size() < 2)
    throw CaseError("a table of poses has " + std::to_string(rows_.size()) + " rows, expected at least 2");
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    PoseRow& row = rows_[k];
    const std::string name = "row " + std::to_string(k + 1) + " of a table of poses ";
    if (!std::isfinite(row.time) || !row.position.allFinite() || !row.orientation.coeffs().allFinite())
      throw CaseError(name + "has a number that is not finite");
    const double length = row.orientation.norm();
    if (!(length > 0)) throw CaseError(name + "has a quaternion of length 0");
    row.orientation.coeffs() /= length;
    if (k > 0 && !(row.time > rows_[k - 1].time))
      throw CaseError(name + "is at " + std::to_string(row.time) + " s, expected later than the row before, " +
                      std::to_string(rows_[k - 1].time) + " s");
  }
  for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
    const PoseRow &from = rows_[k], &to = rows_[k + 1];
    const double duration = to.time - from.time;
    Eigen::Quaterniond turn = to.orientation * from.orientation.conjugate();
    if (turn.w() < 0) turn.coeffs() = -turn.coeffs();  // the same orientation, reached by the smaller angle
    if (turn.w() < half_turn)
      throw CaseError("a wall turns by half a turn from row " + std::to_string(k + 1) +
                      " of its table of poses to the next, in an unknown direction; expected less");
    const double sine = turn.vec().norm(), angle = 2 * std::atan2(sine, turn.w());
    const Vec3 spin = sine > 0 ? Vec3(turn.vec() * (angle / (sine * duration))) : Vec3(Vec3::Zero());
    legs_.push_back({(to.position - from.position) / duration, spin});
  }
}

WallPose PoseTable::at(double time) const {
  WallPose pose;
  const auto next = std::ranges::upper_bound(rows_, time, {}, &PoseRow::time);
  if (next == rows_.begin() || next == rows_.end()) {
    const PoseRow& row = next == rows_.begin() ? rows_.front() : rows_.back();
    pose.position = row.position;
    orient(pose, row.orientation);
    return pose;
  }
  const auto k = std::size_t(next - rows_.begin()) - 1;
  const double since = time - rows_[k].time;
  pose.velocity = legs_[k].velocity;
  pose.angular_velocity = legs_[k].angular_velocity;
  pose.position = rows_[k].position + since * pose.velocity;
  orient(pose, turned(rows_[k].orientation, pose.angular_velocity, since));
  return pose;
}

WallPose pose_at(const WallMotion& motion, double time) {
  if (motion.table) return motion.table->at(time);
  WallPose pose;
  pose.velocity = motion.velocity;
  pose.angular_velocity = motion.angular_velocity;
  pose.position = motion.start + motion.velocity * time;
  orient(pose, turned(motion.orientation, motion.angular_velocity, time));
  if (!motion.pivot.isZero(0)) {
    const Vec3 to_pivot = pose.rotation * motion.pivot;
    pose.position += motion.orientation * motion.pivot - to_pivot;
    pose.velocity -= motion.angular_velocity.cross(to_pivot);
  }
  return pose;
}

WallMotion resting_at(const WallMotion& motion, double time) {
  const WallPose pose = pose_at(motion, time);
  WallMotion rest;
  rest.start = pose.position;
  rest.orientation = pose.orientation;
  return rest;
}

void validate_motion(const WallMotion& motion) {
  if (!motion.start.allFinite() || !motion.velocity.allFinite() || !motion.angular_velocity.allFinite() ||
      !motion.pivot.allFinite() || !motion.orientation.coeffs().allFinite())
    throw CaseError("a wall's motion has a number that is not finite");
  if (std::abs(motion.orientation.norm() - 1) > 1e-9)
    throw CaseError("a wall's orientation is a quaternion of length " + std::to_string(motion.orientation.norm()) +
                    ", expected 1");
}

}  // namespace dem
