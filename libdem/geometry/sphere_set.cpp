#include "libdem/geometry/sphere_set.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libdem/errors.hpp"

namespace dem {
namespace {

// Cells a query visits grow with the grid's fineness, spheres it tests with its coarseness.
constexpr double cells_per_sphere = 2;

}  // namespace

SphereSet::SphereSet(std::vector<Vec3> centres, std::vector<double> radii)
    : centres_(std::move(centres)), radii_(std::move(radii)) {
  if (centres_.size() != radii_.size())
    throw CaseError(std::to_string(centres_.size()) + " centres and " + std::to_string(radii_.size()) +
                    " radii of spheres, expected as many");
  if (centres_.empty()) throw CaseError("a set of spheres is empty");
  low_ = centres_.front();
  Vec3 high = low_;
  for (std::size_t s = 0; s < centres_.size(); ++s) {
    if (!centres_[s].allFinite() || !(radii_[s] > 0) || !std::isfinite(radii_[s]))
      throw CaseError("sphere " + std::to_string(s) + " has a centre that is not finite or a radius that is not > 0");
    low_ = low_.cwiseMin(centres_[s]);
    high = high.cwiseMax(centres_[s]);
    largest_ = std::max(largest_, radii_[s]);
    reach_ = std::max(reach_, centres_[s].norm() + radii_[s]);
  }
  cell_ = 2 * largest_;
  const auto cells = [&] {
    double product = 1;
    for (std::size_t k = 0; k < 3; ++k)
      product *= std::floor((high[Eigen::Index(k)] - low_[Eigen::Index(k)]) / cell_) + 1;
    return product;
  };
  while (cells() > cells_per_sphere * double(centres_.size()) + 8) cell_ *= 1.25;
  for (std::size_t k = 0; k < 3; ++k)
    cells_[k] = std::size_t((high[Eigen::Index(k)] - low_[Eigen::Index(k)]) / cell_) + 1;
  const auto cell_of = [&](const Vec3& x) {
    std::size_t index = 0;
    for (std::size_t k = 0; k < 3; ++k)
      index = index * cells_[k] +
              std::min(std::size_t((x[Eigen::Index(k)] - low_[Eigen::Index(k)]) / cell_), cells_[k] - 1);
    return index;
  };
  begin_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
  for (const Vec3& x : centres_) ++begin_[cell_of(x) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  of_cell_.resize(centres_.size());
  for (std::uint32_t s = 0; s < centres_.size(); ++s) of_cell_[next[cell_of(centres_[s])]++] = s;
}

bool SphereSet::is_within(std::uint32_t sphere, const Vec3& x, double reach) const {
  const double far = reach + radii_[sphere];
  return far >= 0 && (centres_[sphere] - x).squaredNorm() <= far * far;
}

// Goes through the spheres whose cells meet the cube of half edge reach + largest radius about x until `stop_at` says
// so.
template <class F>
bool SphereSet::visit_cells(const Vec3& x, double reach, F&& stop_at) const {
  const double far = reach + largest_;
  std::array<std::size_t, 3> first{}, last{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double from = std::floor((x[Eigen::Index(k)] - far - low_[Eigen::Index(k)]) / cell_);
    const double to = std::floor((x[Eigen::Index(k)] + far - low_[Eigen::Index(k)]) / cell_);
    if (!(to >= 0) || !(from < double(cells_[k]))) return false;
    first[k] = std::size_t(std::max(from, 0.0));
    last[k] = std::size_t(std::min(to, double(cells_[k] - 1)));
  }
  for (std::size_t a = first[0]; a <= last[0]; ++a)
    for (std::size_t b = first[1]; b <= last[1]; ++b) {
      const std::size_t row = (a * cells_[1] + b) * cells_[2];
      for (std::uint32_t k = begin_[row + first[2]]; k < begin_[row + last[2] + 1]; ++k)
        if (is_within(of_cell_[k], x, reach) && stop_at(of_cell_[k])) return true;
    }
  return false;
}

void SphereSet::within(const Vec3& x, double reach, std::vector<std::uint32_t>& out) const {
  const auto first = std::ptrdiff_t(out.size());
  visit_cells(x, reach, [&](std::uint32_t sphere) {
    out.push_back(sphere);
    return false;
  });
  std::sort(out.begin() + first, out.end());
}

bool SphereSet::any_within(const Vec3& x, double reach) const {
  return visit_cells(x, reach, [](std::uint32_t) { return true; });
}

}  // namespace dem
