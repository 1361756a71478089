// Lines of a text file that may be plain, gzip or xz, without ever holding more than one block of it in memory.
#pragma once
#include <cstddef>
#include <memory>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace jam {

// The compression is told from the first bytes, not from the file's name. Concatenated gzip members and xz streams are
// read as one text; a byte order mark at the start and carriage returns at line ends are dropped.
class LineReader {
 public:
  // Throws DataError where the file cannot be opened, is empty, or is compressed in another way.
  explicit LineReader(std::string path);
  // The next line, valid until the next call; false at the end of the text. Throws DataError for a damaged or cut
  // stream, a NUL byte (not text) and a line longer than 1 MiB.
  bool next(std::string_view& line);
  std::size_t line_number() const { return line_number_; }  // of the line returned last, from 1
  const std::string& path() const { return path_; }
  // Throws DataError "PATH:LINE: problem".
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  bool refill();

  std::string path_;
  std::string compression_;  // for messages
  std::unique_ptr<std::streambuf> stream_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // unread part of buffer_
  std::size_t line_number_ = 0;
  bool at_end_ = false;
};

// The first bytes as stored, and the first lines of the text: enough to tell which format a file has.
// Files in a binary format that is no compression (HDF5) have no lines.
struct InputHead {
  std::string path;
  std::string bytes;               // at most 16
  std::vector<std::string> lines;  // at most 32
};
InputHead read_head(const std::string& path);
bool is_hdf5(const InputHead& head);

// Splits at blanks and tabs.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);
// Splits at commas; blanks around a field and quotes around it are dropped.
void split_csv(std::string_view line, std::vector<std::string_view>& fields);

// A finite number of moderate size (|value| < 1e30, so that it fits the snapshot's float32 and its squares fit double).
// False where `text` is anything else.
bool parse_number(std::string_view text, double& value);

// Names separated by ", ", for messages; long lists are cut.
std::string join_names(const std::vector<std::string>& names);

}  // namespace jam
