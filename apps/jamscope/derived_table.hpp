// The derived numbers of a case as people read them: for `check` and for the report.
#pragma once
#include <string>
#include <vector>

#include "libdem/case/derived.hpp"

namespace jamscope {

struct DerivedRow {
  std::string group;  // "motion", "bed", "contact", "time", "cost"
  std::string name, value, unit;
  std::string note;
  double si = 0;  // the number itself in SI units, for machines
};

std::vector<DerivedRow> derived_table(const dem::Case& c, const dem::Derived& d);

}  // namespace jamscope
