#include "libjam/snapshot/export/export_formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>

#include "libjam/snapshot/export/output_file.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "libjam/snapshot/validate.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

namespace jam {
namespace {

using boost::property_tree::ptree;
using testing::HasSubstr;

// The sample run with particles so large that all its contacts could be.
Snapshot close_frame(std::size_t k) {
  Snapshot s = sample::frame(k, 12);
  for (float& r : s.particles.radius) r += 1;
  validate(s, sample::info());
  return s;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

const ExportFormat& format_named(const std::string& name) {
  for (const ExportFormat& format : export_formats()) {
    if (format.name == name) return format;
  }
  throw std::logic_error("no such format");
}

class Export : public sample::InFolder {
 protected:
  // Exports the frames, numbered from 0; keeps the map.
  std::vector<std::filesystem::path> write(const std::string& format, const std::vector<Snapshot>& frames,
                                           const RunInfo& info = sample::info()) {
    const auto exporter = format_named(format).open(info, folder);
    for (std::size_t k = 0; k < frames.size(); ++k) exporter->add(k, frames[k]);
    const auto files = exporter->finish();
    map = exporter->map();
    return files;
  }
  SnapshotSource read_back(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> paths;
    for (const auto& file : files) paths.push_back(file.string());
    return open_source(paths, &map.value());
  }
  // Empty, or what differs first.
  std::string round_trip(const std::string& format, const std::vector<Snapshot>& frames,
                         const RunInfo& info = sample::info()) {
    const SnapshotSource source = read_back(write(format, frames, info));
    if (source.frames != frames.size()) return "number of frames";
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const std::string difference = sample::difference(frames[k], source.read(k), info);
      if (!difference.empty()) return "frame " + std::to_string(k) + ": " + difference;
    }
    return "";
  }
  std::optional<ImportMap> map;
};

TEST_F(Export, EveryFormatWritesWholeFilesAndNothingElse) {
  for (const ExportFormat& format : export_formats()) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const auto files = write(format.name, {close_frame(0), close_frame(1)});
    EXPECT_FALSE(files.empty()) << format.name;
    for (const auto& file : files) EXPECT_GT(std::filesystem::file_size(file), 100U) << file;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      EXPECT_NE(entry.path().extension(), ".part") << format.name;
  }
}

TEST_F(Export, WhatCannotBeWrittenIsNamed) {
  for (const ExportFormat& format : export_formats()) {
    const std::string missing = (folder / "none").string();
    std::ofstream(folder / "none") << "a file where a folder is wanted";
    const std::string error = sample::error_of([&] {
      const auto exporter = format.open(sample::info(), missing);
      exporter->add(0, close_frame(0));
    });
    EXPECT_THAT(error, HasSubstr(missing + "/")) << format.name;
  }
}

TEST_F(Export, AnExportThatIsGivenUpLeavesNoFilesWithTheirFinalNames) {
  {
    const auto exporter = format_named("lammps").open(sample::info(), folder);
    exporter->add(0, close_frame(0));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

// Bit for bit: positions, forces, flags, ages, wall contacts with facets and features, poses and loads of walls.
TEST_F(Export, LammpsDumpsComeBackAsTheSameFrames) {
  EXPECT_EQ(round_trip("lammps", {close_frame(0), close_frame(1), close_frame(2)}), "");
}
TEST_F(Export, CsvTablesComeBackAsTheSameFrames) {
  EXPECT_EQ(round_trip("csv", {close_frame(0), close_frame(1), close_frame(2)}), "");
}

TEST_F(Export, TheMapKnowsTheRun) {
  for (const char* format : {"lammps", "csv"}) {
    const RunInfo sent = sample::info();
    const RunInfo got = read_back(write(format, {close_frame(0)})).info;
    EXPECT_EQ(got.creator, sent.creator);
    EXPECT_EQ(got.case_toml, sent.case_toml);
    EXPECT_EQ(got.gravity, sent.gravity);
    EXPECT_EQ(got.dt, sent.dt);
    EXPECT_EQ(got.gap.tip_radius, sent.gap.tip_radius);
    EXPECT_EQ(got.gap.z_low, sent.gap.z_low);
    ASSERT_EQ(got.materials.size(), 2U);
    EXPECT_EQ(got.materials[1].young, sent.materials[1].young);
    EXPECT_EQ(got.interactions[0][1].friction, sent.interactions[0][1].friction);
    EXPECT_TRUE(got.wall_loads_known);
    ASSERT_EQ(got.walls.size(), sent.walls.size());
    for (std::size_t w = 0; w < got.walls.size(); ++w) {
      EXPECT_EQ(got.walls[w].name, sent.walls[w].name);
      EXPECT_EQ(got.walls[w].kind, sent.walls[w].kind);
      EXPECT_EQ(got.walls[w].role, sent.walls[w].role);
      EXPECT_EQ(got.walls[w].axis, sent.walls[w].axis);
      EXPECT_EQ(got.walls[w].triangles, sent.walls[w].triangles);
    }
  }
}

TEST_F(Export, FramesWithoutContactsParticlesOrWallsComeBackToo) {
  Snapshot empty = close_frame(1);
  empty.pp = {};
  empty.pw = {};
  Snapshot nobody = close_frame(2);
  nobody.particles = {};
  nobody.pp = {};
  nobody.pw = {};
  // A comma separated frame without rows is not there at all, so only dumps can hold a frame without particles.
  EXPECT_EQ(round_trip("lammps", {nobody}), "");
  for (const char* format : {"lammps", "csv"}) {
    Snapshot first = close_frame(0);
    EXPECT_EQ(round_trip(format, {empty}), "") << format;
    EXPECT_EQ(round_trip(format, {first, empty, close_frame(2)}), "") << format;
    first.pp = {};  // which columns contacts have is then known from the second frame only
    first.pw = {};
    EXPECT_EQ(round_trip(format, {first, close_frame(1)}), "") << format;
    RunInfo no_walls = sample::info();
    no_walls.walls.clear();
    no_walls.gap = {};
    Snapshot alone = close_frame(0);
    alone.pw = {};
    alone.walls.clear();
    EXPECT_EQ(round_trip(format, {alone}, no_walls), "") << format;
  }
}

TEST_F(Export, WhatTheSourceDoesNotKnowIsAbsentInTheFilesToo) {
  RunInfo info = sample::info();
  info.materials.clear();
  info.interactions.clear();
  for (Wall& wall : info.walls) wall.material.clear();
  info.wall_loads_known = false;
  Snapshot s = close_frame(0);
  s.particles.velocity.clear();
  s.particles.angular_velocity.clear();
  s.particles.material.clear();
  s.particles.compressive_force.clear();
  s.pp.damping_force.clear();
  s.pp.birth_step.clear();
  s.pw.damping_force.clear();
  s.pw.birth_step.clear();
  s.pw.facet.clear();
  s.pw.feature.clear();
  // Facets of walls without triangles are 0 for the importer, so only mesh contacts show that they are not known.
  std::fill(s.pw.wall.begin(), s.pw.wall.end(), std::uint8_t{1});
  validate(s, info);
  EXPECT_EQ(round_trip("lammps", {s}, info), "");
  EXPECT_THAT(bytes_of(folder / "atoms.dump"), HasSubstr("ITEM: ATOMS id type x y z radius\n"));
  EXPECT_EQ(round_trip("csv", {s}, info), "");
  EXPECT_THAT(bytes_of(folder / "particles.csv"), HasSubstr("frame,step,time [s],id,position_x [m],position_y [m],position_z [m],radius [m]\n"));
  EXPECT_EQ(bytes_of(folder / "walls.csv").find("force"), std::string::npos);
}

TEST_F(Export, FramesWithOtherQuantitiesThanThoseBeforeAreRefused) {
  for (const char* format : {"lammps", "csv"}) {
    Snapshot other = close_frame(1);
    other.particles.velocity.clear();
    const std::string error = sample::error_of([&] { write(format, {close_frame(0), other}); });
    EXPECT_THAT(error, HasSubstr("frame 1 has the quantities")) << format;
    EXPECT_THAT(error, HasSubstr((folder / (format == std::string("csv") ? "particles.csv" : "atoms.dump")).string()));
  }
}

TEST_F(Export, WallNamesThatCsvCannotHoldAreReplacedAndMapped) {
  RunInfo info = sample::info();
  info.walls[0].name = "a, \"b\"";
  info.walls[1].name = " a  \"b\"";
  EXPECT_EQ(round_trip("csv", {close_frame(0)}, info), "");
  EXPECT_EQ(map->walls[0].wall.name, "a, \"b\"");
}

// Every way to cut a dump or a table short gives an error that names a file, or fewer frames; never anything else.
TEST_F(Export, DumpsAndTablesThatAreCutShortGiveErrorsWithPlaces) {
  RunInfo two_walls = sample::info();
  two_walls.walls.resize(2);
  Snapshot small = sample::frame(0, 3);
  for (float& r : small.particles.radius) r += 1;
  for (std::uint8_t& wall : small.pw.wall) wall = std::uint8_t(wall % 2);
  small.walls.resize(2);
  for (const char* format : {"lammps", "csv"}) {
    const std::vector<std::filesystem::path> files = write(format, {small}, two_walls);
    for (const auto& file : files) {
      const std::string whole = bytes_of(file);
      std::size_t errors = 0;
      for (std::size_t length = 0; length < whole.size(); ++length) {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
        const std::string error = sample::error_of([&] {
          const SnapshotSource source = read_back(files);
          for (std::size_t k = 0; k < source.frames; ++k) source.read(k);
        });
        if (error == "no error") continue;  // a cut within the digits of the last number cannot be seen
        ++errors;
        // Where a table lacks whole frames or is not recognised the message names the other file, or the map.
        EXPECT_TRUE(error.find(folder.string()) != std::string::npos || error.find("map") == 0) << error;
      }
      EXPECT_GT(errors, whole.size() / 2) << file;
      std::ofstream(file, std::ios::binary | std::ios::trunc) << whole;
    }
  }
}

TEST_F(Export, BrokenWallStatesAreNamedByFileAndLine) {
  const auto files = write("lammps", {close_frame(0)});
  const std::string whole = bytes_of(folder / "walls.dump");
  const auto error_with = [&](const std::string& text) {
    std::ofstream(folder / "walls.dump", std::ios::binary | std::ios::trunc) << text;
    return sample::error_of([&] { read_back(files); });
  };
  EXPECT_EQ(error_with(whole), "no error");
  const std::size_t second = whole.find("\n1 ") + 1;
  std::string text = whole;
  text.replace(second, 1, "0");
  EXPECT_THAT(error_with(text), HasSubstr("walls.dump:13: the wall vessel side is listed twice in this frame"));
  text.replace(second, 1, "9");
  EXPECT_THAT(error_with(text), HasSubstr("walls.dump:13: mesh 9.000000 is the mesh_id of no wall of the map"));
  const std::size_t sixth = whole.find("\n5 ") + 1;
  text = whole.substr(0, sixth);
  text.replace(text.find("ENTRIES\n6"), 9, "ENTRIES\n5");
  EXPECT_THAT(error_with(text), HasSubstr("has no row for the wall rough plate"));
}

TEST(AppendNumber, WhatIsReadAsADoubleAndRoundedIsTheSameFloat) {
  std::mt19937 random(1);
  const auto check = [](float value) {
    std::string text;
    append_number(text, value);
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    const float back = static_cast<float>(read);
    EXPECT_EQ(std::memcmp(&back, &value, sizeof value), 0) << text;
  };
  for (const float special : {0.0F, -0.0F, 1.0F, 0.1F, 7.038531e-26F, -7.038531e-26F, std::numeric_limits<float>::denorm_min(),
                              std::numeric_limits<float>::max()})
    check(special);
  for (int k = 0; k < 200000; ++k) {
    const std::uint32_t bits = random() % 0x7f800000U | (random() % 2) << 31;
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    check(value);
  }
}

// A VTK XML file with its raw arrays, taken apart as the format says.
struct Vtp {
  ptree xml;
  std::string appended;
  struct Values {
    std::string type;
    std::size_t components;
    std::string bytes;
  };
  std::map<std::string, Values> arrays;  // "PointData/radius"
  std::size_t expected_bytes = 0;

  explicit Vtp(const std::filesystem::path& path) {
    const std::string all = bytes_of(path);
    const std::string open = "<AppendedData encoding=\"raw\">\n_", close = "\n</AppendedData>\n</VTKFile>\n";
    const std::size_t begin = all.find(open);
    EXPECT_NE(begin, std::string::npos);
    EXPECT_EQ(all.substr(all.size() - close.size()), close);
    appended = all.substr(begin + open.size(), all.size() - close.size() - begin - open.size());
    std::istringstream head(all.substr(0, begin) + "</VTKFile>\n");
    read_xml(head, xml);
    for (const auto& [section, items] : xml.get_child("VTKFile.PolyData.Piece")) {
      if (section == "<xmlattr>") continue;
      for (const auto& [tag, item] : items) {
        if (tag != "DataArray") continue;
        const auto offset = item.get<std::size_t>("<xmlattr>.offset");
        std::uint64_t size = 0;
        EXPECT_LE(offset + sizeof size, appended.size());
        std::memcpy(&size, appended.data() + offset, sizeof size);
        EXPECT_LE(offset + sizeof size + size, appended.size());
        arrays[section + "/" + item.get<std::string>("<xmlattr>.Name")] = {
            item.get<std::string>("<xmlattr>.type"), item.get<std::size_t>("<xmlattr>.NumberOfComponents"),
            appended.substr(offset + sizeof size, size)};
        expected_bytes += sizeof size + size;
      }
    }
  }
  std::size_t count(const std::string& what) const { return xml.get<std::size_t>("VTKFile.PolyData.Piece.<xmlattr>.NumberOf" + what); }
  template <class T>
  std::vector<T> values(const std::string& name) const {
    const Values& v = arrays.at(name);
    std::vector<T> out(v.bytes.size() / sizeof(T));
    std::memcpy(out.data(), v.bytes.data(), v.bytes.size());
    return out;
  }
};

TEST_F(Export, VtpFilesHoldWhatTheirHeadSays) {
  const RunInfo info = sample::info();
  const Snapshot s = close_frame(1);
  write("vtp", {close_frame(0), s});
  std::size_t mesh_triangles = 0;
  for (const Wall& wall : info.walls) mesh_triangles += wall.triangles.size();

  const std::map<std::string, std::size_t> size_of{{"Float32", 4}, {"Float64", 8}, {"UInt8", 1}, {"UInt32", 4}, {"UInt64", 8}, {"Int32", 4}};
  for (const char* name : {"particles", "contacts", "blade", "walls"}) {
    const Vtp file(folder / "vtp" / (std::string(name) + "_000001.vtp"));
    EXPECT_EQ(file.appended.size(), file.expected_bytes) << name;  // no gap, nothing behind
    EXPECT_EQ(file.xml.get<double>("VTKFile.PolyData.FieldData.DataArray"), s.time);
    const std::size_t cells = file.count("Verts") + file.count("Lines") + file.count("Polys");
    for (const auto& [key, array] : file.arrays) {
      const std::size_t tuple = size_of.at(array.type) * array.components;
      if (key.rfind("PointData/", 0) == 0 || key == "Points/Points") {
        EXPECT_EQ(array.bytes.size(), tuple * file.count("Points")) << key;
      } else if (key.rfind("CellData/", 0) == 0 || key.find("/offsets") != std::string::npos) {
        EXPECT_EQ(array.bytes.size(), tuple * cells) << key;
      }
    }
  }

  const Vtp particles(folder / "vtp" / "particles_000001.vtp");
  EXPECT_EQ(particles.count("Points"), s.particles.size());
  EXPECT_EQ(particles.values<float>("PointData/radius"), s.particles.radius);
  EXPECT_EQ(particles.values<std::uint32_t>("PointData/id"), s.particles.id);
  EXPECT_EQ(particles.values<float>("PointData/compressive_force"), s.particles.compressive_force);
  EXPECT_EQ(particles.values<float>("Points/Points")[3], s.particles.position[1].x());
  const auto coordination = particles.values<std::uint32_t>("PointData/coordination");
  EXPECT_EQ(std::accumulate(coordination.begin(), coordination.end(), 0U), 2 * s.pp.size() + s.pw.size());

  const Vtp contacts(folder / "vtp" / "contacts_000001.vtp");
  EXPECT_EQ(contacts.count("Lines"), s.pp.size() + s.pw.size());
  EXPECT_EQ(contacts.count("Points"), s.particles.size() + s.pw.size());
  const auto force = contacts.values<float>("CellData/normal_force");
  EXPECT_EQ(force[0], s.pp.normal_force[0]);
  EXPECT_EQ(force[s.pp.size()], s.pw.normal_force[0]);
  const auto ends = contacts.values<std::int32_t>("Lines/connectivity");
  EXPECT_EQ(ends[0], static_cast<std::int32_t>(s.pp.row[0][0]));
  EXPECT_EQ(ends[2 * s.pp.size()], static_cast<std::int32_t>(s.pw.row[0]));
  EXPECT_EQ(contacts.values<float>("Points/Points")[3 * static_cast<std::size_t>(ends[2 * s.pp.size() + 1])], s.pw.point[0].x());
  EXPECT_EQ(contacts.values<std::int32_t>("CellData/wall")[s.pp.size()], s.pw.wall[0]);

  const Vtp blade(folder / "vtp" / "blade_000001.vtp");
  EXPECT_EQ(blade.count("Polys"), mesh_triangles);
  const Vec3 corner = s.walls[1].position + s.walls[1].orientation * info.walls[1].vertices[1];
  const auto points = blade.values<float>("Points/Points");
  EXPECT_FLOAT_EQ(points[3], static_cast<float>(corner.x()));
  EXPECT_FLOAT_EQ(points[5], static_cast<float>(corner.z()));
  // 2 of the plane, 192 of the tube and of the cone, 192 of the ring, 40 of two spheres.
  EXPECT_EQ(Vtp(folder / "vtp" / "walls_000001.vtp").count("Polys"), 2U + 3 * 192 + 40);
}

TEST_F(Export, WallsAreDrawnWhereTheyAre) {
  RunInfo info = sample::info();
  Snapshot s = close_frame(0);
  s.walls.assign(s.walls.size(), WallState{});
  write("vtp", {s}, info);
  const Vtp walls(folder / "vtp" / "walls_000000.vtp");
  const auto points = walls.values<float>("Points/Points");
  const auto corners = walls.values<std::int32_t>("Polys/connectivity");
  const auto wall = walls.values<std::uint8_t>("CellData/wall");
  for (std::size_t t = 0; t < wall.size(); ++t) {
    const Wall& w = info.walls[wall[t]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = 3 * static_cast<std::size_t>(corners[3 * t + k]);
      const Vec3 x = Vec3(double{points[at]}, double{points[at + 1]}, double{points[at + 2]}) - w.point;
      const double along = x.dot(w.axis), across = (x - along * w.axis).norm();
      if (w.kind == "plane" || w.kind == "disc") {
        EXPECT_NEAR(along, 0, 1e-6);
      }
      if (w.kind == "disc") {
        EXPECT_TRUE(std::abs(across - w.radius) < 1e-6 || std::abs(across - w.hole_radius) < 1e-6);
      }
      if (w.kind == "cylinder" || w.kind == "cone") {
        const double high_radius = w.kind == "cone" ? w.high_radius : w.radius;
        EXPECT_NEAR(across, w.radius + (along - w.low) / (w.high - w.low) * (high_radius - w.radius), 1e-6);
        EXPECT_TRUE(std::abs(along - w.low) < 1e-6 || std::abs(along - w.high) < 1e-6) << along;
      }
    }
  }
}

TEST_F(Export, TheIndexOfAVtpSeriesHasTheTimesOfTheFrames) {
  write("vtp", {close_frame(0), close_frame(1), close_frame(2)});
  for (const char* name : {"particles", "contacts", "blade", "walls"}) {
    ptree xml;
    read_xml((folder / (std::string(name) + ".pvd")).string(), xml);
    std::vector<double> times;
    for (const auto& [tag, item] : xml.get_child("VTKFile.Collection")) {
      times.push_back(item.get<double>("<xmlattr>.timestep"));
      EXPECT_TRUE(std::filesystem::exists(folder / item.get<std::string>("<xmlattr>.file")));
    }
    EXPECT_EQ(times, (std::vector<double>{0, 0.002, 0.004})) << name;
  }
}

TEST_F(Export, GraphmlHasANodeAParticleAndTouchedWallAndAnEdgeAContact) {
  RunInfo info = sample::info();
  info.walls[1].name = "a<b> & \"c\"";
  const Snapshot s = close_frame(1);
  write("graphml", {close_frame(0), s}, info);
  ptree xml;
  read_xml((folder / "frame_000001.graphml").string(), xml);
  const auto attributes = [&](const ptree& item) {
    std::map<std::string, std::string> values;
    for (const auto& [tag, child] : item) {
      if (tag == "data") values[child.get<std::string>("<xmlattr>.key")] = child.data();
    }
    return values;
  };
  std::set<std::string> nodes, ids, touched;
  for (const std::uint8_t w : s.pw.wall) touched.insert("w" + std::to_string(w));
  std::size_t edges = 0, walls = 0;
  double force = 0;
  const ptree& graph = xml.get_child("graphml.graph");
  EXPECT_EQ(graph.get<std::string>("<xmlattr>.edgedefault"), "undirected");
  EXPECT_EQ(std::stod(attributes(graph).at("g_time")), s.time);
  for (const auto& [tag, item] : graph) {
    if (tag == "node") {
      nodes.insert(item.get<std::string>("<xmlattr>.id"));
      auto a = attributes(item);
      if (a.at("n_kind") == "wall") {
        ++walls;
        EXPECT_TRUE(touched.count(item.get<std::string>("<xmlattr>.id")));
        if (item.get<std::string>("<xmlattr>.id") == "w1") {
          EXPECT_EQ(a.at("n_label"), info.walls[1].name);
        }
      }
    } else if (tag == "edge") {
      ++edges;
      ids.insert(item.get<std::string>("<xmlattr>.id"));
      EXPECT_TRUE(nodes.count(item.get<std::string>("<xmlattr>.source")) && nodes.count(item.get<std::string>("<xmlattr>.target")));
      force += std::stod(attributes(item).at("e_normal"));
    }
  }
  EXPECT_EQ(nodes.size(), s.particles.size() + touched.size());
  EXPECT_EQ(walls, touched.size());
  EXPECT_EQ(edges, s.pp.size() + s.pw.size());
  EXPECT_EQ(ids.size(), edges);
  double sum = 0;
  for (const float f : s.pp.normal_force) sum += double{f};
  for (const float f : s.pw.normal_force) sum += double{f};
  EXPECT_NEAR(force, sum, 1e-6);
}

}  // namespace
}  // namespace jam
