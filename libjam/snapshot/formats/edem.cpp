#include "libjam/snapshot/formats/edem.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/tables_source.hpp"

namespace jam {
namespace {

constexpr std::size_t most_values = std::size_t{1} << 26;  // of one block

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// "Q02 : Particle ID:" -> "Particle ID"; empty where the cell is no query.
std::string_view query_name(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() < 2 || cell[0] != 'Q') return {};
  std::size_t k = 1;
  while (k < cell.size() && cell[k] >= '0' && cell[k] <= '9') ++k;
  if (k == 1) return {};
  cell = trimmed(cell.substr(k));
  if (cell.empty() || cell.front() != ':') return {};
  cell = trimmed(cell.substr(1));
  while (!cell.empty() && cell.back() == ':') cell = trimmed(cell.substr(0, cell.size() - 1));
  return cell;
}

// Whether a line begins a block; `time` is NaN where it has no value.
bool is_time(const std::vector<std::string_view>& cells, double& time) {
  if (cells.empty()) return false;
  std::string_view cell = trimmed(cells[0]);
  constexpr std::string_view word = "time";
  if (cell.size() < word.size()) return false;
  for (std::size_t k = 0; k < word.size(); ++k) {
    if (std::tolower(static_cast<unsigned char>(cell[k])) != word[k]) return false;
  }
  cell = trimmed(cell.substr(word.size()));
  if (!cell.empty() && cell.front() == ':') cell = trimmed(cell.substr(1));
  if (cell.empty() && cells.size() > 1) cell = trimmed(cells[1]);
  time = std::numeric_limits<double>::quiet_NaN();
  // "Timestep" and other words are no times.
  return parse_number(cell, time);
}

class BlockReader {
 public:
  BlockReader(std::string path, std::vector<Field> fields, std::vector<std::string> words, double dt)
      : lines_(std::move(path)), fields_(std::move(fields)), words_(std::move(words)), dt_(dt) {}

  std::optional<Table> next(bool with_rows) {
    std::string_view line;
    while (!have_time_) {
      if (!lines_.next(line)) {
        if (number_ == 0) lines_.fail("there is no line that begins with TIME and has a number");
        return std::nullopt;
      }
      split_csv(line, cells_);
      have_time_ = is_time(cells_, time_);
    }
    have_time_ = false;
    Table table;
    table.path = lines_.path();
    table.time = time_;
    table.step = dt_ > 0 && time_ >= 0 && time_ / dt_ < 9e15 ? static_cast<std::uint64_t>(std::llround(time_ / dt_)) : number_;
    ++number_;
    table.first_line = lines_.line_number() + 1;
    read_block(table, with_rows);
    return table;
  }

 private:
  void read_block(Table& table, bool with_rows) {
    std::string_view line;
    std::vector<std::vector<double>> columns(fields_.size());
    std::vector<std::size_t> found(fields_.size(), 0);  // lines of the queries
    std::vector<int> order;                             // field of each cell, in the layout with columns
    std::vector<std::size_t> row_lines;
    std::size_t values = 0;
    while (lines_.next(line)) {
      split_csv(line, cells_);
      if (is_time(cells_, time_)) {
        have_time_ = true;
        break;
      }
      if (trimmed(line).empty()) continue;
      const std::string_view name = query_name(cells_[0]);
      const bool header = !name.empty() && (cells_.size() == 1 || !query_name(cells_[1]).empty());
      if (header && order.empty() && std::all_of(found.begin(), found.end(), [](std::size_t l) { return l == 0; })) {
        for (const std::string_view cell : cells_) order.push_back(field_of(query_name(cell), found));
      } else if (!name.empty()) {
        const int field = field_of(name, found);
        if (field < 0 || !with_rows) continue;
        std::vector<double>& column = columns[static_cast<std::size_t>(field)];
        for (std::size_t k = 1; k < cells_.size(); ++k) {
          if (k + 1 == cells_.size() && trimmed(cells_[k]).empty()) break;  // a comma at the end of the line
          column.push_back(value_of(cells_[k], field));
        }
        values += column.size();
      } else if (!order.empty()) {
        if (!with_rows) continue;
        if (cells_.size() < order.size() || cells_.size() > order.size() + 1)
          lines_.fail("the row has " + std::to_string(cells_.size()) + " values, expected " + std::to_string(order.size()));
        for (std::size_t k = 0; k < order.size(); ++k) {
          if (order[k] < 0) continue;
          columns[static_cast<std::size_t>(order[k])].push_back(value_of(cells_[k], order[k]));
        }
        row_lines.push_back(lines_.line_number());
        values += order.size();
      } else {
        lines_.fail("expected an answer to a query, 'Q01:NAME:,value,...'");
      }
      if (values > most_values) lines_.fail("more than 67 million values in one block");
    }
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      if (found[f] != 0) continue;
      throw DataError(lines_.path() + ":" + std::to_string(table.first_line) + ": the block has no query '" +
                      fields_[f].column + "' for " + fields_[f].name);
    }
    if (!with_rows) return;
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      table.fields.push_back(fields_[f].name);
      if (columns[f].size() == columns[0].size()) continue;
      throw DataError(lines_.path() + ":" + std::to_string(found[f]) + ": the query '" + fields_[f].column + "' has " +
                      std::to_string(columns[f].size()) + " values, expected " + std::to_string(columns[0].size()) +
                      " as '" + fields_[0].column + "'");
    }
    const std::size_t rows = columns.empty() ? 0 : columns[0].size();
    for (std::size_t row = 0; row < rows; ++row) {
      for (const std::vector<double>& column : columns) table.values.push_back(column[row]);
    }
    // In the layout with lines a row has no line of its own.
    table.lines = row_lines.empty() ? std::vector<std::size_t>(rows, table.first_line) : row_lines;
  }

  int field_of(std::string_view name, std::vector<std::size_t>& found) {
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      if (fields_[f].column != name) continue;
      if (found[f] != 0) lines_.fail("the query '" + std::string(name) + "' is answered twice in this block");
      found[f] = lines_.line_number();
      return static_cast<int>(f);
    }
    return -1;
  }

  double value_of(std::string_view cell, int field) {
    const Field& f = fields_[static_cast<std::size_t>(field)];
    double value = 0;
    if (f.text) {
      const auto word = std::find(words_.begin(), words_.end(), trimmed(cell));
      if (word == words_.end()) lines_.fail("'" + f.column + "' names no wall of the map; they are: " + join_names(words_));
      return static_cast<double>(word - words_.begin());
    }
    if (!parse_number(trimmed(cell), value)) lines_.fail("a value of '" + f.column + "' is not a finite number");
    return value;
  }

  LineReader lines_;
  std::vector<Field> fields_;
  std::vector<std::string> words_;
  double dt_;
  bool have_time_ = false;
  double time_ = 0;
  std::uint64_t number_ = 0;
  std::vector<std::string_view> cells_;
};

// Names of the queries in the first block, as far as the head of the file shows them.
std::vector<std::string> queries_of(const std::string& path) {
  LineReader lines(path);
  std::string_view line;
  std::vector<std::string_view> cells;
  std::vector<std::string> names;
  double time = 0;
  bool inside = false;
  while (lines.next(line)) {
    split_csv(line, cells);
    if (is_time(cells, time)) {
      if (inside) break;
      inside = true;
      continue;
    }
    if (!inside) continue;
    for (const std::string_view cell : cells) {
      if (const std::string_view name = query_name(cell); !name.empty()) names.emplace_back(name);
    }
  }
  return names;
}

struct Candidate {
  TableKind kind;
  const char* name;
  const ImportTable ImportMap::*table;
  const std::vector<std::string>& (*known)();
};

constexpr Candidate candidates[] = {
    {TableKind::particles, "particles", &ImportMap::particles, known_particle_fields},
    {TableKind::pair_contacts, "pair_contacts", &ImportMap::pair_contacts, known_pair_fields},
    {TableKind::wall_contacts, "wall_contacts", &ImportMap::wall_contacts, known_wall_fields},
    {TableKind::wall_states, "wall_states", &ImportMap::wall_states, known_wall_state_fields},
};

}  // namespace

bool is_edem(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (map != nullptr) return map->format == "edem";
  const auto has_block = [](const InputHead& head) {
    std::vector<std::string_view> cells;
    double time = 0;
    bool inside = false;
    for (const std::string& line : head.lines) {
      split_csv(line, cells);
      if (inside && !query_name(cells[0]).empty()) return true;
      inside |= is_time(cells, time);
    }
    return false;
  };
  return std::any_of(inputs.begin(), inputs.end(), has_block);
}

SnapshotSource open_edem(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (map == nullptr) {
    throw DataError(inputs.front().path +
                    ": is a text export of EDEM; it needs a map (--map FILE.toml) that names queries, units and walls");
  }
  check_map(*map);
  const std::string origin = map->origin.empty() ? "map" : map->origin;
  std::vector<TableFile> files;
  for (const InputHead& head : inputs) {
    const std::vector<std::string> queries = queries_of(head.path);
    const std::string name = std::filesystem::path(head.path).filename().string();
    const Candidate* best = nullptr;
    std::vector<Field> best_fields;
    std::string why;
    for (const Candidate& candidate : candidates) {
      const ImportTable& table = map->*candidate.table;
      if (!table.used()) continue;
      const std::vector<Field> fields = ordered_fields(table.columns, candidate.known(), origin + ": " + candidate.name);
      std::vector<std::string> missing;
      for (const Field& field : fields) {
        if (std::find(queries.begin(), queries.end(), field.column) == queries.end()) missing.push_back(field.column);
      }
      if (!missing.empty()) {
        why += std::string("; ") + candidate.name + " lacks " + join_names(missing);
        continue;
      }
      if (name.find(table.file) == std::string::npos) {
        why += std::string("; ") + candidate.name + " fits but its files have '" + table.file + "' in their name";
        continue;
      }
      // A file with the queries of two tables is of the one that explains more of them.
      if (best != nullptr && best_fields.size() == fields.size())
        throw DataError(head.path + ": fits two tables of the map equally well; tell them apart by `file`, a part of the file name");
      if (best == nullptr || fields.size() > best_fields.size()) {
        best = &candidate;
        best_fields = fields;
      }
    }
    if (best == nullptr)
      throw DataError(head.path + ":1: fits no table of the map" + why + "; the queries are: " + join_names(queries));
    files.push_back({best->kind, head.path, best_fields,
                     open_frames<BlockReader>(head.path, best_fields, wall_words(*map), map->dt)});
  }
  return open_tables(files, *map, true, "");
}

}  // namespace jam
