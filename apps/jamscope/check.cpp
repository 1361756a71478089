#include "apps/jamscope/check.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/jamscope/derived_table.hpp"
#include "apps/jamscope/sha256.hpp"

namespace jamscope {
namespace {

// "Rayleigh time, mean grain" -> "rayleigh_time_mean_grain".
std::string identifier(const std::string& name) {
  std::string key;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z')
      key += static_cast<char>(c - 'A' + 'a');
    else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      key += c;
    else if (c == ' ')
      key += '_';
  }
  return key;
}

}  // namespace

std::string check_text(const CaseFile& file) {
  const dem::Case& c = file.physics;
  std::string text = fmt::format("{}: {}\n{}\n", c.name, c.description, file.path);
  std::string group;
  for (const DerivedRow& row : derived_table(c, dem::derive(c))) {
    if (row.group != group) text += fmt::format("\n{}\n", row.group);
    group = row.group;
    std::string line = fmt::format("  {:<32}{:>11} {:<6}{}", row.name, row.value, row.unit, row.note);
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  if (!file.warnings.empty()) text += "\n";
  for (const std::string& warning : file.warnings) text += fmt::format("warning: {}\n", warning);
  return text;
}

std::string check_json(const CaseFile& file) {
  const dem::Case& c = file.physics;
  nlohmann::ordered_json json{{"name", c.name},
                              {"description", c.description},
                              {"case_sha256", sha256_hex(file.text)},
                              {"warnings", file.warnings}};
  for (const DerivedRow& row : derived_table(c, dem::derive(c)))
    json["derived"][row.group][identifier(row.name)] = row.si;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace jamscope
