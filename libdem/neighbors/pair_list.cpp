#include "libdem/neighbors/pair_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <experimental/simd>
#include <limits>
#include <numeric>

namespace dem {
namespace {

// Cells hold grains of up to so many mean radii; larger ones look further than the next cell.
constexpr double many_sizes = 2;

using Cell = std::array<std::int64_t, 3>;

// Grains sorted by cell, cells numbered row by row over the bounding box. Where the box holds many more cells than grains
// (a few stray grains far away), cells are made larger until their number is in proportion.
struct Grid {
  Vec3 low = Vec3::Zero();
  double edge = 1;
  Cell cells{1, 1, 1};
  std::vector<std::uint32_t> begin, member;

  Cell cell_of(const Vec3& x) const {
    Cell c;
    for (std::size_t k = 0; k < 3; ++k)
      c[k] = std::clamp<std::int64_t>(std::int64_t((x[Eigen::Index(k)] - low[Eigen::Index(k)]) / edge), 0, cells[k] - 1);
    return c;
  }
  std::size_t index(const Cell& c) const { return std::size_t((c[2] * cells[1] + c[1]) * cells[0] + c[0]); }
};

Grid make_grid(const std::vector<Vec3>& position, double edge) {
  Grid grid;
  const std::size_t n = position.size();
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());
  grid.low = -high;
  for (const Vec3& x : position) {
    grid.low = grid.low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vec3 size = high - grid.low;
  const double most = 8.0 * double(n) + 64;
  grid.edge = edge;
  while ((std::floor(size.x() / grid.edge) + 1) * (std::floor(size.y() / grid.edge) + 1) *
             (std::floor(size.z() / grid.edge) + 1) > most)
    grid.edge *= 1.5;
  for (std::size_t k = 0; k < 3; ++k) grid.cells[k] = std::int64_t(std::floor(size[Eigen::Index(k)] / grid.edge)) + 1;
  const std::size_t total = std::size_t(grid.cells[0] * grid.cells[1] * grid.cells[2]);
  grid.begin.assign(total + 1, 0);
  std::vector<std::uint32_t> cell(n);
  for (std::size_t i = 0; i < n; ++i) {
    cell[i] = std::uint32_t(grid.index(grid.cell_of(position[i])));
    ++grid.begin[cell[i] + 1];
  }
  for (std::size_t c = 0; c < total; ++c) grid.begin[c + 1] += grid.begin[c];
  grid.member.resize(n);
  std::vector<std::uint32_t> next(grid.begin.begin(), grid.begin.end() - 1);
  for (std::size_t i = 0; i < n; ++i) grid.member[next[cell[i]]++] = std::uint32_t(i);
  return grid;
}

using Pack = std::experimental::native_simd<double>;

// Column by column, so that a pack of them is looked at at once; the last pack is filled up.
struct Spheres {
  std::vector<double> x, y, z, radius;
  explicit Spheres(std::size_t n) : x(n + Pack::size()), y(x), z(x), radius(x) {}
  void set(std::size_t m, const Vec3& centre, double r) {
    x[m] = centre.x();
    y[m] = centre.y();
    z[m] = centre.z();
    radius[m] = r;
  }

  // Those in [begin, end) that are not larger than a sphere and whose surface is less than `skin` from its own.
  template <class Found>
  void smaller_near(std::size_t begin, std::size_t end, const Vec3& centre, double own, double skin, Found found) const {
    constexpr std::experimental::element_aligned_tag anywhere;
    const Pack cx = centre.x(), cy = centre.y(), cz = centre.z();
    for (std::size_t m = begin; m < end; m += Pack::size()) {
      const Pack dx = cx - Pack(&x[m], anywhere), dy = cy - Pack(&y[m], anywhere), dz = cz - Pack(&z[m], anywhere);
      const Pack r(&radius[m], anywhere), reach = own + r + skin;
      auto near = r <= own && dx * dx + dy * dy + dz * dz < reach * reach;
      while (any_of(near)) {
        const int k = find_first_set(near);
        near[std::size_t(k)] = false;
        if (m + std::size_t(k) < end) found(m + std::size_t(k));
      }
    }
  }
};

}  // namespace

PairList build_pair_list(const std::vector<Vec3>& position, const std::vector<double>& radius, double skin) {
  PairList list;
  const std::size_t n = position.size();
  list.begin.assign(n + 1, 0);
  if (n == 0) return list;
  const double largest = *std::max_element(radius.begin(), radius.end());
  const double mean = std::accumulate(radius.begin(), radius.end(), 0.0) / double(n);
  const Grid grid = make_grid(position, 2 * std::min(largest, many_sizes * mean) + skin);

  // Cell by cell, so that the cells of a row are one stretch of memory. The larger grain of a pair looks for the smaller one, as far as
  // its own size needs: a few large grains among small ones cost no more than the small ones that they touch.
  Spheres spheres(n);
  for (std::size_t m = 0; m < n; ++m) spheres.set(m, position[grid.member[m]], radius[grid.member[m]]);

  constexpr std::size_t rows = 256;  // are handled together
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> found((n + rows - 1) / rows);
#pragma omp parallel for schedule(static)
  for (std::size_t part = 0; part < found.size(); ++part) {
    for (std::size_t i = part * rows; i < std::min((part + 1) * rows, n); ++i) {
      const Cell c = grid.cell_of(position[i]);
      const std::int64_t reach = std::max<std::int64_t>(1, std::int64_t(std::ceil((2 * radius[i] + skin) / grid.edge)));
      const auto low = [&](std::size_t k) { return std::max<std::int64_t>(c[k] - reach, 0); };
      const auto high = [&](std::size_t k) { return std::min(c[k] + reach, grid.cells[k] - 1); };
      for (std::int64_t z = low(2); z <= high(2); ++z)
        for (std::int64_t y = low(1); y <= high(1); ++y) {
          const std::uint32_t begin = grid.begin[grid.index({low(0), y, z})], end = grid.begin[grid.index({high(0), y, z}) + 1];
          spheres.smaller_near(begin, end, position[i], radius[i], skin, [&](std::size_t m) {
            const std::uint32_t j = grid.member[m];
            if (radius[j] == radius[i] && j <= i) return;
            found[part].emplace_back(std::min(std::uint32_t(i), j), std::max(std::uint32_t(i), j));
          });
        }
    }
  }

  for (const auto& pairs : found)
    for (const auto& [i, j] : pairs) ++list.begin[i + 1];
  for (std::size_t i = 0; i < n; ++i) list.begin[i + 1] += list.begin[i];
  list.first.resize(list.begin[n]);
  list.second.resize(list.begin[n]);
  std::vector<std::uint32_t> at(list.begin.begin(), list.begin.end() - 1);
  for (const auto& pairs : found)
    for (const auto& [i, j] : pairs) list.second[at[i]++] = j;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(list.second.begin() + list.begin[i], list.second.begin() + list.begin[i + 1]);
    std::fill(list.first.begin() + list.begin[i], list.first.begin() + list.begin[i + 1], std::uint32_t(i));
  }
  return list;
}

}  // namespace dem
