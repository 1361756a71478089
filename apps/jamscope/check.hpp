// jamscope check: read a case, say what follows from it, simulate nothing.
#pragma once
#include <string>
#include <vector>

#include "apps/jamscope/case_file.hpp"

namespace jamscope {

// The derived numbers as aligned text, warnings last. Throws dem::GeometryError where the blade is no closed surface or
// touches the vessel.
std::string check_text(const CaseFile& file);

// The same for machines: numbers in SI units, under the names of the text in lower case with '_' for spaces.
std::string check_json(const CaseFile& file);

}  // namespace jamscope
