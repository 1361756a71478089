#include "libjam/jamming/jam_criteria.hpp"

#include <algorithm>
#include <limits>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/widest_path.hpp"
#include "libjam/jamming/gap.hpp"

namespace jam {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

double hertz_scale(const ContactGraph& graph, const RunInfo& run, ContactGraph::Vertex v) {
  const Particles& p = graph.snapshot().particles;
  const std::size_t material = present(p.material, p.size()) ? p.material[v] : 0;
  return hertz_scale(run.materials[material], double{p.radius[v]});
}

std::vector<double> same_for_all(const ContactGraph& graph, const RunInfo&, const Criteria&, double threshold) {
  return std::vector<double>(graph.vertex_count(), threshold);
}

std::vector<double> by_stiffness(const ContactGraph& graph, const RunInfo& run, const Criteria&, double threshold) {
  std::vector<double> limit(graph.vertex_count());
  for (ContactGraph::Vertex v = 0; v < limit.size(); ++v) limit[v] = threshold * hertz_scale(graph, run, v);
  return limit;
}

bool pressed_by(const ContactGraph& graph, ContactGraph::Vertex v, WallRole role) {
  const auto contacts = graph.wall_contacts(v, role);
  return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t c) { return repulsive_force(graph.snapshot().pw, c) > 0; });
}

std::vector<double> of_the_wedged(const ContactGraph& graph, const RunInfo& run, const Criteria& criteria, double threshold) {
  std::vector<double> limit(graph.vertex_count(), never);
  for (ContactGraph::Vertex v = 0; v < limit.size(); ++v)
    if (pressed_by(graph, v, WallRole::blade) && pressed_by(graph, v, WallRole::vessel) && in_gap(graph.snapshot(), v, run, criteria))
      limit[v] = threshold * hertz_scale(graph, run, v);
  return limit;
}

std::vector<double> of_the_bridge(const ContactGraph& graph, const RunInfo& run, const Criteria&, double threshold) {
  std::vector<double> limit(graph.vertex_count(), never);
  const WidestPath path = widest_path(graph, contacts_by_force(graph));
  for (const ContactGraph::Vertex v : path.particles) {
    const double least = threshold * hertz_scale(graph, run, v);
    if (path.strength > least) limit[v] = least;
  }
  return limit;
}

// 20 N is the paper's; over E* R^2 of its glass beads of 0.925 mm it is 2.85e-3. A contact of a wedged grain carries about half of what the
// grain's forces add up to.
constexpr JamCriterion table[] = {
    {"compressive_force", "N", "the sum of its repulsive forces is above a force, the same for all (the paper's)", 20, false, false, same_for_all},
    {"scaled_force", "1", "the sum of its repulsive forces is above a multiple of E* R^2, whatever the stiffness", 2.85e-3, true, false, by_stiffness},
    {"wedged", "1", "in the gap, pressed by the blade and by the vessel, and above a multiple of E* R^2", 1e-5, true, true, of_the_wedged},
    {"bridge", "1", "on the strongest path from blade to vessel, whose weakest contact is above a multiple of E* R^2", 1.4e-3, true, false, of_the_bridge},
};

}  // namespace

std::span<const JamCriterion> jam_criteria() { return table; }

const JamCriterion* find_jam_criterion(std::string_view name) {
  for (const JamCriterion& row : table)
    if (row.name == name) return &row;
  return nullptr;
}

const JamCriterion& criterion_of(const Criteria& criteria) { return *find_jam_criterion(criteria.criterion); }

double threshold_of(const Criteria& criteria) {
  const JamCriterion& criterion = criterion_of(criteria);
  return criterion.unit == "N" ? criteria.jam_force : criteria.threshold.value_or(criterion.threshold);
}

std::vector<double> jam_limits(const ContactGraph& graph, const RunInfo& run, const Criteria& criteria) {
  return criterion_of(criteria).limits(graph, run, criteria, threshold_of(criteria));
}

double hertz_scale(const Material& material, double radius) {
  return material.young / (2 * (1 - material.poisson * material.poisson)) * radius * radius;
}

}  // namespace jam
