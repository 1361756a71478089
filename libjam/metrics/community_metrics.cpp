#include "libjam/metrics/community_metrics.hpp"

#include <cmath>
#include <limits>

#include "libjam/graph/particle_stress.hpp"
#include "libjam/tessellation/convex_hull.hpp"

namespace jam {
namespace {

using Vertex = ContactGraph::Vertex;

std::vector<std::vector<Vertex>> members_of(const Communities& communities) {
  std::vector<std::vector<Vertex>> members(communities.size.size());
  for (Vertex v = 0; v < communities.label.size(); ++v) members[communities.label[v]].push_back(v);
  return members;
}

Vec3 centre(const ContactGraph& graph, Vertex v) {
  return graph.snapshot().particles.position[v].cast<double>();
}

// Moments of pairs (x, y), about a first guess of the mean so that they do not cancel.
struct Correlation {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double a, double b) {
    n += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
  }
  // NaN where one of them does not vary by more than rounding.
  double value() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    if (!(vx > 1e-12 * xx) || !(vy > 1e-12 * yy)) return std::numeric_limits<double>::quiet_NaN();
    return (xy - x * y / n) / std::sqrt(vx * vy);
  }
};

double distance_correlation(const ContactGraph& graph, const Communities& communities, const std::vector<Vertex>& members,
                            std::vector<std::uint32_t>& away) {
  constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();
  Correlation correlation;
  std::vector<Vertex> front;
  for (const Vertex source : members) {
    front.assign(1, source);
    away[source] = 0;
    for (std::size_t k = 0; k < front.size(); ++k) {
      const Vertex v = front[k];
      if (v > source) correlation.add(away[v], (centre(graph, v) - centre(graph, source)).norm());
      for (const ContactGraph::Neighbor& n : graph.neighbors(v))
        if (away[n.vertex] == unreached && communities.label[n.vertex] == communities.label[source]) {
          away[n.vertex] = away[v] + 1;
          front.push_back(n.vertex);
        }
    }
    for (const Vertex v : front) away[v] = unreached;
  }
  return correlation.value();
}

}  // namespace

double gap_factor(const ContactGraph& graph, const Communities& communities) {
  double sum = 0, count = 0;
  std::vector<std::uint32_t> away(graph.vertex_count(), std::numeric_limits<std::uint32_t>::max());
  for (const std::vector<Vertex>& members : members_of(communities)) {
    if (members.size() < 3) break;  // largest first
    const double r = distance_correlation(graph, communities, members, away);
    if (std::isnan(r)) continue;
    sum += 1 - r * double(members.size()) / double(communities.size[0]);
    count += 1;
  }
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

double hull_ratio(const ContactGraph& graph, const Communities& communities) {
  const std::vector<double> volume = sphere_volumes(graph.snapshot());
  double sum = 0, count = 0;
  for (const std::vector<Vertex>& members : members_of(communities)) {
    if (members.size() < 4) break;
    std::vector<Vec3> centres;
    double particles = 0;
    for (const Vertex v : members) {
      centres.push_back(centre(graph, v));
      particles += volume[v];
    }
    const double hull = convex_hull_volume(centres);
    if (!(hull > 0)) continue;
    sum += hull / particles;
    count += 1;
  }
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace jam
