#include "libjam/snapshot/formats/lammps.hpp"

#include <algorithm>
#include <filesystem>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/tables_source.hpp"

namespace jam {
namespace {

struct Candidate {
  TableKind kind;
  std::string name;
  std::string file;  // part of the file's name, or empty
  std::vector<Field> fields;
};

std::vector<Candidate> candidates(const ImportMap& map) {
  const std::string origin = map.origin.empty() ? "map" : map.origin;
  std::vector<Candidate> list;
  const auto add = [&](TableKind kind, const char* name, const ImportTable& table,
                       const std::vector<std::string>& known) {
    if (table.used())
      list.push_back({kind, name, table.file, ordered_fields(table.columns, known, origin + ": " + name)});
  };
  add(TableKind::particles, "particles", map.particles, known_particle_fields());
  add(TableKind::pair_contacts, "pair_contacts", map.pair_contacts, known_pair_fields());
  add(TableKind::wall_contacts, "wall_contacts", map.wall_contacts, known_wall_fields());
  add(TableKind::wall_states, "wall_states", map.wall_states, known_wall_state_fields());
  if (map.wall_arrays.used())
    list.push_back({TableKind::wall_arrays, "wall_arrays", map.wall_arrays.file, array_fields(map)});
  return list;
}

std::vector<std::string> missing_columns(const Candidate& candidate, const std::vector<std::string>& columns) {
  std::vector<std::string> missing;
  for (const Field& field : candidate.fields) {
    if (std::find(columns.begin(), columns.end(), field.column) == columns.end()) missing.push_back(field.column);
  }
  return missing;
}

TableFile sort_in(const InputHead& head, const std::vector<Candidate>& list) {
  const std::vector<std::string> columns = dump_columns(head);
  if (columns.empty()) {
    throw DataError(
        head.path + ":" + std::to_string(head.lines.size()) +
        ": the first frame's header does not end in 'ITEM: ATOMS ...' or 'ITEM: ENTRIES ...' with column names");
  }
  const std::string name = std::filesystem::path(head.path).filename().string();
  const Candidate* best = nullptr;
  bool tie = false;
  std::string why;
  for (const Candidate& candidate : list) {
    const std::vector<std::string> missing = missing_columns(candidate, columns);
    if (!missing.empty()) {
      why += "; " + candidate.name + " lacks " + join_names(missing);
      continue;
    }
    if (name.find(candidate.file) == std::string::npos) {
      why += "; " + candidate.name + " fits but its files have '" + candidate.file + "' in their name";
      continue;
    }
    // A file with the columns of two kinds is of the one that explains more of them.
    tie = best != nullptr && best->fields.size() == candidate.fields.size();
    if (best == nullptr || candidate.fields.size() >= best->fields.size()) best = &candidate;
  }
  if (best == nullptr)
    throw DataError(head.path + ": fits no table of the map" + why + "; the columns are: " + join_names(columns));
  if (tie)
    throw DataError(head.path +
                    ": fits two tables of the map equally well; tell them apart by `file`, a part of the file name");
  return {best->kind, head.path, best->fields, open_frames<DumpReader>(head.path, best->fields)};
}

}  // namespace

bool is_lammps(const std::vector<InputHead>& inputs, const ImportMap*) {
  return std::any_of(inputs.begin(), inputs.end(),
                     [](const InputHead& head) { return !head.lines.empty() && head.lines[0].rfind("ITEM:", 0) == 0; });
}

SnapshotSource open_lammps(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (map == nullptr) {
    throw DataError(
        inputs.front().path +
        ": is a LAMMPS or LIGGGHTS dump; it needs a map (--map FILE.toml) that names columns, units and walls");
  }
  if (map->format != "lammps") {
    throw DataError(inputs.front().path + ": is a LAMMPS or LIGGGHTS dump, but the map is for the format '" +
                    map->format + "'");
  }
  check_map(*map);
  const std::vector<Candidate> list = candidates(*map);
  std::vector<TableFile> files;
  std::string load_series;
  for (const InputHead& head : inputs) {
    if (!head.lines.empty() && head.lines[0].rfind("ITEM:", 0) == 0) {
      files.push_back(sort_in(head, list));
    } else if (map->wall_loads.used() && !head.lines.empty() && head.lines[0].rfind('#', 0) == 0) {
      if (!load_series.empty()) throw DataError(head.path + ": is a second table of wall loads, after " + load_series);
      load_series = head.path;
    } else {
      throw DataError(head.path + ": is no dump (first line 'ITEM: TIMESTEP')" +
                      (map->wall_loads.used() ? " and no table of wall loads (first line '# NAME NAME ...')" : ""));
    }
  }
  for (const Candidate& candidate : list) {
    if (std::none_of(files.begin(), files.end(), [&](const TableFile& f) { return f.kind == candidate.kind; })) {
      std::string columns;
      for (const Field& field : candidate.fields) columns += (columns.empty() ? "" : ", ") + field.column;
      throw DataError((map->origin.empty() ? "map" : map->origin) + ": none of the inputs holds its " + candidate.name +
                      " (columns " + columns + ")");
    }
  }
  return open_tables(files, *map, false, load_series);
}

}  // namespace jam
