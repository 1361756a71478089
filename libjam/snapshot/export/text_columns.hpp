// The columns of text tables that another program, and our own importers, read: headings, fields of the map, rows.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "libjam/snapshot/export/columns.hpp"
#include "libjam/snapshot/formats/import_map.hpp"

namespace jam {

enum class Headings { lammps, with_units };  // "vx", "velocity_x [m/s]"

// One column of text: a component of a column of the frame.
struct TextColumn {
  std::string heading;
  std::string field;  // of the map that reads it back, see ColumnMap
  FrameColumn column;
  unsigned component;
};

// Those that the frame has. Keys (ids, rows, walls, materials) are left to the exporter. A frame without rows has them all.
std::vector<TextColumn> text_columns(const std::vector<FrameColumn>& columns, std::size_t rows, Headings headings);

// The states of the walls of a frame as columns.
class WallColumns {
 public:
  WallColumns(const Snapshot& snapshot, const RunInfo& info);
  const std::vector<FrameColumn>& columns() const { return columns_; }

 private:
  std::vector<std::vector<double>> values_;  // of each column, [walls * width]
  std::vector<FrameColumn> columns_;
};

// Keeps the columns of one table the same over all frames that have rows.
class TableColumns {
 public:
  // Throws DataError where the columns differ from those of the frames before. `table` names the file for the message.
  void agree(const std::vector<TextColumn>& columns, std::size_t rows, std::size_t frame, const std::string& table);
  // Fields and headings, for the map.
  const ColumnMap& fields() const { return fields_; }

 private:
  ColumnMap fields_;
  bool settled_ = false;
};

// What a map says of the run itself: provenance, materials, walls with their number as mesh_id, the gap, the case.
// first_type: of the first material.
ImportMap map_of_run(const RunInfo& info, const std::string& format, int first_type);

}  // namespace jam
