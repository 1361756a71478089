// jam.h5: the result of an analysis, beside the snapshots it was made from and never inside them.
//
//   /                  attrs: format="jamscope-analysis" schema_version, and of the run: creator creator_version commit
//                      created_utc case_sha256 seed
//   /criteria          the thresholds, one row each
//   /summary           scalars, one row each
//   /frames            one row per frame
//   /metrics           a dataset for each metric recorded, one row per frame
//   /clusters          one row per cluster; members are rows [member_start, + member_count) of /clusters/members
//   /cluster_links     which cluster of a frame became which of the next; /clusters/identity is the row of
//   /cluster_events    the cluster stream
//   /events            the global stream; members as above
//   /tracks            the per-particle stream; points are rows [point_start, + point_count) of /tracks/points/...
//   /loaded            the particles under load in every frame, for counts at other thresholds; /loaded/of_frame: how many of each frame
//   /blade             where the blade was in each frame
//   /every_step/...    global, particle, site: jams as every step of the run saw them, where it watched
//   /contact_life      how long contacts lasted, by octaves, where the run counted
//   /flow_pattern      mean velocities around the blade, one row per bin, where they are known (since 2.1)
//   /survival_classes /jammed_histogram /flow_energy /notes
//
// Every dataset has the attributes `unit` and `doc`. Truth values are 0 and 1.
#pragma once
#include <filesystem>

#include "libjam/analysis.hpp"

namespace jam {

// Written aside and renamed, so `path` holds either the old result or the whole new one. Throws DataError.
void write_results(const std::filesystem::path& path, const Analysis& analysis, const RunInfo& info);

// The same Analysis again, bit by bit. Throws DataError where the file cannot be read, is something else, or breaks its
// own structure.
Analysis read_results(const std::filesystem::path& path);

}  // namespace jam
