#include "apps/jamscope/analyze.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/frames_in_flight.hpp"
#include "apps/jamscope/outputs.hpp"
#include "libjam/errors.hpp"

namespace jamscope {

std::string result_text(const jam::Analysis& a) {
  if (a.frames.empty()) return "no frames\n";
  float largest = 0;
  for (const jam::FrameSummary& frame : a.frames)
    largest = std::max(largest, static_cast<float>(frame.largest_compressive_force));
  std::string text =
      fmt::format("{} frames over {:.4g} s, {} grains; largest compressive force {:.4g} N\n", a.frames.size(),
                  a.frames.back().time - a.frames.front().time, a.frames.back().particles, largest);
  if (a.events.empty()) {
    text += fmt::format("no jams above {:g} N\n", a.criteria.jam_force);
  } else {
    text +=
        fmt::format("{} jams above {:g} N: {:.3g} a second, {:.3g} ms long on average, {:.3g} % of the time\n",
                    a.events.size(), a.criteria.jam_force, a.jam_frequency,
                    1e3 * a.jammed_time / static_cast<double>(a.events.size()), 100 * a.jammed_time / a.observed_time);
    if (std::isfinite(a.jammed_in_gap_share))
      text += fmt::format("{:.3g} % of the jammed grains sat in the gap\n", 100 * a.jammed_in_gap_share);
  }
  if (!a.every_step.empty()) {
    const jam::Analysis::StepStream& global = a.every_step[0];
    const jam::JamStatistics& s = global.statistics;
    if (global.jams.empty()) {
      text += fmt::format("at every step: no jams above {:g} N\n", a.criteria.jam_force);
    } else {
      const std::string median = std::isfinite(s.median.value) ? fmt::format("half end within {:.3g} ms, ", 1e3 * s.median.value) : "";
      text += fmt::format("at every step: {} jams ({} of single grains), {:.3g} a second (95 %: {:.3g} to {:.3g}), {}the longest lasts {:.3g} ms\n",
                          global.jams.size(), a.every_step[1].jams.size(), s.rate.value, s.rate.low, s.rate.high, median, 1e3 * s.longest);
    }
  }
  if (a.flow_energy.source != "none")
    text += fmt::format("flow energy {:.4g} J, from the {}\n", a.flow_energy.total, a.flow_energy.source);
  for (const std::string& note : a.notes) text += "note: " + note + "\n";
  return text;
}

int analyze(const AnalyzeOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Console console(stderr, options.log_format, options.quiet);
  jam::SnapshotSource source = open_stored_run(options.input);
  const jam::Criteria criteria = stored_run_criteria(source.info, options.criteria, options.overrides);
  jam::Pipeline pipeline(source.info, criteria);
  prepare_folder(options.output, options.overwrite);

  for (const std::string& warning : source.warnings) console.warning(warning);
  if (source.frames == 0)
    throw jam::DataError(options.input.paths.front() + ": holds no frames, expected at least one");
  catch_stop_signals();
  Progress progress;
  progress.stage = "analyze";
  progress.unit = "frames";
  progress.total = static_cast<double>(source.frames);
  const auto examine = [&](std::size_t frame, const jam::Snapshot*, const jam::Snapshot& snapshot) {
    return pipeline.examine(snapshot, frame);
  };
  for_frames_in_flight(source, 0, source.frames, options.threads, false, examine, [&](jam::ExaminedFrame frame) {
    if (stop_requested()) throw UsageError("interrupted: nothing was written");
    const jam::FrameSummary& summary = pipeline.add(std::move(frame));
    progress.done = static_cast<double>(pipeline.frames());
    progress.contacts = summary.particle_contacts + summary.wall_contacts;
    progress.largest_force = summary.largest_compressive_force;
    progress.jammed = summary.jammed;
    progress.events = pipeline.events_so_far();
    console.progress(progress);
  });
  console.finished(progress);

  const jam::Analysis analysis = pipeline.finish(source.series);
  RunFacts facts = facts_of_this_process(options.command_line);
  const CaseTitle title = case_title(source.info);
  facts.name = title.name;
  facts.description = title.description;
  facts.inputs = options.input.paths;
  facts.warnings = source.warnings;
  facts.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_outputs(options.output, source.info, analysis, source.series, facts);
  if (!options.quiet) fmt::print("{}{}results in {}\n", result_text(analysis), energy_text(source.info, source.series),
                                 options.output);
  return 0;
}

}  // namespace jamscope
