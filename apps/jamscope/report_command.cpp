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

// The value of `--name VALUE` or `--name=VALUE` in a command line, or "".
std::string option_value(const std::vector<std::string>& words, const std::string& name) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == name && k + 1 < words.size()) return words[k + 1];
    if (words[k].starts_with(name + "=")) return words[k].substr(name.size() + 1);
  }
  return "";
}

// The snapshots that results were made from: the files the analysis read, from the current folder or from beside the results; or run.h5 among them.
struct FoundSnapshots {
  jam::SnapshotSource source;
  std::string file;  // empty where they are several
};
std::optional<FoundSnapshots> snapshots_of(const fs::path& folder, const RunFacts& facts) {
  std::vector<InputOptions> candidates;
  const auto add = [&](const fs::path& base) {
    InputOptions input;
    for (const std::string& path : facts.inputs) input.paths.push_back((base / path).string());
    if (const std::string map = option_value(facts.command_line, "--map"); !map.empty()) input.map = (base / map).string();
    input.blade = option_value(facts.command_line, "--blade");
    input.vessel = option_value(facts.command_line, "--vessel");
    if (!input.paths.empty()) candidates.push_back(input);
  };
  add("");
  add(fs::absolute(folder).lexically_normal() / "..");
  candidates.push_back({{(folder / "run.h5").string()}, "", "", ""});
  for (const InputOptions& input : candidates) {
    try {
      return FoundSnapshots{open_stored_run(input), input.paths.size() == 1 ? input.paths.front() : std::string()};
    } catch (const jam::DataError&) {
    } catch (const dem::CaseError&) {
    } catch (const UsageError&) {
      // Not there, or something else by now: the next one, or none.
    }
  }
  return std::nullopt;
}

struct StoredResults {
  jam::Analysis analysis;
  jam::RunInfo info;
  jam::Series series;
  RunFacts facts;
  ReportContext context;
  SceneData scene;
};

StoredResults read_folder(const std::string& name, std::size_t room) {
  const fs::path folder(name);
  if (!fs::is_directory(folder)) throw UsageError(name + ": expected a folder of results");
  StoredResults r;
  r.analysis = jam::read_results(folder / "jam.h5");
  const std::string summary = (folder / "summary.json").string();
  r.facts = facts_of_summary(read_text_file(summary), summary);
  if (const auto found = snapshots_of(folder, r.facts)) {
    const jam::SnapshotSource* const source = &found->source;
    r.info = source->info;
    r.series = source->series;
    // jam.h5 holds the jams of every step, not what they say in all.
    const double begin = r.analysis.frames.empty() ? 0.0 : double(r.analysis.frames.front().step) * r.info.dt;
    for (auto& stream : r.analysis.every_step) stream.statistics = jam::jam_statistics(stream.jams, begin, r.series.time.empty() ? begin : r.series.time.back());
    r.scene = scene_data(*source, r.analysis, r.series, room, found->file);
  } else {
    r.scene = no_scene("The snapshots of these results were found neither beside them nor where the analysis read them.");
    const auto& frames = r.analysis.frames;
    if (!frames.empty())
      for (auto& stream : r.analysis.every_step) stream.statistics = jam::jam_statistics(stream.jams, frames.front().time, frames.back().time);
  }
  if (r.facts.name.empty()) r.facts.name = case_title(r.info).name;
  r.context = report_context(r.info, r.facts, r.analysis.criteria);
  return r;
}

}  // namespace

int report(const ReportOptions& options) {
  const std::size_t n = options.folders.size();
  std::vector<StoredResults> results;
  for (const std::string& folder : options.folders) results.push_back(read_folder(folder, room_for_scenes / n));
  if (n > 1)
    // Runs of one case have one name; folders tell them apart.
    for (std::size_t k = 0; k < n; ++k) results[k].context.name = fs::path(options.folders[k]).lexically_normal().string();
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
