#include "libjam/jamming/compressive_force.hpp"

#include <algorithm>

#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

template <class Add>
std::vector<double> over_contacts(const ContactGraph& graph, Add add) {
  std::vector<double> result(graph.vertex_count(), 0.0);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    for (const ContactGraph::Neighbor& n : graph.neighbors(v))
      add(result[v], normal_force(graph.snapshot().pp, n.contact));
    for (const std::uint32_t c : graph.wall_contacts(v)) add(result[v], normal_force(graph.snapshot().pw, c));
  }
  return result;
}

}  // namespace

std::vector<double> compressive_forces(const ContactGraph& graph, CompressiveMeasure measure) {
  switch (measure) {
    case CompressiveMeasure::max:
      return over_contacts(graph, [](double& result, double f) { result = std::max(result, f); });
    case CompressiveMeasure::signed_:
      return over_contacts(graph, [](double& result, double f) { result += f; });
    case CompressiveMeasure::sum:
      break;
  }
  return over_contacts(graph, [](double& result, double f) { result += std::max(f, 0.0); });
}

}  // namespace jam
