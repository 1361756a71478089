#include "libjam/snapshot/inspect.hpp"

#include <algorithm>

#include "libjam/errors.hpp"
#include "libjam/snapshot/reader.hpp"

namespace jam {
namespace {

constexpr std::size_t most_problems = 20;  // a file of which everything is damaged need not say so frame by frame

template <class F>
FileReport::Range range_of(const std::vector<schema::FrameRow>& frames, F&& count) {
  FileReport::Range range;
  if (frames.empty()) return range;
  range.min = range.max = count(frames.front());
  double sum = 0;
  for (const schema::FrameRow& row : frames) {
    const std::uint64_t n = count(row);
    range.min = std::min(range.min, n);
    range.max = std::max(range.max, n);
    sum += static_cast<double>(n);
  }
  range.mean = sum / static_cast<double>(frames.size());
  return range;
}

void list_items(const h5::File& file, FileReport& report) {
  for (const schema::Item& item : schema::table) {
    if (item.axis == schema::attribute) continue;
    std::vector<std::string> paths;
    if (item.path.find('*') == std::string_view::npos) {
      paths.push_back(schema::path_of(item));
    } else {
      for (const Wall& wall : report.info.walls) {
        const bool of_mesh = item.axis == schema::vertex || item.axis == schema::triangle;
        const bool of_spheres = item.axis == schema::sphere;
        if ((of_mesh && wall.kind != "mesh") || (of_spheres && wall.kind != "spheres")) continue;
        paths.push_back(schema::path_of(item, wall.name));
      }
    }
    for (const std::string& path : paths) (file.exists(path) ? report.present : report.absent).push_back(path);
  }
}

void inspect_snapshots(const std::filesystem::path& path, FileReport& report) {
  const SnapshotIndex index = read_index(path);
  report.version = std::to_string(index.version[0]) + "." + std::to_string(index.version[1]);
  report.frames = index.frames.size();
  report.frames_begun = index.frames_begun;
  report.info = index.info;
  report.warnings = index.warnings;
  report.series_rows = index.series.size();
  if (!index.frames.empty()) {
    report.time_first = index.frames.front().time;
    report.time_last = index.frames.back().time;
    report.step_first = index.frames.front().step;
    report.step_last = index.frames.back().step;
  }
  if (index.frames.size() > 1) {
    report.interval = (report.time_last - report.time_first) / static_cast<double>(index.frames.size() - 1);
  }
  report.particles = range_of(index.frames, [](const schema::FrameRow& row) { return row.particle_count; });
  report.particle_contacts = range_of(index.frames, [](const schema::FrameRow& row) { return row.pp_count; });
  report.wall_contacts = range_of(index.frames, [](const schema::FrameRow& row) { return row.pw_count; });
  list_items(h5::File::open(path), report);
  if (index.condition.cut_short()) report.problems.push_back(path.string() + ": the end of the file is missing");
  std::size_t bad = 0;
  for (std::size_t k = 0; k < index.frames.size(); ++k) {
    try {
      read_frame(index, k);
    } catch (const DataError& e) {
      if (++bad <= most_problems) report.problems.emplace_back(e.what());
    }
  }
  if (bad > most_problems) {
    report.problems.push_back(path.string() + ": " + std::to_string(bad - most_problems) + " more frames are damaged");
  }
}

}  // namespace

FileReport inspect_file(const std::filesystem::path& path) {
  FileReport report;
  report.path = path.string();
  report.format = "unknown";
  const h5::Condition condition = h5::condition_of(path);
  report.bytes = condition.bytes;
  report.closed = !condition.unclosed;
  try {
    {
      const h5::File file = h5::File::open(path);
      report.format = file.has_attribute("/", "format") ? file.attribute<std::string>("/", "format") : "HDF5";
    }
    if (report.format == schema::format) {
      inspect_snapshots(path, report);
    } else {
      report.problems.push_back(path.string() + ": is a file of format '" + report.format + "', expected '" +
                                std::string(schema::format) + "'");
    }
  } catch (const DataError& e) {
    report.problems.emplace_back(e.what());
  }
  return report;
}

}  // namespace jam
