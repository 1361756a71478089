#include "apps/jamscope/inspect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "apps/jamscope/console.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"

namespace jamscope {
namespace {

using Json = nlohmann::ordered_json;

// Columns that foreign data may lack, and whether this frame has them. A table without rows says nothing.
struct Column {
  const char* name;
  std::size_t rows;
  bool present;
};
std::vector<Column> columns(const jam::Snapshot& s) {
  const std::size_t n = s.particles.size(), c = s.pp.size(), w = s.pw.size();
  const auto is = [](const auto& column, std::size_t rows) { return jam::present(column, rows); };
  return {{"particles/velocity", n, is(s.particles.velocity, n)},
          {"particles/angular_velocity", n, is(s.particles.angular_velocity, n)},
          {"particles/material", n, is(s.particles.material, n)},
          {"particles/compressive_force", n, is(s.particles.compressive_force, n)},
          {"contacts/pp/damping_force", c, is(s.pp.damping_force, c)},
          {"contacts/pp/tangential_force", c, is(s.pp.tangential_force, c)},
          {"contacts/pp/overlap", c, is(s.pp.overlap, c)},
          {"contacts/pp/birth_step", c, is(s.pp.birth_step, c)},
          {"contacts/pp/flags", c, is(s.pp.flags, c)},
          {"contacts/pw/facet", w, is(s.pw.facet, w)},
          {"contacts/pw/feature", w, is(s.pw.feature, w)},
          {"contacts/pw/point", w, is(s.pw.point, w)},
          {"contacts/pw/normal", w, is(s.pw.normal, w)},
          {"contacts/pw/damping_force", w, is(s.pw.damping_force, w)},
          {"contacts/pw/tangential_force", w, is(s.pw.tangential_force, w)},
          {"contacts/pw/overlap", w, is(s.pw.overlap, w)},
          {"contacts/pw/birth_step", w, is(s.pw.birth_step, w)},
          {"contacts/pw/flags", w, is(s.pw.flags, w)}};
}

void extend(jam::FileReport::Range& range, std::size_t value, bool first) {
  range.min = first ? value : std::min<std::uint64_t>(range.min, value);
  range.max = std::max<std::uint64_t>(range.max, value);
  range.mean += static_cast<double>(value);  // divided by the number of frames in the end
}

// What inspect_file says of a snapshot file, said of foreign data: every frame is read.
jam::FileReport foreign_report(const InputOptions& input, Console& console) {
  const jam::SnapshotSource source = open_stored_run(input);
  jam::FileReport report;
  report.path = fmt::format("{}", fmt::join(input.paths, " "));
  report.format = "foreign, read through " + input.map;
  for (const std::string& path : input.paths) report.bytes += std::filesystem::file_size(path);
  report.frames_begun = source.frames;
  report.series_rows = source.series.size();
  report.info = source.info;
  report.warnings = source.warnings;

  std::vector<std::pair<std::string, bool>> seen;  // column, present in some frame; only those with rows
  Progress progress;
  progress.stage = "read";
  progress.unit = "frames";
  progress.total = static_cast<double>(source.frames);
  for (std::size_t k = 0; k < source.frames; ++k) {
    progress.done = static_cast<double>(k + 1);
    console.progress(progress);
    try {
      const jam::Snapshot s = source.read(k);
      const bool first = report.frames == 0;
      if (first) {
        report.time_first = s.time;
        report.step_first = s.step;
      }
      report.time_last = s.time;
      report.step_last = s.step;
      extend(report.particles, s.particles.size(), first);
      extend(report.particle_contacts, s.pp.size(), first);
      extend(report.wall_contacts, s.pw.size(), first);
      for (const Column& column : columns(s)) {
        if (column.rows == 0) continue;
        auto at = std::find_if(seen.begin(), seen.end(), [&](const auto& entry) { return entry.first == column.name; });
        if (at == seen.end()) at = seen.insert(seen.end(), {column.name, false});
        at->second |= column.present;
      }
      ++report.frames;
    } catch (const jam::DataError& error) {
      report.problems.push_back(error.what());
    }
  }
  const double frames = static_cast<double>(report.frames);
  for (auto* range : {&report.particles, &report.particle_contacts, &report.wall_contacts})
    if (report.frames > 0) range->mean /= frames;
  if (report.frames > 1) report.interval = (report.time_last - report.time_first) / (frames - 1);
  for (const auto& [name, present] : seen) (present ? report.present : report.absent).push_back(name);
  if (!source.info.wall_loads_known) report.absent.push_back("walls/force, walls/torque");
  if (report.series_rows == 0) report.absent.push_back("series");
  return report;
}

const char* word(jam::WallRole role) {
  switch (role) {
    case jam::WallRole::blade:
      return "blade";
    case jam::WallRole::vessel:
      return "vessel";
    case jam::WallRole::other:
      break;
  }
  return "other";
}

// A damaged file may hold a damaged case.
CaseTitle title_of(const jam::RunInfo& info) {
  try {
    return case_title(info);
  } catch (const dem::CaseError&) {
    return {};
  }
}

std::string range_text(const jam::FileReport::Range& range) {
  return range.min == range.max ? fmt::format("{}", range.max) : fmt::format("{} to {}", range.min, range.max);
}

}  // namespace

std::string inspection_text(const jam::FileReport& r) {
  std::string text;
  const auto row = [&](const char* name, const std::string& value) {
    if (value.find_first_not_of(' ') != std::string::npos) text += fmt::format("{:<12}{}\n", name, value);
  };
  const CaseTitle title = title_of(r.info);
  row("file", r.path);
  row("format", fmt::format("{} {}, {:.3g} MB", r.format, r.version, 1e-6 * static_cast<double>(r.bytes)));
  row("creator", fmt::format("{} {} {}", r.info.creator, r.info.creator_version, r.info.commit));
  row("created", r.info.created_utc);
  row("case", title.name.empty() ? "" : fmt::format("{}: {}", title.name, title.description));
  row("frames", r.frames == r.frames_begun ? fmt::format("{}", r.frames)
                                           : fmt::format("{} complete of {}", r.frames, r.frames_begun));
  if (r.frames > 0) {
    row("time",
        fmt::format("{:.6g} to {:.6g} s, steps {} to {}", r.time_first, r.time_last, r.step_first, r.step_last));
    row("particles", range_text(r.particles));
    row("contacts", fmt::format("{} between particles, {} with walls", range_text(r.particle_contacts),
                                range_text(r.wall_contacts)));
  }
  for (const jam::Wall& wall : r.info.walls)
    row("wall", fmt::format("{}: {}, role {}{}", wall.name, wall.kind, word(wall.role),
                            wall.triangles.empty() ? "" : fmt::format(", {} triangles", wall.triangles.size())));
  for (const jam::Material& m : r.info.materials)
    row("material", fmt::format("{}: {:g} kg/m3, {:g} Pa, Poisson {:g}", m.name, m.density, m.young, m.poisson));
  const jam::Gap& gap = r.info.gap;
  row("gap", gap.tip_radius > 0 ? fmt::format("{:.4g} mm, tip radius {:.4g} mm",
                                              1e3 * (gap.vessel_radius - gap.tip_radius), 1e3 * gap.tip_radius)
                                : "");
  row("series", r.series_rows == 0 ? "" : fmt::format("{} rows", r.series_rows));
  row("absent", fmt::format("{}", fmt::join(r.absent, ", ")));
  for (const std::string& warning : r.warnings) row("warning", warning);
  for (const std::string& problem : r.problems) row("damaged", problem);
  row("verdict", r.valid() ? "valid" : "not valid");
  return text;
}

std::string inspection_json(const jam::FileReport& r) {
  const auto range = [](const jam::FileReport::Range& x) {
    return Json{{"min", x.min}, {"max", x.max}, {"mean", x.mean}};
  };
  Json walls = Json::array(), materials = Json::array();
  for (const jam::Wall& wall : r.info.walls)
    walls.push_back({{"name", wall.name},
                     {"kind", wall.kind},
                     {"role", word(wall.role)},
                     {"material", wall.material},
                     {"triangles", wall.triangles.size()}});
  for (const jam::Material& m : r.info.materials)
    materials.push_back(
        {{"name", m.name}, {"density_kg_m3", m.density}, {"young_Pa", m.young}, {"poisson", m.poisson}});
  const Json json{{"valid", r.valid()},
                  {"file", r.path},
                  {"format", r.format},
                  {"version", r.version},
                  {"bytes", r.bytes},
                  {"closed", r.closed},
                  {"creator", r.info.creator},
                  {"creator_version", r.info.creator_version},
                  {"commit", r.info.commit},
                  {"created_utc", r.info.created_utc},
                  {"case", title_of(r.info).name},
                  {"case_sha256", r.info.case_sha256},
                  {"frames", r.frames},
                  {"frames_begun", r.frames_begun},
                  {"first_time_s", r.time_first},
                  {"last_time_s", r.time_last},
                  {"first_step", r.step_first},
                  {"last_step", r.step_last},
                  {"interval_s", r.interval},
                  {"particles", range(r.particles)},
                  {"particle_contacts", range(r.particle_contacts)},
                  {"wall_contacts", range(r.wall_contacts)},
                  {"series_rows", r.series_rows},
                  {"walls", walls},
                  {"materials", materials},
                  {"present", r.present},
                  {"absent", r.absent},
                  {"warnings", r.warnings},
                  {"problems", r.problems}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int inspect(const InspectOptions& options) {
  jam::FileReport report;
  if (options.input.map.empty() && options.input.paths.size() == 1) {
    report = jam::inspect_file(options.input.paths.front());
  } else {
    Console console(stderr, LogFormat::text, options.quiet || options.json);
    report = foreign_report(options.input, console);
  }
  fmt::print("{}", options.json ? inspection_json(report) : inspection_text(report));
  return report.valid() ? 0 : 3;
}

}  // namespace jamscope
