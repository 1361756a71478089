// Case files: TOML in, dem::Case and jam::Criteria out. The layout is shown by data/cases/ft4_a_down.toml.
//
// A value with a dimension is text with a unit ("63 GPa"), a value without one a plain number. Unknown, missing,
// repeated and mistyped keys, unknown materials and values out of range are errors that name file, line and column; all
// of them are reported at once, one per line:
//
//   case.toml:14:1: unknown key 'yuong' in [material.glass]; did you mean 'young'?
//   --set bed.depht: unknown key 'depht' in [bed]; did you mean 'depth'?
//
// To add a key: one line in the function of case_file.cpp that reads its table.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "libdem/case/case.hpp"
#include "libdem/scene/scene.hpp"
#include "libjam/jamming/criteria.hpp"

namespace jamscope {

struct CaseFile {
  dem::Case physics;
  std::vector<dem::SceneWall> walls;  // of the [wall.NAME] tables
  jam::Criteria criteria;
  std::string text;  // the file byte for byte; with overrides, the case after them, written out as TOML again
  std::string path;
  std::vector<std::string> warnings;  // positioned like errors
};

// overrides: "key=value" with the dotted key of the file, applied to the TOML before it is read; the value is TOML
// ("motion.tip_speed='100 mm/s'", "bed.seed=7"), and text without quotes is taken for text ("bed.depth=4 mm").
// Relative paths in the case are relative to the file. Throws dem::CaseError; what() is all its messages, one per line.
CaseFile read_case_file(const std::string& path, const std::vector<std::string>& overrides = {});

// The same from memory; `path` is used in messages and to resolve relative paths.
CaseFile read_case_text(std::string_view text, const std::string& path, const std::vector<std::string>& overrides = {});

// The [analysis] table alone: what a criteria file holds. `base` gives every key that the text does not. A key of the
// overrides may omit "analysis.". Throws dem::CaseError.
jam::Criteria read_criteria_text(std::string_view text, const std::string& path, const jam::Criteria& base,
                                 const std::vector<std::string>& overrides = {});
jam::Criteria read_criteria_file(const std::string& path, const jam::Criteria& base,
                                 const std::vector<std::string>& overrides = {});

// The criteria of a case whose other tables do not matter, as stored with its snapshots. Throws dem::CaseError.
jam::Criteria read_case_criteria(std::string_view text, const std::string& path);

}  // namespace jamscope
