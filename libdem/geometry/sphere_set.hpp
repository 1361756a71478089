// Spheres that keep their places to each other, and a grid of cells that finds those near a point.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

class SphereSet {
 public:
  // Centres and radii in m. Throws CaseError where they differ in number, for none, for radii that are not > 0 and for
  // centres that are not finite.
  SphereSet(std::vector<Vec3> centres, std::vector<double> radii);

  std::span<const Vec3> centres() const { return centres_; }
  std::span<const double> radii() const { return radii_; }
  double reach() const { return reach_; }  // m, of the farthest point of a sphere from the origin

  // Spheres whose surface or inside is at most `reach` from x, ascending. Appends.
  void within(const Vec3& x, double reach, std::vector<std::uint32_t>& out) const;
  bool any_within(const Vec3& x, double reach) const;

 private:
  template <class F>
  bool visit_cells(const Vec3& x, double reach, F&& stop_at) const;
  bool is_within(std::uint32_t sphere, const Vec3& x, double reach) const;

  std::vector<Vec3> centres_;
  std::vector<double> radii_;
  double reach_ = 0, largest_ = 0;              // m; largest radius
  Vec3 low_;                                    // m, corner of the grid
  double cell_ = 1;                             // m, edge of a cell
  std::array<std::size_t, 3> cells_{};          // per direction
  std::vector<std::uint32_t> begin_, of_cell_;  // compressed rows: the spheres of each cell, ascending
};

}  // namespace dem
