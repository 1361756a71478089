#include "libdem/geometry/simple_bodies.hpp"

#include <cmath>
#include <random>

#include "libdem/errors.hpp"

namespace dem {

TriangleMesh make_box(const Vec3& size) {
  if (!size.allFinite() || !(size.array() > 0).all())
    throw CaseError("the edges of a box are " + std::to_string(size.x()) + ", " + std::to_string(size.y()) + ", " +
                    std::to_string(size.z()) + " m, expected all > 0");
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  const auto side = [&](std::array<std::uint32_t, 4> corner, FacetLabel label) {
    mesh.triangles.push_back({corner[0], corner[1], corner[2]});
    mesh.triangles.push_back({corner[0], corner[2], corner[3]});
    mesh.labels.insert(mesh.labels.end(), 2, label);
  };
  // Corner k has x, y, z high where bits 0, 1, 2 are set; counter-clockwise seen from outside.
  side({0, 2, 3, 1}, FacetLabel::tip);
  side({4, 5, 7, 6}, FacetLabel::face);
  side({0, 1, 5, 4}, FacetLabel::face);
  side({2, 6, 7, 3}, FacetLabel::face);
  side({0, 4, 6, 2}, FacetLabel::face);
  side({1, 3, 7, 5}, FacetLabel::face);
  return mesh;
}

GluedGrains make_rough_plate(const RoughPlate& plate) {
  const double d = plate.diameter, length = plate.x_high - plate.x_low, width = plate.y_high - plate.y_low;
  if (!(d > 0) || !std::isfinite(d)) throw CaseError("glued grains have a diameter of " + std::to_string(d) + " m, expected > 0");
  if (!(length >= 0) || !(width >= 0) || !std::isfinite(length + width))
    throw CaseError("glued grains cover an area of " + std::to_string(length) + " by " + std::to_string(width) +
                    " m, expected ends that lie above their beginnings");
  if (!(plate.roughness >= 0 && plate.roughness <= 1))
    throw CaseError("the roughness of glued grains is " + std::to_string(plate.roughness) + ", expected 0 to 1");
  if (!std::isfinite(plate.top)) throw CaseError("the top of glued grains is not finite");
  const double row_distance = 0.5 * std::sqrt(3.0) * d;
  if ((length / d + 1) * (width / row_distance + 1) > 1e7) throw CaseError("more than ten million glued grains");
  std::mt19937_64 random(plate.seed);
  std::vector<Vec3> centres;
  // A share of the rounding of the lattice, so that a plate of a whole number of grains has all of them.
  const double slack = 1e-9 * d;
  for (std::size_t row = 0; double(row) * row_distance <= width + slack; ++row)
    for (std::size_t k = 0;; ++k) {
      const double x = (double(k) + (row % 2 == 0 ? 0.0 : 0.5)) * d;
      if (x > length + slack) break;
      const double share = double(random() >> 11) * 0x1.0p-53;
      centres.emplace_back(plate.x_low + x, plate.y_low + double(row) * row_distance,
                           plate.top - 0.5 * d - share * plate.roughness * d);
    }
  return make_glued_grains(centres, std::vector<double>(centres.size(), 0.5 * d));
}

}  // namespace dem
