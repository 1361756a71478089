// Opening stored data the way every subcommand does: files, an optional map, roles given on the command line.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

struct InputOptions {
  std::vector<std::string> paths;
  std::string map;            // map file, or empty
  std::string blade, vessel;  // names of the walls that take these roles, instead of those that have them; or empty
};

// Throws jam::DataError, dem::CaseError (map file) and UsageError (no wall of that name).
jam::SnapshotSource open_stored_run(const InputOptions& options);

// The snapshots that the results in `folder` were made from: the files that `command_line` read as `inputs`, from the current folder or from that of
// `folder`; or run.h5 in it. Nothing where none of them can be read.
struct FoundSnapshots {
  jam::SnapshotSource source;
  std::string file;  // empty where they are several
};
std::optional<FoundSnapshots> find_snapshots(const std::filesystem::path& folder, const std::vector<std::string>& inputs,
                                             const std::vector<std::string>& command_line);

// Frames from `first` to before `last`.
struct FrameRange {
  std::size_t first = 0, last = 0;
};

// "A:B": from frame A to before frame B, either may be left out; empty: all. Throws UsageError.
FrameRange frame_range(const std::string& text, std::size_t frames);

// The rows of the series that came with frames [first, last).
jam::Series series_of(const jam::SnapshotSource& source, FrameRange range);

// Gives the role to the wall of this name and takes it from every other one. Throws UsageError.
void assign_role(std::vector<jam::Wall>& walls, const std::string& name, jam::WallRole role);

// The criteria of a stored run: those of its own case file where it has one (the defaults otherwise), then those of
// `criteria_file`, then the overrides. Throws dem::CaseError.
jam::Criteria stored_run_criteria(const jam::RunInfo& info, const std::string& criteria_file,
                                  const std::vector<std::string>& overrides);

// Name and description of the case that the data carry; empty for foreign data.
struct CaseTitle {
  std::string name, description;
};
CaseTitle case_title(const jam::RunInfo& info);

}  // namespace jamscope
