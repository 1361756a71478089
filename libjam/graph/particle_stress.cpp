#include "libjam/graph/particle_stress.hpp"

#include <Eigen/Eigenvalues>
#include <numbers>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/wall_touch.hpp"

namespace jam {
namespace {

Vec3 tangential_of(const std::vector<Vec3f>& forces, std::size_t contacts, std::size_t c) {
  return present(forces, contacts) ? Vec3(forces[c].cast<double>()) : Vec3(Vec3::Zero());
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
  constexpr double same = 1e-9;
  std::vector<Load> load(stress.size());
  for (std::size_t i = 0; i < stress.size(); ++i) {
    if (stress[i].isZero(0)) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(stress[i]);  // ascending
    const Vec3& value = principal.eigenvalues();
    if (!(value[0] < 0)) continue;
    load[i].pressure = -value[0];
    if (value[1] - value[0] > same * load[i].pressure) load[i].direction = principal.eigenvectors().col(0);
  }
  return load;
}

}  // namespace jam
