// Strict reading of TOML tables into plain structs: whoever reads a key thereby declares it, so that reading, the check
// for unknown keys and the suggestions cannot disagree. Used for case, criteria and map files.
//
//   Document document(text, "case.toml", overrides);
//   Section bed = document.root().section("bed");
//   bed.quantity("depth", dimension::length, c.bed.depth);
//   ...
//   document.root().finish(); document.throw_problems();
#pragma once
#include <toml++/toml.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/jamscope/units.hpp"

namespace jamscope {

// The candidate with the smallest edit distance (insert, delete, replace, swap neighbours), or "" where none is near
// enough to be a slip of the finger. Ties: the first.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

// "; did you mean 'x'?", or the list of candidates where none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

// Reads a whole text file. Throws dem::CaseError where it cannot be read or is larger than 4 MB.
std::string read_text_file(const std::string& path);

enum class Need { required, optional };

class Section;

// A parsed file with its problems. Not copyable: sections point into it.
class Document {
 public:
  // Throws dem::CaseError where the text is no TOML or an override is no "key=value".
  Document(std::string_view text, std::string path, const std::vector<std::string>& overrides);
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  Section root();
  const toml::table& table() const { return table_; }
  const std::string& path() const { return path_; }

  // Records a problem at the dotted key, or at its nearest parent that is in the file. at_key: point at the key, not at
  // its value.
  void problem(const std::string& key, const std::string& message, bool at_key = false);
  bool has_problems() const { return !problems_.empty(); }
  // "case.toml:3:9" or "--set bed.depth".
  std::string place(const std::string& key, bool at_key = false) const;
  // Throws dem::CaseError with all problems in the order of the file, if there are any.
  void throw_problems() const;

 private:
  struct Place {
    unsigned line = 0, column = 0;  // 0: the file as a whole, or an override
    std::string text;
  };
  Place find_place(std::string key, bool at_key) const;

  struct Problem {
    Place place;
    std::string message;
  };
  std::string path_;
  toml::table table_;
  std::vector<std::string> overridden_;  // dotted keys
  std::vector<Problem> problems_;
};

// One table. Where a value cannot be read, the problem goes to the document and the output keeps its value.
class Section {
 public:
  Section(Document& document, toml::table* table, std::string path);

  explicit operator bool() const { return table_ != nullptr; }
  const std::string& path() const { return path_; }

  // An empty Section where there is no such table.
  Section section(std::string_view key, Need need = Need::required);
  // Every table in it, for tables whose keys are names.
  std::vector<std::pair<std::string, Section>> named_sections();

  bool quantity(std::string_view key, const Dimension& dimension, double& out, Need need = Need::required);
  // A quantity, or one word instead: `is_word` says which.
  bool quantity_or(std::string_view word, bool* is_word, std::string_view key, const Dimension& dimension, double& out,
                   Need need = Need::required);
  bool quantities(std::string_view key, const Dimension& dimension, std::vector<double>& out,
                  Need need = Need::required);
  bool number(std::string_view key, double& out, Need need = Need::required);
  bool numbers(std::string_view key, std::vector<double>& out, Need need = Need::required);
  bool whole_number(std::string_view key, std::uint64_t& out, Need need = Need::required);
  bool truth(std::string_view key, bool& out, Need need = Need::required);
  bool text(std::string_view key, std::string& out, Need need = Need::required);
  bool texts(std::string_view key, std::vector<std::string>& out, Need need = Need::required);
  // One of a few words.
  template <class Value>
  bool choice(std::string_view key, const std::vector<std::pair<std::string, Value>>& choices, Value& out,
              Need need = Need::required);

  // Reports unknown keys, then missing ones (but not those for which an unknown key was probably meant).
  void finish();

 private:
  const toml::node* find(std::string_view key, Need need);
  bool wrong_type(std::string_view key, const std::string& wanted, const toml::node& got);
  int choose(std::string_view key, const std::vector<std::string>& words, Need need);
  std::string dotted(std::string_view key) const;

  Document* document_;
  toml::table* table_;
  std::string path_;
  std::vector<std::string> known_, missing_;
};

template <class Value>
bool Section::choice(std::string_view key, const std::vector<std::pair<std::string, Value>>& choices, Value& out,
                     Need need) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const int chosen = choose(key, words, need);
  if (chosen < 0) return false;
  out = choices[static_cast<std::size_t>(chosen)].second;
  return true;
}

}  // namespace jamscope
