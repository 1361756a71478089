#include "libjam/snapshot/export/export_formats.hpp"

#include "libjam/snapshot/export/csv_tables.hpp"
#include "libjam/snapshot/export/graphml.hpp"
#include "libjam/snapshot/export/lammps_dump.hpp"
#include "libjam/snapshot/export/vtp.hpp"

namespace jam {
namespace {

// To add a format: write NAME.hpp with a function that makes its exporter, and add its row. The suites in
// tests/jam/snapshot/export go over the table.
constexpr ExportFormat formats[] = {
    {"vtp", "ParaView, VisIt, PyVista: particles.pvd, contacts.pvd, blade.pvd, walls.pvd", export_vtp},
    {"lammps", "OVITO and LAMMPS tools: atoms.dump, pairs.dump, wall_contacts.dump, walls.dump", export_lammps},
    {"csv", "pandas, R, spreadsheets: particles.csv, contacts.csv, wall_contacts.csv, walls.csv", export_csv},
    {"graphml", "networkx, igraph, Gephi: the contact network of each frame, frame_N.graphml", export_graphml},
};

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

}  // namespace jam
