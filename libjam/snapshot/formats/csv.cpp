#include "libjam/snapshot/formats/csv.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/tables_source.hpp"

namespace jam {
namespace {

std::vector<std::string> csv_columns(const InputHead& head) {
  std::vector<std::string> columns;
  if (head.lines.empty() || head.lines[0].find(',') == std::string::npos) return columns;
  std::vector<std::string_view> parts;
  split_csv(head.lines[0], parts);
  columns.assign(parts.begin(), parts.end());
  return columns;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct Kind {
  TableKind kind;
  const char* name;
  const ImportTable ImportMap::*table;
  std::vector<std::string> required;  // of the fixed header
  const std::vector<std::string>& (*known)();
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list{{TableKind::particles,
                                       "particles",
                                       &ImportMap::particles,
                                       {"frame", "time", "id", "x", "y", "z", "radius"},
                                       known_particle_fields},
                                      {TableKind::pair_contacts,
                                       "contacts",
                                       &ImportMap::pair_contacts,
                                       {"frame", "id1", "id2", "fn"},
                                       known_pair_fields},
                                      {TableKind::wall_contacts,
                                       "wall_contacts",
                                       &ImportMap::wall_contacts,
                                       {"frame", "id", "wall", "fn"},
                                       known_wall_fields},
                                      {TableKind::wall_states,
                                       "wall_states",
                                       &ImportMap::wall_states,
                                       {"frame", "wall", "x", "y", "z", "qw", "qx", "qy", "qz"},
                                       known_wall_state_fields}};
  return list;
}

std::vector<std::string> missing_from(const std::vector<std::string>& wanted, const std::vector<std::string>& columns) {
  std::vector<std::string> missing;
  for (const std::string& name : wanted) {
    if (!contains(columns, name)) missing.push_back(name);
  }
  return missing;
}

// The columns that the map names, or those of the fixed header that the file has.
ColumnMap columns_of(const Kind& kind, const ImportMap& map, const std::vector<std::string>& columns,
                     bool materials_known) {
  const ImportTable& table = map.*kind.table;
  if (table.used()) return table.columns;
  ColumnMap found;
  for (const std::string& name : kind.known()) {
    if (contains(columns, name) && (name != "material" || materials_known)) found[name] = name;
  }
  return found;
}

// Distinct words of one column, in order of appearance.
std::vector<std::string> words_of(const std::string& path, const std::string& column) {
  LineReader lines(path);
  std::string_view line;
  std::vector<std::string_view> parts;
  lines.next(line);
  split_csv(line, parts);
  const auto place = static_cast<std::size_t>(std::find(parts.begin(), parts.end(), column) - parts.begin());
  std::vector<std::string> words;
  std::set<std::string, std::less<>> seen;
  while (lines.next(line)) {
    split_csv(line, parts);
    if (place >= parts.size() || seen.count(parts[place]) > 0) continue;
    if (parts[place].empty() || parts[place].size() > 200)
      lines.fail("the name of the wall is empty or longer than 200 characters");
    if (words.size() == 255) lines.fail("more than 255 walls");
    seen.emplace(parts[place]);
    words.emplace_back(parts[place]);
  }
  return words;
}

}  // namespace

WallRole role_from_name(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto has = [&](std::initializer_list<const char*> parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const char* part) { return lower.find(part) != std::string::npos; });
  };
  if (has({"blade", "impeller", "paddle", "rotor", "wing", "stirrer", "screw", "geometry"})) return WallRole::blade;
  if (has({"vessel", "cylinder", "wall", "container", "casing", "drum", "housing"})) return WallRole::vessel;
  return WallRole::other;
}

bool is_csv(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (map != nullptr) return map->format == "csv";
  return std::all_of(inputs.begin(), inputs.end(), [](const InputHead& head) {
    const std::vector<std::string> columns = csv_columns(head);
    return std::any_of(kinds().begin(), kinds().end(),
                       [&](const Kind& kind) { return contains(columns, kind.required[0]); });
  });
}

SnapshotSource open_csv(const std::vector<InputHead>& inputs, const ImportMap* given) {
  ImportMap map;
  if (given != nullptr) map = *given;
  map.format = "csv";
  if (map.creator.empty()) map.creator = "csv";
  bool ignored_material = false;

  struct Input {
    const InputHead* head;
    const Kind* kind;
    ColumnMap columns;
  };
  std::vector<Input> sorted;
  for (const InputHead& head : inputs) {
    const std::vector<std::string> columns = csv_columns(head);
    if (columns.empty()) throw DataError(head.path + ":1: expected a header line of comma separated column names");
    const Kind* best = nullptr;
    std::string why;
    for (const Kind& kind : kinds()) {
      const ImportTable& table = map.*kind.table;
      std::vector<std::string> wanted = kind.required;
      if (table.used()) {
        wanted.clear();
        for (const auto& [field, column] : table.columns) wanted.push_back(column);
      }
      const std::vector<std::string> missing = missing_from(wanted, columns);
      if (missing.empty()) {
        best = &kind;
        break;
      }
      why += std::string("; ") + kind.name + " lacks " + join_names(missing);
    }
    if (best == nullptr)
      throw DataError(head.path + ":1: is none of the known tables" + why +
                      "; the columns are: " + join_names(columns));
    for (const Input& other : sorted) {
      if (other.kind == best)
        throw DataError(head.path + ": is a second table of " + best->name + ", after " + other.head->path);
    }
    ignored_material |= best->kind == TableKind::particles && map.materials.empty() && contains(columns, "material");
    sorted.push_back({&head, best, columns_of(*best, map, columns, !map.materials.empty())});
  }
  if (map.walls.empty()) {
    for (const Input& input : sorted) {
      if (input.kind->kind != TableKind::wall_contacts && input.kind->kind != TableKind::wall_states) continue;
      const auto column = input.columns.find("wall");
      if (column == input.columns.end()) continue;
      for (const std::string& name : words_of(input.head->path, column->second)) {
        if (std::any_of(map.walls.begin(), map.walls.end(), [&](const ImportWall& w) { return w.wall.name == name; }))
          continue;
        ImportWall wall;
        wall.wall.name = name;
        wall.wall.kind = "mesh";
        wall.wall.role = role_from_name(name);
        map.walls.push_back(wall);
      }
      // Numbered by name, so that the order of the rows does not matter.
      std::sort(map.walls.begin(), map.walls.end(),
                [](const ImportWall& a, const ImportWall& b) { return a.wall.name < b.wall.name; });
    }
  }
  std::vector<TableFile> files;
  const auto name_of = [&](const Input& input) { return input.head->path + ": " + input.kind->name; };
  for (const Input& input : sorted) {
    if (input.kind->kind == TableKind::particles) map.particles.columns = input.columns;
    if (input.kind->kind == TableKind::pair_contacts) map.pair_contacts.columns = input.columns;
    if (input.kind->kind == TableKind::wall_contacts && !map.walls.empty()) map.wall_contacts.columns = input.columns;
    if (input.kind->kind == TableKind::wall_states && !map.walls.empty()) map.wall_states.columns = input.columns;
    const std::vector<Field> fields = ordered_fields(input.columns, input.kind->known(), name_of(input));
    files.push_back({input.kind->kind, input.head->path, fields,
                     open_frames<CsvReader>(input.head->path, fields, wall_words(map))});
  }
  if (std::none_of(files.begin(), files.end(), [](const TableFile& f) { return f.kind == TableKind::particles; })) {
    throw DataError(inputs.front().path + ": none of the inputs holds particles (header frame,time,id,x,y,z,radius)");
  }
  check_map(map);
  SnapshotSource source = open_tables(files, map, true, "");
  if (ignored_material)
    source.warnings.push_back("the column 'material' is ignored: no map says what the materials are");
  return source;
}

}  // namespace jam
