#include "apps/jamscope/report_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/figure_files.hpp"
#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/report.hpp"
#include "apps/jamscope/stored_run.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"
#include "libjam/results_file.hpp"

namespace jamscope {
namespace {

namespace fs = std::filesystem;

struct StoredResults {
  jam::Analysis analysis;
  jam::RunInfo info;
  jam::Series series;
  ReportContext context;
  SceneData scene;
};

// Where the frames of the results begin in what was found; nothing where it holds others, or cannot be read.
std::optional<std::size_t> first_frame_in(const std::optional<FoundSnapshots>& found, const jam::Analysis& analysis) {
  if (!found) return std::nullopt;
  try {
    return first_frame(found->source, analysis);
  } catch (const jam::DataError&) {
    return std::nullopt;
  }
}

StoredResults read_folder(const std::string& name, std::size_t room) {
  const fs::path folder(name);
  if (!fs::is_directory(folder)) throw UsageError(name + ": expected a folder of results");
  StoredResults r;
  r.analysis = jam::read_results(folder / "jam.h5");
  const std::string summary = (folder / "summary.json").string();
  RunFacts facts = facts_of_summary(read_text_file(summary), summary);
  const auto found = find_snapshots(folder, facts.inputs, facts.command_line);
  if (const auto first = first_frame_in(found, r.analysis)) {
    r.info = found->source.info;
    r.series = series_of(found->source, {*first, *first + r.analysis.frames.size()});
    // jam.h5 holds the jams of every step, not what they say in all.
    const double begin = r.analysis.frames.empty() ? 0.0 : double(r.analysis.frames.front().step) * r.info.dt;
    for (auto& stream : r.analysis.every_step) stream.statistics = jam::jam_statistics(stream.jams, begin, r.series.time.empty() ? begin : r.series.time.back());
    r.scene = scene_data(found->source, r.analysis, r.series, room, found->file);
  } else {
    r.scene = no_scene(found ? "The snapshots that were found are not those of these results, or cannot be read."
                             : "The snapshots of these results were found neither beside them nor where the analysis read them.");
    const auto& frames = r.analysis.frames;
    if (!frames.empty())
      for (auto& stream : r.analysis.every_step) stream.statistics = jam::jam_statistics(stream.jams, frames.front().time, frames.back().time);
  }
  if (facts.name.empty()) facts.name = case_title(r.info).name;
  r.context = report_context(r.info, facts, r.analysis.criteria);
  return r;
}

}  // namespace

int report(const ReportOptions& options) {
  const std::size_t n = options.folders.size();
  std::vector<StoredResults> results;
  for (const std::string& folder : options.folders) results.push_back(read_folder(folder, room_for_scenes / n));
  if (n > 1)
    // Runs of one case have one name; folders tell them apart.
    for (std::size_t k = 0; k < n; ++k) results[k].context.facts.name = fs::path(options.folders[k]).lexically_normal().string();
  std::vector<ReportRun> runs;
  for (const StoredResults& r : results) runs.push_back({r.info, r.analysis, r.series, r.context, r.scene});
  const std::string output = !options.output.empty() ? options.output : n == 1 ? (fs::path(options.folders[0]) / "report.html").string() : "report.html";
  write_text_file(output, report_html(runs));
  if (!options.quiet) fmt::print("report in {}\n", output);
  if (options.figures) {
    for (std::size_t k = 0; k < n; ++k) {
      const fs::path folder = fs::path(options.folders[k]) / "figures";
      const std::size_t files = write_figures(folder.string(), results[k].info, results[k].analysis, results[k].series);
      if (!options.quiet) fmt::print("{} figures in {}\n", files, folder.string());
    }
  }
  return 0;
}

}  // namespace jamscope
