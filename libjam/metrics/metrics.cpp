#include "libjam/metrics/metrics.hpp"

#include <algorithm>
#include <array>

#include "libjam/metrics/bridge.hpp"
#include "libjam/metrics/clustering.hpp"
#include "libjam/metrics/component_count.hpp"
#include "libjam/metrics/coordination.hpp"
#include "libjam/metrics/coordination_with_walls.hpp"
#include "libjam/metrics/fabric.hpp"
#include "libjam/metrics/force_chain_metrics.hpp"
#include "libjam/metrics/independent_cycles.hpp"
#include "libjam/metrics/largest_component_share.hpp"
#include "libjam/metrics/largest_core_number.hpp"
#include "libjam/metrics/mean_repulsive_force.hpp"
#include "libjam/metrics/mechanical_coordination.hpp"
#include "libjam/metrics/rattler_share.hpp"
#include "libjam/metrics/sliding_share.hpp"
#include "libjam/metrics/strong_contact_share.hpp"

namespace jam {
namespace {

// To add a metric: write a free function `double NAME(const ContactGraph&)` in a header of its own, or in that of its closest
// kin, whose comment states formula, reference and what happens where it is undefined (NaN), include it above, and add its row
// here. The suites in tests/jam/metrics run over this table: the new row is tested for invariance under reordering and
// relabelling of the particles, for rigid motions, for empty frames, and for having a unit and a doc line. It appears on the command line
// by itself.
constexpr auto table = std::to_array<Metric>({
    {"coordination", "1", "mean number of particle contacts per particle, walls not counted", coordination},
    {"coordination_with_walls", "1", "mean number of contacts per particle, walls counted", coordination_with_walls},
    {"mechanical_coordination", "1", "coordination of the particles with two or more contacts (Thornton)",
     mechanical_coordination},
    {"mean_repulsive_force", "N", "mean normal force of the compressed particle contacts", mean_repulsive_force},
    {"strong_contact_share", "1", "share of compressed particle contacts above their mean force", strong_contact_share},
    {"component_count", "1", "connected components of the contact network", component_count},
    {"largest_component_share", "1", "share of particles in the largest component", largest_component_share},
    {"rattler_share", "1", "share of particles that their contacts cannot hold, with friction", rattler_share},
    {"sliding_share", "1", "share of particle contacts at their friction limit", sliding_share},
    {"largest_core_number", "1", "largest k for which there is a k-core", largest_core_number},
    {"triangle_count", "1", "triples of particles that touch each other", triangle_count},
    {"transitivity", "1", "share of pairs of contacts at a particle that a third contact closes", transitivity},
    {"mean_clustering", "1", "mean clustering coefficient of the particles with two or more contacts", mean_clustering},
    {"independent_cycles", "1", "cyclomatic number of the contact network", independent_cycles},
    {"fabric_anisotropy", "1", "anisotropy of the contacts' directions", fabric_anisotropy},
    {"force_fabric_anisotropy", "1", "the same, contacts weighted by their repulsive force", force_fabric_anisotropy},
    {"strong_fabric_anisotropy", "1", "the same of the contacts above the mean repulsive force", strong_fabric_anisotropy},
    {"weak_fabric_anisotropy", "1", "the same of the other repulsive contacts", weak_fabric_anisotropy},
    {"force_chain_count", "1", "linear force chains (Peters et al.)", force_chain_count},
    {"force_chain_share", "1", "share of particles in force chains", force_chain_share},
    {"mean_force_chain_length", "1", "particles of a force chain in the mean", mean_force_chain_length},
    {"bridging_force_chains", "1", "force chains from blade to vessel", bridging_force_chains},
    {"bridge_strength", "N", "weakest contact of the strongest path from blade to vessel", bridge_strength},
    {"bridge_flow", "N", "maximum flow of repulsive force from blade to vessel", bridge_flow},
    {"contact_disjoint_load_paths", "1", "paths from blade to vessel that share no contact",
     [](const ContactGraph& graph) { return double(contact_disjoint_load_paths(graph)); }},
    {"particle_disjoint_load_paths", "1", "paths from blade to vessel that share no particle",
     [](const ContactGraph& graph) { return double(particle_disjoint_load_paths(graph)); }},
});

}  // namespace

std::span<const Metric> metrics() {
  return table;
}

const Metric* find_metric(std::string_view name) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const Metric& m) { return m.name == name; });
  return row == table.end() ? nullptr : &*row;
}

}  // namespace jam
