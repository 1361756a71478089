// Every threshold and choice of the analysis in one place.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace jam {

// How the contacts of a particle add up to its compressive force.
enum class CompressiveMeasure {
  sum,     // sum of the repulsive normal force magnitudes (EDEM's quantity, the paper's)
  max,     // the largest of them
  signed_  // sum of the signed normal forces, adhesion negative
};

struct Criteria {
  CompressiveMeasure measure = CompressiveMeasure::sum;
  // What jammed means, a name of libjam/jamming/jam_criteria.cpp, and its threshold in its own unit; nothing: the one of its row. Of
  // compressive_force the threshold is jam_force.
  std::string criterion = "compressive_force";
  std::optional<double> threshold = std::nullopt;
  double jam_force = 20.0;  // N; a particle is jammed when its compressive force is larger (paper, section 3.2)
  // Jams last from where the force rises above end_force, N, to where it falls back to it, if it passes jam_force between; nothing: jam_force.
  // Pauses of up to hold_off, s, do not end them, and those shorter than shortest_jam, s, do not count.
  std::optional<double> end_force = std::nullopt;
  double hold_off = 0, shortest_jam = 0;
  // A contact belongs to a jam's load path when its normal force exceeds this share of jam_force.
  double bridge_contact_share = 0.1;
  // A particle sits in the gap when its centre is farther than tip radius - gap_margin * its diameter from the axis and
  // within the blade's height +- its diameter (reference: physics.md claim 16 has gap_margin = 1/2).
  double gap_margin = 0.5;
  // Upper bounds of the survival-time classes, s; the last class is open (paper, Fig. 9 and Table 4).
  std::vector<double> survival_classes{0.01, 0.02, 0.03, 0.04, 0.05};
  // Metrics recorded for each frame, by their names in libjam/metrics/metrics.cpp; nothing: those of low cost.
  std::optional<std::vector<std::string>> metrics = std::nullopt;
};

}  // namespace jam
