#include "libjam/snapshot/export/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "libjam/errors.hpp"

namespace jam {
namespace {

constexpr std::size_t large = std::size_t{1} << 20;

}  // namespace

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)), aside_(path_) {
  aside_ += ".part";
  out_.open(aside_, std::ios::binary | std::ios::trunc);
  if (!out_) fail();
}

OutputFile::~OutputFile() {
  if (finished_) return;
  out_.close();
  std::error_code ignored;
  std::filesystem::remove(aside_, ignored);
}

void OutputFile::fail() const { throw DataError(path_.string() + ": cannot be written: " + std::strerror(errno)); }

void OutputFile::flush_if_large() {
  if (text_.size() >= large) write({});
}

void OutputFile::write(std::string_view bytes) {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out_) fail();
}

void OutputFile::finish() {
  write({});
  out_.close();
  if (!out_) fail();
  std::error_code error;
  std::filesystem::rename(aside_, path_, error);
  if (error) throw DataError(path_.string() + ": cannot put the new file in place: " + error.message());
  finished_ = true;
}

}  // namespace jam
