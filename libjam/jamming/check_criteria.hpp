// The gate for the analysis options.
#pragma once
#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Throws CriteriaError, naming the option, its value and what was expected: a threshold, share or margin that is
// negative or not finite; survival classes that are not positive and strictly ascending; no wall of role blade or none
// of role vessel, because a bridge goes from one to the other.
void check_criteria(const Criteria& criteria, const RunInfo& info);

}  // namespace jam
