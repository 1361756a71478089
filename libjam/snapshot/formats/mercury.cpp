#include "libjam/snapshot/formats/mercury.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/tables_source.hpp"

namespace jam {
namespace {

constexpr std::size_t fstat_columns = 16;

// The numbers of a line; false where something else is in it.
bool parse_numbers(std::string_view line, std::vector<std::string_view>& parts, std::vector<double>& values) {
  split_fields(line, parts);
  values.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!parse_number(parts[k], values[k])) return false;
  }
  return true;
}

bool is_whole(double value, double least) { return value >= least && value == std::floor(value) && std::abs(value) < 4294967295.0; }

// "N time xmin ymin zmin xmax ymax zmax": three dimensions have 8 numbers, two have 6.
bool is_data_header(const std::vector<double>& values) {
  return (values.size() == 8 || values.size() == 6) && is_whole(values[0], 0);
}

bool is_data(const InputHead& head) {
  std::vector<std::string_view> parts;
  std::vector<double> first, second;
  if (head.lines.empty() || !parse_numbers(head.lines[0], parts, first) || !is_data_header(first)) return false;
  if (head.lines.size() < 2 || first[0] == 0) return true;
  return parse_numbers(head.lines[1], parts, second) && second.size() == (first.size() == 8 ? 14 : 8);
}

bool is_fstat(const InputHead& head) {
  for (std::size_t k = 0; k < head.lines.size() && k < 3; ++k) {
    if (head.lines[k].rfind('#', 0) != 0) return false;
  }
  std::vector<std::string_view> parts;
  double time = 0;
  if (head.lines.empty()) return false;
  split_fields(std::string_view(head.lines[0]).substr(1), parts);
  return !parts.empty() && parse_number(parts[0], time);
}

// The step of a frame: its time over dt where the map knows that, else its number. Both kinds of files count the same way.
std::uint64_t step_of(double time, double dt, std::uint64_t number) {
  return dt > 0 && time >= 0 && time / dt < 9e15 ? static_cast<std::uint64_t>(std::llround(time / dt)) : number;
}

class DataReader {
 public:
  DataReader(std::string path, std::vector<std::string> fields, double dt)
      : lines_(std::move(path)), fields_(std::move(fields)), dt_(dt) {}

  std::optional<Table> next(bool with_rows) {
    std::string_view line;
    do {
      if (!lines_.next(line)) return std::nullopt;
      split_fields(line, parts_);
    } while (parts_.empty());
    if (!parse_numbers(line, parts_, values_) || !is_data_header(values_)) {
      lines_.fail("expected the head of a frame, N time xmin ymin zmin xmax ymax zmax" +
                  std::string(number_ > 0 ? " (the frame before may have more rows than its head says)" : ""));
    }
    const std::size_t width = values_.size() == 8 ? 14 : 8;
    const auto rows = static_cast<std::size_t>(values_[0]);
    Table table;
    table.path = lines_.path();
    table.time = values_[1];
    table.step = step_of(table.time, dt_, number_++);
    table.first_line = lines_.line_number() + 1;
    if (with_rows) table.fields = fields_;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!lines_.next(line)) {
        lines_.fail("the file ends after " + std::to_string(row) + " of " + std::to_string(rows) + " particles");
      }
      if (!with_rows) continue;
      if (!parse_numbers(line, parts_, values_)) lines_.fail("a value of the row is not a finite number");
      if (values_.size() != width) {
        lines_.fail("the row has " + std::to_string(values_.size()) + " values, expected " + std::to_string(width));
      }
      add_row(table, row);
    }
    return table;
  }

 private:
  void add_row(Table& table, std::size_t row) const {
    const std::vector<double>& v = values_;
    std::array<double, 12> all{};  // id x y z radius vx vy vz wx wy wz xi, the order of the fields
    if (v.size() == 14) {
      all = {double(row), v[0], v[1], v[2], v[6], v[3], v[4], v[5], v[10], v[11], v[12], v[13]};
    } else {
      all = {double(row), v[0], v[1], 0, v[4], v[2], v[3], 0, 0, 0, v[6], v[7]};
    }
    table.values.insert(table.values.end(), all.begin(), all.begin() + std::ssize(fields_));
  }

  LineReader lines_;
  std::vector<std::string> fields_;
  double dt_;
  std::uint64_t number_ = 0;
  std::vector<std::string_view> parts_;
  std::vector<double> values_;
};

// Contacts of particles with each other, or with walls.
class FstatReader {
 public:
  FstatReader(std::string path, bool walls, double dt) : lines_(std::move(path)), walls_(walls), dt_(dt) {}

  std::optional<Table> next(bool with_rows) {
    std::string_view line;
    if (!have_head_) {
      do {
        if (!lines_.next(line)) return std::nullopt;
        split_fields(line, parts_);
      } while (parts_.empty());
      read_head(line);
    }
    have_head_ = false;
    Table table;
    table.path = lines_.path();
    table.time = time_;
    table.step = step_of(time_, dt_, number_++);
    table.first_line = lines_.line_number() + 1;
    if (with_rows) table.fields = fields();
    std::set<std::array<double, 2>> seen;
    while (lines_.next(line)) {
      if (line.rfind('#', 0) == 0) {
        read_head(line);
        have_head_ = true;
        break;
      }
      if (!with_rows) continue;
      if (!parse_numbers(line, parts_, v_)) lines_.fail("a value of the row is not a finite number");
      if (v_.size() != fstat_columns) {
        lines_.fail("the row has " + std::to_string(v_.size()) + " values, expected " + std::to_string(fstat_columns) +
                    ": time i j x y z overlap tangential-overlap fn ft nx ny nz tx ty tz");
      }
      if (!is_whole(v_[1], 0) || !is_whole(v_[2], -4294967295.0))
        lines_.fail("i and j are " + std::to_string(v_[1]) + " and " + std::to_string(v_[2]) + ", expected whole numbers, i >= 0");
      if ((v_[2] < 0) != walls_) continue;
      if (!walls_ && !seen.insert({std::min(v_[1], v_[2]), std::max(v_[1], v_[2])}).second) continue;  // the other half
      table.lines.push_back(lines_.line_number());
      add_row(table);
    }
    return table;
  }

  std::vector<std::string> fields() const {
    if (walls_) return {"id", "mesh", "fn", "ft_x", "ft_y", "ft_z", "px", "py", "pz", "nx", "ny", "nz", "overlap"};
    return {"id1", "id2", "fn", "ft_x", "ft_y", "ft_z", "overlap"};
  }

 private:
  // Of the three lines of a frame's head the first one has been read.
  void read_head(std::string_view line) {
    split_fields(line.substr(1), parts_);
    if (line.rfind('#', 0) != 0 || parts_.empty() || !parse_number(parts_[0], time_))
      lines_.fail("expected the head of a frame, '# time ...'");
    for (int k = 0; k < 2; ++k) {
      if (!lines_.next(line) || line.rfind('#', 0) != 0)
        lines_.fail("expected the second and third line of a frame's head, which begin with '#'");
    }
  }

  void add_row(Table& table) const {
    const double fn = v_[8], ft = walls_ ? -v_[9] : v_[9];
    if (walls_) {
      table.values.insert(table.values.end(), {v_[1], -v_[2] - 1, fn, ft * v_[13], ft * v_[14], ft * v_[15], v_[3], v_[4],
                                               v_[5], v_[10], v_[11], v_[12], v_[6]});
    } else {
      table.values.insert(table.values.end(), {v_[1], v_[2], fn, ft * v_[13], ft * v_[14], ft * v_[15], v_[6]});
    }
  }

  LineReader lines_;
  bool walls_;
  double dt_;
  bool have_head_ = false;
  double time_ = 0;
  std::uint64_t number_ = 0;
  std::vector<std::string_view> parts_;
  std::vector<double> v_;
};

// Numbers of the walls that are touched.
std::set<int> walls_in(const std::string& path) {
  FstatReader reader(path, true, 0);
  std::set<int> numbers;
  while (const std::optional<Table> table = reader.next(true)) {
    for (std::size_t row = 0; row < table->rows(); ++row) numbers.insert(static_cast<int>(table->at(row, table->find("mesh"))));
    if (numbers.size() > 255) throw DataError(path + ": more than 255 walls are touched; a map joins them by mesh_count");
  }
  return numbers;
}

ColumnMap named_alike(const std::vector<std::string>& fields) {
  ColumnMap columns;
  for (const std::string& field : fields) columns[field] = field;
  return columns;
}

std::vector<Field> as_fields(const std::vector<std::string>& names) {
  std::vector<Field> fields;
  for (const std::string& name : names) fields.push_back({name, name});
  return fields;
}

}  // namespace

bool is_mercury(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (map != nullptr) return map->format == "mercury";
  return std::any_of(inputs.begin(), inputs.end(), is_data);
}

SnapshotSource open_mercury(const std::vector<InputHead>& inputs, const ImportMap* given) {
  ImportMap map;
  if (given != nullptr) map = *given;
  map.format = "mercury";
  if (map.creator.empty()) map.creator = "MercuryDPM";
  const InputHead *data = nullptr, *fstat = nullptr;
  for (const InputHead& head : inputs) {
    const InputHead*& place = is_data(head) ? data : fstat;
    if (!is_data(head) && !is_fstat(head)) {
      throw DataError(head.path +
                      ":1: is neither NAME.data (first line N time xmin ymin zmin xmax ymax zmax) nor NAME.fstat (first "
                      "three lines with '#', the first with the time)");
    }
    if (place != nullptr) throw DataError(head.path + ": is a second file of its kind, after " + place->path);
    place = &head;
  }
  if (data == nullptr) throw DataError(inputs.front().path + ": none of the inputs holds particles (NAME.data)");
  if (given == nullptr && fstat != nullptr) {
    for (const int number : walls_in(fstat->path)) {
      ImportWall wall;
      wall.wall.name = "wall_" + std::to_string(number);
      wall.wall.kind = "mesh";
      wall.mesh_id = number;
      map.walls.push_back(std::move(wall));
    }
  }
  const bool typed = std::any_of(map.materials.begin(), map.materials.end(), [](const ImportMaterial& m) { return m.type >= 0; });
  std::vector<std::string> particle_fields{"id", "x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz"};
  if (typed) particle_fields.emplace_back("material");
  map.particles.columns = named_alike(particle_fields);
  std::vector<TableFile> files;
  files.push_back({TableKind::particles, data->path, as_fields(particle_fields),
                   open_frames<DataReader>(data->path, particle_fields, map.dt)});
  if (fstat != nullptr) {
    for (const bool walls : {false, true}) {
      if (walls && map.walls.empty()) continue;
      const std::vector<std::string> names = FstatReader(fstat->path, walls, map.dt).fields();
      (walls ? map.wall_contacts : map.pair_contacts).columns = named_alike(names);
      files.push_back({walls ? TableKind::wall_contacts : TableKind::pair_contacts, fstat->path, as_fields(names),
                       open_frames<FstatReader>(fstat->path, walls, map.dt)});
    }
  }
  check_map(map);
  return open_tables(files, map, false, "");
}

}  // namespace jam
