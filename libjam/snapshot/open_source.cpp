#include "libjam/snapshot/open_source.hpp"

#include <algorithm>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/csv.hpp"
#include "libjam/snapshot/formats/edem.hpp"
#include "libjam/snapshot/formats/lammps.hpp"
#include "libjam/snapshot/formats/mercury.hpp"
#include "libjam/snapshot/reader.hpp"

namespace jam {
namespace {

struct SourceFormat {
  const char* name;
  const char* looks_like;  // for the message when nothing fits
  bool (*recognises)(const std::vector<InputHead>& inputs, const ImportMap* map);
  SnapshotSource (*open)(const std::vector<InputHead>& inputs, const ImportMap* map);
};

bool is_jamscope(const std::vector<InputHead>& inputs, const ImportMap*) {
  return std::any_of(inputs.begin(), inputs.end(), [](const InputHead& head) { return is_hdf5(head); });
}

SnapshotSource open_jamscope(const std::vector<InputHead>& inputs, const ImportMap* map) {
  if (inputs.size() > 1) {
    throw DataError(inputs[1].path +
                    ": is one file too many, expected a jamscope file alone or another code's files without one");
  }
  if (map != nullptr) throw DataError(inputs[0].path + ": is an HDF5 file, which needs no map");
  return open_jamscope_file(inputs[0].path);
}

// Formats of stored snapshots, asked in this order. To add one: write formats/NAME.hpp with a function that recognises
// it from the heads of the files and one that opens them (formats/tables_source.hpp does the work for anything that is
// a table a frame), and add its row.
constexpr SourceFormat formats[] = {
    {"jamscope", "jamscope snapshot files (HDF5)", is_jamscope, open_jamscope},
    {"lammps", "LAMMPS or LIGGGHTS dumps (first line 'ITEM: TIMESTEP') with a map", is_lammps, open_lammps},
    {"mercury", "MercuryDPM's NAME.data and NAME.fstat", is_mercury, open_mercury},
    {"edem", "EDEM's text exports (\"TIME\" before each block of queries) with a map", is_edem, open_edem},
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
