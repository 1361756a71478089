#include "apps/jamscope/inspect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "libjam/errors.hpp"

namespace jamscope {
namespace {

using Json = nlohmann::ordered_json;

// Name of each column that a source may lack, and whether this frame has it. A table without rows says nothing.
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

struct Findings {
  std::size_t read = 0;
  double first_time = 0, last_time = 0;
  std::uint64_t first_step = 0, last_step = 0;
  std::size_t fewest_particles = 0, most_particles = 0, most_contacts = 0, most_wall_contacts = 0;
  std::vector<std::string> missing;  // columns that no frame has
  std::vector<std::string> broken;   // messages of frames that cannot be read
};

Findings look(const jam::SnapshotSource& source, bool quick, Console& console) {
  Findings f;
  std::vector<std::pair<std::string, bool>> seen;  // column, present in some frame; only those with rows
  Progress progress;
  progress.stage = "read";
  progress.unit = "frames";
  progress.total = static_cast<double>(source.frames);
  for (std::size_t k = 0; k < source.frames; ++k) {
    if (quick && k != 0 && k + 1 != source.frames) continue;
    progress.done = static_cast<double>(k + 1);
    console.progress(progress);
    try {
      const jam::Snapshot s = source.read(k);
      if (f.read == 0) {
        f.first_time = s.time;
        f.first_step = s.step;
        f.fewest_particles = s.particles.size();
      }
      f.last_time = s.time;
      f.last_step = s.step;
      f.fewest_particles = std::min(f.fewest_particles, s.particles.size());
      f.most_particles = std::max(f.most_particles, s.particles.size());
      f.most_contacts = std::max(f.most_contacts, s.pp.size());
      f.most_wall_contacts = std::max(f.most_wall_contacts, s.pw.size());
      for (const Column& column : columns(s)) {
        if (column.rows == 0) continue;
        auto at = std::find_if(seen.begin(), seen.end(), [&](const auto& entry) { return entry.first == column.name; });
        if (at == seen.end()) at = seen.insert(seen.end(), {column.name, false});
        at->second |= column.present;
      }
      ++f.read;
    } catch (const jam::DataError& error) {
      f.broken.push_back(error.what());
    }
  }
  for (const auto& [name, present] : seen)
    if (!present) f.missing.push_back(name);
  if (!source.info.wall_loads_known) f.missing.push_back("walls/force and torque");
  if (source.series.size() == 0) f.missing.push_back("series");
  if (!(source.info.gap.tip_radius > 0)) f.missing.push_back("gap");
  if (source.info.materials.empty()) f.missing.push_back("materials");
  if (source.info.case_toml.empty()) f.missing.push_back("case");
  return f;
}

std::string text_of(const jam::SnapshotSource& source, const Findings& f, const CaseTitle& title) {
  const jam::RunInfo& info = source.info;
  std::string text;
  const auto row = [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format("{:<12}{}\n", name, value);
  };
  row("creator", fmt::format("{} {} {}", info.creator, info.creator_version, info.commit));
  row("created", info.created_utc);
  row("case", title.name.empty() ? "" : fmt::format("{}: {}", title.name, title.description));
  row("frames", fmt::format("{}, {} read", source.frames, f.read));
  if (f.read > 0) {
    row("time",
        fmt::format("{:.6g} to {:.6g} s, steps {} to {}", f.first_time, f.last_time, f.first_step, f.last_step));
    row("particles", f.fewest_particles == f.most_particles
                         ? fmt::format("{}", f.most_particles)
                         : fmt::format("{} to {}", f.fewest_particles, f.most_particles));
    row("contacts", fmt::format("at most {} between particles, {} with walls", f.most_contacts, f.most_wall_contacts));
  }
  for (const jam::Wall& wall : info.walls)
    row("wall", fmt::format("{}: {}, role {}{}", wall.name, wall.kind, word(wall.role),
                            wall.triangles.empty() ? "" : fmt::format(", {} triangles", wall.triangles.size())));
  for (const jam::Material& m : info.materials)
    row("material", fmt::format("{}: {:g} kg/m3, {:g} Pa, Poisson {:g}", m.name, m.density, m.young, m.poisson));
  if (info.gap.tip_radius > 0)
    row("gap", fmt::format("{:.4g} mm, tip radius {:.4g} mm", 1e3 * (info.gap.vessel_radius - info.gap.tip_radius),
                           1e3 * info.gap.tip_radius));
  row("series", source.series.size() == 0 ? "" : fmt::format("{} rows", source.series.size()));
  row("missing", fmt::format("{}", fmt::join(f.missing, ", ")));
  for (const std::string& warning : source.warnings) row("warning", warning);
  for (const std::string& broken : f.broken) row("invalid", broken);
  row("verdict", f.broken.empty() ? "valid" : fmt::format("{} frames are invalid", f.broken.size()));
  return text;
}

std::string json_of(const jam::SnapshotSource& source, const Findings& f, const CaseTitle& title) {
  const jam::RunInfo& info = source.info;
  Json walls = Json::array(), materials = Json::array();
  for (const jam::Wall& wall : info.walls)
    walls.push_back({{"name", wall.name},
                     {"kind", wall.kind},
                     {"role", word(wall.role)},
                     {"material", wall.material},
                     {"triangles", wall.triangles.size()}});
  for (const jam::Material& m : info.materials)
    materials.push_back(
        {{"name", m.name}, {"density_kg_m3", m.density}, {"young_Pa", m.young}, {"poisson", m.poisson}});
  const Json json{{"valid", f.broken.empty()},
                  {"creator", info.creator},
                  {"creator_version", info.creator_version},
                  {"commit", info.commit},
                  {"created_utc", info.created_utc},
                  {"case", title.name},
                  {"case_sha256", info.case_sha256},
                  {"frames", source.frames},
                  {"frames_read", f.read},
                  {"first_time_s", f.first_time},
                  {"last_time_s", f.last_time},
                  {"first_step", f.first_step},
                  {"last_step", f.last_step},
                  {"fewest_particles", f.fewest_particles},
                  {"most_particles", f.most_particles},
                  {"most_particle_contacts", f.most_contacts},
                  {"most_wall_contacts", f.most_wall_contacts},
                  {"walls", walls},
                  {"materials", materials},
                  {"series_rows", source.series.size()},
                  {"missing", f.missing},
                  {"warnings", source.warnings},
                  {"invalid", f.broken}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

int inspect(const InspectOptions& options) {
  Console console(stderr, LogFormat::text, options.quiet || options.json);
  const jam::SnapshotSource source = open_stored_run(options.input);
  const Findings findings = look(source, options.quick, console);
  const CaseTitle title = case_title(source.info);
  fmt::print("{}", options.json ? json_of(source, findings, title) : text_of(source, findings, title));
  return findings.broken.empty() ? 0 : 3;
}

}  // namespace jamscope
