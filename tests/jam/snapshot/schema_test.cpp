#include "libjam/snapshot/schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "libjam/snapshot/crc32c.hpp"
#include "libjam/snapshot/reader.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

namespace jam::schema {
namespace {

class Schema : public sample::InFolder {};

std::string shape_of(const Item& item) {
  const std::map<Axis, std::string> letters{{attribute, ""},      {text, ""},    {argument, "A"}, {material, "M"},
                                            {interaction, "M,M"}, {vertex, "V"}, {triangle, "F"}, {sphere, "G"}, {frame, "T"},
                                            {particle, "P"},      {pp, "C"},     {pw, "W"},       {series, "S"}, {excursion, "E"}};
  std::string shape = letters.at(item.axis);
  if (item.width > 1) shape += (shape.empty() ? "" : ",") + std::to_string(item.width);
  return shape.empty() ? shape : "[" + shape + "]";
}

// The check value of the catalogue of CRCs, and the table's for data of all lengths at all places in memory.
TEST(Crc32c, IsCastagnolis) {
  Crc32c crc;
  crc.process_bytes("123456789", 9);
  EXPECT_EQ(crc.checksum(), 0xE3069283u);
  const std::string data = "What a processor computes in an instruction and what a table gives must not differ in a bit.";
  for (std::size_t first = 0; first < 9; ++first)
    for (std::size_t middle = first; middle < data.size(); middle += 5)
      for (std::size_t last = middle; last < data.size(); last += 7) {
        Crc32c parts;
        parts.process_bytes(data.data() + first, middle - first);
        parts.process_bytes(data.data() + middle, last - middle);
        boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> table;
        table.process_bytes(data.data() + first, last - first);
        EXPECT_EQ(parts.checksum(), table.checksum());
      }
}

TEST_F(Schema, TheDocumentHasTheSameTableAsTheCode) {
  std::vector<std::string> expected, found;
  for (const Item& i : table) {
    expected.push_back("| `" + std::string(i.path) + "` | " + h5::name_of(i.type) + " | " + shape_of(i) + " | " +
                       (i.need == required ? "required" : "optional") + " | " + std::string(i.unit) + " | " +
                       std::string(i.doc) + " |");
  }
  std::ifstream in(std::string(JAMSCOPE_DATA_DIR) + "/../libjam/snapshot/SCHEMA.md");
  ASSERT_TRUE(in);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("| `", 0) == 0) found.push_back(line);
  }
  EXPECT_EQ(found, expected);
}

TEST_F(Schema, PathsAreUnique) {
  std::set<std::string_view> paths;
  for (const Item& i : table) EXPECT_TRUE(paths.insert(i.path).second) << i.path;
}

TEST_F(Schema, VisitorsGoThroughEveryGrowingItemInTheOrderOfTheTable) {
  std::vector<std::string_view> visited, expected;
  const auto note = [&](const Item& item, const auto&) { visited.push_back(item.path); };
  Snapshot s;
  Series rows;
  Series::WallSeries wall;
  visit_wall(note);
  visit_frame(note);
  visit_particles(s.particles, note);
  visit_pp(s.pp, note);
  visit_pw(s.pw, note);
  visit_series(rows, note);
  visit_wall_series(wall, note);
  visit_excursions(rows.excursions, note);
  for (const Item& i : table) {
    const bool grows = i.axis == frame || i.axis == particle || i.axis == pp || i.axis == pw || i.axis == series || i.axis == excursion;
    // The commit is no member: it is computed from all others.
    if (grows && i.path != "/frames/commit") expected.push_back(i.path);
  }
  EXPECT_EQ(visited, expected);
}

// The items that say where a wall is; what a wall of each kind has of them.
const std::map<std::string_view, std::set<std::string_view>> items_of_shape{
    {"plane", {"/walls/*@point", "/walls/*@axis"}},
    {"cylinder",
     {"/walls/*@point", "/walls/*@axis", "/walls/*@radius", "/walls/*@low", "/walls/*@high", "/walls/*@free_side"}},
    {"cone",
     {"/walls/*@point", "/walls/*@axis", "/walls/*@radius", "/walls/*@high_radius", "/walls/*@low", "/walls/*@high",
      "/walls/*@free_side"}},
    {"disc", {"/walls/*@point", "/walls/*@axis", "/walls/*@radius", "/walls/*@hole_radius"}},
    {"spheres", {"/walls/*/sphere_centre", "/walls/*/sphere_radius"}},
    {"mesh", {"/walls/*/vertices", "/walls/*/triangles", "/walls/*/triangle_label"}}};

bool is_of_shape(const Item& item) {
  return std::any_of(items_of_shape.begin(), items_of_shape.end(),
                     [&](const auto& shape) { return shape.second.contains(item.path); });
}

// A file of a run of which everything is known holds every item of the table as the table says, and nothing else.
TEST_F(Schema, AFullFileHasExactlyTheItemsOfTheTable) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < 2; ++k) writer.append(sample::frame(k), sample::series(k));
  const h5::File file = h5::File::open(path);
  std::set<std::string> expected;
  for (const Item& i : table) {
    for (const Wall& wall : sample::info().walls) {
      if (is_of_shape(i) && !items_of_shape.at(wall.kind).contains(i.path)) continue;
      if (i.path == "/walls/*@material" && wall.material.empty()) continue;
      if (i.axis == attribute) {
        expected.insert(object_of(i, wall.name) + "@" + attribute_of(i));
        EXPECT_TRUE(file.has_attribute(object_of(i, wall.name), attribute_of(i))) << i.path << " " << wall.name;
        continue;
      }
      const std::string name = path_of(i, wall.name);
      expected.insert(name);
      ASSERT_TRUE(file.exists(name)) << name;
      const h5::Layout layout = file.layout(name);
      EXPECT_EQ(layout.type, i.type) << name;
      EXPECT_EQ(layout.width(), i.axis == interaction ? 2U : i.width) << name;
      EXPECT_EQ(file.attribute<std::string>(name, "unit"), i.unit) << name;
      EXPECT_EQ(file.attribute<std::string>(name, "doc"), i.doc) << name;
    }
  }
  std::set<std::string> found;
  std::vector<std::string> todo{"/"};
  while (!todo.empty()) {
    const std::string name = todo.back();
    todo.pop_back();
    if (!file.is_group(name)) {
      found.insert(name);
      continue;
    }
    for (const std::string& a : file.attributes(name)) found.insert(name + "@" + a);
    for (const std::string& child : file.children(name)) todo.push_back((name == "/" ? "" : name) + "/" + child);
  }
  EXPECT_EQ(found, expected);
}

TEST_F(Schema, EveryMissingRequiredItemIsNamed) {
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < 2; ++k) writer.append(sample::frame(k), sample::series(k));
  for (const Item& i : table) {
    if (i.need == optional) continue;
    const std::filesystem::path copy = folder / "copy.h5";
    std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
    const std::string place = i.axis == attribute ? object_of(i, "blade") + "@" + attribute_of(i) : path_of(i, "blade");
    {
      h5::File file = h5::File::open_update(copy);
      file.remove(place);
      file.close();
    }
    const std::string error = sample::error_of([&] {
      const SnapshotSource source = open_jamscope_file(copy);
      source.read(1);
    });
    if (i.path == "/walls/*@torque_origin") {
      EXPECT_EQ(error, "no error");  // says what is always so
    } else {
      EXPECT_THAT(error, testing::HasSubstr("copy.h5:" + place + ":")) << i.path;
    }
  }
}

}  // namespace
}  // namespace jam::schema
