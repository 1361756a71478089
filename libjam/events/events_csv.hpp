// Events as a table that any tool reads.
#pragma once
#include <span>
#include <string>

#include "libjam/events/event.hpp"
#include "libjam/events/every_step.hpp"

namespace jam {

// One row per global event, then one per cluster's identity, then one per track; column `stream` is "global", "cluster" or "particle". Units stand in the header.
// Comma-separated, "." as decimal point in every locale, line ends "\n"; truth values are 0 and 1, members are joined
// by
// ";", an open bracket ends in "inf". Numbers have as many digits as give back the same double, so identical analyses
// give identical bytes.
std::string events_csv(std::span<const JamEvent> events, std::span<const JamEvent> clusters, std::span<const Track> tracks);

// Jams seen at every step: a header, and one row per jam of a stream, in the same manner.
std::string_view step_jams_header();
std::string step_jams_rows(JamStream stream, std::span<const StepJam> jams);

}  // namespace jam
