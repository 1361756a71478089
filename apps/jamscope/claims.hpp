// jamscope claims: statements about runs, read from a file, measured on the summaries of runs.
//
// A claims file is a TOML file of tables [claim.NAME]:
//
//   [claim.blade_force_a]
//   number = 1                               # its place in the table
//   says = "peaks of the blade's axial force in A exceed 40 N"
//   source = "Fig. 3(a)"
//   expected = "> 40 N"                      # as the source has it
//   measure = "value"                        # a row of the table in claims.cpp
//   of = "blade.force_N.every_step"          # where in summary.json, below `analysis`
//   run = "ft4_a_down"                       # runs by the name of their case
//   low = 10.0                               # holds from here
//   high = 400.0                             # to here; either may be left out
//
// and, where the measure uses them, `observed_time` (the shortest record that counts), `at`, `against_run`,
// `against_of` (default: `of`), `first`, `values`, `components` (so many numbers of a list are one place).
//
// Several runs of one name are repetitions (other seeds): the measure takes the median of them, and its interval goes from the smallest to the
// largest that any choice of them gives.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace jamscope {

enum class ClaimsFormat { text, markdown, json };

struct ClaimsOptions {
  std::vector<std::string> runs;  // folders with a summary.json, or such files, or folders of them
  std::string claims;             // file
  std::string variant;            // asked of runs whose names end so in addition: `ft4_a_down` is `ft4_a_down_flat` with `_flat`
  std::optional<double> shortest;  // s, of a record that counts, in place of the claims' own `observed_time`
  bool only_measured = false;     // leaves out what these runs do not measure
  ClaimsFormat format = ClaimsFormat::text;
};

// Prints the table to standard output. Returns 0 whatever the verdicts are. Throws dem::CaseError for the claims file, jam::DataError for a summary, UsageError for a variant that no run is.
int claims(const ClaimsOptions& options);

// One line per measure, for the help text.
std::string claim_measures();

}  // namespace jamscope
