#include "libjam/snapshot/deflated_chunks.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

namespace jam::h5 {
namespace {

constexpr std::size_t largest_chunk = std::size_t{64} << 20;  // bytes; HDF5 allows 4 GiB, jamscope writes some hundred kB

struct Close {
  herr_t (*close)(hid_t);
  hid_t id;
  ~Close() {
    if (id >= 0) close(id);
  }
};

// Shuffle stores the first bytes of all elements, then the second bytes, and so on: of elements whose bytes are rows, the transpose.
enum class Shuffle : bool { back, forth };
template <std::size_t size>
void turn(Shuffle way, const unsigned char* from, std::size_t elements, unsigned char* to) {
  if (way == Shuffle::forth) {
    for (std::size_t byte = 0; byte < size; ++byte)
      for (std::size_t k = 0; k < elements; ++k) to[byte * elements + k] = from[k * size + byte];
  } else {
    for (std::size_t k = 0; k < elements; ++k)
      for (std::size_t byte = 0; byte < size; ++byte) to[k * size + byte] = from[byte * elements + k];
  }
}
void turn(Shuffle way, std::size_t size, const unsigned char* from, std::size_t bytes, unsigned char* to) {
  switch (size) {
    case 4: return turn<4>(way, from, bytes / 4, to);
    case 8: return turn<8>(way, from, bytes / 8, to);
    default: std::memcpy(to, from, bytes);
  }
}

// Bytes of an element where the filters are shuffle then deflate; 0 where they are not.
std::size_t shuffled_size(hid_t plan) {
  if (H5Pget_nfilters(plan) != 2) return 0;
  std::array<unsigned, 8> values{};
  unsigned flags = 0, config = 0;
  std::size_t count = values.size();
  if (H5Pget_filter2(plan, 0, &flags, &count, values.data(), 0, nullptr, &config) != H5Z_FILTER_SHUFFLE || count < 1) return 0;
  const std::size_t size = values[0];
  count = values.size();
  return H5Pget_filter2(plan, 1, &flags, &count, values.data(), 0, nullptr, &config) == H5Z_FILTER_DEFLATE ? size : 0;
}

// A dataset that is stored as this file knows how.
struct PlainChunks {
  std::size_t element = 0;                  // bytes
  std::uint64_t rows = 0, chunk_rows = 0;
  std::size_t row_bytes = 0;
  std::size_t chunk_bytes() const { return std::size_t(chunk_rows) * row_bytes; }
};

std::optional<PlainChunks> plain_chunks(hid_t dataset, hid_t memory) {
  const Close stored{H5Tclose, H5Dget_type(dataset)}, plan{H5Pclose, H5Dget_create_plist(dataset)}, space{H5Sclose, H5Dget_space(dataset)};
  if (stored.id < 0 || plan.id < 0 || space.id < 0 || H5Tequal(stored.id, memory) <= 0 || H5Pget_layout(plan.id) != H5D_CHUNKED) return std::nullopt;
  const std::size_t element = H5Tget_size(stored.id);
  if ((element != 1 && element != 4 && element != 8) || shuffled_size(plan.id) != element) return std::nullopt;
  const int rank = H5Sget_simple_extent_ndims(space.id);
  std::array<hsize_t, 2> shape{1, 1}, chunk{1, 1};
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space.id, shape.data(), nullptr) != rank || H5Pget_chunk(plan.id, rank, chunk.data()) != rank)
    return std::nullopt;
  if (chunk[1] != shape[1] || chunk[0] == 0 || shape[1] == 0 || shape[1] > largest_chunk || chunk[0] > largest_chunk / shape[1] / element) return std::nullopt;
  return PlainChunks{element, shape[0], chunk[0], std::size_t(shape[1]) * element};
}

// RFC 1951, section 3.2.4: blocks stored as they are. The last of them may end the stream.
void store(const unsigned char* from, std::size_t bytes, bool ends, std::vector<unsigned char>& stream) {
  constexpr std::size_t most = 65535;
  for (std::size_t at = 0; at < bytes; at += most) {
    const auto length = std::uint16_t(std::min(most, bytes - at));
    const auto complement = std::uint16_t(~length);
    stream.push_back(ends && at + length == bytes ? 1 : 0);
    for (const std::uint16_t number : {length, complement}) {
      stream.push_back(std::uint8_t(number & 0xFF));
      stream.push_back(std::uint8_t(number >> 8));
    }
    stream.insert(stream.end(), from + at, from + at + length);
  }
}

// What deflate makes of a chunk.
class Packer {
 public:
  Packer() : compress_(libdeflate_alloc_compressor(level), libdeflate_free_compressor) {}
  explicit operator bool() const { return compress_ != nullptr; }

  // A stream as zlib's (RFC 1950), which lives until the next call.
  const std::vector<unsigned char>& pack(const unsigned char* shuffled, std::size_t bytes, std::size_t planes) {
    const std::size_t plane = bytes / planes;
    std::size_t noise = 0;
    while (noise < planes && is_noise(shuffled + noise * plane, plane)) ++noise;
    stream_ = {0x78, 0x01};  // deflate with a window of 32 kB, fast
    const std::size_t stored = noise * plane;
    store(shuffled, stored, noise == planes, stream_);
    if (noise < planes) {
      const std::size_t before = stream_.size(), most = libdeflate_deflate_compress_bound(compress_.get(), bytes - stored);
      stream_.resize(before + most);
      stream_.resize(before + libdeflate_deflate_compress(compress_.get(), shuffled + stored, bytes - stored, stream_.data() + before, most));
    }
    const std::uint32_t check = libdeflate_adler32(1, shuffled, bytes);
    for (int shift = 24; shift >= 0; shift -= 8) stream_.push_back(std::uint8_t(check >> shift));
    return stream_;
  }

 private:
  static constexpr int level = 1;
  static constexpr std::size_t sample = 8192;  // bytes

  // Does coding save less than a tenth of the first of these bytes?
  bool is_noise(const unsigned char* bytes, std::size_t count) {
    std::array<unsigned char, sample> coded;
    count = std::min(count, sample);
    return libdeflate_deflate_compress(compress_.get(), bytes, count, coded.data(), count - count / 10) == 0;
  }

  std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compress_;
  std::vector<unsigned char> stream_;
};

}  // namespace

bool read_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t start, std::uint64_t count, void* rows) {
  const auto plain = plain_chunks(dataset, memory);
  if (!plain) return false;
  const std::uint64_t chunk = plain->chunk_rows;
  const std::size_t row = plain->row_bytes, chunk_bytes = plain->chunk_bytes();
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflate) return false;
  std::vector<unsigned char> packed, shuffled(chunk_bytes), whole;
  auto* const to = static_cast<unsigned char*>(rows);
  for (std::uint64_t first = start / chunk * chunk; first < start + count; first += chunk) {
    const std::array<hsize_t, 2> offset{first, 0};
    hsize_t bytes = 0;
    if (H5Dget_chunk_storage_size(dataset, offset.data(), &bytes) < 0 || bytes == 0 || bytes > 2 * chunk_bytes + 1024) return false;
    packed.resize(std::size_t(bytes));
    std::uint32_t skipped = 0;
    if (H5Dread_chunk(dataset, H5P_DEFAULT, offset.data(), &skipped, packed.data()) < 0 || skipped != 0) return false;
    if (libdeflate_zlib_decompress(inflate.get(), packed.data(), packed.size(), shuffled.data(), chunk_bytes, nullptr) != LIBDEFLATE_SUCCESS) return false;
    const std::uint64_t begin = std::max(first, start), end = std::min(first + chunk, start + count);
    if (begin == first && end == first + chunk) {
      turn(Shuffle::back, plain->element, shuffled.data(), chunk_bytes, to + (begin - start) * row);
      continue;
    }
    whole.resize(chunk_bytes);
    turn(Shuffle::back, plain->element, shuffled.data(), chunk_bytes, whole.data());
    std::memcpy(to + (begin - start) * row, whole.data() + (begin - first) * row, std::size_t(end - begin) * row);
  }
  return true;
}

bool write_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t rows_before, std::uint64_t start, std::uint64_t count, const void* rows) {
  const auto plain = plain_chunks(dataset, memory);
  if (!plain || start % plain->chunk_rows != 0 || start + count > plain->rows) return false;
  if (const bool ends_within_chunk = count % plain->chunk_rows != 0; ends_within_chunk && rows_before > start + count) return false;
  Packer packer;
  if (!packer) return false;
  std::vector<unsigned char> whole(plain->chunk_bytes()), shuffled(plain->chunk_bytes());
  const auto* const from = static_cast<const unsigned char*>(rows);
  for (std::uint64_t done = 0; done < count; done += plain->chunk_rows) {
    const std::size_t bytes = std::size_t(std::min(plain->chunk_rows, count - done)) * plain->row_bytes;
    std::memcpy(whole.data(), from + done * plain->row_bytes, bytes);
    std::fill(whole.begin() + std::ptrdiff_t(bytes), whole.end(), std::uint8_t{0});
    turn(Shuffle::forth, plain->element, whole.data(), whole.size(), shuffled.data());
    const std::vector<unsigned char>& stream = packer.pack(shuffled.data(), shuffled.size(), plain->element);
    const std::array<hsize_t, 2> offset{start + done, 0};
    if (H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset.data(), stream.size(), stream.data()) < 0) return false;
  }
  return true;
}

}  // namespace jam::h5
