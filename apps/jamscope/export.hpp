// jamscope export: frames in the formats of other programs.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/console.hpp"
#include "apps/jamscope/stored_run.hpp"

namespace jamscope {

struct ExportOptions {
  InputOptions input;
  std::string format;                // a name of jam::export_formats()
  std::string output;                // folder
  std::optional<std::size_t> frame;  // this one only
  std::string frames;                // "A:B", see frame_range
  bool overwrite = false;
  bool quiet = false;
  LogFormat log_format = LogFormat::text;
};

// Names of the formats, and the list of them for the help.
std::vector<std::string> export_format_names();
std::string export_format_list();

// Writes the files into options.output, with map.toml where they can be read back. Returns the exit code; throws like the
// libraries, and UsageError.
int export_frames(const ExportOptions& options);

}  // namespace jamscope
