#include "apps/jamscope/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/map_file.hpp"
#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libjam/errors.hpp"
#include "libjam/snapshot/export/export_formats.hpp"

namespace jamscope {

std::vector<std::string> export_format_names() {
  std::vector<std::string> names;
  for (const jam::ExportFormat& format : jam::export_formats()) names.emplace_back(format.name);
  return names;
}

std::string export_format_list() {
  std::string text = "Formats:\n";
  for (const jam::ExportFormat& format : jam::export_formats()) text += fmt::format("  {:<9}{}\n", format.name, format.doc);
  return text;
}

int export_frames(const ExportOptions& options) {
  const auto formats = jam::export_formats();
  const auto format = std::find_if(formats.begin(), formats.end(), [&](const jam::ExportFormat& f) { return options.format == f.name; });
  if (format == formats.end())
    throw UsageError(fmt::format("--to: '{}' is no choice{}", options.format, suggestion(options.format, export_format_names())));
  Console console(stderr, options.log_format, options.quiet);
  const jam::SnapshotSource source = open_stored_run(options.input);
  if (source.frames == 0) throw jam::DataError(options.input.paths.front() + ": holds no frames, expected at least one");
  FrameRange range = frame_range(options.frames, source.frames);
  if (options.frame) {
    if (*options.frame >= source.frames)
      throw UsageError(fmt::format("--frame {}: the frames are 0 to {}", *options.frame, source.frames - 1));
    range = {*options.frame, *options.frame + 1};
  }
  prepare_folder(options.output, options.overwrite);
  for (const std::string& warning : source.warnings) console.warning(warning);

  catch_stop_signals();
  Progress progress;
  progress.stage = "export";
  progress.unit = "frames";
  progress.total = static_cast<double>(range.last - range.first);
  const std::filesystem::path folder = options.output;
  const auto exporter = format->open(source.info, folder);
  for (std::size_t k = range.first; k < range.last; ++k) {
    if (stop_requested()) throw UsageError("interrupted: the files in " + options.output + " are not complete");
    const jam::Snapshot snapshot = source.read(k);
    exporter->add(k, snapshot);
    progress.done += 1;
    progress.contacts = snapshot.pp.size() + snapshot.pw.size();
    console.progress(progress);
  }
  const std::vector<std::filesystem::path> files = exporter->finish();
  console.finished(progress);
  std::string names;
  for (const std::filesystem::path& file : files) names += fmt::format("{}{}", names.empty() ? "" : " ", file.filename().string());
  if (const auto map = exporter->map())
    write_map_file(*map, (folder / "map.toml").string(), fmt::format("How to read these files back: jamscope analyze {} --map map.toml -o DIR", names));
  if (!options.quiet) {
    const std::size_t count = range.last - range.first;
    fmt::print("{} frame{} in {}: {}{}\n", count, count == 1 ? "" : "s", options.output, names, exporter->map() ? " map.toml" : "");
  }
  return 0;
}

}  // namespace jamscope
