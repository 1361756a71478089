#include "libjam/graph/particle_stress.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/wall_touch.hpp"

namespace jam {
namespace {

Vec3 tangential_of(const std::vector<Vec3f>& forces, std::size_t contacts, std::size_t c) {
  return present(forces, contacts) ? Vec3(forces[c].cast<double>()) : Vec3(Vec3::Zero());
}

constexpr double same = 1e-9;  // of two principal stresses, against the most compressive

// By iteration: always right.
Load most_compressive_iterated(const Eigen::Matrix3d& stress) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(stress);  // ascending
  const Vec3& value = principal.eigenvalues();
  Load load;
  if (!(value[0] < 0)) return load;
  load.pressure = -value[0];
  if (value[1] - value[0] > same * load.pressure) load.direction = principal.eigenvectors().col(0);
  return load;
}

// In closed form (Smith, Commun. ACM 4, 168, 1961): with q = tr(S)/3, p = |S - q I|/sqrt(6) and r = det((S - q I)/p)/2 the smallest
// eigenvalue is q + 2 p cos(acos(r)/3 + 2 pi/3). Its direction is at right angles to the rows of S less it. Good to rounding unless the two
// smallest nearly agree, where r is 1.
Load most_compressive(const Eigen::Matrix3d& stress) {
  const double q = stress.trace() / 3;
  const Eigen::Matrix3d deviator = stress - q * Eigen::Matrix3d::Identity();
  const double p = std::sqrt(deviator.squaredNorm() / 6), r = deviator.determinant() / (2 * p * p * p);
  if (!(r < 0.99)) return most_compressive_iterated(stress);
  Load load;
  const double angle = std::acos(std::max(r, -1.0)) / 3;
  const double smallest = q + 2 * p * std::cos(angle + 2 * std::numbers::pi / 3), largest = q + 2 * p * std::cos(angle);
  if (!(smallest < 0)) return load;
  load.pressure = -smallest;
  if (!(3 * q - largest - 2 * smallest > same * load.pressure)) return load;
  const Eigen::Matrix3d rest = stress - smallest * Eigen::Matrix3d::Identity();
  const Vec3 x = rest.row(0), y = rest.row(1), z = rest.row(2);
  const Vec3 xy = x.cross(y), yz = y.cross(z), zx = z.cross(x);
  const double a = xy.squaredNorm(), b = yz.squaredNorm(), c = zx.squaredNorm();
  load.direction = a >= b && a >= c ? Vec3(xy / std::sqrt(a)) : b >= c ? Vec3(yz / std::sqrt(b)) : Vec3(zx / std::sqrt(c));
  return load;
}

}  // namespace

std::vector<double> sphere_volumes(const Snapshot& snapshot) {
  std::vector<double> volume;
  volume.reserve(snapshot.particles.size());
  for (const double radius : snapshot.particles.radius) volume.push_back(4.0 / 3.0 * std::numbers::pi * radius * radius * radius);
  return volume;
}

std::vector<Eigen::Matrix3d> particle_stress(const ContactGraph& graph, std::span<const double> volume) {
  const Snapshot& s = graph.snapshot();
  const Particles& p = s.particles;
  std::vector<Eigen::Matrix3d> stress(p.size(), Eigen::Matrix3d::Zero());
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const auto [i, j] = s.pp.row[c];
    const Vec3 branch = p.position[j].cast<double>() - p.position[i].cast<double>();
    const double length = branch.norm(), radii = double{p.radius[i]} + double{p.radius[j]};
    if (!(length > 0)) continue;
    const Vec3 force = tangential_of(s.pp.tangential_force, s.pp.size(), c) - normal_force(s.pp, c) / length * branch;
    // Of j both the force and the arm are opposite.
    const Eigen::Matrix3d moment = branch * force.transpose();
    stress[i] += double{p.radius[i]} / radii * moment;
    stress[j] += double{p.radius[j]} / radii * moment;
  }
  for (std::size_t c = 0; c < s.pw.size(); ++c) {
    const std::optional<WallTouch> touch = wall_touch(s, c);
    if (!touch) continue;
    const Vec3 force = tangential_of(s.pw.tangential_force, s.pw.size(), c) - normal_force(s.pw, c) * touch->normal;
    stress[s.pw.row[c]] += touch->arm * force.transpose();
  }
  for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = (0.5 / volume[i] * (stress[i] + stress[i].transpose())).eval();
  return stress;
}

std::vector<Load> particle_loads(std::span<const Eigen::Matrix3d> stress) {
  std::vector<Load> load(stress.size());
  for (std::size_t i = 0; i < stress.size(); ++i)
    if (!stress[i].isZero(0)) load[i] = most_compressive(stress[i]);
  return load;
}

}  // namespace jam
