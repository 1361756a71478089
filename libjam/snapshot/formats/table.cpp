#include "libjam/snapshot/formats/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "libjam/errors.hpp"

namespace jam {
namespace {

bool parse_count(std::string_view text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string_view trimmed(std::string_view line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  return line;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown;
  for (const char c : text.substr(0, longest)) shown += (c >= ' ' && c <= '~') ? c : '?';
  return "'" + shown + (text.size() > longest ? "...'" : "'");
}

std::string_view next_line(LineReader& lines, const std::string& expected) {
  std::string_view line;
  if (!lines.next(line)) lines.fail("the file ends here, expected " + expected);
  return trimmed(line);
}

// Rows are stored as they come, so a header that promises too many costs no memory.
std::size_t modest(std::uint64_t count) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(count, 1u << 20));
}

}  // namespace

int Table::find(std::string_view field) const {
  const auto found = std::find(fields.begin(), fields.end(), field);
  return found == fields.end() ? -1 : static_cast<int>(found - fields.begin());
}

void Table::fail(std::size_t row, const std::string& problem) const {
  const std::size_t line = row < lines.size() ? lines[row] : first_line + row;
  throw DataError(path + ":" + std::to_string(line) + ": " + problem);
}

std::vector<Field> ordered_fields(const ColumnMap& columns, const std::vector<std::string>& known,
                                  const std::string& origin) {
  std::vector<Field> fields;
  for (const std::string& name : known) {
    if (const auto found = columns.find(name); found != columns.end()) {
      fields.push_back({name, found->second, name == "wall"});
    }
  }
  for (const auto& [name, column] : columns) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw DataError(origin + ": unknown field '" + name + "', expected one of: " + join_names(known));
    }
  }
  // Vectors are named x y z, vx vy vz, fn_x fn_y fn_z ...: all three components or none.
  for (const Field& field : fields) {
    const char axis = field.name.back();
    const bool is_x = axis == 'x';
    for (const char other : {'y', 'z'}) {
      std::string partner = field.name;
      partner.back() = other;
      if (is_x && columns.find(partner) == columns.end()) {
        throw DataError(origin + ": field '" + field.name + "' is mapped but '" + partner + "' is not");
      }
    }
    if (axis == 'y' || axis == 'z') {
      std::string partner = field.name;
      partner.back() = 'x';
      if (columns.find(partner) == columns.end()) {
        throw DataError(origin + ": field '" + field.name + "' is mapped but '" + partner + "' is not");
      }
    }
  }
  return fields;
}

std::optional<Table> DumpReader::next(bool with_rows) {
  Table table;
  table.path = lines_.path();
  std::string_view line;
  do {
    if (!lines_.next(line)) return std::nullopt;
  } while (trimmed(line).empty());  // blank lines between frames are harmless

  std::optional<std::uint64_t> rows;
  bool have_step = false;
  std::vector<std::string_view> parts;
  for (;; line = next_line(lines_, "the rest of a frame's header")) {
    const std::string_view item = trimmed(line);
    const auto is = [&](std::string_view name) { return item.substr(0, name.size()) == name; };
    if (is("ITEM: TIMESTEP")) {
      const std::string_view value = next_line(lines_, "the time step");
      if (have_step) lines_.fail("a second ITEM: TIMESTEP inside a frame's header");
      if (!parse_count(value, table.step)) lines_.fail("time step " + quoted(value) + ", expected a whole number >= 0");
      have_step = true;
    } else if (is("ITEM: TIME")) {
      const std::string_view value = next_line(lines_, "the time");
      if (!parse_number(value, table.time)) lines_.fail("time " + quoted(value) + ", expected a number");
    } else if (is("ITEM: UNITS") || is("ITEM: LABEL")) {
      next_line(lines_, "a word");
    } else if (is("ITEM: NUMBER OF ")) {
      const std::string_view value = next_line(lines_, "the number of rows");
      std::uint64_t count = 0;
      if (!parse_count(value, count)) lines_.fail("number of rows " + quoted(value) + ", expected a whole number >= 0");
      rows = count;
    } else if (is("ITEM: BOX BOUNDS")) {
      split_fields(item.substr(16), parts);
      // "xy xz yz" names a triclinic box; its faces are given as three letter pairs like "pp" after that.
      const bool triclinic = !parts.empty() && parts[0] == "xy";
      if (triclinic) parts.erase(parts.begin(), parts.begin() + std::min<std::ptrdiff_t>(3, std::ssize(parts)));
      const std::vector<std::string> faces(parts.begin(), parts.end());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view bounds = next_line(lines_, "the bounds of the box");
        split_fields(bounds, parts);
        double low = 0, high = 0;
        if (parts.size() < 2 || !parse_number(parts[0], low) || !parse_number(parts[1], high) || high < low) {
          lines_.fail("box bounds " + quoted(bounds) + ", expected two numbers, low before high");
        }
        if (axis < faces.size() && faces[axis] == "pp") {
          if (triclinic) lines_.fail("the box is periodic and triclinic, expected an orthogonal one");
          table.period[static_cast<Eigen::Index>(axis)] = high - low;
        }
      }
    } else if (is("ITEM: ATOMS") || is("ITEM: ENTRIES")) {
      break;
    } else {
      lines_.fail("found " + quoted(item) + ", expected a header line 'ITEM: ...'" +
                  (have_step ? "" : " (the frame before may have more rows than its header says)"));
    }
  }
  if (!have_step) lines_.fail("the frame's header has no ITEM: TIMESTEP");
  if (!rows) lines_.fail("the frame's header has no ITEM: NUMBER OF ATOMS or ENTRIES");

  std::vector<std::size_t> columns(fields_.size());
  std::size_t width = 0;
  {
    split_fields(trimmed(line), parts);
    parts.erase(parts.begin(), parts.begin() + 2);
    width = parts.size();
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const auto found = std::find(parts.begin(), parts.end(), fields_[f].column);
      if (found == parts.end()) {
        lines_.fail("there is no column '" + fields_[f].column + "' for " + fields_[f].name +
                    "; the columns are: " + join_names(std::vector<std::string>(parts.begin(), parts.end())));
      }
      columns[f] = static_cast<std::size_t>(found - parts.begin());
    }
  }
  table.first_line = lines_.line_number() + 1;
  if (with_rows) {
    for (const Field& field : fields_) table.fields.push_back(field.name);
    table.values.reserve(modest(*rows) * fields_.size());
  }
  for (std::uint64_t row = 0; row < *rows; ++row) {
    const auto count_so_far = [&] {
      return std::to_string(row) + " of " + std::to_string(*rows) + " rows of step " + std::to_string(table.step);
    };
    if (!lines_.next(line)) lines_.fail("the file ends after " + count_so_far());
    if (line.substr(0, 5) == "ITEM:") lines_.fail("the next header comes after " + count_so_far());
    if (!with_rows) continue;
    split_fields(line, parts);
    if (parts.size() != width) {
      lines_.fail("the row has " + std::to_string(parts.size()) + " values, expected " + std::to_string(width));
    }
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      double value = 0;
      if (!parse_number(parts[columns[f]], value)) {
        lines_.fail("column '" + fields_[f].column + "' holds " + quoted(parts[columns[f]]) +
                    ", expected a finite number");
      }
      table.values.push_back(value);
    }
  }
  return table;
}

CsvReader::CsvReader(std::string path, std::vector<Field> fields, std::vector<std::string> words)
    : lines_(std::move(path)), fields_(std::move(fields)), words_(std::move(words)) {
  std::string_view header;
  if (!lines_.next(header)) lines_.fail("the file is empty, expected a header line");
  std::vector<std::string_view> names;
  split_csv(header, names);
  width_ = names.size();
  const auto column_of = [&](const std::string& column, const std::string& field) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end()) {
      lines_.fail("there is no column '" + column + "' for " + field +
                  "; the columns are: " + join_names(std::vector<std::string>(names.begin(), names.end())));
    }
    return static_cast<std::size_t>(found - names.begin());
  };
  for (const Field& field : fields_) columns_.push_back(column_of(field.column, field.name));
  const auto frame = std::find_if(fields_.begin(), fields_.end(), [](const Field& f) { return f.name == "frame"; });
  if (frame == fields_.end()) throw DataError(lines_.path() + ": no column is mapped to the field 'frame'");
  frame_column_ = static_cast<std::size_t>(frame - fields_.begin());
}

bool CsvReader::parse_line() {
  std::string_view line;
  do {
    if (!lines_.next(line)) return false;
    if (trimmed(line).empty()) {  // only allowed at the end, so that row numbers stay line numbers
      const std::size_t blank = lines_.line_number();
      while (lines_.next(line)) {
        if (!trimmed(line).empty())
          lines_.fail("line " + std::to_string(blank) + " is blank, expected rows without gaps");
      }
      return false;
    }
  } while (trimmed(line).empty());
  std::vector<std::string_view> parts;
  split_csv(line, parts);
  if (parts.size() != width_) {
    lines_.fail("the row has " + std::to_string(parts.size()) + " values, expected " + std::to_string(width_));
  }
  row_.resize(fields_.size());
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const std::string_view text = parts[columns_[f]];
    if (fields_[f].text) {
      const auto found = std::find(words_.begin(), words_.end(), text);
      if (found == words_.end()) {
        lines_.fail("column '" + fields_[f].column + "' holds " + quoted(text) +
                    ", expected one of: " + join_names(words_));
      }
      row_[f] = static_cast<double>(found - words_.begin());
    } else if (!parse_number(text, row_[f])) {
      lines_.fail("column '" + fields_[f].column + "' holds " + quoted(text) + ", expected a finite number");
    }
    if (f == frame_column_ && !parse_count(text, frame_)) {
      lines_.fail("column '" + fields_[f].column + "' holds " + quoted(text) + ", expected a whole number >= 0");
    }
  }
  return true;
}

std::optional<Table> CsvReader::next(bool with_rows) {
  if (!pending_ && !parse_line()) return std::nullopt;
  pending_ = false;
  Table table;
  table.path = lines_.path();
  table.step = frame_;
  table.first_line = lines_.line_number();
  for (const Field& field : fields_) table.fields.push_back(field.name);
  const int time = table.find("time");
  if (time >= 0) table.time = row_[static_cast<std::size_t>(time)];
  do {
    if (frame_ != table.step) {
      pending_ = true;
      break;
    }
    if (time >= 0 && row_[static_cast<std::size_t>(time)] != table.time) {
      lines_.fail("time differs from that of the first row of frame " + std::to_string(table.step));
    }
    if (with_rows) table.values.insert(table.values.end(), row_.begin(), row_.end());
  } while (parse_line());
  if (!with_rows) table.fields.clear();
  return table;
}

FrameCursor::FrameCursor(std::string path, OpenFrames open) : path_(std::move(path)), open_(std::move(open)) {
  reader_ = open_();
  while (const std::optional<Table> table = reader_(false)) {
    if (!marks_.empty() && table->step <= marks_.back().step) {
      table->fail(0, "step " + std::to_string(table->step) + " comes after step " + std::to_string(marks_.back().step) +
                         ", expected increasing steps");
    }
    marks_.push_back({table->step, table->time});
  }
  reader_ = nullptr;  // closes the file until it is read
}

Table FrameCursor::read(std::size_t frame) {
  if (frame >= marks_.size()) throw DataError(path_ + ": there is no frame " + std::to_string(frame));
  try {
    if (!reader_ || frame < next_) {
      reader_ = open_();
      next_ = 0;
    }
    for (; next_ < frame; ++next_) {
      if (!reader_(false)) throw DataError(path_ + ": the file became shorter while it was read");
    }
    std::optional<Table> table = reader_(true);
    if (!table || table->step != marks_[frame].step) throw DataError(path_ + ": the file changed while it was read");
    ++next_;
    return std::move(*table);
  } catch (...) {
    reader_ = nullptr;  // the place in the file is lost
    throw;
  }
}

std::vector<std::string> dump_columns(const InputHead& head) {
  std::vector<std::string> columns;
  if (head.lines.empty() || head.lines[0].rfind("ITEM:", 0) != 0) return columns;
  std::vector<std::string_view> parts;
  for (const std::string& line : head.lines) {
    if (line.rfind("ITEM: ATOMS", 0) == 0 || line.rfind("ITEM: ENTRIES", 0) == 0) {
      split_fields(line, parts);
      for (std::size_t i = 2; i < parts.size(); ++i) columns.emplace_back(parts[i]);
      break;
    }
  }
  return columns;
}

}  // namespace jam
