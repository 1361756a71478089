// Four tables over all frames: particles.csv, contacts.csv, wall_contacts.csv, walls.csv.
//
// The first line names the columns with their units, "position_x [m]"; the first columns are the frame's number, step and
// time. A quantity that the source does not know has no column. With map() the files are the same frames again.
#pragma once
#include <filesystem>
#include <memory>

#include "libjam/snapshot/export/export_formats.hpp"

namespace jam {

std::unique_ptr<SnapshotExporter> export_csv(const RunInfo& info, const std::filesystem::path& folder);

}  // namespace jam
