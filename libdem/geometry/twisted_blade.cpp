#include "libdem/geometry/twisted_blade.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include "libdem/case/derived.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/mesh_processing.hpp"

namespace dem {
namespace {

constexpr double default_shaft_length = 60e-3;  // m
constexpr double tip_sagitta = 1. / 4000;       // of the tip radius
constexpr std::size_t shaft_sides = 36;

void require(bool holds, const char* quantity, double value, const char* unit, const std::string& expected) {
  if (holds) return;
  std::ostringstream message;
  message << "blade: " << quantity << " = " << value << ' ' << unit << "; expected " << expected;
  throw GeometryError(message.str());
}

std::string text(double value, const char* unit) {
  std::ostringstream s;
  s << value << ' ' << unit;
  return s.str();
}

void check(const TwistedBlade& b) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  require(positive(b.diameter) && b.diameter < 10, "diameter", b.diameter, "m", "a positive length below 10 m");
  require(positive(b.height), "height", b.height, "m", "a positive length");
  require(positive(b.thickness) && b.thickness <= b.height, "thickness", b.thickness, "m",
          "a positive length of at most the height, " + text(b.height, "m"));
  const double diagonal = std::hypot(b.height, b.thickness);
  require(diagonal < 0.9 * b.diameter, "height", b.height, "m",
          "a section whose diagonal is below 0.9 of the diameter, " + text(0.9 * b.diameter, "m"));
  require(b.thickness > 1e-3 * b.diameter, "thickness", b.thickness, "m",
          "more than a thousandth of the diameter, " + text(1e-3 * b.diameter, "m"));
  require(std::abs(b.tip_twist) <= 80 * std::numbers::pi / 180, "tip_twist", b.tip_twist, "rad",
          "an angle between -1.396 and 1.396 rad (80 degrees)");
  require(b.twist_exponent >= 0.1 && b.twist_exponent <= 10, "twist_exponent", b.twist_exponent, "",
          "a number from 0.1 to 10");
  if (b.shaft_diameter == 0) return;
  require(b.shaft_diameter > 1e-3 * b.diameter && b.shaft_diameter <= b.diameter / 2, "shaft_diameter",
          b.shaft_diameter, "m",
          "0 (no shaft) or a length from a thousandth to half of the diameter, " + text(b.diameter / 2, "m"));
  require(b.shaft_length == 0 || (b.shaft_length > 0.6 * b.height && b.shaft_length < 100 * b.diameter), "shaft_length",
          b.shaft_length, "m",
          "0 (60 mm) or a length above the plate's mid plane of more than 0.6 of its height, " +
              text(0.6 * b.height, "m") + ", and less than " + text(100 * b.diameter, "m"));
}

// The outline of the section, walked so that a sweep along +x has its outside on the right-hand side: points (xi, zeta)
// as fractions of the half thickness and half height, with the label of the side that begins there.
struct OutlinePoint {
  std::size_t i, k;  // of the tip grid: xi = -1 + 2 i / across, zeta = -1 + 2 k / along
  FacetLabel label;
};

std::vector<OutlinePoint> section_outline(std::size_t across, std::size_t along) {
  std::vector<OutlinePoint> outline;
  for (std::size_t i = 0; i < across; ++i) outline.push_back({i, 0, FacetLabel::edge});
  for (std::size_t k = 0; k < along; ++k) outline.push_back({across, k, FacetLabel::face});
  for (std::size_t i = across; i > 0; --i) outline.push_back({i, along, FacetLabel::edge});
  for (std::size_t k = along; k > 0; --k) outline.push_back({0, k, FacetLabel::face});
  return outline;
}

class Plate {
 public:
  explicit Plate(const TwistedBlade& blade) : blade_(blade), radius_(blade.diameter / 2) {
    // A facet that spans w along the tip circle lies up to w^2 / 8 R inside it; cells are chosen so that even their
    // diagonal meets the bound.
    const double cell = std::sqrt(8 * tip_sagitta) * radius_ / std::numbers::sqrt2;
    across_ = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(blade.thickness / cell)));
    along_ = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(blade.height / cell)));
    // Along an arm: at most 1.5 degrees of twist from one section to the next.
    const double twist_step = 1.5 * std::numbers::pi / 180;
    sections_ = std::max<std::size_t>(8, static_cast<std::size_t>(std::ceil(std::abs(blade.tip_twist) / twist_step)));
    sections_ = std::min<std::size_t>(sections_, 40);
  }

  TriangleMesh mesh() {
    const std::vector<OutlinePoint> outline = section_outline(across_, along_);
    const std::size_t n = outline.size(), rings = 2 * sections_ + 1;
    // Rings of vertices from the tip of the arm along -x to the tip of the arm along +x.
    for (std::size_t ring = 0; ring < rings; ++ring)
      for (const OutlinePoint& p : outline) out_.vertices.push_back(position(ring, p));
    for (std::size_t ring = 0; ring + 1 < rings; ++ring)
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t next = (j + 1) % n;
        add_quad(ring * n + j, ring * n + next, (ring + 1) * n + next, (ring + 1) * n + j, outline[j].label);
      }
    add_tip(outline, 0, false);
    add_tip(outline, rings - 1, true);
    return std::move(out_);
  }

 private:
  // The arm along -x is the half turn of the arm along +x.
  Vec3 position(std::size_t ring, const OutlinePoint& p) const {
    const bool positive = ring >= sections_;
    const double u =
        static_cast<double>(positive ? ring - sections_ : sections_ - ring) / static_cast<double>(sections_);
    const double turn = positive ? 1 : -1;
    const double xi = turn * (static_cast<double>(2 * p.i) / static_cast<double>(across_) - 1) * blade_.thickness / 2;
    const double zeta = (static_cast<double>(2 * p.k) / static_cast<double>(along_) - 1) * blade_.height / 2;
    const double beta = blade_.tip_twist * std::pow(u, blade_.twist_exponent);
    const double y = xi * std::cos(beta) + zeta * std::sin(beta), z = zeta * std::cos(beta) - xi * std::sin(beta);
    return {turn * u * tip_x(xi, zeta), turn * y, z};
  }

  double tip_x(double xi, double zeta) const {
    if (blade_.tip_cut == TwistedBlade::TipCut::flat) return flat_tip_distance(blade_);
    const double y = xi * std::cos(blade_.tip_twist) + zeta * std::sin(blade_.tip_twist);
    return std::sqrt((radius_ - y) * (radius_ + y));
  }

  void add_triangle(std::size_t a, std::size_t b, std::size_t c, FacetLabel label) {
    out_.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    out_.labels.push_back(label);
  }

  // Cut along the diagonal that lies outside: it makes the facets meet in a ridge, not in a valley.
  void add_quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d, FacetLabel label) {
    const auto& v = out_.vertices;
    const bool ridge_ac = (v[b] - v[a]).cross(v[c] - v[a]).dot(v[d] - v[a]) <= 0;
    if (ridge_ac) {
      add_triangle(a, b, c, label);
      add_triangle(a, c, d, label);
    } else {
      add_triangle(a, b, d, label);
      add_triangle(b, c, d, label);
    }
  }

  void add_tip(const std::vector<OutlinePoint>& outline, std::size_t ring, bool positive) {
    std::vector<std::size_t> grid((across_ + 1) * (along_ + 1));
    const auto at = [&](std::size_t i, std::size_t k) -> std::size_t& { return grid[i * (along_ + 1) + k]; };
    for (std::size_t j = 0; j < outline.size(); ++j) at(outline[j].i, outline[j].k) = ring * outline.size() + j;
    for (std::size_t i = 1; i < across_; ++i)
      for (std::size_t k = 1; k < along_; ++k) {
        at(i, k) = out_.vertices.size();
        out_.vertices.push_back(position(ring, {i, k, FacetLabel::tip}));
      }
    for (std::size_t i = 0; i < across_; ++i)
      for (std::size_t k = 0; k < along_; ++k) {
        const std::size_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
        if (positive)
          add_quad(a, b, c, d, FacetLabel::tip);
        else
          add_quad(a, d, c, b, FacetLabel::tip);
      }
  }

  const TwistedBlade& blade_;
  double radius_;
  std::size_t across_ = 0, along_ = 0, sections_ = 0;
  TriangleMesh out_;
};

// A prism about z, cut into rings of about `height` above the plate so that its facets are not slivers. It is turned by
// 0.3 of a side so that its vertices do not fall onto the plate's lines of symmetry, where the union would get slivers.
TriangleMesh make_shaft(const TwistedBlade& blade) {
  const double radius = blade.shaft_diameter / 2;
  const double bottom = -0.45 * blade.height, plate_top = 0.55 * blade.height;
  const double top = blade.shaft_length > 0 ? blade.shaft_length : std::max(default_shaft_length, 2 * blade.height);
  std::vector<double> levels{bottom, plate_top};
  const auto rings = static_cast<std::size_t>(std::clamp(std::round((top - plate_top) / blade.height), 1., 20.));
  for (std::size_t r = 1; r <= rings; ++r)
    levels.push_back(plate_top + (top - plate_top) * static_cast<double>(r) / static_cast<double>(rings));

  TriangleMesh out;
  const auto index = [](std::size_t level, std::size_t side) {
    return static_cast<std::uint32_t>(level * shaft_sides + side % shaft_sides);
  };
  for (const double z : levels)
    for (std::size_t side = 0; side < shaft_sides; ++side) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(side) + 0.3) / shaft_sides;
      out.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (std::size_t level = 0; level + 1 < levels.size(); ++level)
    for (std::size_t side = 0; side < shaft_sides; ++side) {
      out.triangles.push_back({index(level, side), index(level, side + 1), index(level + 1, side + 1)});
      out.triangles.push_back({index(level, side), index(level + 1, side + 1), index(level + 1, side)});
    }
  const auto low_centre = static_cast<std::uint32_t>(out.vertices.size()), high_centre = low_centre + 1;
  out.vertices.emplace_back(0, 0, levels.front());
  out.vertices.emplace_back(0, 0, levels.back());
  for (std::size_t side = 0; side < shaft_sides; ++side) {
    out.triangles.push_back({low_centre, index(0, side + 1), index(0, side)});
    out.triangles.push_back({high_centre, index(levels.size() - 1, side), index(levels.size() - 1, side + 1)});
  }
  out.labels.assign(out.triangles.size(), FacetLabel::hub);
  return out;
}

}  // namespace

TriangleMesh make_twisted_blade(const TwistedBlade& blade) {
  check(blade);
  TriangleMesh plate = Plate(blade).mesh();
  return blade.shaft_diameter > 0 ? mesh_union(plate, make_shaft(blade)) : plate;
}

BladeExtent blade_extent(const TriangleMesh& mesh) {
  const auto is_hub = [&](std::size_t t) { return t < mesh.labels.size() && mesh.labels[t] == FacetLabel::hub; };
  bool all_hub = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) all_hub = all_hub && is_hub(t);
  BladeExtent e{0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vec3& p = mesh.vertices[v];
      e.z_low = std::min(e.z_low, p.z());
      if (is_hub(t) && !all_hub) continue;
      e.tip_radius = std::max(e.tip_radius, std::hypot(p.x(), p.y()));
      e.z_high = std::max(e.z_high, p.z());
    }
  return e;
}

void label_tips(TriangleMesh& mesh) {
  constexpr double tip_fraction = 0.98;
  const double cosine = std::cos(30 * std::numbers::pi / 180);
  const auto radius = [&](std::uint32_t v) { return std::hypot(mesh.vertices[v].x(), mesh.vertices[v].y()); };
  double largest = 0;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) largest = std::max(largest, radius(v));
  mesh.labels.assign(mesh.triangles.size(), FacetLabel::face);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (std::min({radius(a), radius(b), radius(c)}) < tip_fraction * largest) continue;
    const auto& v = mesh.vertices;
    const Vec3 normal = (v[b] - v[a]).cross(v[c] - v[a]);
    Vec3 outward = v[a] + v[b] + v[c];
    outward.z() = 0;
    if (normal.dot(outward) > cosine * normal.norm() * outward.norm()) mesh.labels[i] = FacetLabel::tip;
  }
}

}  // namespace dem
