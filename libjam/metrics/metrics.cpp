#include "libjam/metrics/metrics.hpp"

#include <algorithm>
#include <array>

#include "libjam/metrics/component_count.hpp"
#include "libjam/metrics/coordination.hpp"
#include "libjam/metrics/coordination_with_walls.hpp"
#include "libjam/metrics/largest_component_share.hpp"
#include "libjam/metrics/mean_repulsive_force.hpp"
#include "libjam/metrics/mechanical_coordination.hpp"
#include "libjam/metrics/strong_contact_share.hpp"

namespace jam {
namespace {

// To add a metric: write libjam/metrics/NAME.hpp with one free function `double NAME(const ContactGraph&)` whose header
// comment states formula, reference and what happens where it is undefined (NaN), include it above, and add its row
// here. The suites in tests/jam/metrics run over this table: the new row is tested for invariance under reordering and
// relabelling of the particles, for empty frames, and for having a unit and a doc line. It appears on the command line
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
