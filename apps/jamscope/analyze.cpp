#include "apps/jamscope/analyze.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/frames_in_flight.hpp"
#include "apps/jamscope/outputs.hpp"
#include "libjam/errors.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jamscope {

namespace {

// What a jam is, to follow the word.
std::string rule_text(const jam::Criteria& criteria) {
  const jam::JamCriterion& criterion = jam::criterion_of(criteria);
  if (criterion.unit == "N") return fmt::format(" above {:g} N", criteria.jam_force);
  return fmt::format(" by {} above {:g} E* R^2", criterion.name, jam::threshold_of(criteria));
}

std::string jams(std::size_t count) { return fmt::format("{} jam{}", count, count == 1 ? "" : "s"); }

}  // namespace

std::string result_text(const jam::Analysis& a) {
  if (a.frames.empty()) return "no frames\n";
  float largest = 0;
  for (const jam::FrameSummary& frame : a.frames)
    largest = std::max(largest, static_cast<float>(frame.largest_compressive_force));
  std::string text =
      fmt::format("{} frames over {:.4g} s, {} grains; largest compressive force {:.4g} N\n", a.frames.size(),
                  a.frames.back().time - a.frames.front().time, a.frames.back().particles, largest);
  const std::string rule = rule_text(a.criteria);
  if (a.events.empty()) {
    text += fmt::format("no jams{}\n", rule);
  } else {
    text +=
        fmt::format("{}{}: {:.3g} a second, {:.3g} ms long on average, {:.3g} % of the time\n",
                    jams(a.events.size()), rule, a.jam_frequency,
                    1e3 * a.jammed_time / static_cast<double>(a.events.size()), 100 * a.jammed_time / a.observed_time);
    if (std::isfinite(a.jammed_in_gap_share))
      text += fmt::format("{:.3g} % of the jammed grains sat in the gap\n", 100 * a.jammed_in_gap_share);
  }
  if (!a.every_step.empty()) {
    const jam::Analysis::StepStream& global = a.every_step[0];
    const jam::JamStatistics& s = global.statistics;
    if (global.jams.empty()) {
      text += fmt::format("at every step: no jams{}\n", rule);
    } else {
      const std::string median = std::isfinite(s.median.value) ? fmt::format("half end within {:.3g} ms, ", 1e3 * s.median.value) : "";
      text += fmt::format("at every step: {} ({} of single grains), {:.3g} a second (95 %: {:.3g} to {:.3g}), {}the longest lasts {:.3g} ms\n",
                          jams(global.jams.size()), a.every_step[1].jams.size(), s.rate.value, s.rate.low, s.rate.high, median, 1e3 * s.longest);
    }
  }
  if (a.flow_energy.source != "none")
    text += fmt::format("flow energy {:.4g} J, from the {}\n", a.flow_energy.total, a.flow_energy.source);
  for (const std::string& note : a.notes) text += "note: " + note + "\n";
  return text;
}

namespace {

constexpr const char* partial_name = "partial.h5";

RunFacts facts_of(const jam::RunInfo& info, const std::vector<std::string>& command_line, const std::vector<std::string>& inputs) {
  RunFacts facts = facts_of_this_process(command_line);
  const CaseTitle title = case_title(info);
  facts.name = title.name;
  facts.description = title.description;
  facts.inputs = inputs;
  return facts;
}

std::string in_folder(const std::string& folder) { return (std::filesystem::path(folder) / partial_name).string(); }

}  // namespace

jam::PartialAnalysis examine_frames(const jam::SnapshotSource& source, const jam::Pipeline& pipeline, FrameRange range, int threads,
                                    const std::function<void(const jam::FrameSummary&)>& seen) {
  jam::PartialAnalysis part{source.info, pipeline.criteria(), range.first, {}, series_of(source, range), 0, {}, {}};
  const auto examine = [&](std::size_t frame, const jam::Snapshot*, const jam::Snapshot& snapshot) {
    return pipeline.examine(snapshot, frame);
  };
  for_frames_in_flight(source, range.first, range.last, threads, false, examine, [&](jam::ExaminedFrame frame) {
    seen(frame.summary);
    add_frame(part, std::move(frame));
  });
  return part;
}

int analyze(const AnalyzeOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Console console(stderr, options.log_format, options.quiet);
  jam::SnapshotSource source = open_stored_run(options.input);
  const jam::Criteria criteria = stored_run_criteria(source.info, options.criteria, options.overrides);
  jam::Pipeline pipeline(source.info, criteria);
  if (source.frames == 0)
    throw jam::DataError(options.input.paths.front() + ": holds no frames, expected at least one");
  const FrameRange range = frame_range(options.frames, source.frames);
  prepare_folder(options.output, options.overwrite);

  for (const std::string& warning : source.warnings) console.warning(warning);
  catch_stop_signals();
  Progress progress;
  progress.stage = "analyze";
  progress.unit = "frames";
  progress.total = static_cast<double>(range.last - range.first);
  std::size_t events = 0;
  bool jammed_before = false;
  jam::PartialAnalysis part = examine_frames(source, pipeline, range, options.threads, [&](const jam::FrameSummary& summary) {
    if (stop_requested()) throw UsageError("interrupted: nothing was written");
    progress.done += 1;
    progress.contacts = summary.particle_contacts + summary.wall_contacts;
    progress.largest_force = summary.largest_compressive_force;
    progress.jammed = summary.jammed;
    events += summary.jammed > 0 && !jammed_before;
    jammed_before = summary.jammed > 0;
    progress.events = events;
    console.progress(progress);
  });
  console.finished(progress);

  if (options.partial) {
    part.inputs = options.input.paths;
    part.command_line = options.command_line;
    jam::write_partial(in_folder(options.output), part);
    if (!options.quiet) fmt::print("frames {} to {} in {}\n", range.first, range.last - 1, in_folder(options.output));
    return 0;
  }
  const jam::Analysis analysis = jam::finish(part);
  RunFacts facts = facts_of(source.info, options.command_line, options.input.paths);
  facts.warnings = source.warnings;
  facts.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_outputs(options.output, source.info, analysis, part.series, facts, &source,
                options.input.paths.size() == 1 ? options.input.paths.front() : std::string());
  if (!options.quiet) fmt::print("{}{}results in {}\n", result_text(analysis), energy_text(source.info, part.series), options.output);
  return 0;
}

int merge(const MergeOptions& options) {
  std::vector<jam::PartialAnalysis> parts;
  std::vector<std::string> names;
  for (const std::string& path : options.parts) {
    names.push_back(std::filesystem::is_directory(path) ? in_folder(path) : path);
    parts.push_back(jam::read_partial(names.back()));
  }
  const jam::PartialAnalysis whole = jam::joined(std::move(parts), names);
  prepare_folder(options.output, options.overwrite);
  const std::size_t last = whole.first_frame + whole.frames.size() - 1;
  if (options.partial) {
    jam::write_partial(in_folder(options.output), whole);
    if (!options.quiet) fmt::print("frames {} to {} in {}\n", whole.first_frame, last, in_folder(options.output));
    return 0;
  }
  const jam::Analysis analysis = jam::finish(whole);
  const auto found = find_snapshots(options.output, whole.inputs, whole.command_line);
  write_outputs(options.output, whole.run, analysis, whole.series, facts_of(whole.run, options.command_line, whole.inputs), found ? &found->source : nullptr,
                found ? found->file : std::string());
  if (!options.quiet) fmt::print("{}{}results in {}\n", result_text(analysis), energy_text(whole.run, whole.series), options.output);
  return 0;
}

}  // namespace jamscope
