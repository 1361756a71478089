// Grains at random and the list of their pairs, as the blocks of contacts are made of.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "libdem/contact/pair_blocks.hpp"

namespace dem::support {

struct Scene {
  LargeArray<GrainRow> rows;
  std::vector<std::uint8_t> material;
  PairList list;
  MaterialTable materials;
  GrainTable table() const { return {rows, material}; }
};

// Grains of two materials, enough for several chunks.
inline Scene random_scene(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> draw(0, 1);
  const double side = 10 * std::max(1.0, std::cbrt(double(n) / 1600));
  Scene s;
  std::vector<Vec3> x;
  std::vector<double> radius;
  for (std::size_t i = 0; i < n; ++i) {
    x.emplace_back(side * draw(random), side * draw(random), side * draw(random));
    radius.push_back(0.4 + 0.2 * draw(random));
    GrainRow row;
    row.place = quad(x[i], radius[i]);
    s.material.push_back(draw(random) < 0.7 ? 0 : 1);
    row.spin[3] = 1 + draw(random);
    s.rows.push_back(row);
  }
  s.rows.resize(n + RowChunks(n).count(), phantom());
  s.list = build_pair_list(x, radius, 0.2);
  s.materials =
      make_material_table({{"a", 1, 1e9, 0.2}, {"b", 1, 2e9, 0.3}},
                          {{{0.9, 0.5, 0, 0.1}, {0.8, 0.4, 0, 0.2}}, {{0.8, 0.4, 0, 0.2}, {0.7, 0.3, 0, 0.3}}});
  return s;
}

// Half of the pairs touch, on three levels.
inline std::optional<std::uint8_t> level(std::uint32_t i, std::uint32_t j) {
  if ((i + j) % 2 == 0) return std::nullopt;
  return std::uint8_t(i % 3);
}

}  // namespace dem::support
