#include "libjam/snapshot/open_source.hpp"

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/csv.hpp"
#include "libjam/snapshot/formats/lammps.hpp"

namespace jam {
namespace {

struct SourceFormat {
  const char* name;
  const char* looks_like;  // for the message when nothing fits
  bool (*recognises)(const std::vector<InputHead>& inputs, const ImportMap* map);
  SnapshotSource (*open)(const std::vector<InputHead>& inputs, const ImportMap* map);
};

// Formats of stored snapshots, asked in this order. To add one: write formats/NAME.hpp with a function that recognises
// it from the heads of the files and one that opens them (formats/tables_source.hpp does the work for anything that is
// a table a frame), and add its row.
constexpr SourceFormat formats[] = {
    {"lammps", "LAMMPS or LIGGGHTS dumps (first line 'ITEM: TIMESTEP') with a map", is_lammps, open_lammps},
    {"csv", "comma separated tables (header frame,time,id,x,y,z,radius ...)", is_csv, open_csv},
};

}  // namespace

SnapshotSource open_source(const std::vector<std::string>& paths, const ImportMap* map) {
  if (paths.empty()) throw DataError("no input file was given");
  std::vector<InputHead> inputs;
  for (const std::string& path : paths) inputs.push_back(read_head(path));
  std::string known;
  for (const SourceFormat& format : formats) {
    if (format.recognises(inputs, map)) return format.open(inputs, map);
    known += (known.empty() ? "" : "; ") + std::string(format.looks_like);
  }
  throw DataError(paths.front() + ": is in no format that can be read; known are: " + known);
}

}  // namespace jam
