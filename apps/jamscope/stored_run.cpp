#include "apps/jamscope/stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/map_file.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "libjam/snapshot/schema.hpp"

namespace jamscope {
namespace {

// The value of `--name VALUE` or `--name=VALUE` in a command line, or "".
std::string option_value(const std::vector<std::string>& words, const std::string& name) {
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == name && k + 1 < words.size()) return words[k + 1];
    if (words[k].starts_with(name + "=")) return words[k].substr(name.size() + 1);
  }
  return "";
}

}  // namespace

void assign_role(std::vector<jam::Wall>& walls, const std::string& name, jam::WallRole role) {
  std::vector<std::string> names;
  bool found = false;
  for (const jam::Wall& wall : walls) {
    names.push_back(wall.name);
    found |= wall.name == name;
  }
  if (!found) throw UsageError(fmt::format("the data have no wall '{}'{}", name, suggestion(name, names)));
  for (jam::Wall& wall : walls) {
    if (wall.name == name)
      wall.role = role;
    else if (wall.role == role)
      wall.role = jam::WallRole::other;
  }
}

FrameRange frame_range(const std::string& text, std::size_t frames) {
  if (text.empty()) return {0, frames};
  const auto refuse = [&](const std::string& expected) -> UsageError {
    return UsageError(fmt::format("--frames {}: expected {}; there are {} frames", text, expected, frames));
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw refuse("A:B, from frame A to before frame B");
  const auto number = [&](const std::string& part, std::size_t left_out) {
    if (part.empty()) return left_out;
    std::size_t value = 0;
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (problem != std::errc() || end != part.data() + part.size()) throw refuse("two numbers of frames");
    return value;
  };
  const FrameRange range{number(text.substr(0, colon), 0), std::min(number(text.substr(colon + 1), frames), frames)};
  if (range.first >= range.last) throw refuse("the first below the second and below the number of frames");
  return range;
}

jam::Series series_of(const jam::SnapshotSource& source, FrameRange range) {
  const auto rows_up_to = [&](std::size_t frames) {
    if (frames == 0) return std::size_t{0};
    if (frames == source.frames) return source.series.size();
    const auto& steps = source.series.step;
    return std::size_t(std::upper_bound(steps.begin(), steps.end(), source.read(frames - 1).step) - steps.begin());
  };
  if (source.series.size() == 0) return {};
  return jam::schema::rows_of(source.series, rows_up_to(range.first), rows_up_to(range.last));
}

jam::SnapshotSource open_stored_run(const InputOptions& options) {
  for (const std::string& path : options.paths) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw jam::DataError(path + ": cannot be read: no such file");
    if (std::filesystem::is_directory(path, error))
      throw jam::DataError(path + ": is a folder, expected a file of snapshots (run.h5)");
  }
  jam::SnapshotSource source;
  if (options.map.empty()) {
    source = jam::open_source(options.paths);
  } else {
    const jam::ImportMap map = read_map_file(options.map);
    source = jam::open_source(options.paths, &map);
  }
  if (!options.blade.empty()) assign_role(source.info.walls, options.blade, jam::WallRole::blade);
  if (!options.vessel.empty()) assign_role(source.info.walls, options.vessel, jam::WallRole::vessel);
  return source;
}

std::optional<FoundSnapshots> find_snapshots(const std::filesystem::path& folder, const std::vector<std::string>& inputs,
                                             const std::vector<std::string>& command_line) {
  std::vector<InputOptions> candidates;
  const auto add = [&](const std::filesystem::path& base) {
    InputOptions input;
    for (const std::string& path : inputs) input.paths.push_back((base / path).string());
    if (const std::string map = option_value(command_line, "--map"); !map.empty()) input.map = (base / map).string();
    input.blade = option_value(command_line, "--blade");
    input.vessel = option_value(command_line, "--vessel");
    if (!input.paths.empty()) candidates.push_back(input);
  };
  add("");
  add(std::filesystem::absolute(folder).lexically_normal() / "..");
  candidates.push_back({{(folder / "run.h5").string()}, "", "", ""});
  for (const InputOptions& input : candidates) {
    try {
      return FoundSnapshots{open_stored_run(input), input.paths.size() == 1 ? input.paths.front() : std::string()};
    } catch (const jam::DataError&) {
    } catch (const dem::CaseError&) {
    } catch (const UsageError&) {
      // Not there, or something else by now: the next one, or none.
    }
  }
  return std::nullopt;
}

jam::Criteria stored_run_criteria(const jam::RunInfo& info, const std::string& criteria_file,
                                  const std::vector<std::string>& overrides) {
  jam::Criteria criteria;
  if (!info.case_toml.empty()) criteria = read_case_criteria(info.case_toml, "stored case");
  if (!criteria_file.empty()) criteria = read_criteria_file(criteria_file, criteria);
  return read_criteria_text("", "", criteria, overrides);
}

CaseTitle case_title(const jam::RunInfo& info) {
  if (info.case_toml.empty()) return {};
  const Document document(info.case_toml, "stored case", {});
  return {document.table().at_path("case.name").value_or(std::string()),
          document.table().at_path("case.description").value_or(std::string())};
}

}  // namespace jamscope
