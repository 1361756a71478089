#include "libjam/snapshot/formats/text_input.hpp"

#include <algorithm>
#include <boost/iostreams/device/file.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "libjam/errors.hpp"

namespace jam {
namespace {

namespace io = boost::iostreams;

constexpr std::size_t block = std::size_t{1} << 16;
constexpr std::size_t longest_line = std::size_t{1} << 20;

bool starts_with(const std::string& bytes, std::string_view magic) {
  return std::string_view(bytes).substr(0, magic.size()) == magic;
}

std::string first_bytes(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw DataError(path + ": is a folder, expected a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw DataError(path + ": cannot be opened: " + std::strerror(errno));
  std::string bytes(16, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  if (bytes.empty()) throw DataError(path + ": the file is empty, expected text");
  return bytes;
}

// Compressions that we know by their first bytes but do not read.
const char* foreign_compression(const std::string& bytes) {
  using namespace std::string_view_literals;
  if (starts_with(bytes, "BZh"sv)) return "bzip2";
  if (starts_with(bytes, "\x28\xb5\x2f\xfd"sv)) return "zstd";
  if (starts_with(bytes, "PK\x03\x04"sv)) return "zip";
  if (starts_with(bytes, "7z\xbc\xaf\x27\x1c"sv)) return "7z";
  if (starts_with(bytes, "\x04\x22\x4d\x18"sv)) return "lz4";
  return nullptr;
}

}  // namespace

LineReader::LineReader(std::string path) : path_(std::move(path)) {
  using namespace std::string_view_literals;
  const std::string bytes = first_bytes(path_);
  if (const char* name = foreign_compression(bytes)) {
    throw DataError(path_ + ": is compressed with " + name + ", expected plain text, gzip or xz");
  }
  auto stream = std::make_unique<io::filtering_streambuf<io::input>>();
  if (starts_with(bytes, "\x1f\x8b"sv)) {
    compression_ = "gzip";
    stream->push(io::gzip_decompressor(), static_cast<std::streamsize>(block));
  } else if (starts_with(bytes, "\xfd\x37zXZ\0"sv)) {
    compression_ = "xz";
    stream->push(io::lzma_decompressor(), static_cast<std::streamsize>(block));
  }
  stream->push(io::file_source(path_, std::ios::binary), static_cast<std::streamsize>(block));
  stream_ = std::move(stream);
}

bool LineReader::refill() {
  if (at_end_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ > longest_line) {
    ++line_number_;
    fail("line is longer than 1 MiB, expected lines of numbers");
  }
  if (buffer_.size() < end_ + block) buffer_.resize(end_ + block);
  std::streamsize got = 0;
  try {
    got = stream_->sgetn(buffer_.data() + end_, static_cast<std::streamsize>(block));
  } catch (const std::exception&) {  // the filters' own messages say no more than "iostream error"
    ++line_number_;
    fail("damaged or cut " + (compression_.empty() ? std::string("file") : compression_ + " stream"));
  }
  if (got <= 0) {
    at_end_ = true;
    return false;
  }
  if (std::memchr(buffer_.data() + end_, '\0', static_cast<std::size_t>(got)) != nullptr) {
    throw DataError(path_ + ": holds NUL bytes, expected text (plain, gzip or xz)");
  }
  end_ += static_cast<std::size_t>(got);
  return true;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* start = buffer_.data() + begin_;
    const std::size_t size = end_ - begin_;
    const void* newline = size > searched ? std::memchr(start + searched, '\n', size - searched) : nullptr;
    std::size_t length = size;
    if (newline != nullptr) {
      length = static_cast<std::size_t>(static_cast<const char*>(newline) - start);
      begin_ += length + 1;
    } else if (refill()) {
      searched = size;
      continue;
    } else if (size == 0) {
      return false;
    } else {
      start = buffer_.data() + begin_;  // the last line has no end of line
      begin_ = end_;
    }
    line = std::string_view(start, length);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line_number_++ == 0 && line.substr(0, 3) == "\xef\xbb\xbf") line.remove_prefix(3);
    return true;
  }
}

void LineReader::fail(const std::string& problem) const {
  throw DataError(path_ + ":" + std::to_string(line_number_) + ": " + problem);
}

bool is_hdf5(const InputHead& head) {
  return starts_with(head.bytes, "\x89HDF\r\n\x1a\n");
}

InputHead read_head(const std::string& path) {
  InputHead head{path, first_bytes(path), {}};
  if (is_hdf5(head)) return head;
  LineReader reader(path);
  std::string_view line;
  while (head.lines.size() < 32 && reader.next(line)) head.lines.emplace_back(line);
  return head;
}

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t i = 0;
  const auto blank = [&](std::size_t k) { return line[k] == ' ' || line[k] == '\t'; };
  while (i < line.size()) {
    while (i < line.size() && blank(i)) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !blank(i)) ++i;
    if (i > begin) fields.push_back(line.substr(begin, i - begin));
  }
}

void split_csv(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    std::string_view field = line.substr(begin, comma - begin);
    while (!field.empty() && (field.front() == ' ' || field.front() == '\t')) field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\t')) field.remove_suffix(1);
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    if (comma == line.size()) return;
    begin = comma + 1;
  }
}

bool parse_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);  // from_chars takes no plus sign
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return false;
  if (error == std::errc::result_out_of_range) {
    // Denormal and smaller numbers are zero to us; larger ones than a double holds are refused.
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent == std::string_view::npos || exponent + 1 >= text.size() || text[exponent + 1] != '-') return false;
    value = 0;
    return true;
  }
  return error == std::errc() && std::abs(value) < 1e30;
}

std::string join_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == 48) return text + ", ... (" + std::to_string(names.size()) + " in all)";
    text += (i > 0 ? ", " : "") + names[i];
  }
  return text;
}

}  // namespace jam
