#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "libjam/errors.hpp"
#include "libjam/snapshot/formats/text_input.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/jam/snapshot/formats/peer_data.hpp"

namespace jam {
namespace {

using namespace jam::test;
using testing::HasSubstr;

std::string text_of(const std::string& path) {
  LineReader reader(path);
  std::string text;
  std::string_view line;
  while (reader.next(line)) text += std::string(line) + "\n";
  return text;
}

// The LIGGGHTS example as plain text, small enough to be broken in many ways.
struct Texts {
  std::string particles = text_of(data_file("liggghts_edge.particles.dump.xz"));
  std::string pairs = text_of(data_file("liggghts_edge.pair.local.xz"));
  std::string walls = text_of(data_file("liggghts_edge.wall.local.xz"));
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error_of(const TemporaryFolder& folder, const Texts& texts, const ImportMap& map) {
  try {
    const SnapshotSource source = open_source({folder.write("particles", texts.particles),
                                               folder.write("pairs", texts.pairs), folder.write("walls", texts.walls)},
                                              &map);
    for (std::size_t frame = 0; frame < source.frames; ++frame) source.read(frame);
    return "";
  } catch (const DataError& error) {
    return error.what();
  }
}

TEST(DumpErrors, TheUnbrokenExampleHasNone) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder, Texts(), liggghts_map()), "");
}

TEST(DumpErrors, ColumnsThatTheMapNamesButTheFileLacksAreNamedWithThoseThatItHas) {
  const TemporaryFolder folder;
  ImportMap map = liggghts_map();
  map.particles.columns["radius"] = "c_r";
  const std::string error = error_of(folder, Texts(), map);
  EXPECT_THAT(error, HasSubstr("particles: fits no table of the map"));
  EXPECT_THAT(error, HasSubstr("particles lacks c_r"));
  EXPECT_THAT(error, HasSubstr("the columns are: id, type, x"));
}

TEST(DumpErrors, AMapWithoutTheFilesItSpeaksOfIsRefused) {
  const TemporaryFolder folder;
  const Texts texts;
  const ImportMap map = liggghts_map();
  try {
    open_source({folder.write("particles", texts.particles), folder.write("pairs", texts.pairs)}, &map);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none of the inputs holds its wall_contacts"));
  }
  EXPECT_THROW(open_source({folder.write("particles", texts.particles)}), DataError);  // no map
}

TEST(DumpErrors, BrokenTextIsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  const ImportMap map = liggghts_map();
  const Texts good;
  const auto expect = [&](const Texts& texts, const std::vector<std::string>& parts) {
    const std::string error = error_of(folder, texts, map);
    for (const std::string& part : parts) EXPECT_THAT(error, HasSubstr(part));
  };
  Texts t = good;
  t.particles.resize(t.particles.size() - t.particles.size() / 4);
  t.particles.resize(t.particles.rfind('\n') + 1);
  expect(t, {"particles:", "the file ends after", "rows of step 20000"});

  t = good;
  t.pairs = replaced(t.pairs, "NUMBER OF ENTRIES\n2", "NUMBER OF ENTRIES\n3");
  expect(t, {"pairs:12", "the next header comes after 2 of 3 rows of step 0"});
  t.pairs = replaced(good.pairs, "NUMBER OF ENTRIES\n2", "NUMBER OF ENTRIES\n1");
  expect(t, {"pairs:11", "expected a header line"});
  t.pairs = replaced(good.pairs, "NUMBER OF ENTRIES\n2", "NUMBER OF ENTRIES\n99999999999999");
  expect(t, {"pairs:12", "2 of 99999999999999 rows"});
  t.pairs = replaced(good.pairs, "NUMBER OF ENTRIES\n2", "NUMBER OF ENTRIES\n-2");
  expect(t, {"pairs:4", "'-2'", "whole number"});
  t.pairs = replaced(good.pairs, "-0.014 0.014", "low high");
  expect(t, {"pairs:6", "box bounds 'low high'"});
  t.pairs = replaced(good.pairs, "TIMESTEP\n20000", "TIMESTEP\n30000");
  expect(t, {"pairs: has step 30000", "expected the same steps"});
  t.pairs = good.pairs.substr(0, good.pairs.find("ITEM: TIMESTEP", 1));
  expect(t, {"pairs: lacks step 20000"});
  t.pairs = good.pairs + good.pairs;
  expect(t, {"pairs:", "step 0 comes after step 20000"});
  t.pairs = replaced(good.pairs, "\n3526 ", "\n4000000000 ");
  if (good.pairs.find("\n3526 ") != std::string::npos) expect(t, {"pairs:", "particle 4000000000"});

  t = good;
  t.particles = replaced(good.particles, "\n3526 1 ", "\n3526 1 nan");
  expect(t, {"particles:", "column 'x'", "finite number"});
  t.particles = replaced(good.particles, "\n3526 1 ", "\n3654 1 ");
  expect(t, {"particles:", "particle 3654", "twice"});
  t.particles = replaced(good.particles, "\n3526 1 ", "\n3526 7 ");
  expect(t, {"particles:", "material 7", "no material"});
  t.particles = replaced(good.particles, "\n3526 1 ", "\n3526 1 1 2 3 ");
  expect(t, {"particles:", "values, expected 15"});
  t.particles = replaced(good.particles, "ff ff ff", "xy xz yz pp pp pp");
  expect(t, {"triclinic"});

  t = good;
  t.walls = replaced(good.walls, " 0 143 3526", " 3 143 3526");
  expect(t, {"walls:", "mesh 3", "mesh_id of no wall"});
  t.walls = replaced(good.walls, " 0 143 3526", " 0 1143 3526");
  expect(t, {"walls:", "triangle 1143", "196"});
  t.walls = replaced(good.walls, " 0 143 3526", " 0 143 1");
  expect(t, {"walls:", "particle 1,"});
}

TEST(DumpErrors, WrongUnitsOfLengthAreNoticed) {
  const TemporaryFolder folder;
  ImportMap map = liggghts_map();
  map.particles.columns["radius"] = "x";
  map.particles.columns["x"] = "radius";
  EXPECT_NE(error_of(folder, Texts(), map), "");
}

TEST(DumpErrors, AMapThatContradictsItselfIsRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::function<void(ImportMap&)>& change, const std::string& part) {
    ImportMap map = liggghts_map();
    change(map);
    const std::string error = error_of(folder, Texts(), map);
    EXPECT_THAT(error, HasSubstr("test map"));
    EXPECT_THAT(error, HasSubstr(part));
  };
  expect([](ImportMap& m) { m.units.length = 0; }, "units.length is 0");
  expect([](ImportMap& m) { m.dt = -1; }, "dt");
  expect([](ImportMap& m) { m.walls[1].wall.name = "bottom"; }, "two walls are called bottom");
  expect([](ImportMap& m) { m.walls[1].wall.kind = "prism"; }, "'prism', expected plane, cylinder, cone, disc, spheres or mesh");
  expect([](ImportMap& m) { m.walls[1].wall.radius = 0; }, "radius");
  expect([](ImportMap& m) { m.walls[1].velocity.z() = 1; }, "moves");
  expect([](ImportMap& m) { m.walls[2].recover = true; }, "is a mesh");
  expect([](ImportMap& m) { m.walls[2].wall.material = "steel"; }, "'steel'");
  expect([](ImportMap& m) { m.particles.columns.erase("z"); }, "'z' is not");
  expect([](ImportMap& m) { m.particles.columns["zz"] = "z"; }, "unknown field 'zz'");
  expect([](ImportMap& m) { m.particles.columns.erase("id"); }, "no column to id");
  expect(
      [](ImportMap& m) {
        for (const char* f : {"fx", "fy", "fz"}) m.particles.columns.erase(f);
      },
      "total forces are needed");
  expect([](ImportMap& m) { m.materials.clear(); }, "density");
}

TEST(DumpErrors, ADensityThatIsWrongShowsInTheForceBalance) {
  ImportMap map = liggghts_map();
  const auto balance = [&] {
    const SnapshotSource source = open_source(liggghts_files(), &map);
    EXPECT_FALSE(source.warnings.empty());
    return source.warnings.front();
  };
  EXPECT_THAT(balance(), testing::Not(HasSubstr("too much")));
  map.materials[0].material.density = 7800;
  EXPECT_THAT(balance(), HasSubstr("too much"));
}

TEST(DumpErrors, ABladeThatTurnsTheWrongWayShowsInItsContactPoints) {
  ImportMap map = liggghts_map();
  map.walls[2].angular_velocity *= -1;
  const SnapshotSource source = open_source(liggghts_files(), &map);
  EXPECT_THAT(source.warnings, testing::Contains(HasSubstr("away from their triangles")));
  map.walls[2].angular_velocity *= -1;
  EXPECT_THAT(open_source(liggghts_files(), &map).warnings, testing::Not(testing::Contains(HasSubstr("triangles"))));
}

TEST(TextInput, CutAndDamagedStreamsAreRefused) {
  const TemporaryFolder folder;
  const std::string xz = file_bytes(data_file("liggghts.particles.dump.xz"));
  const std::string gz = file_bytes(data_file("csv/particles.csv.gz"));
  for (const std::string& whole : {xz, gz}) {
    for (const std::size_t cut :
         {std::size_t{1}, std::size_t{4}, std::size_t{9}, whole.size() / 2, whole.size() - 20}) {
      EXPECT_THROW(text_of(folder.write("cut", whole.substr(0, whole.size() - cut))), DataError) << cut;
    }
    std::string damaged = whole;
    damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 0x20);
    EXPECT_THROW(text_of(folder.write("damaged", damaged)), DataError);
    EXPECT_EQ(text_of(folder.write("twice", whole + whole)).size(), 2 * text_of(folder.write("once", whole)).size());
  }
}

TEST(TextInput, WhatIsNoTextIsRefusedByName) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& bytes) -> std::string {
    try {
      text_of(folder.write("input", bytes));
      return "";
    } catch (const DataError& e) {
      return e.what();
    }
  };
  EXPECT_THAT(error(""), HasSubstr("the file is empty"));
  EXPECT_THAT(error("BZh91AY"), HasSubstr("bzip2, expected plain text, gzip or xz"));
  EXPECT_THAT(error("\x28\xb5\x2f\xfd rest"), HasSubstr("zstd"));
  EXPECT_THAT(error(std::string("text\0text", 9)), HasSubstr("NUL"));
  EXPECT_THAT(error(std::string(3 << 20, 'x')), HasSubstr("longer than 1 MiB"));
  EXPECT_THROW(text_of("/no/such/file"), DataError);
  EXPECT_THROW(text_of(JAMSCOPE_DATA_DIR), DataError);
  EXPECT_THROW(open_source({}), DataError);
  EXPECT_THROW(open_source({folder.write("prose", "a poem\nof two lines\n")}), DataError);
}

TEST(TextInput, NumbersAreReadStrictly) {
  double value = 7;
  EXPECT_TRUE(parse_number("+1.5e-3", value));
  EXPECT_EQ(value, 1.5e-3);
  EXPECT_TRUE(parse_number("1e-400", value));  // smaller than a double holds
  EXPECT_EQ(value, 0);
  for (const char* bad : {"", "nan", "inf", "-inf", "1e400", "1e31", "1.5x", "0x10", "1,5", "--1", "+-"}) {
    EXPECT_FALSE(parse_number(bad, value)) << bad;
  }
}

// Whatever bytes change, the answer is a DataError or a snapshot, never a crash (run under the sanitizers too).
TEST(DumpErrors, RandomlyBrokenTextIsRefusedOrRead) {
  const TemporaryFolder folder;
  const Texts good;
  const ImportMap map = liggghts_map();
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::string letters = "0123456789-+.eE \n,ITEM:naf\0\xff" + std::string(1, '\0');
  int refused = 0, read = 0;
  for (int round = 0; round < 600; ++round) {
    Texts texts = good;
    std::string* const all[] = {&texts.particles, &texts.pairs, &texts.walls};
    std::string& text = *all[below(3)];
    switch (below(4)) {
      case 0:
        text.resize(below(text.size() + 1));
        break;
      case 1:
        text.erase(below(text.size()), 1 + below(40));
        break;
      case 2:
        for (std::size_t k = 0, n = 1 + below(6); k < n; ++k) text[below(text.size())] = letters[below(letters.size())];
        break;
      default: {
        const std::size_t from = below(text.size());
        text.insert(below(text.size()), text.substr(from, below(200)));
      }
    }
    (error_of(folder, texts, map).empty() ? read : refused) += 1;
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 20);  // changed digits are still numbers
}

}  // namespace
}  // namespace jam
