#include "libjam/snapshot/formats/tables_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/validate.hpp"

namespace jam {
namespace {

constexpr std::array<const char*, 5> kind_names{"particles", "pair_contacts", "wall_contacts", "wall_arrays",
                                                "wall_states"};

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Where one kind of table is at one step.
struct Place {
  std::uint64_t step;
  double time;
  std::size_t cursor, frame;
};

struct Frames {
  ImportMap map;
  RunInfo info;
  std::vector<FrameCursor> cursors;
  std::array<std::vector<Place>, kind_names.size()> places;  // by kind, in order of step
  std::array<std::vector<std::string>, kind_names.size()> fields;
  std::vector<double> time;

  std::optional<Table> table(TableKind kind, std::uint64_t step) {
    const std::vector<Place>& list = places[static_cast<std::size_t>(kind)];
    if (list.empty()) return std::nullopt;
    const auto place =
        std::lower_bound(list.begin(), list.end(), step, [](const Place& p, std::uint64_t s) { return p.step < s; });
    if (place != list.end() && place->step == step) return cursors[place->cursor].read(place->frame);
    Table none;  // a csv frame without contacts
    none.step = step;
    none.fields = fields[static_cast<std::size_t>(kind)];
    return none;
  }

  Snapshot read(std::size_t frame, FrameCheck* check = nullptr) {
    const std::vector<Place>& list = places[0];
    if (frame >= list.size()) {
      throw DataError("frame " + std::to_string(frame) + " was asked for, but there are " +
                      std::to_string(list.size()));
    }
    FrameTables tables;
    tables.time = time[frame];
    tables.particles = *table(TableKind::particles, list[frame].step);
    tables.pairs = table(TableKind::pair_contacts, list[frame].step);
    tables.walls = table(TableKind::wall_contacts, list[frame].step);
    tables.arrays = table(TableKind::wall_arrays, list[frame].step);
    tables.wall_states = table(TableKind::wall_states, list[frame].step);
    Snapshot snapshot = assemble(tables, map, info, check);
    validate(snapshot, info, tables.particles.path + ":step " + std::to_string(list[frame].step));
    return snapshot;
  }
};

void match_steps(const Frames& frames, bool empty_frames_absent) {
  const auto has = [](const std::vector<Place>& list, std::uint64_t step) {
    return std::binary_search(list.begin(), list.end(), Place{step, 0, 0, 0},
                              [](const Place& a, const Place& b) { return a.step < b.step; });
  };
  const std::vector<Place>& particles = frames.places[0];
  const std::string particle_path = frames.cursors[particles.front().cursor].path();
  for (std::size_t kind = 1; kind < kind_names.size(); ++kind) {
    const std::vector<Place>& list = frames.places[kind];
    if (list.empty()) continue;
    const std::string path = frames.cursors[list.front().cursor].path();
    for (const Place& place : list) {
      const auto same = std::lower_bound(particles.begin(), particles.end(), place.step,
                                         [](const Place& p, std::uint64_t step) { return p.step < step; });
      if (same != particles.end() && same->step == place.step && !std::isnan(same->time) && !std::isnan(place.time) &&
          std::abs(same->time - place.time) > 1e-5 * std::abs(same->time)) {
        throw DataError(frames.cursors[place.cursor].path() + ": frame " + std::to_string(place.step) + " is at time " +
                        short_number(place.time) + ", that of the particles in " + particle_path + " at " +
                        short_number(same->time) + "; expected the same times in both");
      }
      if (!has(particles, place.step)) {
        throw DataError(frames.cursors[place.cursor].path() + ": has step " + std::to_string(place.step) +
                        ", which the particles in " + particle_path + " have not; expected the same steps in both");
      }
    }
    for (const Place& place : particles) {
      // Walls have a state in every frame, contacts may have none.
      const bool may_lack = empty_frames_absent && kind != static_cast<std::size_t>(TableKind::wall_states);
      if (!may_lack && !has(list, place.step)) {
        throw DataError(path + ": lacks step " + std::to_string(place.step) + " of the particles in " + particle_path +
                        "; expected the same steps in both");
      }
    }
  }
}

void report(const FrameCheck& check, std::uint64_t step, const ImportMap& map, std::vector<std::string>& warnings) {
  const std::string at = "step " + std::to_string(step) + ": ";
  const bool recovers = std::any_of(map.walls.begin(), map.walls.end(), [](const ImportWall& w) { return w.recover; });
  if (check.balanced > 0) {
    const bool off = check.median_residual > 0.01 * check.median_load;
    if (off || recovers) {
      warnings.push_back(at + "force balance of the " + std::to_string(check.balanced) +
                         " particles that touch no recovered wall: |f - m g - contacts| has median " +
                         short_number(check.median_residual) + " N and maximum " +
                         short_number(check.largest_residual) + " N (particle " + std::to_string(check.largest_id) +
                         "), against a median load of " + short_number(check.median_load) + " N" +
                         (off ? "; this is too much: check densities, gravity, units and columns of the map" : ""));
    }
  }
  if (check.points > 0 && check.largest_point_error > 0.01 * check.mean_radius) {
    warnings.push_back(
        at + "listed contact points are up to " + short_number(check.largest_point_error) +
        " m away from their triangles: check position, velocity and angular_velocity of the map's mesh walls");
  }
}

}  // namespace

Series read_load_series(const std::string& path, const ImportMap& map) {
  LineReader lines(path);
  std::string_view line;
  if (!lines.next(line) || line.empty() || line.front() != '#') lines.fail("expected a first line '# NAME NAME ...'");
  line.remove_prefix(1);
  std::vector<std::string_view> parts;
  split_fields(line, parts);
  const std::size_t width = parts.size();
  std::array<std::size_t, 7> columns{};
  std::size_t next = 0;
  for (const char* field : {"time", "fx", "fy", "fz", "tx", "ty", "tz"}) {
    const auto mapped = map.wall_loads.columns.find(field);
    const std::string column = mapped == map.wall_loads.columns.end() ? field : mapped->second;
    const auto found = std::find(parts.begin(), parts.end(), column);
    if (found == parts.end()) {
      lines.fail("there is no column '" + column + "' for " + field +
                 "; the columns are: " + join_names(std::vector<std::string>(parts.begin(), parts.end())));
    }
    columns[next++] = static_cast<std::size_t>(found - parts.begin());
  }
  Series series;
  series.walls.resize(map.walls.size());
  const auto loaded =
      std::find_if(map.walls.begin(), map.walls.end(), [](const ImportWall& w) { return w.has_load_series; });
  if (loaded == map.walls.end()) lines.fail("no wall of the map has a load series");
  Series::WallSeries& wall = series.walls[static_cast<std::size_t>(loaded - map.walls.begin())];
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;  // restarted runs repeat the header
    split_fields(line, parts);
    if (parts.size() != width) {
      lines.fail("the row has " + std::to_string(parts.size()) + " values, expected " + std::to_string(width));
    }
    std::array<double, 7> values{};
    for (std::size_t k = 0; k < 7; ++k) {
      if (!parse_number(parts[columns[k]], values[k])) {
        lines.fail("value " + std::to_string(columns[k] + 1) + " of the row is not a finite number");
      }
    }
    const double time = values[0] * map.units.time;
    if (!series.time.empty() && !(time > series.time.back())) lines.fail("the time does not increase");
    series.time.push_back(time);
    // Steps must increase; where the time step is not known, or coarser than the table, they only count.
    std::uint64_t step = series.step.empty() ? 0 : series.step.back() + 1;
    if (map.dt > 0 && time > 0 && time / map.dt < 9e15) {
      step = std::max(step, static_cast<std::uint64_t>(std::llround(time / map.dt)));
    }
    series.step.push_back(step);
    const Vec3 force = map.units.force * Vec3(values[1], values[2], values[3]);
    const Vec3 torque = map.units.torque * Vec3(values[4], values[5], values[6]);
    const WallState state = wall_state(*loaded, time);
    wall.force.push_back(force);
    wall.torque.push_back(torque);
    wall.power.push_back(-(force.dot(state.velocity) + torque.dot(state.angular_velocity)));
  }
  return series;
}

std::vector<std::string> wall_words(const ImportMap& map) {
  std::vector<std::string> words;
  for (const ImportWall& wall : map.walls)
    words.push_back(wall.source_name.empty() ? wall.wall.name : wall.source_name);
  return words;
}

SnapshotSource open_tables(const std::vector<TableFile>& files, const ImportMap& map, bool empty_frames_absent,
                           const std::string& load_series) {
  const auto frames = std::make_shared<Frames>();
  frames->map = map;
  frames->info = run_info(map);
  for (const TableFile& file : files) {
    const std::size_t kind = static_cast<std::size_t>(file.kind), cursor = frames->cursors.size();
    frames->cursors.emplace_back(file.path, file.open);
    const std::vector<FrameCursor::Mark>& marks = frames->cursors.back().marks();
    for (std::size_t f = 0; f < marks.size(); ++f)
      frames->places[kind].push_back({marks[f].step, marks[f].time, cursor, f});
    for (const Field& field : file.fields) frames->fields[kind].push_back(field.name);
    if (frames->fields[kind].size() > file.fields.size()) frames->fields[kind].resize(file.fields.size());
  }
  for (std::size_t kind = 0; kind < kind_names.size(); ++kind) {
    std::vector<Place>& list = frames->places[kind];
    std::stable_sort(list.begin(), list.end(), [](const Place& a, const Place& b) { return a.step < b.step; });
    for (std::size_t k = 1; k < list.size(); ++k) {
      if (list[k].step == list[k - 1].step) {
        throw DataError(frames->cursors[list[k].cursor].path() + ": step " + std::to_string(list[k].step) + " of " +
                        kind_names[kind] + " is also in " + frames->cursors[list[k - 1].cursor].path());
      }
    }
  }
  const std::vector<Place>& particles = frames->places[0];
  if (particles.empty())
    throw DataError((files.empty() ? map.origin : files.front().path) + ": holds no frame of particles");
  match_steps(*frames, empty_frames_absent);
  for (const Place& place : particles) {
    const std::string& path = frames->cursors[place.cursor].path();
    if (std::isnan(place.time) && !(map.dt > 0)) {
      throw DataError(path + ": the times of the frames are not known: the map needs dt, or the file a time");
    }
    const double time = std::isnan(place.time) ? static_cast<double>(place.step) * map.dt : place.time * map.units.time;
    if (!frames->time.empty() && !(time > frames->time.back())) {
      throw DataError(path + ": step " + std::to_string(place.step) + " is at " + short_number(time) +
                      " s, not later than the step before");
    }
    frames->time.push_back(time);
  }

  SnapshotSource source;
  source.frames = particles.size();
  validate(frames->info, map.origin.empty() ? "map" : map.origin);
  FrameCheck first, last;
  frames->read(0, &first);
  report(first, particles.front().step, map, source.warnings);
  if (source.frames > 1) {
    frames->read(source.frames - 1, &last);
    report(last, particles.back().step, map, source.warnings);
  }
  if (!load_series.empty()) {
    source.series = read_load_series(load_series, map);
    validate(source.series, frames->info, load_series);
  }
  frames->info.wall_loads_known = first.loads_known;
  source.info = frames->info;
  source.read = [frames](std::size_t frame) { return frames->read(frame); };
  return source;
}

}  // namespace jam
