// What jammed means. A particle is jammed when its compressive force is above its limit, and a contact carries a jam's load above a share of the
// limit (Criteria::bridge_contact_share); a criterion says what the limit of each particle is.
//
// JAM CRITERIA. Add one: a row of the table with a function that gives the limits, N, infinity where a particle cannot be jammed. The tests try every row
// for relabelling, reversed contacts, frames without contacts.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/criteria.hpp"

namespace jam {

struct JamCriterion {
  std::string_view name, unit, doc;  // of the threshold
  double threshold;                  // where Criteria::threshold says nothing
  bool of_stiffness, of_gap;         // needs the materials' stiffness; needs to know where the gap is
  std::vector<double> (*limits)(const ContactGraph& graph, const RunInfo& run, const Criteria& criteria, double threshold);  // [N] N
};

std::span<const JamCriterion> jam_criteria();
const JamCriterion* find_jam_criterion(std::string_view name);

// The criterion that is asked for and its threshold. Condition: check_criteria() has passed.
const JamCriterion& criterion_of(const Criteria& criteria);
double threshold_of(const Criteria& criteria);

// [N] N.
std::vector<double> jam_limits(const ContactGraph& graph, const RunInfo& run, const Criteria& criteria);

// N, E* R^2 of a particle against one of its own material, 1/E* = 2 (1 - nu^2)/E: the force scale of Hertz' contact, with which forces of the
// same indentation grow when grains are made stiffer.
double hertz_scale(const Material& material, double radius);

}  // namespace jam
