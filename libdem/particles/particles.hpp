// The grains: spheres as structure of arrays.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// V = (4/3) pi R^3, m^3.
inline double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
// I = (2/5) m R^2, kg m^2.
template <class Real>
Real sphere_inertia(const Real& mass, const Real& radius) { return 0.4 * mass * radius * radius; }
// 1/(kg m^2): one over it, from one over mass, 1/kg, and radius, 1/m; no division.
inline double inverse_sphere_inertia(double per_mass, double per_radius) { return 2.5 * per_mass * (per_radius * per_radius); }

struct Particles {
  std::vector<std::uint32_t> id;       // persistent
  std::vector<std::uint8_t> material;  // index into the run's materials
  std::vector<double> radius;          // m
  std::vector<Vec3> position;          // m
  std::vector<Vec3> velocity;          // m/s, half a step before `position`
  std::vector<Vec3> angular_velocity;  // rad/s, likewise
  std::size_t size() const { return id.size(); }

  void add(std::uint32_t new_id, std::uint8_t new_material, double new_radius, const Vec3& x,
           const Vec3& v = Vec3::Zero(), const Vec3& w = Vec3::Zero()) {
    id.push_back(new_id);
    material.push_back(new_material);
    radius.push_back(new_radius);
    position.push_back(x);
    velocity.push_back(v);
    angular_velocity.push_back(w);
  }
};

}  // namespace dem
