// A small reader of reference tables: a header line, then rows of text fields.
#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace support {

using Row = std::map<std::string, std::string>;

inline std::vector<Row> read_csv(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::string line, field;
  std::vector<std::string> header;
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream fields(line);
    std::vector<std::string> values;
    while (std::getline(fields, field, ',')) values.push_back(field);
    if (header.empty()) {
      header = values;
      continue;
    }
    Row row;
    for (std::size_t k = 0; k < header.size() && k < values.size(); ++k) row[header[k]] = values[k];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace support
