#include "apps/jamscope/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "libdem/errors.hpp"

namespace jamscope {
namespace {

constexpr std::uintmax_t largest_file = 4u << 20;

// Optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::vector<std::string> split_key(const std::string& key) {
  std::vector<std::string> parts(1);
  for (char c : key) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string kind_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("the text '{}'", text->get());
  if (const auto* number = node.as_integer()) return fmt::format("the plain number {}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("the plain number {}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

// TOML where it is TOML ("7", "'4 mm'", "[1, 2]"), else the text itself ("4 mm").
void insert_override(toml::table& table, const std::string& key, const std::string& value) {
  try {
    toml::table parsed = toml::parse(std::string_view(std::string("value = ").append(value)), std::string_view());
    if (parsed.size() == 1 && parsed.contains("value") && !parsed.get("value")->is_table()) {
      parsed.get("value")->visit([&](const auto& node) { table.insert_or_assign(key, node); });
      return;
    }
  } catch (const toml::parse_error&) {
  }
  table.insert_or_assign(key, value);
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  if (word.size() > 64) return best;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string best = nearest(word, candidates);
  if (!best.empty()) return fmt::format("; did you mean '{}'?", best);
  if (candidates.empty()) return "";
  return fmt::format("; known: {}", fmt::join(candidates, ", "));
}

std::string read_text_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (error || status.type() == std::filesystem::file_type::not_found)
    throw dem::CaseError(path + ": cannot be read: no such file");
  if (std::filesystem::is_directory(status)) throw dem::CaseError(path + ": is a folder, expected a TOML file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw dem::CaseError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  std::string text(largest_file + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > largest_file) throw dem::CaseError(path + ": is larger than 4 MB, expected a TOML file");
  return text;
}

Document::Document(std::string_view text, std::string path, const std::vector<std::string>& overrides)
    : path_(std::move(path)) {
  try {
    table_ = toml::parse(text, std::string_view(path_));
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw dem::CaseError(fmt::format("{}:{}:{}: {}", path_, at.line, at.column, error.description()));
  }
  for (const std::string& override : overrides) {
    const std::size_t equals = override.find('=');
    const std::string key = override.substr(0, std::min(equals, override.size()));
    const std::vector<std::string> parts = split_key(key);
    const bool empty_part = std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); });
    if (equals == std::string::npos || empty_part)
      throw dem::CaseError(fmt::format("--set {}: expected KEY=VALUE, for example --set bed.depth=\"4 mm\"", override));
    toml::table* table = &table_;
    for (std::size_t k = 0; k + 1 < parts.size(); ++k) {
      if (!table->contains(parts[k])) table->insert(parts[k], toml::table{});
      table = table->get(parts[k])->as_table();
      if (!table) throw dem::CaseError(fmt::format("--set {}: '{}' is a value, not a table", key, parts[k]));
    }
    insert_override(*table, parts.back(), override.substr(equals + 1));
    overridden_.push_back(key);
  }
}

Section Document::root() {
  return Section(*this, &table_, "");
}

Document::Place Document::find_place(std::string key, bool at_key) const {
  for (const std::string& name : overridden_)
    if (name == key || name.starts_with(key + ".")) {
      // A table that is in the file has its own place there.
      if (name == key || !table_.at_path(key).node() || table_.at_path(key).node()->source().begin.line == 0)
        return {0, 0, "--set " + name};
    }
  while (!key.empty()) {
    const std::vector<std::string> parts = split_key(key);
    const toml::table* table = &table_;
    for (std::size_t k = 0; k < parts.size() && table; ++k) {
      const auto found = table->find(parts[k]);
      if (found == table->end()) break;
      if (k + 1 == parts.size()) {
        const auto at = at_key || found->second.is_table() ? found->first.source().begin : found->second.source().begin;
        if (at.line > 0) return {at.line, at.column, fmt::format("{}:{}:{}", path_, at.line, at.column)};
      }
      table = found->second.as_table();
    }
    const std::size_t dot = key.rfind('.');
    key.resize(dot == std::string::npos ? 0 : dot);
  }
  return {0, 0, path_};
}

std::string Document::place(const std::string& key, bool at_key) const {
  return find_place(key, at_key).text;
}

void Document::problem(const std::string& key, const std::string& message, bool at_key) {
  problems_.push_back({find_place(key, at_key), message});
}

void Document::throw_problems() const {
  if (problems_.empty()) return;
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  std::string all;
  for (const Problem& p : sorted) {
    if (!all.empty()) all += '\n';
    all += p.place.text + ": " + p.message;
  }
  throw dem::CaseError(all);
}

Section::Section(Document& document, toml::table* table, std::string path)
    : document_(&document), table_(table), path_(std::move(path)) {}

std::string Section::dotted(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const toml::node* Section::find(std::string_view key, Need need) {
  if (!table_) return nullptr;
  known_.emplace_back(key);
  const toml::node* node = table_->get(key);
  if (!node && need == Need::required) missing_.emplace_back(key);
  return node;
}

bool Section::wrong_type(std::string_view key, const std::string& wanted, const toml::node& got) {
  document_->problem(dotted(key), fmt::format("'{}' wants {}, got {}", key, wanted, kind_of(got)));
  return false;
}

Section Section::section(std::string_view key, Need need) {
  const toml::node* node = find(key, need);
  if (node && !node->is_table()) wrong_type(key, "a table", *node);
  return Section(*document_, node && node->is_table() ? table_->get(key)->as_table() : nullptr, dotted(key));
}

std::vector<std::pair<std::string, Section>> Section::named_sections() {
  std::vector<std::pair<std::string, Section>> sections;
  if (!table_) return sections;
  std::vector<std::string> names;
  for (const auto& [key, node] : *table_) names.emplace_back(key.str());
  // toml++ sorts keys; the order of the file is the one its author expects.
  std::stable_sort(names.begin(), names.end(), [this](const std::string& a, const std::string& b) {
    const auto at_a = table_->find(a)->first.source().begin, at_b = table_->find(b)->first.source().begin;
    return std::pair(at_a.line, at_a.column) < std::pair(at_b.line, at_b.column);
  });
  for (const std::string& name : names) {
    Section inner = section(name);
    if (inner) sections.emplace_back(name, std::move(inner));
  }
  return sections;
}

bool Section::quantity(std::string_view key, const Dimension& dimension, double& out, Need need) {
  return quantity_or({}, nullptr, key, dimension, out, need);
}

bool Section::quantity_or(std::string_view word, bool* is_word, std::string_view key, const Dimension& dimension, double& out,
                          Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const std::string instead = is_word ? fmt::format(", or \"{}\"", word) : "";
  const auto* text = node->as_string();
  if (!text)
    return wrong_type(key, fmt::format("{} with its unit, for example \"{}\"{}", dimension.name, dimension.example, instead),
                      *node);
  if (is_word) {
    *is_word = text->get() == word;
    if (*is_word) return true;
  }
  try {
    out = to_si(text->get(), dimension);
  } catch (const UnitError& error) {
    document_->problem(dotted(key), fmt::format("'{}' {}{}", key, error.what(), instead));
    return false;
  }
  return true;
}

bool Section::quantities(std::string_view key, const Dimension& dimension, std::vector<double>& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const std::string wanted = fmt::format("a list like [\"{}\"]", dimension.example);
  const toml::array* list = node->as_array();
  if (!list) return wrong_type(key, wanted, *node);
  std::vector<double> values;
  for (const toml::node& entry : *list) {
    if (!entry.is_string()) return wrong_type(key, wanted, entry);
    try {
      values.push_back(to_si(entry.as_string()->get(), dimension));
    } catch (const UnitError& error) {
      document_->problem(dotted(key), fmt::format("'{}' {}", key, error.what()));
      return false;
    }
  }
  out = std::move(values);
  return true;
}

bool Section::texts(std::string_view key, std::vector<std::string>& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const char* const wanted = "a list of texts in quotes";
  const toml::array* list = node->as_array();
  if (!list) return wrong_type(key, wanted, *node);
  std::vector<std::string> values;
  for (const toml::node& entry : *list) {
    if (!entry.is_string()) return wrong_type(key, wanted, entry);
    values.push_back(entry.as_string()->get());
  }
  out = std::move(values);
  return true;
}

bool Section::number(std::string_view key, double& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) return wrong_type(key, "a plain number", *node);
  out = *value;
  return true;
}

bool Section::numbers(std::string_view key, std::vector<double>& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const toml::array* list = node->as_array();
  if (!list) return wrong_type(key, "a list of plain numbers", *node);
  std::vector<double> values;
  for (const toml::node& entry : *list) {
    const auto value = entry.is_number() ? entry.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) return wrong_type(key, "a list of plain numbers", entry);
    values.push_back(*value);
  }
  out = std::move(values);
  return true;
}

bool Section::whole_number(std::string_view key, std::uint64_t& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const auto* value = node->as_integer();
  if (!value || value->get() < 0) return wrong_type(key, "a whole number that is not negative", *node);
  out = static_cast<std::uint64_t>(value->get());
  return true;
}

bool Section::truth(std::string_view key, bool& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  const auto* value = node->as_boolean();
  if (!value) return wrong_type(key, "true or false", *node);
  out = value->get();
  return true;
}

bool Section::text(std::string_view key, std::string& out, Need need) {
  const toml::node* node = find(key, need);
  if (!node) return false;
  if (!node->is_string()) return wrong_type(key, "a text in quotes", *node);
  out = node->as_string()->get();
  return true;
}

int Section::choose(std::string_view key, const std::vector<std::string>& words, Need need) {
  std::string word;
  if (!text(key, word, need)) return -1;
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  document_->problem(dotted(key), fmt::format("'{}' wants '{}', got '{}'", key, fmt::join(words, "' or '"), word));
  return -1;
}

void Section::finish() {
  if (!table_) return;
  const std::string where = path_.empty() ? "" : fmt::format(" in [{}]", path_);
  std::vector<std::string> meant;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    meant.push_back(nearest(name, known_));
    const char* const what = node.is_table() && path_.empty() ? "table" : "key";
    document_->problem(dotted(name), fmt::format("unknown {} '{}'{}{}", what, name, where, suggestion(name, known_)),
                       true);
  }
  for (const std::string& name : missing_) {
    if (std::find(meant.begin(), meant.end(), name) != meant.end()) continue;
    document_->problem(path_, path_.empty() ? fmt::format("missing table [{}]", name)
                                            : fmt::format("missing key '{}'{}", name, where));
  }
}

}  // namespace jamscope
