#include "libjam/graph/particle_stress.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
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
// Of the largest principal stress. What compresses less is rounding: a particle that is only pulled has two principal stresses of 0.
constexpr double nothing = 1e-12;

// By iteration: always right.
Load most_compressive_iterated(const Eigen::Matrix3d& stress) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(stress);  // ascending
  const Vec3& value = principal.eigenvalues();
  Load load;
  if (!(value[0] < -nothing * std::max(value[2], 0.0))) return load;
  load.pressure = -value[0];
  if (value[1] - value[0] > same * load.pressure) load.direction = principal.eigenvectors().col(0);
  return load;
}

// Eight at a time. With q = tr(S)/3, p = |S - q I|/sqrt(6) and r = det((S - q I)/p)/2 the eigenvalues are q + p t with the roots of
// t^3 - 3 t - 2 r (Smith, Commun. ACM 4, 168, 1961); the smallest root is in [-2, -1], where Newton's steps from below go straight to it. Its
// direction is at right angles to the rows of S less it. Good to rounding unless the two smallest nearly agree, where r is 1.
constexpr Eigen::Index lanes = 8;
using Lanes = Eigen::Array<double, lanes, 1>;

void most_compressive(const Eigen::Matrix3d* stress, Load* load) {
  Lanes xx, yy, zz, xy, xz, yz;
  for (Eigen::Index k = 0; k < lanes; ++k) {
    const Eigen::Matrix3d& s = stress[k];
    xx[k] = s(0, 0), yy[k] = s(1, 1), zz[k] = s(2, 2), xy[k] = s(0, 1), xz[k] = s(0, 2), yz[k] = s(1, 2);
  }
  const Lanes q = (xx + yy + zz) / 3, a = xx - q, b = yy - q, c = zz - q;
  const Lanes p = ((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6).sqrt();
  const Lanes half_determinant = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / 2;
  const Lanes r = (half_determinant / (p * p * p)).max(-1);
  const Lanes root = ((1 - r.min(1)) / 2).sqrt();
  Lanes t = -1 - root * (1.1547 - 0.1547 * root);  // within 0.004
  for (int step = 0; step < 4; ++step) t -= (t * (t * t - 3) - 2 * r) / (3 * (t * t - 1));
  const Lanes smallest = q + p * t;
  // The roots add up to 0: the others are -t/2 -+ sqrt(3 - 3/4 t^2).
  const Lanes apart = (3 - 0.75 * t * t).max(0).sqrt(), gap = p * (-1.5 * t - apart), largest = q + p * (apart - t / 2);

  const Lanes dx = xx - smallest, dy = yy - smallest, dz = zz - smallest;
  // Cross products of the rows (dx, xy, xz), (xy, dy, yz), (xz, yz, dz): entries of the adjugate, of which they are columns.
  const Lanes nxx = dy * dz - yz * yz, nyy = dx * dz - xz * xz, nzz = dx * dy - xy * xy;
  const Lanes nxy = xz * yz - xy * dz, nxz = xy * yz - xz * dy, nyz = xy * xz - dx * yz;
  for (Eigen::Index k = 0; k < lanes; ++k) {
    if (stress[k].isZero(0)) continue;
    if (!(r[k] < 0.99)) {
      load[k] = most_compressive_iterated(stress[k]);
      continue;
    }
    if (!(smallest[k] < -nothing * std::max(largest[k], 0.0))) continue;
    load[k].pressure = -smallest[k];
    if (!(gap[k] > same * load[k].pressure)) continue;
    // The adjugate is n (x) n times the product of the two gaps: its column of largest diagonal is the most accurate.
    const Vec3 column = nxx[k] >= nyy[k] && nxx[k] >= nzz[k] ? Vec3(nxx[k], nxy[k], nxz[k])
                        : nyy[k] >= nzz[k]                   ? Vec3(nxy[k], nyy[k], nyz[k])
                                                             : Vec3(nxz[k], nyz[k], nzz[k]);
    load[k].direction = column.normalized();
  }
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
  const std::size_t whole = stress.size() - stress.size() % std::size_t(lanes);
  for (std::size_t i = 0; i < whole; i += std::size_t(lanes)) most_compressive(&stress[i], &load[i]);
  if (whole == stress.size()) return load;
  std::array<Eigen::Matrix3d, std::size_t(lanes)> rest;
  std::array<Load, std::size_t(lanes)> rest_load;
  rest.fill(Eigen::Matrix3d::Zero());
  std::copy(stress.begin() + std::ptrdiff_t(whole), stress.end(), rest.begin());
  most_compressive(rest.data(), rest_load.data());
  std::copy_n(rest_load.begin(), stress.size() - whole, load.begin() + std::ptrdiff_t(whole));
  return load;
}

}  // namespace jam
