// A file that gets its name when it is complete, and numbers as text that lose nothing.
#pragma once
#include <charconv>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace jam {

// Appends a number with the fewest digits that give the same number when they are read: at most 9 for a float, 17 for a
// double. Our own importers, as most programs, read a float as a double and round that, and so round twice: of all 2^31 - 2^23
// finite floats from 0 on (all were tried) one then becomes its neighbour, and gets 9 digits.
template <class Number>
requires std::floating_point<Number> || std::integral<Number>
void append_number(std::string& text, Number value) {
  char buffer[32];
  char* const end = buffer + sizeof buffer;
  if constexpr (std::same_as<Number, float>) {
    constexpr float rounded_twice = 7.038531e-26F;
    if (value == rounded_twice || value == -rounded_twice) {
      text.append(buffer, std::to_chars(buffer, end, double{value}, std::chars_format::general, 9).ptr);
      return;
    }
  }
  text.append(buffer, std::to_chars(buffer, end, value).ptr);
}

// Text with &, <, >, " as XML wants them; control characters, which XML cannot hold, become spaces.
std::string xml_text(std::string_view text);

// Written under "PATH.part" and renamed by finish(); what is not finished is removed. Throws DataError.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // To be appended to; flush_if_large() now and then.
  std::string& text() { return text_; }
  void flush_if_large();
  void write(std::string_view bytes);
  void finish();
  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_, aside_;
  std::ofstream out_;
  std::string text_;
  bool finished_ = false;
};

}  // namespace jam
