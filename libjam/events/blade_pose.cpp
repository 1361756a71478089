#include "libjam/events/blade_pose.hpp"

#include <algorithm>
#include <cmath>

namespace jam {

BladePose blade_of(const Snapshot& snapshot, const std::vector<Wall>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallState& state = snapshot.walls[w];
    if (walls[w].role == WallRole::blade) return {snapshot.time, state.position, state.velocity, state.angular_velocity, state.orientation};
  }
  return {};
}

Vec3 in_blade_frame(std::span<const BladePose> poses, double time, const Vec3& position) {
  if (poses.empty()) return position;
  const auto after = std::upper_bound(poses.begin(), poses.end(), time, [](double t, const BladePose& p) { return t < p.time; });
  const BladePose& pose = after == poses.begin() ? poses.front() : *(after - 1);
  const double since = time - pose.time, angle = pose.angular_velocity.norm() * since;
  Eigen::Quaterniond orientation = pose.orientation;
  if (angle != 0) orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, pose.angular_velocity.normalized())) * orientation;
  return orientation.conjugate() * (position - (pose.position + since * pose.velocity));
}

double tip_speed(const BladePose& blade, double tip_radius) {
  return std::hypot(blade.angular_velocity.norm() * tip_radius, blade.velocity.norm());
}

}  // namespace jam
