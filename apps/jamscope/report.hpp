// report.html: one page, readable from disk without network, that shows what one analysis found, or several side by side.
//
// The page is apps/report, built once by npm, checked in and compiled into the program; this file only fills in the
// data.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "apps/jamscope/scene_data.hpp"
#include "libjam/analysis.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

// One line of the table of derived numbers, already written out: {"Bond number", "17.3", ""}.
struct DerivedNumber {
  std::string name, value, unit;
};

// What the process that made results knows of them and neither RunInfo nor Analysis does; summary.json keeps it. Empty, 0 or NaN: not known, not
// written.
struct RunFacts {
  std::string name, description;          // of the case; without a name the page calls itself "Jam analysis"
  std::vector<std::string> inputs;        // files that were analysed
  std::vector<std::string> command_line;  // of the process; RunInfo::argv is that of the run
  std::string machine;                    // "AMD EPYC 7763, 2 processors"
  std::string created_utc;                // of the results
  int threads = 0;
  double wall_seconds = std::numeric_limits<double>::quiet_NaN();
  double particle_steps_per_second = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> warnings;  // for example SnapshotSource::warnings
};

// What the page says of a run beside its analysis.
struct ReportContext {
  RunFacts facts;
  std::vector<DerivedNumber> derived;
};

// One run on the page. What it refers to must outlive it.
struct ReportRun {
  const jam::RunInfo& info;
  const jam::Analysis& analysis;
  const jam::Series& series;
  const ReportContext& context;
  const SceneData& scene;
};

// No page is larger than this, however long the runs (bytes).
inline constexpr std::size_t largest_report = 20'000'000;
// Of that, what the scenes of all runs together may take.
inline constexpr std::size_t room_for_scenes = 13'000'000;

// The whole page, of one run or of several, overlaid. Curves of more rows than the page can hold are thinned to bins that keep minimum, mean and
// maximum, so that no peak is lost, and the page says so; of too many events or tracks those with the largest peak force stay.
// NaN and infinity become null. Any text may hold any bytes: invalid UTF-8 is replaced, markup is escaped.
std::string report_html(const std::vector<ReportRun>& runs);

// The data of the page alone, as the JSON text of its island (format "jamscope-report", schema 2). `rows` bounds every
// curve.
std::string report_json(const std::vector<ReportRun>& runs, std::size_t rows);

}  // namespace jamscope
