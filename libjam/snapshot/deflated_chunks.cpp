#include "libjam/snapshot/deflated_chunks.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
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

// Shuffle stores the first bytes of all elements, then the second bytes, and so on.
template <std::size_t size>
void unshuffle(const unsigned char* from, std::size_t elements, unsigned char* to) {
  for (std::size_t k = 0; k < elements; ++k)
    for (std::size_t byte = 0; byte < size; ++byte) to[k * size + byte] = from[byte * elements + k];
}
bool unshuffle(std::size_t size, const unsigned char* from, std::size_t bytes, unsigned char* to) {
  switch (size) {
    case 1: std::memcpy(to, from, bytes); return true;
    case 4: unshuffle<4>(from, bytes / 4, to); return true;
    case 8: unshuffle<8>(from, bytes / 8, to); return true;
    default: return false;
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

}  // namespace

bool read_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t start, std::uint64_t count, void* rows) {
  const Close stored{H5Tclose, H5Dget_type(dataset)}, plan{H5Pclose, H5Dget_create_plist(dataset)}, space{H5Sclose, H5Dget_space(dataset)};
  if (stored.id < 0 || plan.id < 0 || space.id < 0 || H5Tequal(stored.id, memory) <= 0 || H5Pget_layout(plan.id) != H5D_CHUNKED) return false;
  const std::size_t element = H5Tget_size(stored.id);
  if (element == 0 || shuffled_size(plan.id) != element) return false;
  const int rank = H5Sget_simple_extent_ndims(space.id);
  std::array<hsize_t, 2> shape{1, 1}, chunk{1, 1};
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space.id, shape.data(), nullptr) != rank || H5Pget_chunk(plan.id, rank, chunk.data()) != rank) return false;
  if (chunk[1] != shape[1] || chunk[0] == 0 || shape[1] == 0 || shape[1] > largest_chunk || chunk[0] > largest_chunk / shape[1] / element) return false;
  const std::size_t row = std::size_t(shape[1]) * element, chunk_bytes = std::size_t(chunk[0]) * row;

  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflate) return false;
  std::vector<unsigned char> packed, shuffled(chunk_bytes), whole;
  auto* const to = static_cast<unsigned char*>(rows);
  for (std::uint64_t first = start / chunk[0] * chunk[0]; first < start + count; first += chunk[0]) {
    const std::array<hsize_t, 2> offset{first, 0};
    hsize_t bytes = 0;
    if (H5Dget_chunk_storage_size(dataset, offset.data(), &bytes) < 0 || bytes == 0 || bytes > 2 * chunk_bytes + 1024) return false;
    packed.resize(std::size_t(bytes));
    std::uint32_t skipped = 0;
    if (H5Dread_chunk(dataset, H5P_DEFAULT, offset.data(), &skipped, packed.data()) < 0 || skipped != 0) return false;
    if (libdeflate_zlib_decompress(inflate.get(), packed.data(), packed.size(), shuffled.data(), chunk_bytes, nullptr) != LIBDEFLATE_SUCCESS) return false;
    const std::uint64_t begin = std::max(first, start), end = std::min<std::uint64_t>(first + chunk[0], start + count);
    if (begin == first && end == first + chunk[0]) {
      if (!unshuffle(element, shuffled.data(), chunk_bytes, to + (begin - start) * row)) return false;
      continue;
    }
    whole.resize(chunk_bytes);
    if (!unshuffle(element, shuffled.data(), chunk_bytes, whole.data())) return false;
    std::memcpy(to + (begin - start) * row, whole.data() + (begin - first) * row, std::size_t(end - begin) * row);
  }
  return true;
}

}  // namespace jam::h5
