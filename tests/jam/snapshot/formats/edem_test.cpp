#include "libjam/snapshot/formats/edem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libjam/errors.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/jam/snapshot/formats/peer_data.hpp"

namespace jam {
namespace {

using namespace jam::test;
using testing::HasSubstr;

ImportMap edem_map() {
  ImportMap map;
  map.format = "edem";
  map.particles.columns = {{"id", "Particle ID"},         {"volume", "Particle Volume"},   {"x", "Particle Position X"},
                           {"y", "Particle Position Y"},  {"z", "Particle Position Z"},    {"vx", "Particle Velocity X"},
                           {"vy", "Particle Velocity Y"}, {"vz", "Particle Velocity Z"}};
  map.pair_contacts.columns = {{"id1", "Contact IDfirst"},
                               {"id2", "Contact IDsecond"},
                               {"fn", "Contact Normal Force Magnitude"},
                               {"overlap", "Contact Normal Overlap"}};
  map.wall_contacts.columns = {{"id", "Contact IDfirst"},     {"wall", "Contact Geometry"},
                               {"px", "Contact Position X"},  {"py", "Contact Position Y"},
                               {"pz", "Contact Position Z"},  {"fn", "Contact Normal Force Magnitude"}};
  for (const char* name : {"blade", "floor", "vessel"}) {
    ImportWall wall;
    wall.wall.name = name;
    wall.wall.kind = "mesh";
    map.walls.push_back(wall);
  }
  return map;
}

std::vector<std::string> files() {
  return {data_file("edem/wall_contacts.csv"), data_file("edem/particles.csv"), data_file("edem/contacts.csv")};
}

// The scene of the csv files, made by hand in EDEM's layouts: answers in lines and, for contacts, in columns.
TEST(Edem, GivesTheSameFramesAsTheCsvFiles) {
  const ImportMap map = edem_map();
  const SnapshotSource csv = open_source(csv_files()), edem = open_source(files(), &map);
  ASSERT_EQ(edem.frames, 2U);
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const Snapshot a = csv.read(frame), b = edem.read(frame);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.particles.id, b.particles.id);
    EXPECT_EQ(a.particles.position, b.particles.position);
    EXPECT_EQ(a.particles.velocity, b.particles.velocity);
    for (std::size_t i = 0; i < a.particles.size(); ++i) EXPECT_FLOAT_EQ(a.particles.radius[i], b.particles.radius[i]);
    EXPECT_EQ(a.pp.row, b.pp.row);
    EXPECT_EQ(a.pp.normal_force, b.pp.normal_force);
    EXPECT_EQ(a.pp.overlap, b.pp.overlap);
    EXPECT_EQ(a.pw.row, b.pw.row);
    EXPECT_EQ(a.pw.wall, b.pw.wall);
    EXPECT_EQ(a.pw.normal_force, b.pw.normal_force);
    EXPECT_EQ(a.pw.point, b.pw.point);
  }
}

TEST(Edem, WithoutAMapItIsRecognisedAndAsksForOne) {
  try {
    open_source(files());
    FAIL() << "no error";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a text export of EDEM; it needs a map"));
  }
}

std::string error_of(const TemporaryFolder& folder, const std::string& particles, const std::string& contacts) {
  ImportMap map = edem_map();
  map.wall_contacts = {};
  try {
    const SnapshotSource source = open_source({folder.write("p.csv", particles), folder.write("c.csv", contacts)}, &map);
    for (std::size_t k = 0; k < source.frames; ++k) source.read(k);
    return "";
  } catch (const DataError& error) {
    return error.what();
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Edem, ErrorsNameFileAndLine) {
  const TemporaryFolder folder;
  const std::string particles = file_bytes(files()[1]), contacts = file_bytes(files()[2]);
  EXPECT_EQ(error_of(folder, particles, contacts), "");
  std::string in_second_block = particles;
  in_second_block.replace(particles.rfind("Particle ID"), 11, "ID");
  EXPECT_THAT(error_of(folder, replaced(particles, "0.01,0.0109,0.01\n", "0.01,0.0109\n"), contacts),
              HasSubstr("p.csv:9: the query 'Particle Position X' has 2 values, expected 3 as 'Particle ID'"));
  EXPECT_THAT(error_of(folder, replaced(particles, "0.0109", "nan"), contacts),
              HasSubstr("p.csv:9: a value of 'Particle Position X' is not a finite number"));
  EXPECT_THAT(error_of(folder, replaced(particles, "Q06", "Q05"), contacts), "");  // numbers of queries do not matter
  EXPECT_THAT(error_of(folder, replaced(particles, "Total Number of Particles", "Particle Position X"), contacts),
              HasSubstr("p.csv:9: the query 'Particle Position X' is answered twice in this block"));
  EXPECT_THAT(error_of(folder, in_second_block, contacts), HasSubstr("p.csv:17: the block has no query 'Particle ID' for id"));
  EXPECT_THAT(error_of(folder, particles, replaced(contacts, "1,2,25", "1,3,25")),
              HasSubstr("c.csv:3: the contact names particle 3, which is not among the 3 particles"));
  EXPECT_THAT(error_of(folder, particles, replaced(contacts, "1,2,25,", "1,2,")), HasSubstr("c.csv:3: the row has 3 values, expected 4"));
  EXPECT_THAT(error_of(folder, particles, replaced(contacts, "TIME: 0.001", "TIME: 0.002")), HasSubstr("c.csv: frame 1 is at time 0.002"));
  EXPECT_THAT(error_of(folder, "some,words\n", contacts), HasSubstr("p.csv:1: fits no table of the map"));
}

TEST(Edem, FilesThatAreCutAnywhereGiveErrorsOrFewerFrames) {
  const TemporaryFolder folder;
  const std::string particles = file_bytes(files()[1]), contacts = file_bytes(files()[2]);
  std::size_t errors = 0;
  for (std::size_t length = 0; length < particles.size(); ++length)
    errors += !error_of(folder, particles.substr(0, length), contacts).empty();
  EXPECT_GT(errors, particles.size() * 9 / 10);
  errors = 0;
  for (std::size_t length = 0; length < contacts.size(); ++length)
    errors += !error_of(folder, particles, contacts.substr(0, length)).empty();
  EXPECT_GT(errors, contacts.size() / 2);
}

}  // namespace
}  // namespace jam
