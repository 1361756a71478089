#include "libjam/snapshot/reader.hpp"

#include <algorithm>
#include <memory>

#include "libjam/errors.hpp"
#include "libjam/snapshot/schema_run_info.hpp"
#include "libjam/snapshot/validate.hpp"

namespace jam {
namespace {

using schema::FrameRow;
using schema::Item;
using schema::path_of;

// Reads rows [start, start + count) of a column; an optional column that the file does not have stays empty.
template <class V>
void read_column(const h5::File& file, const std::string& path, const Item& item, std::uint64_t start,
                 std::uint64_t count, std::vector<V>& values) {
  values.clear();
  if (count == 0 || (item.need == schema::optional && !file.exists(path))) return;
  values = file.read_rows<V>(path, start, count);
}

// The first `count` rows of /frames.
std::vector<FrameRow> read_frame_rows(const h5::File& file, std::uint64_t count) {
  std::vector<FrameRow> rows(file.read_rows<double>("/frames/time", 0, count).size());
  schema::visit_frame([&]<class V>(const Item& item, V FrameRow::*member) {
    const auto values = file.read_rows<V>(path_of(item), 0, count);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].*member = values[k];
  });
  return rows;
}

Series read_series(const h5::File& file, const RunInfo& info, std::uint64_t count) {
  Series series;
  if (count == 0) return series;
  if (!file.exists("/series/time")) {
    file.fail("/series/time", "missing, but the frames name " + std::to_string(count) + " rows");
  }
  series.walls.resize(info.walls.size());
  schema::visit_all_series(series, info.walls, [&](const std::string& path, const Item& item, auto& values) {
    read_column(file, path, item, 0, count, values);
  });
  const std::uint64_t excursions = schema::excursion_rows(series, series.size());
  schema::visit_excursions(series.excursions, [&](const Item& item, auto& values) {
    read_column(file, path_of(item), item, 0, excursions, values);
  });
  const bool any = std::any_of(info.walls.begin(), info.walls.end(),
                               [&](const Wall& wall) { return file.exists("/series/walls/" + wall.name); });
  if (!any) series.walls.clear();
  return series;
}

std::string place_of(const SnapshotIndex& index, std::size_t frame) {
  return index.path + ":frame " + std::to_string(frame);
}

// Unchecked contents of a frame.
Snapshot load_frame(const h5::File& file, const RunInfo& info, const FrameRow& row, std::size_t frame) {
  Snapshot s;
  s.time = row.time;
  s.step = row.step;
  const auto columns = [&](std::uint64_t start, std::uint64_t count) {
    return [&file, start, count](const Item& item, auto& values) {
      read_column(file, path_of(item), item, start, count, values);
    };
  };
  schema::visit_particles(s.particles, columns(row.particle_start, row.particle_count));
  schema::visit_pp(s.pp, columns(row.pp_start, row.pp_count));
  schema::visit_pw(s.pw, columns(row.pw_start, row.pw_count));
  for (const Wall& wall : info.walls) {
    schema::WallRow state;
    schema::visit_wall([&]<class V>(const Item& item, V schema::WallRow::*member) {
      if (item.need == schema::required || info.wall_loads_known) {
        state.*member = file.read_rows<V>(path_of(item, wall.name), frame, 1)[0];
      }
    });
    s.walls.push_back(state_of(state));
  }
  return s;
}

Snapshot checked_frame(const h5::File& file, const SnapshotIndex& index, std::size_t frame) {
  const FrameRow& row = index.frames[frame];
  Snapshot s = load_frame(file, index.info, row, frame);
  const std::uint64_t before = frame == 0 ? 0 : index.frames[frame - 1].series_count;
  if (row.series_count < before || row.series_count > index.series.size()) {
    throw DataError(place_of(index, frame) + ": names " + std::to_string(row.series_count) +
                    " rows of /series, expected " + std::to_string(before) + " to " +
                    std::to_string(index.series.size()));
  }
  const Series rows = schema::rows_of(index.series, before, row.series_count);
  if (schema::checksum(row, s, index.info.wall_loads_known, rows, index.info.walls) != index.commit[frame]) {
    throw DataError(place_of(index, frame) + ": contents do not match the checksum, the file is damaged");
  }
  validate(s, index.info, place_of(index, frame));
  return s;
}

// The largest number of complete frames of a file whose end may be missing or unfinished: the last frame must pass
// every check, together with the series up to it.
void drop_incomplete_frames(const h5::File& file, SnapshotIndex& index) {
  while (!index.frames.empty()) {
    try {
      index.series = read_series(file, index.info, index.frames.back().series_count);
      checked_frame(file, index, index.frames.size() - 1);
      return;
    } catch (const DataError&) {
      index.frames.pop_back();
      index.commit.pop_back();
    }
  }
  index.series = {};
}

void read_frames_of_doubtful_file(const h5::File& file, SnapshotIndex& index) {
  std::uint64_t count = file.layout("/frames/commit").rows();
  index.frames_begun = count;
  while (count > 0) {
    try {
      index.commit = file.read_rows<std::uint32_t>("/frames/commit", 0, count);
      index.frames = read_frame_rows(file, count);
      break;
    } catch (const DataError&) {
      // The end of the tables is lost, chunk by chunk.
      const std::uint64_t chunk = std::max<std::uint64_t>(file.chunk_rows("/frames/commit"), 1);
      count = (count - 1) / chunk * chunk;
      index.commit.clear();
      index.frames.clear();
    }
  }
  drop_incomplete_frames(file, index);
}

}  // namespace

bool is_jamscope_file(const std::filesystem::path& path) {
  try {
    if (!h5::is_hdf5(path)) return false;
    const h5::File file = h5::File::open(path);
    return file.has_attribute("/", "format") && file.attribute<std::string>("/", "format") == schema::format;
  } catch (const DataError&) {
    return false;
  }
}

SnapshotIndex read_index(const std::filesystem::path& path) {
  SnapshotIndex index;
  index.path = path.string();
  index.condition = h5::condition_of(path);
  const h5::File file = h5::File::open(path);
  index.info = read_run_info(file);
  index.version = file.attribute<std::array<std::uint32_t, 2>>("/", "schema_version");

  const std::string sizes =
      std::to_string(index.condition.bytes) + " of at least " + std::to_string(index.condition.least_bytes) + " bytes";
  if (index.condition.unclosed || index.condition.cut_short()) {
    read_frames_of_doubtful_file(file, index);
  } else {
    // Commits first: a writer at work extends them last.
    index.commit = file.read<std::uint32_t>("/frames/commit");
    index.frames_begun = index.commit.size();
    index.frames = read_frame_rows(file, index.commit.size());
    index.series = read_series(file, index.info, index.frames.empty() ? 0 : index.frames.back().series_count);
  }
  const std::string complete = std::to_string(index.frames.size()) + " complete frames";
  index.frames_begun = std::max<std::uint64_t>(index.frames_begun, file.layout("/frames/time").rows());
  if (index.condition.cut_short()) {
    index.warnings.push_back(index.path + ": cut short, " + sizes + " are there; " + complete + " of " +
                             std::to_string(index.frames_begun) + " are used");
  } else if (index.condition.unclosed) {
    index.warnings.push_back(index.path + ": its writer was killed or is still at work; " + complete + " are used");
  }
  if (index.frames_begun > index.frames.size() && !index.condition.cut_short()) {
    index.warnings.push_back(index.path + ": an incomplete frame after the last complete one is ignored");
  }

  for (std::size_t k = 1; k < index.frames.size(); ++k) {
    if (!(index.frames[k].time > index.frames[k - 1].time) || index.frames[k].step <= index.frames[k - 1].step) {
      throw DataError(place_of(index, k) + ": time or step does not follow those of the frame before");
    }
  }
  validate(index.series, index.info, index.path);
  return index;
}

Snapshot read_frame(const SnapshotIndex& index, std::size_t frame) {
  if (frame >= index.frames.size()) {
    throw DataError(place_of(index, frame) + ": no such frame, the file has " + std::to_string(index.frames.size()));
  }
  return checked_frame(h5::File::open(index.path), index, frame);
}

SnapshotSource open_jamscope_file(const std::filesystem::path& path) {
  const auto index = std::make_shared<const SnapshotIndex>(read_index(path));
  SnapshotSource source;
  source.info = index->info;
  source.frames = index->frames.size();
  source.series = index->series;
  source.warnings = index->warnings;
  source.read = [index](std::size_t frame) { return read_frame(*index, frame); };
  return source;
}

}  // namespace jam
