#include "libjam/snapshot/xdmf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/writer.hpp"
#include "tests/jam/snapshot/sample_run.hpp"

namespace jam {
namespace {

using boost::property_tree::ptree;

class Xdmf : public sample::InFolder {};

std::vector<std::uint64_t> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::uint64_t> values;
  for (std::uint64_t v = 0; in >> v;) values.push_back(v);
  return values;
}

struct Slab {
  std::vector<std::uint64_t> start, count, whole;  // per dimension
  std::string file, path;
};

// Takes a HyperSlab item apart and checks that its parts agree.
Slab slab_of(const ptree& item) {
  EXPECT_EQ(item.get<std::string>("<xmlattr>.ItemType"), "HyperSlab");
  Slab slab;
  std::vector<const ptree*> parts;
  for (const auto& [tag, child] : item) {
    if (tag == "DataItem") parts.push_back(&child);
  }
  EXPECT_EQ(parts.size(), 2U);
  const auto selection = numbers(parts[0]->data());
  const std::size_t rank = selection.size() / 3;
  EXPECT_EQ(numbers(parts[0]->get<std::string>("<xmlattr>.Dimensions")), (std::vector<std::uint64_t>{3, rank}));
  for (std::size_t d = 0; d < rank; ++d) {
    slab.start.push_back(selection[d]);
    EXPECT_EQ(selection[rank + d], 1U);  // stride
    slab.count.push_back(selection[2 * rank + d]);
  }
  EXPECT_EQ(numbers(item.get<std::string>("<xmlattr>.Dimensions")), slab.count);
  slab.whole = numbers(parts[1]->get<std::string>("<xmlattr>.Dimensions"));
  EXPECT_EQ(parts[1]->get<std::string>("<xmlattr>.Format"), "HDF");
  const std::string source = parts[1]->data();
  slab.file = source.substr(0, source.find(":/"));
  slab.path = source.substr(source.find(":/") + 1);
  for (std::size_t d = 0; d < rank; ++d) EXPECT_LE(slab.start[d] + slab.count[d], slab.whole[d]) << slab.path;
  return slab;
}

ptree parsed(const std::filesystem::path& path) {
  ptree tree;
  boost::property_tree::read_xml(path.string(), tree);
  return tree;
}

TEST_F(Xdmf, EveryFrameIsThereWithItsParticlesAndContacts) {
  const auto frame = [](std::size_t k) {
    Snapshot s = sample::frame(k);
    if (k == 2) s.pp = {};
    return s;
  };
  std::filesystem::create_directories(folder / "data & more");
  path = folder / "data & more" / "run.h5";
  SnapshotWriter writer = SnapshotWriter::create(path, sample::info());
  for (std::size_t k = 0; k < 5; ++k) writer.append(frame(k));
  write_xdmf(folder / "run.xdmf", path);

  const h5::File file = h5::File::open(path);
  const ptree tree = parsed(folder / "run.xdmf");
  EXPECT_EQ(tree.get<std::string>("Xdmf.<xmlattr>.Version"), "2.2");
  const ptree& frames = tree.get_child("Xdmf.Domain.Grid");
  EXPECT_EQ(frames.get<std::string>("<xmlattr>.CollectionType"), "Temporal");
  std::size_t k = 0;
  for (const auto& [tag, step] : frames) {
    if (tag != "Grid") continue;
    const Snapshot s = frame(k);
    EXPECT_EQ(step.get<std::string>("<xmlattr>.CollectionType"), "Spatial");
    EXPECT_EQ(step.get<double>("Time.<xmlattr>.Value"), s.time);
    std::vector<std::string> names;
    for (const auto& [inner, grid] : step) {
      if (inner != "Grid") continue;
      names.push_back(grid.get<std::string>("<xmlattr>.Name"));
      const bool points = names.back() == "particles";
      const std::size_t rows = points ? s.particles.size() : s.pp.size();
      const ptree& topology = grid.get_child("Topology");
      EXPECT_EQ(topology.get<std::string>("<xmlattr>.TopologyType"), points ? "Polyvertex" : "Polyline");
      EXPECT_EQ(topology.get<std::size_t>("<xmlattr>.NumberOfElements"), rows);
      EXPECT_EQ(topology.get<std::size_t>("<xmlattr>.NodesPerElement"), points ? 1U : 2U);
      if (!points) {
        const Slab lines = slab_of(topology.get_child("DataItem"));
        EXPECT_EQ(lines.path, "/contacts/pp/row");
        EXPECT_EQ(lines.count, (std::vector<std::uint64_t>{rows, 2}));
        EXPECT_EQ((file.read_rows<std::array<std::uint32_t, 2>>(lines.path, lines.start[0], lines.count[0])), s.pp.row);
      }
      const Slab geometry = slab_of(grid.get_child("Geometry.DataItem"));
      EXPECT_EQ(geometry.file, "data & more/run.h5");
      EXPECT_EQ(geometry.whole[0], file.layout("/particles/position").rows());
      EXPECT_EQ(file.read_rows<Vec3f>(geometry.path, geometry.start[0], geometry.count[0]), s.particles.position);
      std::vector<std::string> attributes;
      for (const auto& [kind, attribute] : grid) {
        if (kind != "Attribute") continue;
        attributes.push_back(attribute.get<std::string>("<xmlattr>.Name"));
        const Slab slab = slab_of(attribute.get_child("DataItem"));
        EXPECT_EQ(slab.count[0], rows);
        EXPECT_EQ(attribute.get<std::string>("<xmlattr>.AttributeType"), slab.count.size() == 2 ? "Vector" : "Scalar");
        EXPECT_EQ(attribute.get<std::string>("<xmlattr>.Center"), points ? "Node" : "Cell");
        if (slab.path == "/contacts/pp/normal_force") {
          EXPECT_EQ(file.read_rows<float>(slab.path, slab.start[0], slab.count[0]), s.pp.normal_force);
        }
      }
      EXPECT_EQ(attributes, points ? (std::vector<std::string>{"id", "velocity", "angular_velocity", "radius",
                                                               "material", "compressive_force"})
                                   : (std::vector<std::string>{"normal_force", "damping_force", "tangential_force",
                                                               "overlap", "flags"}));
    }
    EXPECT_EQ(names,
              k == 2 ? (std::vector<std::string>{"particles"}) : (std::vector<std::string>{"particles", "contacts"}));
    ++k;
  }
  EXPECT_EQ(k, 5U);
}

TEST_F(Xdmf, ARunWithoutFramesGivesAnEmptyCollection) {
  SnapshotWriter::create(path, sample::info());
  write_xdmf(folder / "run.xdmf", path);
  EXPECT_EQ(parsed(folder / "run.xdmf").get_child("Xdmf.Domain.Grid").count("Grid"), 0U);
}

TEST_F(Xdmf, WhatCannotBeWrittenIsNamed) {
  SnapshotWriter::create(path, sample::info());
  EXPECT_THAT(sample::error_of([&] { write_xdmf(folder / "no" / "run.xdmf", path); }),
              testing::HasSubstr("run.xdmf: cannot be written"));
}

}  // namespace
}  // namespace jam
