#include "libdem/geometry/stl.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "libdem/errors.hpp"
#include "libdem/geometry/twisted_blade.hpp"
#include "libdem/geometry/validate_mesh.hpp"
#include "tests/dem/geometry/test_meshes.hpp"

namespace dem {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Stl : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("stl_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& bytes) const {
    const std::string path = folder_ / "mesh.stl";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string message(const std::string& bytes, double scale = 1) const {
    try {
      read_stl(file(bytes), scale);
    } catch (const GeometryError& e) {
      return e.what();
    }
    return "accepted";
  }
  std::filesystem::path folder_;
};

std::string ascii(const TriangleMesh& mesh, const std::string& name = "body") {
  std::ostringstream s;
  s.precision(9);
  s << "solid " << name << "\n";
  for (const auto& t : mesh.triangles) {
    s << "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t v : t)
      s << "      vertex " << mesh.vertices[v].x() << ' ' << mesh.vertices[v].y() << ' ' << mesh.vertices[v].z()
        << '\n';
    s << "    endloop\n  endfacet\n";
  }
  s << "endsolid " << name << "\n";
  return s.str();
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string replace_first(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST_F(Stl, AnAsciiFileGivesTheClosedMeshItWasMadeFrom) {
  const TriangleMesh box = test::box(2, 3, 4);
  for (const std::string& text : {ascii(box), replace_first(ascii(box), "solid body", "solid"),
                                  replace_first(ascii(box), "facet normal 0 0 0", "FACET NORMAL nan nan nan")}) {
    const StlMesh stl = read_stl(file(text), 1e-3);
    EXPECT_FALSE(stl.binary);
    EXPECT_EQ(stl.facets, 12U);
    EXPECT_EQ(stl.degenerate_triangles, 0U);
    EXPECT_EQ(stl.mesh.vertices.size(), 8U);
    EXPECT_EQ(stl.mesh.labels, std::vector<FacetLabel>(12, FacetLabel::face));
    EXPECT_NO_THROW(validate_mesh(stl.mesh, "box"));
    for (const Vec3& p : stl.mesh.vertices) EXPECT_NEAR((p.cwiseAbs() - Vec3(1e-3, 1.5e-3, 2e-3)).norm(), 0, 1e-18);
  }
}

TEST_F(Stl, ABinaryFileGivesBackWhatWasWrittenToTheLast32BitDigit) {
  TwistedBlade shape;
  shape.diameter = 23.5e-3;
  shape.shaft_diameter = 0;
  const TriangleMesh blade = make_twisted_blade(shape);
  const std::string path = folder_ / "blade.stl";
  write_stl(blade, path);
  EXPECT_EQ(std::filesystem::file_size(path), 84 + 50 * blade.triangles.size());
  const StlMesh stl = read_stl(path);
  EXPECT_TRUE(stl.binary);
  EXPECT_EQ(stl.mesh.vertices.size(), blade.vertices.size());
  EXPECT_EQ(stl.mesh.triangles.size(), blade.triangles.size());
  EXPECT_NO_THROW(validate_mesh(stl.mesh, "blade"));
  for (std::size_t t = 0; t < blade.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR((stl.mesh.vertices[stl.mesh.triangles[t][k]] - blade.vertices[blade.triangles[t][k]]).norm(), 0,
                  12e-3 * 1.2e-7);
}

TEST_F(Stl, ABinaryFileWhoseHeaderBeginsWithSolidIsStillBinary) {
  const std::string path = folder_ / "box.stl";
  write_stl(test::box(1, 1, 1), path);
  std::string bytes = bytes_of(path);
  bytes.replace(0, 20, "solid made by a tool");
  const StlMesh stl = read_stl(file(bytes));
  EXPECT_TRUE(stl.binary);
  EXPECT_EQ(stl.facets, 12U);
}

TEST_F(Stl, SeveralSolidsBecomeOneMesh) {
  TriangleMesh other = test::box(1, 1, 1);
  for (Vec3& p : other.vertices) p.x() += 3;
  const StlMesh stl = read_stl(file(ascii(test::box(1, 1, 1), "one") + "\n" + ascii(other, "the other facet")));
  EXPECT_EQ(stl.facets, 24U);
  EXPECT_EQ(stl.mesh.vertices.size(), 16U);
  EXPECT_NO_THROW(validate_mesh(stl.mesh, "two boxes"));
}

TEST_F(Stl, DegenerateAndRepeatedFacetsAreDroppedAndCounted) {
  TriangleMesh box = test::box(1, 1, 1);
  box.triangles.push_back({0, 1, 1});
  box.triangles.push_back({4, 4, 4});
  box.triangles.push_back(box.triangles[3]);
  const StlMesh stl = read_stl(file(ascii(box)));
  EXPECT_EQ(stl.facets, 15U);
  EXPECT_EQ(stl.degenerate_triangles, 2U);
  EXPECT_EQ(stl.repeated_triangles, 1U);
  EXPECT_NO_THROW(validate_mesh(stl.mesh, "box"));
}

TEST_F(Stl, VerticesThatDifferByRoundingAreMerged) {
  std::string text = ascii(test::box(2, 2, 2));
  for (int k = 0; k < 5; ++k) text = replace_first(text, "vertex 1 1 1", "vertex 0.99999999 1.00000001 1");
  const StlMesh stl = read_stl(file(text));
  EXPECT_EQ(stl.mesh.vertices.size(), 8U);
  EXPECT_NO_THROW(validate_mesh(stl.mesh, "box"));
}

TEST_F(Stl, BrokenAsciiFilesNameTheLine) {
  const std::string good = ascii(test::box(1, 1, 1));
  EXPECT_THAT(message(replace_first(good, "vertex 0.5 0.5", "vertex nan 0.5")),
              AllOf(HasSubstr("mesh.stl"), HasSubstr("line 6"), HasSubstr("nan"), HasSubstr("expected finite")));
  EXPECT_THAT(message(replace_first(good, "vertex -0.5 -0.5", "vertex 1e9 -0.5")),
              AllOf(HasSubstr("line 4"), HasSubstr("1000 m")));
  EXPECT_THAT(message(replace_first(good, "vertex -0.5 -0.5", "vertex x -0.5")),
              HasSubstr("line 4: 'x'; expected a number"));
  EXPECT_THAT(message(replace_first(good, "vertex -0.5 -0.5", "vertex 1,5 -0.5")),
              HasSubstr("'1,5'; expected a number"));
  EXPECT_THAT(message(replace_first(good, "endloop", "endlop")), HasSubstr("line 7: 'endlop'; expected endloop"));
  EXPECT_THAT(message(good.substr(0, good.size() / 2)), HasSubstr("expected"));
  EXPECT_THAT(message(good.substr(0, good.rfind("endsolid"))), HasSubstr("the file ends; expected facet or endsolid"));
  EXPECT_THAT(message(good + "rubbish"), HasSubstr("'rubbish'; expected solid"));
  EXPECT_THAT(message("solid nothing\nendsolid nothing\n"), HasSubstr("no facets; expected at least 4"));
  EXPECT_THAT(message("solid"), HasSubstr("the file ends"));
}

TEST_F(Stl, BrokenBinaryFilesNameTheFacetOrTheSize) {
  const std::string path = folder_ / "box.stl";
  write_stl(test::box(1, 1, 1), path);
  const std::string good = bytes_of(path);
  EXPECT_THAT(message(good.substr(0, good.size() - 10)), AllOf(HasSubstr("684"), HasSubstr("674")));
  EXPECT_THAT(message(good + "more"), HasSubstr("688"));
  EXPECT_THAT(message(good.substr(0, 50)), HasSubstr("50 bytes"));
  EXPECT_THAT(message(""), HasSubstr("0 bytes"));
  std::string nan = good;
  const float value = std::nanf("");
  std::memcpy(nan.data() + 84 + 3 * 50 + 12, &value, 4);
  EXPECT_THAT(message(nan), AllOf(HasSubstr("facet 3"), HasSubstr("nan")));
  // A count of 4 billion facets must not be believed.
  std::string lying = good;
  std::memset(lying.data() + 80, 0xff, 4);
  EXPECT_THAT(message(lying), HasSubstr("4294967295 facets"));
  std::string empty = good.substr(0, 84);
  std::memset(empty.data() + 80, 0, 4);
  EXPECT_THAT(message(empty), HasSubstr("no facets"));
  EXPECT_THAT(message(good, 0), HasSubstr("scale"));
  EXPECT_THAT(message(good, std::nan("")), HasSubstr("scale"));
  EXPECT_THAT(message(good, 1e300), HasSubstr("1000 m"));
}

TEST_F(Stl, MissingFilesAndFoldersAreErrors) {
  EXPECT_THROW(read_stl(folder_ / "none.stl"), GeometryError);
  EXPECT_THROW(read_stl(folder_), GeometryError);
  EXPECT_THROW(write_stl(test::box(1, 1, 1), folder_ / "no" / "such" / "folder.stl"), GeometryError);
}

TEST_F(Stl, EveryCutAndEveryFlippedByteIsReadOrRefused) {
  std::mt19937_64 rng(1);
  const std::string path = folder_ / "box.stl";
  write_stl(test::box(1, 1, 1), path);
  std::size_t refused = 0;
  for (const std::string& good : {bytes_of(path), ascii(test::box(1, 1, 1))})
    for (int i = 0; i < 400; ++i) {
      std::string bad = good;
      if (i % 2 == 0) bad.resize(rng() % bad.size());
      for (int k = 0; k < 3 && !bad.empty(); ++k) bad[rng() % bad.size()] = static_cast<char>(rng());
      try {
        const StlMesh stl = read_stl(file(bad));
        EXPECT_LE(stl.mesh.triangles.size(), 12U);
      } catch (const GeometryError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 400U);
}

}  // namespace
}  // namespace dem
