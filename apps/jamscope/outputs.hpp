// The results of an analysis as files of one folder: events.csv summary.json jam.h5 report.html.
#pragma once
#include <string>
#include <vector>

#include "apps/jamscope/report.hpp"
#include "libjam/analysis.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

// Fills machine and created_utc.
RunFacts facts_of_this_process(std::vector<std::string> command_line);
std::string utc_now();  // "2026-11-22T03:08:39Z"

// summary.json. `run` says where the numbers come from; `analysis` depends on the analysis alone, so that equal
// analyses have equal bytes; `energy`, of runs with a ledger, has its last row. Numbers that do not exist (NaN, infinity) are null.
std::string summary_json(const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series,
                         const RunFacts& facts);

// The facts that summary_json() wrote, so that a report can be built again to the same bytes. Throws jam::DataError where the text is none.
RunFacts facts_of_summary(const std::string& text, const std::string& path);

// One line on where the work of the walls went, of a run that kept an energy ledger; else "".
std::string energy_text(const jam::RunInfo& info, const jam::Series& series);

// Makes the folder, with its parents. Throws UsageError where it holds something already and `overwrite` is false, or
// where the path is a file.
void prepare_folder(const std::string& folder, bool overwrite);

// Written under another name, then renamed, so that the file is either the old or the whole new one. Throws
// jam::DataError where the disk refuses.
void write_text_file(const std::string& path, const std::string& text);

// What report.html says of a run beside its analysis.
ReportContext report_context(const jam::RunInfo& info, const RunFacts& facts, const jam::Criteria& criteria);

// All result files. The folder must exist; other files in it are left alone. `snapshots`: the frames of the analysis, for the report; null where
// they are not at hand. `snapshot_file`: where they are stored; empty: in no single file.
void write_outputs(const std::string& folder, const jam::RunInfo& info, const jam::Analysis& analysis,
                   const jam::Series& series, const RunFacts& facts, const jam::SnapshotSource* snapshots,
                   const std::string& snapshot_file);

}  // namespace jamscope
