#include "libjam/snapshot/hdf5.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "libjam/errors.hpp"

namespace jam::h5 {
namespace {

class Hdf5 : public testing::Test {
 protected:
  Hdf5() {
    folder = std::filesystem::path(testing::TempDir()) /
             (std::string("hdf5_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    path = folder / "a.h5";
  }
  ~Hdf5() override { std::filesystem::remove_all(folder); }
  std::filesystem::path folder, path;
};

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const DataError& e) {
    return e.what();
  }
  return "no error";
}

TEST_F(Hdf5, ArraysOfNumbersArraysAndEigenVectorsComeBackExactly) {
  const std::vector<double> numbers{1.5, -0.0, 1e-300, INFINITY};
  const std::vector<std::uint64_t> large{0, UINT64_MAX};
  const std::vector<std::array<std::uint32_t, 2>> pairs{{1, 2}, {3, UINT32_MAX}};
  const std::vector<Eigen::Vector3f> vectors{{1, 2, 3}, {-4, 5e-30F, 6}};
  const std::vector<std::uint8_t> none;
  File out = File::create(path);
  out.write("/a/b/numbers", numbers, "m", "some numbers");
  out.write("/a/large", large, "1", "");
  out.write("/pairs", pairs, "1", "rows");
  out.write("/vectors", vectors, "N", "forces");
  out.write("/none", none, "1", "empty");
  out.write_matrix("/matrix", std::vector<double>{1, 2, 3, 4, 5, 6}, 3, "J", "");
  out.close();
  const File in = File::open(path);
  EXPECT_EQ(in.read<double>("/a/b/numbers"), numbers);
  EXPECT_TRUE(std::signbit(in.read<double>("/a/b/numbers")[1]));
  EXPECT_EQ(in.read<std::uint64_t>("/a/large"), large);
  EXPECT_EQ((in.read<std::array<std::uint32_t, 2>>("/pairs")), pairs);
  EXPECT_EQ(in.read<Eigen::Vector3f>("/vectors"), vectors);
  EXPECT_EQ(in.read<std::uint8_t>("/none"), none);
  std::uint64_t columns = 0;
  EXPECT_EQ(in.read_matrix<double>("/matrix", columns), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(columns, 3U);
  EXPECT_EQ(in.attribute<std::string>("/a/b/numbers", "unit"), "m");
  EXPECT_EQ(in.attribute<std::string>("/a/b/numbers", "doc"), "some numbers");
  EXPECT_EQ(in.attribute<std::string>("/a/large", "doc"), "");
  EXPECT_THAT(in.children("/"), testing::ElementsAre("a", "matrix", "none", "pairs", "vectors"));
  EXPECT_TRUE(in.exists("/a/b/numbers"));
  EXPECT_FALSE(in.exists("/x/b/numbers"));
  EXPECT_TRUE(in.is_group("/a"));
  EXPECT_FALSE(in.is_group("/pairs"));
  EXPECT_EQ(in.layout("/vectors").shape, (std::vector<std::uint64_t>{2, 3}));
}

TEST_F(Hdf5, TextsAndAttributesComeBackExactly) {
  const std::string toml = "name = \"käse\"\n\n[bed]\ndepth = \"55 mm\"\n";
  const std::vector<std::string> argv{"jamscope", "", "simulate", "é"};
  File out = File::create(path);
  out.write_text("/case/toml", toml, "the case");
  out.write_text("/case/empty", "", "");
  out.write_texts("/case/argv", argv, "the command");
  out.write_texts("/case/nothing", {}, "");
  out.set_attribute("/", "seed", std::uint64_t{18446744073709551615ULL});
  out.set_attribute("/", "gravity", Eigen::Vector3d(0, 0, -9.81));
  out.set_attribute("/", "version", std::array<std::uint32_t, 2>{1, 0});
  out.set_attribute("/case", "name", std::string(100000, 'x'));
  out.set_attribute("/", "seed", std::uint64_t{7});
  out.close();
  const File in = File::open(path);
  EXPECT_EQ(in.read_text("/case/toml"), toml);
  EXPECT_EQ(in.read_text("/case/empty"), "");
  EXPECT_EQ(in.read_texts("/case/argv"), argv);
  EXPECT_TRUE(in.read_texts("/case/nothing").empty());
  EXPECT_EQ(in.attribute<std::uint64_t>("/", "seed"), 7U);
  EXPECT_EQ(in.attribute<Eigen::Vector3d>("/", "gravity"), Eigen::Vector3d(0, 0, -9.81));
  EXPECT_EQ((in.attribute<std::array<std::uint32_t, 2>>("/", "version")), (std::array<std::uint32_t, 2>{1, 0}));
  EXPECT_EQ(in.attribute<std::string>("/case", "name").size(), 100000U);
  EXPECT_THAT(in.attributes("/"), testing::ElementsAre("gravity", "seed", "version"));
}

TEST_F(Hdf5, ColumnsGrowWhileTheFileIsReadable) {
  {
    File file = File::create(path);
    file.make_column<Eigen::Vector3f>("/position", 4, true, "m", "centres");
    file.make_column<std::uint64_t>("/step", 8, false, "1", "steps");
    file.close();
  }
  for (std::uint64_t k = 0; k < 5; ++k) {
    File file = File::open_append(path);
    file.write_rows("/position", 4 * k, std::vector<Eigen::Vector3f>(3, Eigen::Vector3f::Constant(float(k))));
    file.append("/step", std::vector<std::uint64_t>{k});
    file.close();
    const File in = File::open(path);
    EXPECT_EQ(in.layout("/position").rows(), 4 * k + 3);
    EXPECT_EQ(in.read_rows<Eigen::Vector3f>("/position", 4 * k, 3)[2], Eigen::Vector3f::Constant(float(k)));
    EXPECT_EQ(in.read<std::uint64_t>("/step").back(), k);
    EXPECT_EQ(in.chunk_rows("/position"), 4U);
  }
}

TEST_F(Hdf5, ErrorsNameFilePlaceAndWhatWasExpected) {
  using testing::HasSubstr;
  {
    File out = File::create(path);
    out.write("/forces", std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::Zero()), "N", "");
    out.write("/wide", std::vector<std::uint64_t>{1}, "1", "");
    out.close();
  }
  const File in = File::open(path);
  EXPECT_EQ(error_of([&] { in.read<double>("/absent"); }), path.string() + ":/absent: missing");
  EXPECT_THAT(error_of([&] { in.read<double>("/forces"); }), HasSubstr("/forces: has 3 components"));
  EXPECT_THAT(error_of([&] { in.read<std::uint32_t>("/wide"); }), HasSubstr("type u8, expected u4"));
  EXPECT_THAT(error_of([&] { in.read<std::int64_t>("/wide"); }), HasSubstr("type u8, expected i8"));
  EXPECT_THAT(error_of([&] { in.read_rows<Eigen::Vector3d>("/forces", 2, 3); }), HasSubstr("has 4 rows"));
  EXPECT_THAT(error_of([&] { in.read_rows<Eigen::Vector3d>("/forces", UINT64_MAX, 2); }), HasSubstr("has 4 rows"));
  EXPECT_THAT(error_of([&] { in.read_text("/forces"); }), HasSubstr("is not a text"));
  EXPECT_THAT(error_of([&] { in.attribute<double>("/", "dt"); }), HasSubstr("/@dt: missing attribute"));
  EXPECT_THAT(error_of([&] { in.attribute<double>("/forces", "unit"); }), HasSubstr("type text, expected f8"));
  EXPECT_THAT(error_of([&] { in.children("/forces"); }), HasSubstr("no such group"));
  EXPECT_THAT(error_of([&] { File::open(folder / "none.h5"); }), HasSubstr("none.h5: no such file"));
  EXPECT_THAT(error_of([&] { File::open(folder); }), HasSubstr("is not a file"));
  EXPECT_THAT(error_of([&] { File::create(folder / "no" / "such" / "folder.h5"); }),
              HasSubstr("No such file or directory"));
  std::ofstream(folder / "text.h5") << "not a table\n";
  EXPECT_THAT(error_of([&] { File::open(folder / "text.h5"); }), HasSubstr("is not an HDF5 file"));
}

TEST_F(Hdf5, FloatsMayBeReadInEitherPrecisionAndIntegersInAWiderType) {
  {
    File out = File::create(path);
    out.write("/f", std::vector<double>{0.1}, "1", "");
    out.write("/u", std::vector<std::uint8_t>{200}, "1", "");
    out.close();
  }
  const File in = File::open(path);
  EXPECT_EQ(in.read<float>("/f")[0], 0.1F);
  EXPECT_EQ(in.read<std::uint32_t>("/u")[0], 200U);
}

TEST_F(Hdf5, ASizeThatTheFileCannotHoldIsRefusedBeforeAllocation) {
  {
    // 2^40 rows are claimed, one chunk is stored.
    File out = File::create(path);
    out.make_column<double>("/huge", 1 << 20, true, "1", "");
    out.write_rows("/huge", (std::uint64_t{1} << 40) - 1, std::vector<double>{1});
    out.close();
  }
  const File in = File::open(path);
  EXPECT_EQ(in.layout("/huge").rows(), std::uint64_t{1} << 40);
  EXPECT_THAT(error_of([&] { in.read<double>("/huge"); }), testing::HasSubstr("claims 1099511627776 rows"));
  EXPECT_EQ(in.read_rows<double>("/huge", (std::uint64_t{1} << 40) - 1, 1)[0], 1);
}

TEST_F(Hdf5, AFlippedBitInAnArrayIsFound) {
  std::vector<double> values(4096);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(double(i));
  {
    File out = File::create(path);
    out.write("/values", values, "1", "");
    out.close();
  }
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(std::streamoff(size / 2));
    const int byte = file.get();
    file.seekp(std::streamoff(size / 2));
    file.put(static_cast<char>(byte ^ 1));
  }
  EXPECT_THAT(error_of([&] { File::open(path).read<double>("/values"); }), testing::HasSubstr("/values: cannot read"));
}

TEST_F(Hdf5, AFileIsReplacedOnlyWhenTheNewOneIsComplete) {
  write_aside(path, [](File& file) { file.write("/a", std::vector<double>{1}, "1", ""); });
  EXPECT_THROW(write_aside(path,
                           [](File& file) {
                             file.write("/a", std::vector<double>{2}, "1", "");
                             throw DataError("stop");
                           }),
               DataError);
  EXPECT_EQ(File::open(path).read<double>("/a")[0], 1);
  EXPECT_FALSE(std::filesystem::exists(aside_of(path)));
}

}  // namespace
}  // namespace jam::h5
