#include "libjam/statistics/flow_energy.hpp"

#include <algorithm>
#include <limits>

#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

// N, force of the wall on the particle. False where the source knows neither normal nor point.
bool contact_force_and_point(const Snapshot& snapshot, std::size_t c, Vec3& force, Vec3& point) {
  const WallContacts& pw = snapshot.pw;
  const bool has_normal = present(pw.normal, pw.size()), has_point = present(pw.point, pw.size());
  if (!has_normal && !has_point) return false;
  const Vec3 centre = snapshot.particles.position[pw.row[c]].cast<double>();
  const Vec3 normal =
      has_normal ? Vec3(pw.normal[c].cast<double>()) : Vec3((pw.point[c].cast<double>() - centre).normalized());
  const double radius = snapshot.particles.radius[pw.row[c]];
  point = has_point ? Vec3(pw.point[c].cast<double>()) : Vec3(centre + radius * normal);
  force = -normal_force(pw, c) * normal;
  if (present(pw.tangential_force, pw.size())) force += pw.tangential_force[c].cast<double>();
  return true;
}

}  // namespace

double power_from_wall_loads(const Snapshot& snapshot, const std::vector<Wall>& walls) {
  double power = 0;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].role != WallRole::blade) continue;
    const WallState& wall = snapshot.walls[w];
    power -= wall.force.dot(wall.velocity) + wall.torque.dot(wall.angular_velocity);
  }
  return power;
}

double power_from_wall_contacts(const Snapshot& snapshot, const std::vector<Wall>& walls) {
  double power = 0;
  for (std::size_t c = 0; c < snapshot.pw.size(); ++c) {
    const std::uint8_t w = snapshot.pw.wall[c];
    if (walls[w].role != WallRole::blade) continue;
    Vec3 force, point;
    if (!contact_force_and_point(snapshot, c, force, point)) return std::numeric_limits<double>::quiet_NaN();
    const WallState& wall = snapshot.walls[w];
    power += force.dot(wall.velocity + wall.angular_velocity.cross(point - wall.position));
  }
  return power;
}

bool series_has_power(const Series& series, const std::vector<Wall>& walls) {
  if (series.size() == 0 || series.walls.size() != walls.size()) return false;
  bool any = false;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].role != WallRole::blade) continue;
    if (!present(series.walls[w].power, series.size())) return false;
    any = true;
  }
  return any;
}

FlowEnergy flow_energy_from_series(const Series& series, const std::vector<Wall>& walls, double begin) {
  FlowEnergy result;
  result.source = "series";
  result.time = series.time;
  for (std::size_t k = 0; k < series.size(); ++k) {
    double power = 0;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (walls[w].role == WallRole::blade) power += series.walls[w].power[k];
    }
    double window = 0;
    if (k > 0) {
      window = series.time[k] - series.time[k - 1];
    } else if (series.size() > 1) {
      window = series.time[1] - series.time[0];
    } else {
      window = std::max(series.time[0] - begin, 0.0);
    }
    result.total += power * window;
    result.power.push_back(power);
    result.energy.push_back(result.total);
  }
  return result;
}

FlowEnergy flow_energy_from_frames(std::span<const double> time, std::span<const double> power, std::string source) {
  FlowEnergy result;
  result.source = std::move(source);
  result.time.assign(time.begin(), time.end());
  result.power.assign(power.begin(), power.end());
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (k > 0) result.total += (power[k - 1] + power[k]) / 2 * (time[k] - time[k - 1]);
    result.energy.push_back(result.total);
  }
  return result;
}

}  // namespace jam
