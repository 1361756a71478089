// Frames of numbers: what every text format is turned into before its columns get a meaning.
//
// A cursor reads one file forward, one frame at a time, and keeps no frame: opening a file costs one pass that notes
// where the frames are, reading the frames in order costs a second one, and going back starts again from the file's
// beginning. So memory holds one frame whatever the size of the file, at the price of decompressing twice.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/formats/text_input.hpp"

namespace jam {

// All values are as in the file, in its units.
struct Table {
  std::string path;
  std::uint64_t step = 0;
  double time = std::numeric_limits<double>::quiet_NaN();  // where the file has it
  Vec3 period = Vec3::Zero();                              // of the box, per direction; 0: not periodic
  std::size_t first_line = 0;                              // of the first row in the file
  std::vector<std::size_t> lines;                          // of each row, where rows do not follow each other
  std::vector<std::string> fields;
  std::vector<double> values;  // [rows][fields]

  std::size_t rows() const { return fields.empty() ? 0 : values.size() / fields.size(); }
  int find(std::string_view field) const;  // -1: absent
  bool has(std::string_view field) const { return find(field) >= 0; }
  double at(std::size_t row, int field) const { return values[row * fields.size() + static_cast<std::size_t>(field)]; }
  // The vector in three neighbouring fields, `first` being its x component.
  Vec3 vector_at(std::size_t row, int first) const { return {at(row, first), at(row, first + 1), at(row, first + 2)}; }
  // Throws DataError "PATH:LINE: problem".
  [[noreturn]] void fail(std::size_t row, const std::string& problem) const;
};

// One mapped column. Text columns hold one of `words`, of which the table gets the index.
struct Field {
  std::string name;    // of the field
  std::string column;  // in the file
  bool text = false;
};

// The fields of a column map in a fixed order in which vectors are contiguous. Throws DataError (naming `origin`) for a
// field that is not among `known` and for a vector that lacks a component.
std::vector<Field> ordered_fields(const ColumnMap& columns, const std::vector<std::string>& known,
                                  const std::string& origin);

// LAMMPS "dump custom" (ITEM: ATOMS) and "dump local" (ITEM: ENTRIES), and LIGGGHTS' dialect of them.
class DumpReader {
 public:
  DumpReader(std::string path, std::vector<Field> fields) : lines_(std::move(path)), fields_(std::move(fields)) {}
  // The next frame, without its rows when `with_rows` is false; nothing at the end of the file.
  std::optional<Table> next(bool with_rows);

 private:
  LineReader lines_;
  std::vector<Field> fields_;
};

// Comma separated, one header line, rows of one frame together: column `frame` counts up, column `time` (if mapped) is
// constant within a frame.
class CsvReader {
 public:
  CsvReader(std::string path, std::vector<Field> fields, std::vector<std::string> words);
  std::optional<Table> next(bool with_rows);

 private:
  bool parse_line();  // fills row_ from the next line; false at the end

  LineReader lines_;
  std::vector<Field> fields_;
  std::vector<std::string> words_;
  std::vector<std::size_t> columns_;  // of fields_
  std::size_t frame_column_ = 0;
  std::size_t width_ = 0;
  std::uint64_t frame_ = 0;
  std::vector<double> row_;
  bool pending_ = false;  // row_ belongs to the next frame
};

// Reads one file forward: the next frame, without its rows when `with_rows` is false; nothing at the end of the file.
using FrameReader = std::function<std::optional<Table>(bool with_rows)>;
// Begins a file anew.
using OpenFrames = std::function<FrameReader()>;

// For readers that have next(with_rows), as those above.
template <class Reader, class... Arguments>
OpenFrames open_frames(Arguments... arguments) {
  return [=] {
    const auto reader = std::make_shared<Reader>(arguments...);
    return [reader](bool with_rows) { return reader->next(with_rows); };
  };
}

// A file with its frames found; movable, not to be shared between threads.
class FrameCursor {
 public:
  struct Mark {
    std::uint64_t step;
    double time;  // in the file's unit, NaN where the file has none
  };

  // Reads the whole file once. Throws DataError for broken syntax, a cut stream, and steps that do not increase.
  FrameCursor(std::string path, OpenFrames open);
  const std::vector<Mark>& marks() const { return marks_; }
  const std::string& path() const { return path_; }
  Table read(std::size_t frame);

 private:
  std::string path_;
  OpenFrames open_;
  std::vector<Mark> marks_;
  std::size_t next_ = 0;
  FrameReader reader_;  // empty: the file is not open
};

// The column names of the first frame of a dump ("ITEM: ATOMS id type ..."), empty where the head is no dump.
std::vector<std::string> dump_columns(const InputHead& head);

}  // namespace jam
