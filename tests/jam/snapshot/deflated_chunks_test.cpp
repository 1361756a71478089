// Rows that libdeflate unpacks are those that HDF5 reads.
#include "libjam/snapshot/deflated_chunks.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace jam::h5 {
namespace {

class DeflatedChunks : public ::testing::Test {
 protected:
  DeflatedChunks() : path_(std::filesystem::path(testing::TempDir()) / ("deflated_" + std::to_string(getpid()) + ".h5")) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // quiet, as File is
    file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  }
  ~DeflatedChunks() override {
    if (dataset_ >= 0) H5Dclose(dataset_);
    H5Fclose(file_);
    std::filesystem::remove(path_);
  }

  enum Filters { shuffle_and_deflate, deflate_only, none };
  // `rows` rows of `width` random numbers in chunks of `chunk` rows; the last `missing` chunks are never written.
  template <class T>
  std::vector<T> store(hid_t type, hsize_t rows, hsize_t width, hsize_t chunk, Filters filters = shuffle_and_deflate, hsize_t missing = 0) {
    if (dataset_ >= 0) H5Dclose(dataset_);
    const hsize_t shape[] = {rows, width}, chunks[] = {chunk, width};
    const int rank = width > 1 ? 2 : 1;
    const hid_t space = H5Screate_simple(rank, shape, nullptr), plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(plan, rank, chunks);
    if (filters == shuffle_and_deflate) H5Pset_shuffle(plan);
    if (filters != none) H5Pset_deflate(plan, 1);
    std::string name = "array";
    name += std::to_string(count_++);
    dataset_ = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    std::mt19937_64 random(count_);
    std::vector<T> values(rows * width);
    for (T& value : values) value = T(random() % 1000);
    const hsize_t written = rows - std::min(rows, missing * chunk), from[] = {0, 0}, count[] = {written, width};
    const hid_t part = H5Dget_space(dataset_), memory = H5Screate_simple(rank, count, nullptr);
    H5Sselect_hyperslab(part, H5S_SELECT_SET, from, nullptr, count, nullptr);
    H5Dwrite(dataset_, type, memory, part, H5P_DEFAULT, values.data());
    for (const hid_t id : {memory, part, space}) H5Sclose(id);
    H5Pclose(plan);
    H5Fflush(file_, H5F_SCOPE_LOCAL);
    return values;
  }

  std::filesystem::path path_;
  hid_t file_ = -1, dataset_ = -1;
  unsigned count_ = 0;
};

template <class T>
void expect_rows(hid_t dataset, hid_t type, const std::vector<T>& values, std::uint64_t rows, std::uint64_t width) {
  for (std::uint64_t start = 0; start < rows; ++start)
    for (std::uint64_t count = 1; start + count <= rows; ++count) {
      std::vector<T> read(count * width);
      ASSERT_TRUE(read_deflated_rows(dataset, type, start, count, read.data())) << sizeof(T) << " bytes, rows from " << start << ", " << count;
      ASSERT_EQ(std::memcmp(read.data(), values.data() + start * width, read.size() * sizeof(T)), 0) << start << " " << count;
    }
}

TEST_F(DeflatedChunks, AnyRowsOfAnyPlainArrayAreRead) {
  const auto floats = store<float>(H5T_NATIVE_FLOAT, 23, 3, 5);
  expect_rows(dataset_, H5T_NATIVE_FLOAT, floats, 23, 3);
  const auto doubles = store<double>(H5T_NATIVE_DOUBLE, 17, 1, 4);
  expect_rows(dataset_, H5T_NATIVE_DOUBLE, doubles, 17, 1);
  const auto bytes = store<std::uint8_t>(H5T_NATIVE_UINT8, 12, 1, 4);
  expect_rows(dataset_, H5T_NATIVE_UINT8, bytes, 12, 1);
  const auto rows = store<std::uint32_t>(H5T_NATIVE_UINT32, 9, 2, 9);
  expect_rows(dataset_, H5T_NATIVE_UINT32, rows, 9, 2);
}

TEST_F(DeflatedChunks, WhatIsNotPlainIsLeftToHdf5) {
  std::vector<double> to(64);
  store<float>(H5T_NATIVE_FLOAT, 8, 1, 4);
  EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_DOUBLE, 0, 8, to.data()));  // to be converted
  store<float>(H5T_NATIVE_FLOAT, 8, 1, 4, deflate_only);
  EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 8, to.data()));
  store<float>(H5T_NATIVE_FLOAT, 8, 1, 4, none);
  EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 8, to.data()));
  store<std::int16_t>(H5T_NATIVE_INT16, 8, 1, 4);
  EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_INT16, 0, 8, to.data()));  // no array of ours has such elements
  store<float>(H5T_NATIVE_FLOAT, 8, 1, 4, shuffle_and_deflate, 1);
  EXPECT_TRUE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 4, to.data()));
  EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 8, to.data()));  // the second chunk was never written
}

// Bytes of a chunk turned over one after the other: read_deflated_rows gives up or, where deflate's checksum lets it pass, gives the same.
TEST_F(DeflatedChunks, DamageIsLeftToHdf5) {
  const auto values = store<float>(H5T_NATIVE_FLOAT, 40, 1, 40);
  haddr_t address = 0;
  hsize_t size = 0, offset = 0;
  unsigned mask = 0;
  ASSERT_GE(H5Dget_chunk_info_by_coord(dataset_, &offset, &mask, &address, &size), 0);
  std::vector<char> good(size), bad;
  ASSERT_GE(H5Dread_chunk(dataset_, H5P_DEFAULT, &offset, &mask, good.data()), 0);
  std::size_t given_up = 0;
  for (std::size_t k = 0; k < good.size(); ++k) {
    bad = good;
    bad[k] = char(~bad[k]);
    ASSERT_GE(H5Dwrite_chunk(dataset_, H5P_DEFAULT, 0, &offset, bad.size(), bad.data()), 0);
    std::vector<float> read(40);
    if (!read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 40, read.data()))
      ++given_up;
    else
      EXPECT_EQ(read, values) << k;
  }
  EXPECT_GT(given_up, good.size() / 2);
  for (const std::size_t length : {std::size_t{1}, good.size() / 2, good.size() - 1}) {
    ASSERT_GE(H5Dwrite_chunk(dataset_, H5P_DEFAULT, 0, &offset, length, good.data()), 0);
    std::vector<float> read(40);
    EXPECT_FALSE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 40, read.data())) << length;
  }
}

}  // namespace
// Numbers whose low bytes are noise, numbers that code well, and such that do so by their order alone.
template <class T>
std::vector<T> numbers(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<T> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    if constexpr (std::is_floating_point_v<T>)
      values[k] = T(std::normal_distribution<double>()(random));
    else
      values[k] = seed % 2 == 0 ? T(k) : T(random() % 7);
  }
  return values;
}

TEST_F(DeflatedChunks, Hdf5ReadsWhatIsWritten) {
  const auto check = [&]<class T>(hid_t type, hsize_t rows, hsize_t width, hsize_t chunk, const std::vector<T>& values) {
    store<T>(type, rows, width, chunk, shuffle_and_deflate, rows);
    ASSERT_TRUE(write_deflated_rows(dataset_, type, 0, 0, rows, values.data()));
    std::vector<T> read(values.size());
    ASSERT_GE(H5Dread(dataset_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0) << rows << " rows, chunks of " << chunk;
    EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(T)), 0) << rows << " rows, chunks of " << chunk;
    ASSERT_TRUE(read_deflated_rows(dataset_, type, 0, rows, read.data()));
    EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(T)), 0);
  };
  for (const hsize_t rows : {5, 6, 20, 23})
    for (const hsize_t width : {1, 3}) check(H5T_NATIVE_FLOAT, rows, width, 5, numbers<float>(rows * width, 1));
  // Chunks of more than one stored block (65535 bytes) and more than the sample that noise is told by.
  check(H5T_NATIVE_FLOAT, 70000, 3, 33342, numbers<float>(210000, 2));
  check(H5T_NATIVE_DOUBLE, 40000, 1, 16384, numbers<double>(40000, 3));
  check(H5T_NATIVE_UINT32, 40000, 2, 16384, numbers<std::uint32_t>(80000, 4));
  check(H5T_NATIVE_UINT64, 40000, 1, 16384, numbers<std::uint64_t>(40000, 5));
  check(H5T_NATIVE_UINT8, 40000, 1, 16384, numbers<std::uint8_t>(40000, 7));
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> noise(20000);
  for (std::uint64_t& value : noise) value = random();
  check(H5T_NATIVE_UINT64, 20000, 1, 16384, noise);
}

// Three of a float's four bytes are noise and stored; of the last, its sign and most of its exponent, less than half a byte is left.
TEST_F(DeflatedChunks, NoiseIsStoredAndTheRestIsCoded) {
  constexpr hsize_t rows = 65536;
  const auto stored = [&]<class T>(hid_t type, const std::vector<T>& values) {
    store<T>(type, rows, 1, rows, shuffle_and_deflate, rows);
    EXPECT_TRUE(write_deflated_rows(dataset_, type, 0, 0, rows, values.data()));
    return double(H5Dget_storage_size(dataset_)) / double(rows);
  };
  const double bytes = stored(H5T_NATIVE_FLOAT, numbers<float>(rows, 1));
  EXPECT_GT(bytes, 3.0);
  EXPECT_LT(bytes, 3.5);
  EXPECT_LT(stored(H5T_NATIVE_UINT32, numbers<std::uint32_t>(rows, 2)), 0.1);  // 0, 1, 2, ...
}

TEST_F(DeflatedChunks, RowsThatAreThereAreNotOverwritten) {
  const std::vector<float> before = store<float>(H5T_NATIVE_FLOAT, 12, 1, 5), more = numbers<float>(12, 1);
  EXPECT_FALSE(write_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 12, 3, 9, more.data()));  // starts within a chunk
  EXPECT_FALSE(write_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 12, 5, 4, more.data()));  // a row behind it in its chunk
  EXPECT_FALSE(write_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 12, 10, 5, more.data()));  // no room
  EXPECT_FALSE(write_deflated_rows(dataset_, H5T_NATIVE_DOUBLE, 12, 5, 5, more.data()));  // to be converted
  std::vector<float> read(12);
  ASSERT_TRUE(read_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 0, 12, read.data()));
  EXPECT_EQ(read, before);
  ASSERT_TRUE(write_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 12, 5, 5, more.data()));
  ASSERT_TRUE(write_deflated_rows(dataset_, H5T_NATIVE_FLOAT, 12, 10, 2, more.data() + 5));  // the last of all
  ASSERT_GE(H5Dread(dataset_, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(read[k], k < 5 ? before[k] : more[k - 5]) << k;
}

}  // namespace jam::h5
