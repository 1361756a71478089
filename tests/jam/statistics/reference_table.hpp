// A table of data/reference/statistics, made by make.R beside it.
#pragma once
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/support/csv.hpp"

namespace jam::reference {

struct Row {
  support::Row cells;
  const std::string& text(const std::string& column) const { return cells.at(column); }
  double number(const std::string& column) const {  // "Inf" and "NA" as R writes them
    return text(column) == "NA" ? std::nan("") : std::strtod(text(column).c_str(), nullptr);
  }
};

inline std::vector<Row> table(const std::string& name) {
  std::vector<Row> rows;
  for (support::Row& row : support::read_csv(std::string(JAMSCOPE_DATA_DIR) + "/reference/statistics/" + name)) rows.push_back({std::move(row)});
  return rows;
}

}  // namespace jam::reference
