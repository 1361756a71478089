#include "libjam/snapshot/writer.hpp"

#include <algorithm>
#include <bit>
#include <system_error>

#include "libjam/errors.hpp"
#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/schema_run_info.hpp"
#include "libjam/snapshot/validate.hpp"

namespace jam {
namespace {

using schema::FrameRow;
using schema::Item;
using schema::path_of;

constexpr std::uint64_t table_chunk = 512;  // rows of the tables that grow by single rows; not compressed

void make_column(h5::File& file, const std::string& path, const Item& item, std::uint64_t chunk, bool compressed) {
  file.make_column(path, item.type, item.width, chunk, compressed, std::string(item.unit), std::string(item.doc));
}

std::uint64_t round_up(std::uint64_t rows, std::uint64_t chunk) {
  return chunk == 0 ? 0 : (rows + chunk - 1) / chunk * chunk;
}

// One chunk holds all particles of a frame, as their number hardly changes; contacts get a power of two.
std::uint64_t particle_chunk_for(std::size_t rows) {
  return std::clamp<std::uint64_t>(rows, 256, 1U << 18);
}
std::uint64_t contact_chunk_for(std::size_t rows, std::uint64_t largest) {
  return std::clamp<std::uint64_t>(std::bit_ceil(rows), 256, largest);
}

void write_empty_file(const std::filesystem::path& path, const RunInfo& info) {
  h5::write_aside(path, [&](h5::File& file) {
    write_run_info(file, info);
    for (const Item& item : schema::table) {
      if (item.axis != schema::Axis::frame) continue;
      if (item.path.find('*') == std::string_view::npos) {
        make_column(file, path_of(item), item, table_chunk, false);
      } else if (item.need == schema::required || info.wall_loads_known) {
        for (const Wall& wall : info.walls) make_column(file, path_of(item, wall.name), item, table_chunk, false);
      }
    }
  }, h5::Grows::yes);
}

}  // namespace

SnapshotWriter::SnapshotWriter(std::filesystem::path path, RunInfo info)
    : path_(std::move(path)), info_(std::move(info)) {}

SnapshotWriter SnapshotWriter::create(const std::filesystem::path& path, const RunInfo& info) {
  validate(info, path.string());
  write_empty_file(path, info);
  return {path, info};
}

// The state of a writer that has just finished this file.
SnapshotWriter SnapshotWriter::attach(const std::filesystem::path& path) {
  const SnapshotIndex index = read_index(path);
  SnapshotWriter writer(path, index.info);
  writer.frames_ = index.frames.size();
  if (!index.frames.empty()) writer.last_ = index.frames.back();
  if (index.series.size() > 0) {
    writer.last_series_time_ = index.series.time.back();
    writer.last_series_step_ = index.series.step.back();
    writer.excursions_ = index.series.excursions.size();
  }
  const h5::File file = h5::File::open(path);
  for (const Item& item : schema::table) {
    using enum schema::Axis;
    if (item.axis != particle && item.axis != pp && item.axis != pw && item.axis != series && item.axis != excursion) continue;
    if (item.path.find('*') == std::string_view::npos) {
      if (const std::string name = path_of(item); file.exists(name)) writer.columns_.insert(name);
    } else {
      for (const Wall& wall : index.info.walls) {
        if (const std::string name = path_of(item, wall.name); file.exists(name)) writer.columns_.insert(name);
      }
    }
  }
  const auto chunk = [&](const char* name) { return file.exists(name) ? file.chunk_rows(name) : 0; };
  writer.particle_chunk_ = chunk("/particles/id");
  writer.pp_chunk_ = chunk("/contacts/pp/row");
  writer.pw_chunk_ = chunk("/contacts/pw/row");
  return writer;
}

SnapshotWriter SnapshotWriter::resume(const std::filesystem::path& path, std::uint64_t last_step) {
  const SnapshotIndex index = read_index(path);
  const bool sound = !index.condition.unclosed && !index.condition.cut_short();
  if (sound && (index.frames.empty() || index.frames.back().step <= last_step)) return attach(path);
  const std::filesystem::path aside = h5::aside_of(path.string() + ".resume");
  std::error_code error;
  try {
    SnapshotWriter copy = create(aside, index.info);
    std::uint64_t series_rows = 0;
    for (std::size_t k = 0; k < index.frames.size() && index.frames[k].step <= last_step; ++k) {
      const std::uint64_t rows = index.frames[k].series_count;
      copy.append(read_frame(index, k), schema::rows_of(index.series, series_rows, rows));
      series_rows = rows;
    }
  } catch (...) {
    std::filesystem::remove(aside, error);
    throw;
  }
  std::filesystem::rename(aside, path, error);
  if (error) throw DataError(path.string() + ": cannot put the repaired file in place: " + error.message());
  return attach(path);
}

// Columns cannot be made in the mode that survives a kill, so they are made in a copy that then takes the file's place.
// This happens once for the particles, once for each kind of contact and once for the series.
void SnapshotWriter::make_missing_columns(const Snapshot& snapshot, const Series& new_rows) {
  struct Column {
    std::string path;
    const Item* item;
    std::uint64_t chunk;
    bool compressed;
  };
  std::vector<Column> columns;
  const auto plan = [&](std::size_t rows, std::uint64_t chunk, bool compressed) {
    return [&columns, rows, chunk, compressed](const std::string& path, const Item& item, const auto& values) {
      if (item.need == schema::required || (rows > 0 && values.size() == rows)) {
        columns.push_back({path, &item, chunk, compressed});
      }
    };
  };
  const auto with_path = [](const auto& f) {
    return [f](const Item& item, const auto& values) { f(path_of(item), item, values); };
  };
  std::uint64_t particle_chunk = particle_chunk_, pp_chunk = pp_chunk_, pw_chunk = pw_chunk_;
  if (const std::size_t n = snapshot.particles.size(); particle_chunk == 0 && n > 0) {
    particle_chunk = particle_chunk_for(n);
    schema::visit_particles(snapshot.particles, with_path(plan(n, particle_chunk, true)));
  }
  if (const std::size_t n = snapshot.pp.size(); pp_chunk == 0 && n > 0) {
    pp_chunk = contact_chunk_for(n, 16384);
    schema::visit_pp(snapshot.pp, with_path(plan(n, pp_chunk, true)));
  }
  if (const std::size_t n = snapshot.pw.size(); pw_chunk == 0 && n > 0) {
    pw_chunk = contact_chunk_for(n, 4096);
    schema::visit_pw(snapshot.pw, with_path(plan(n, pw_chunk, true)));
  }
  if (const std::size_t n = new_rows.size(); !columns_.contains("/series/time") && n > 0) {
    schema::visit_all_series(new_rows, info_.walls, plan(n, table_chunk, false));
    if (!new_rows.excursion_count.empty())
      schema::visit_excursions(new_rows.excursions, [&](const Item& item, const auto&) {
        columns.push_back({path_of(item), &item, table_chunk, false});
      });
  }
  if (columns.empty()) return;

  const std::filesystem::path aside = h5::aside_of(path_);
  std::error_code error;
  if (h5::condition_of(path_).unclosed) {
    throw DataError(path_.string() + ": another writer is at work or was killed, expected a closed file");
  }
  std::filesystem::copy_file(path_, aside, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw DataError(path_.string() + ": cannot copy the file aside: " + error.message());
  try {
    h5::File file = h5::File::open_update(aside);
    for (const Column& c : columns) make_column(file, c.path, *c.item, c.chunk, c.compressed);
    file.close();
  } catch (...) {
    std::filesystem::remove(aside, error);
    throw;
  }
  std::filesystem::rename(aside, path_, error);
  if (error) throw DataError(path_.string() + ": cannot put the new file in place: " + error.message());
  for (const Column& c : columns) columns_.insert(c.path);
  particle_chunk_ = particle_chunk;
  pp_chunk_ = pp_chunk;
  pw_chunk_ = pw_chunk;
}

void SnapshotWriter::check_columns(const Snapshot& snapshot, const Series& new_rows, const std::string& place) const {
  const auto check = [&](const std::string& path, std::size_t rows, std::size_t group_rows) {
    if (group_rows == 0 || (rows == group_rows) == columns_.contains(path)) return;
    throw DataError(place + ": " + path + (rows == 0 ? " is absent" : " is present") +
                    ", expected as in the frames before");
  };
  const auto group = [&](std::size_t group_rows) {
    return
        [&check, group_rows](const Item& item, const auto& values) { check(path_of(item), values.size(), group_rows); };
  };
  schema::visit_particles(snapshot.particles, group(snapshot.particles.size()));
  schema::visit_pp(snapshot.pp, group(snapshot.pp.size()));
  schema::visit_pw(snapshot.pw, group(snapshot.pw.size()));
  // A series without walls has none of their columns.
  Series rows = new_rows;
  rows.walls.resize(info_.walls.size());
  schema::visit_all_series(rows, info_.walls, [&](const std::string& path, const Item&, const auto& values) {
    check(path, values.size(), new_rows.size());
  });
  schema::visit_excursions(new_rows.excursions, group(new_rows.excursions.size()));
}

// A disk that would fill up in the middle of the frame is told before anything is written.
void SnapshotWriter::check_space(const Snapshot& snapshot, const Series& new_rows) const {
  std::uint64_t bytes = std::uint64_t{1} << 20;
  const auto add = [&](const Item&, const auto& values) { bytes += values.size() * sizeof(values[0]); };
  schema::visit_particles(snapshot.particles, add);
  schema::visit_pp(snapshot.pp, add);
  schema::visit_pw(snapshot.pw, add);
  schema::visit_all_series(new_rows, info_.walls,
                           [&](const std::string&, const Item& item, const auto& values) { add(item, values); });
  schema::visit_excursions(new_rows.excursions, add);
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::absolute(path_).parent_path(), error);
  if (!error && space.available < bytes) {
    throw DataError(path_.string() + ": the disk is full, " + std::to_string(space.available) +
                    " bytes are free, expected " + std::to_string(bytes) + " for the next frame");
  }
}

void SnapshotWriter::append(const Snapshot& snapshot, const Series& new_rows) {
  const std::string place = path_.string() + ":frame " + std::to_string(frames_);
  validate(snapshot, info_, place);
  validate(new_rows, info_, place);
  if (frames_ > 0 && (!(snapshot.time > last_.time) || snapshot.step <= last_.step)) {
    throw DataError(place + ": time " + std::to_string(snapshot.time) + " s, step " + std::to_string(snapshot.step) +
                    " does not follow time " + std::to_string(last_.time) + " s, step " + std::to_string(last_.step));
  }
  if (new_rows.size() > 0 && last_.series_count > 0 &&
      (!(new_rows.time[0] > last_series_time_) || new_rows.step[0] <= last_series_step_)) {
    throw DataError(place + ": the series goes on at step " + std::to_string(new_rows.step[0]) +
                    ", expected more than its last step " + std::to_string(last_series_step_));
  }
  check_space(snapshot, new_rows);
  make_missing_columns(snapshot, new_rows);
  check_columns(snapshot, new_rows, place);

  FrameRow row;
  row.time = snapshot.time;
  row.step = snapshot.step;
  row.particle_start = round_up(last_.particle_start + last_.particle_count, particle_chunk_);
  row.particle_count = static_cast<std::uint32_t>(snapshot.particles.size());
  row.pp_start = round_up(last_.pp_start + last_.pp_count, pp_chunk_);
  row.pp_count = static_cast<std::uint32_t>(snapshot.pp.size());
  row.pw_start = round_up(last_.pw_start + last_.pw_count, pw_chunk_);
  row.pw_count = static_cast<std::uint32_t>(snapshot.pw.size());
  row.series_count = last_.series_count + new_rows.size();

  h5::File file = h5::File::open_append(path_);
  if (const std::uint64_t there = file.layout("/frames/commit").rows(); there != frames_) {
    throw DataError(place + ": the file has " + std::to_string(there) + " frames, expected " + std::to_string(frames_) +
                    "; another writer is at work");
  }
  const auto written_from = [&](std::uint64_t start) {
    return [&file, start](const Item& item, const auto& values) {
      if (!values.empty()) file.write_rows(path_of(item), start, values);
    };
  };
  schema::visit_particles(snapshot.particles, written_from(row.particle_start));
  schema::visit_pp(snapshot.pp, written_from(row.pp_start));
  schema::visit_pw(snapshot.pw, written_from(row.pw_start));
  schema::visit_all_series(new_rows, info_.walls, [&](const std::string& path, const Item&, const auto& values) {
    if (!values.empty()) file.write_rows(path, last_.series_count, values);
  });
  schema::visit_excursions(new_rows.excursions, written_from(excursions_));
  for (std::size_t w = 0; w < snapshot.walls.size(); ++w) {
    const schema::WallRow state = schema::row_of(snapshot.walls[w]);
    schema::visit_wall([&]<class V>(const Item& item, V schema::WallRow::*member) {
      if (item.need == schema::optional && !info_.wall_loads_known) return;
      file.write_rows(path_of(item, info_.walls[w].name), frames_, std::vector<V>{state.*member});
    });
  }
  schema::visit_frame([&]<class V>(const Item& item, V FrameRow::*member) {
    file.write_rows(path_of(item), frames_, std::vector<V>{row.*member});
  });
  file.flush();
  const std::uint32_t commit = schema::checksum(row, snapshot, info_.wall_loads_known, new_rows, info_.walls);
  file.write_rows("/frames/commit", frames_, std::vector<std::uint32_t>{commit});
  file.close();

  last_ = row;
  excursions_ += new_rows.excursions.size();
  ++frames_;
  if (new_rows.size() > 0) {
    last_series_time_ = new_rows.time.back();
    last_series_step_ = new_rows.step.back();
  }
}

}  // namespace jam
