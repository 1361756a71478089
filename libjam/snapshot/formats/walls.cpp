#include "libjam/snapshot/formats/walls.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace jam {
namespace {

double distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab - x).norm();
}

const Vec3& corner(const Wall& wall, std::uint32_t triangle, std::size_t k) {
  return wall.vertices[wall.triangles[triangle][k]];
}

bool same_touch(const WallRecord& a, const WallRecord& b, const Wall& wall, const WallState& state, double radius) {
  const double tolerance = 1e-3 * radius;
  if ((a.point - b.point).norm() <= tolerance) return true;
  if (a.facet >= wall.triangles.size() || b.facet >= wall.triangles.size()) return false;
  std::vector<std::uint32_t> shared;
  for (const std::uint32_t va : wall.triangles[a.facet]) {
    for (const std::uint32_t vb : wall.triangles[b.facet]) {
      if (va == vb) shared.push_back(va);
    }
  }
  if (shared.empty() || a.facet == b.facet) return false;
  const Vec3& from = wall.vertices[shared.front()];
  const Vec3& to = wall.vertices[shared.back()];
  for (const WallRecord* record : {&a, &b}) {
    const Vec3 body = state.orientation.conjugate() * (record->point - state.position);
    if (distance_to_segment(from, to, body) <= tolerance) return true;
  }
  return false;
}

WallRecord merged(const std::vector<const WallRecord*>& parts) {
  WallRecord sum = *parts.front();
  Vec3 force = Vec3::Zero(), damping = Vec3::Zero(), normal = Vec3::Zero(), point = Vec3::Zero();
  double weight = 0;
  for (const WallRecord* part : parts) {
    // The tiny constant gives unloaded records equal weight.
    const double w = std::abs(part->normal_force) + std::numeric_limits<double>::min();
    force += part->tangential_force - part->normal_force * part->normal;
    damping += part->damping_force * part->normal;
    normal += w * part->normal;
    point += w * part->point;
    weight += w;
    sum.facet = std::min(sum.facet, part->facet);
    sum.feature = std::max(sum.feature, part->feature);
    sum.overlap = std::max(sum.overlap, part->overlap);
    sum.flags |= part->flags;
    sum.birth_step = std::min(sum.birth_step, part->birth_step);
  }
  if (normal.norm() > 0) sum.normal = normal.normalized();
  sum.point = point / weight;
  sum.normal_force = -force.dot(sum.normal);
  sum.tangential_force = force + sum.normal_force * sum.normal;
  sum.damping_force = damping.dot(sum.normal);
  sum.tangential_force -= damping - sum.damping_force * sum.normal;
  sum.flags |= contact_merged;
  return sum;
}

// Factors x of least sum of squares, and among those of least norm (walls that face each other, of which only the
// difference of the forces is known), with sum x_k n_k = target: x = N^T (N N^T)^+ target.
std::vector<double> least_squares(const std::vector<Vec3>& normals, const Vec3& target) {
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (const Vec3& n : normals) square += n * n.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(square);
  Vec3 y = Vec3::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double value = solver.eigenvalues()[k];
    const Vec3 direction = solver.eigenvectors().col(k);
    if (value > 1e-9) y += direction * (direction.dot(target) / value);
  }
  std::vector<double> factors;
  for (const Vec3& n : normals) factors.push_back(n.dot(y));
  return factors;
}

}  // namespace

WallState wall_state(const ImportWall& wall, double time) {
  WallState state;
  state.position = wall.position;
  const double moving = time - wall.motion_start;
  if (moving < 0) return state;
  state.position += moving * wall.velocity;
  state.velocity = wall.velocity;
  state.angular_velocity = wall.angular_velocity;
  const double speed = wall.angular_velocity.norm();
  if (speed > 0) state.orientation = Eigen::AngleAxisd(speed * moving, wall.angular_velocity / speed);
  return state;
}

Nearest nearest_point(const Wall& wall, const Vec3& x) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 axis = wall.axis.normalized();
  if (wall.kind == "plane") {
    const double height = (x - wall.point).dot(axis);
    return {std::abs(height), x - height * axis, height >= 0 ? Vec3(-axis) : axis};
  }
  if (wall.kind == "cylinder") {
    const Vec3 from_point = x - wall.point;
    const Vec3 radial = from_point - from_point.dot(axis) * axis;
    const double r = radial.norm();
    if (r == 0) return {infinity, x, axis};
    const Vec3 outward = radial / r;
    return {std::abs(wall.radius - r), x + (wall.radius - r) * outward, r <= wall.radius ? outward : Vec3(-outward)};
  }
  return {infinity, x, axis};
}

NearestOnTriangle nearest_on_triangle(const Wall& wall, std::uint32_t triangle, const Vec3& x, double tolerance) {
  double to_vertex = std::numeric_limits<double>::infinity(), to_edge = to_vertex;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = corner(wall, triangle, k), &b = corner(wall, triangle, (k + 1) % 3);
    to_vertex = std::min(to_vertex, (a - x).norm());
    to_edge = std::min(to_edge, distance_to_segment(a, b, x));
  }
  if (to_vertex <= tolerance) return {to_vertex, WallFeature::vertex};
  if (to_edge <= tolerance) return {to_edge, WallFeature::edge};
  const Vec3 &a = corner(wall, triangle, 0), &b = corner(wall, triangle, 1), &c = corner(wall, triangle, 2);
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    // Inside when x is on the inner side of all three edges.
    const bool inside = normal.dot((b - a).cross(x - a)) >= 0 && normal.dot((c - b).cross(x - b)) >= 0 &&
                        normal.dot((a - c).cross(x - c)) >= 0;
    if (inside) return {std::abs(normal.dot(x - a)) / std::sqrt(area2), WallFeature::face};
  }
  return {to_edge, WallFeature::edge};
}

void merge_shared_edges(std::vector<WallRecord>& records, const std::vector<Wall>& walls,
                        const std::vector<WallState>& states, const std::vector<double>& radius) {
  std::vector<WallRecord> kept;
  kept.reserve(records.size());
  for (std::size_t begin = 0, end = 0; begin < records.size(); begin = end) {
    const WallRecord& first = records[begin];
    while (end < records.size() && records[end].row == first.row && records[end].wall == first.wall) ++end;
    const Wall& wall = walls[first.wall];
    const std::size_t count = end - begin;
    // group[k]: smallest record that k is the same touch as, directly or through others. A particle has few touches of
    // one wall; where a broken file claims very many, comparing all pairs would take for ever, and they stay apart.
    std::vector<std::size_t> group(count);
    std::iota(group.begin(), group.end(), std::size_t{0});
    if (wall.kind == "mesh" && count > 1 && count <= 64) {
      for (std::size_t b = 1; b < count; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
          if (group[a] == group[b] ||
              !same_touch(records[begin + a], records[begin + b], wall, states[first.wall], radius[first.row])) {
            continue;
          }
          const std::size_t low = std::min(group[a], group[b]), high = std::max(group[a], group[b]);
          std::replace(group.begin(), group.end(), high, low);
        }
      }
    }
    std::vector<const WallRecord*> parts;
    for (std::size_t k = 0; k < count; ++k) {
      if (group[k] != k) continue;
      parts.clear();
      for (std::size_t m = k; m < count; ++m) {
        if (group[m] == k) parts.push_back(&records[begin + m]);
      }
      kept.push_back(parts.size() == 1 ? *parts.front() : merged(parts));
    }
  }
  records = std::move(kept);
}

void recover_contacts(const std::vector<ImportWall>& walls, const std::vector<Vec3>& position,
                      const std::vector<double>& radius, const std::vector<Residual>& residual, double tolerance,
                      std::vector<WallRecord>& records, std::vector<char>& touches) {
  touches.assign(position.size(), 0);
  struct Touched {
    std::size_t wall;
    Nearest nearest;
  };
  std::vector<Touched> touched;
  for (std::size_t row = 0; row < position.size(); ++row) {
    touched.clear();
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (!walls[w].recover) continue;
      const Nearest nearest = nearest_point(walls[w].wall, position[row]);
      if (nearest.distance <= radius[row] * (1 + tolerance)) touched.push_back({w, nearest});
    }
    if (touched.empty()) continue;
    touches[row] = 1;
    const Vec3& force = residual[row].force;
    if (!(force.norm() > printed_precision * residual[row].magnitude)) continue;

    std::vector<double> pushes;
    for (;;) {
      std::vector<Vec3> normals;
      for (const Touched& t : touched) normals.push_back(t.nearest.normal);
      pushes = least_squares(normals, -force);
      const auto lowest = std::min_element(pushes.begin(), pushes.end());
      if (touched.size() == 1 || *lowest >= 0) break;
      touched.erase(touched.begin() + (lowest - pushes.begin()));
    }
    Vec3 rest = force;
    for (std::size_t k = 0; k < touched.size(); ++k) {
      rest += pushes[k] * touched[k].nearest.normal;
    }
    double total = 0;
    for (const double push : pushes) total += std::abs(push);
    for (std::size_t k = 0; k < touched.size(); ++k) {
      const double push = pushes[k];
      WallRecord record;
      record.row = static_cast<std::uint32_t>(row);
      record.wall = static_cast<std::uint8_t>(touched[k].wall);
      record.flags = contact_recovered;
      record.point = touched[k].nearest.point;
      record.normal = touched[k].nearest.normal;
      record.normal_force = push;
      record.tangential_force = rest * (total > 0 ? std::abs(push) / total : 1.0 / static_cast<double>(touched.size()));
      record.overlap = radius[row] - touched[k].nearest.distance;
      records.push_back(record);
    }
  }
}

}  // namespace jam
