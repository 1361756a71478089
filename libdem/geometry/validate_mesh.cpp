#include "libdem/geometry/validate_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "libdem/errors.hpp"
#include "libdem/geometry/mesh_processing.hpp"
#include "libdem/geometry/mesh_topology.hpp"

namespace dem {
namespace {

constexpr std::size_t most_triangles = 10'000'000;
constexpr std::uint32_t no_number = std::numeric_limits<std::uint32_t>::max();
constexpr double farthest = 1e3;          // m
constexpr double smallest_height = 1e-9;  // of the longest side

struct Place {
  const TriangleMesh& mesh;
  const std::string& name;

  std::string vertex(std::uint32_t v) const {
    std::ostringstream s;
    const Vec3& p = mesh.vertices[v];
    s << v << " (" << p.x() << ", " << p.y() << ", " << p.z() << " m)";
    return s.str();
  }
  std::string triangle(std::size_t t) const {
    std::ostringstream s;
    const auto& [a, b, c] = mesh.triangles[t];
    s << "triangle " << t << " with vertices " << vertex(a) << ", " << vertex(b) << ", " << vertex(c);
    return s.str();
  }
  [[noreturn]] void fail(const std::string& what) const { throw GeometryError("mesh '" + name + "': " + what); }
};

bool is_degenerate(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  // Twice the area is height times longest side. Scaled by the longest side so that tiny meshes do not underflow.
  if (!(longest > 0) || longest < std::numeric_limits<double>::min()) return true;
  const double scale = 1 / std::sqrt(longest);
  return !(((b - a) * scale).cross((c - a) * scale).norm() > smallest_height);
}

void check_indices(const Place& place) {
  const TriangleMesh& mesh = place.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size())
        place.fail("triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                   "; expected a number below " + std::to_string(mesh.vertices.size()));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (!(mesh.vertices[v].cwiseAbs().maxCoeff() <= farthest) || !mesh.vertices[v].allFinite())
      place.fail("vertex " + place.vertex(v) + "; expected finite coordinates within 1000 m of the origin");
}

void check_edges(const Place& place) {
  const std::vector<HalfEdge> half = sorted_half_edges(place.mesh);
  for (std::size_t first = 0, last = 0; first < half.size(); first = last) {
    const HalfEdge& e = half[first];
    while (last < half.size() && half[last].low == e.low && half[last].high == e.high) ++last;
    const std::string edge = "the edge from vertex " + place.vertex(e.low) + " to " + place.vertex(e.high);
    if (last - first != 2) {
      std::string facets;
      for (std::size_t h = first; h < std::min(last, first + 8); ++h)
        facets += (h > first ? ", " : "") + std::to_string(half[h].facet);
      place.fail(edge + " belongs to " + std::to_string(last - first) + " triangle(s): " + facets +
                 "; in a closed surface each edge belongs to exactly two");
    }
    if (e.forward == half[first + 1].forward)
      place.fail("triangles " + std::to_string(e.facet) + " and " + std::to_string(half[first + 1].facet) +
                 " run through " + edge +
                 " in the same direction; expected opposite directions (all normals on the same side)");
  }
}

// Equivalence classes of 0 .. n-1 under the pairs joined so far; a class is named by its smallest member.
class Components {
 public:
  explicit Components(std::size_t n) : sets_(n), size_(n) {}
  void join(std::size_t a, std::size_t b) { sets_.union_set(a, b); }
  std::vector<std::uint32_t> names() {
    std::vector<std::uint32_t> smallest(size_, no_number), out;
    for (std::uint32_t i = 0; i < size_; ++i) {
      std::uint32_t& name = smallest[sets_.find_set(static_cast<std::size_t>(i))];
      if (name == no_number) name = i;
      out.push_back(name);
    }
    return out;
  }

 private:
  boost::disjoint_sets_with_storage<> sets_;
  std::size_t size_;
};

void check_fans(const Place& place) {
  // The corners at a vertex form one fan if stepping over the edges that leave the vertex reaches all of them.
  const auto& triangles = place.mesh.triangles;
  Components corners(3 * triangles.size());
  const auto corner_of = [&](std::uint32_t f, std::uint32_t v) {
    const auto k = std::ranges::find(triangles[f], v) - triangles[f].begin();
    return static_cast<std::uint32_t>(3 * f + k);
  };
  for (const MeshEdge& e : unique_edges(place.mesh))
    for (const std::uint32_t v : e.vertices) corners.join(corner_of(e.facets[0], v), corner_of(e.facets[1], v));
  const std::vector<std::uint32_t> fans = corners.names();
  std::vector<std::uint32_t> fan_of(place.mesh.vertices.size(), no_number);
  for (std::uint32_t c = 0; c < fans.size(); ++c) {
    std::uint32_t& known = fan_of[triangles[c / 3][c % 3]];
    if (known == no_number) known = fans[c];
    if (known != fans[c])
      place.fail("two parts of the surface touch only in vertex " + place.vertex(triangles[c / 3][c % 3]) +
                 " (triangles " + std::to_string(known / 3) + " and " + std::to_string(fans[c] / 3) +
                 "); expected one fan of triangles around each vertex");
  }
}

std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh) {
  Components components(mesh.triangles.size());
  const std::vector<HalfEdge> half = sorted_half_edges(mesh);
  for (std::size_t h = 1; h < half.size(); ++h)
    if (half[h].low == half[h - 1].low && half[h].high == half[h - 1].high)
      components.join(half[h].facet, half[h - 1].facet);
  return components.names();
}

// Signed volume of each component, at the index of its first triangle.
std::vector<double> component_volumes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& component) {
  std::vector<double> volumes(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    // Relative to a vertex of the component, so that a body far from the origin loses no digits.
    const Vec3& origin = mesh.vertices[mesh.triangles[component[t]][0]];
    const auto& [a, b, c] = mesh.triangles[t];
    volumes[component[t]] +=
        (mesh.vertices[a] - origin).cross(mesh.vertices[b] - origin).dot(mesh.vertices[c] - origin) / 6;
  }
  return volumes;
}

void check_volumes(const Place& place) {
  const std::vector<std::uint32_t> component = triangle_components(place.mesh);
  const std::vector<double> volumes = component_volumes(place.mesh, component);
  for (std::uint32_t t = 0; t < component.size(); ++t)
    if (component[t] == t && !(volumes[t] > 0)) {
      std::ostringstream s;
      s << "the closed part that holds " << place.triangle(t) << " encloses a volume of " << volumes[t]
        << " m^3; expected a positive one (normals outward, no cavities)";
      place.fail(s.str());
    }
}

}  // namespace

void validate_mesh(const TriangleMesh& mesh, const std::string& name) {
  const Place place{mesh, name};
  if (mesh.triangles.size() < 4 || mesh.triangles.size() > most_triangles)
    place.fail(std::to_string(mesh.triangles.size()) + " triangles; expected a closed surface of 4 to 10 000 000");
  if (!mesh.labels.empty() && mesh.labels.size() != mesh.triangles.size())
    place.fail(std::to_string(mesh.labels.size()) + " labels for " + std::to_string(mesh.triangles.size()) +
               " triangles; expected one for each");
  check_indices(place);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_degenerate(mesh, mesh.triangles[t]))
      place.fail(place.triangle(t) + " has no area; expected its height to be at least 1e-9 of its longest side");
  check_edges(place);
  check_fans(place);
  check_volumes(place);
  const auto crossings = self_intersections(mesh);
  if (!crossings.empty())
    place.fail(std::to_string(crossings.size()) +
               " pair(s) of triangles cross or overlap, the first: " + place.triangle(crossings[0][0]) + ", and " +
               place.triangle(crossings[0][1]) + "; expected a surface that does not meet itself");
}

namespace {

// Names each vertex by the first one (by number) that it is merged into. Equal vertices are found by sorting; the rest
// are sorted into cells as wide as the merge distance, and the first vertex of a cell stands for all in it, so that
// even a million vertices in one place take no time.
std::vector<std::uint32_t> merge_map(const std::vector<Vec3>& vertices, double distance) {
  constexpr double smallest_distance = 1e-15;  // m; keeps cell numbers within 64 bits
  Components groups(vertices.size());
  if (distance < smallest_distance) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(
        order, {}, [&](std::uint32_t v) { return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z(), v); });
    for (std::size_t i = 1; i < order.size(); ++i)
      if (vertices[order[i]] == vertices[order[i - 1]]) groups.join(order[i - 1], order[i]);
    return groups.names();
  }
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, std::uint32_t> first_in_cell;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const Vec3 scaled = vertices[v] / distance;
    const Cell cell{std::llround(scaled.x()), std::llround(scaled.y()), std::llround(scaled.z())};
    const auto [own, is_first] = first_in_cell.try_emplace(cell, v);
    groups.join(own->second, v);
    for (int n = 0; is_first && n < 27; ++n) {
      const auto near = first_in_cell.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (near != first_in_cell.end() && (vertices[near->second] - vertices[v]).norm() <= distance)
        groups.join(near->second, v);
    }
  }
  return groups.names();
}

void drop_unused_vertices(MeshRepair& repair) {
  TriangleMesh& mesh = repair.mesh;
  std::vector<std::uint32_t> number(mesh.vertices.size(), no_number);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) number[v] = 0;
  std::vector<Vec3> kept;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == no_number) continue;
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(mesh.vertices[v]);
  }
  for (auto& t : mesh.triangles)
    for (std::uint32_t& v : t) v = number[v];
  repair.unused_vertices = mesh.vertices.size() - kept.size() - repair.merged_vertices;
  mesh.vertices = std::move(kept);
}

}  // namespace

MeshRepair weld_mesh(const TriangleMesh& mesh, double merge_distance) {
  check_indices({mesh, "to be repaired"});
  MeshRepair repair;
  const std::vector<std::uint32_t> merged = merge_map(mesh.vertices, std::max(merge_distance, 0.));
  for (std::uint32_t v = 0; v < merged.size(); ++v) repair.merged_vertices += merged[v] != v;

  repair.mesh.vertices = mesh.vertices;
  std::set<std::array<std::uint32_t, 3>> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::uint32_t, 3> triangle{}, key{};
    std::ranges::transform(mesh.triangles[t], triangle.begin(), [&](std::uint32_t v) { return merged[v]; });
    key = triangle;
    std::ranges::sort(key);
    if (is_degenerate(repair.mesh, triangle)) {
      ++repair.degenerate_triangles;
    } else if (!seen.insert(key).second) {
      ++repair.repeated_triangles;
    } else {
      repair.mesh.triangles.push_back(triangle);
      if (t < mesh.labels.size()) repair.mesh.labels.push_back(mesh.labels[t]);
    }
  }
  drop_unused_vertices(repair);
  return repair;
}

MeshRepair repair_mesh(const TriangleMesh& mesh, double merge_distance) {
  MeshRepair repair = weld_mesh(mesh, merge_distance);
  std::vector<char> turned(repair.mesh.triangles.size(), 0);
  for (const std::uint32_t t : orient_consistently(repair.mesh)) turned[t] = 1;
  const std::vector<std::uint32_t> component = triangle_components(repair.mesh);
  const std::vector<double> volumes = component_volumes(repair.mesh, component);
  for (std::size_t t = 0; t < component.size(); ++t)
    if (volumes[component[t]] < 0) {
      std::swap(repair.mesh.triangles[t][1], repair.mesh.triangles[t][2]);
      turned[t] = !turned[t];
    }
  repair.turned_triangles = static_cast<std::size_t>(std::ranges::count(turned, 1));
  return repair;
}

}  // namespace dem
