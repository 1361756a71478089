// Metrics of real frames (quick case, LAMMPS, LIGGGHTS) and of random geometric graphs against networkx, igraph, GUDHI, voro++, scipy and
// numpy. The values and the script that made them are in data/reference/networks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "libjam/graph/contact_length.hpp"
#include "libjam/metrics/clustering_metrics.hpp"
#include "libjam/metrics/community_metrics.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/snapshot/reader.hpp"
#include "tests/jam/graph/hand_made_network.hpp"
#include "tests/support/csv.hpp"

namespace jam {
namespace {

const char folder[] = JAMSCOPE_DATA_DIR "/reference/networks/";

std::map<std::string, Snapshot> read_networks() {
  std::map<std::string, Snapshot> networks;
  std::map<std::string, std::map<std::string, std::uint32_t>> row;
  for (const support::Row& line : support::read_csv(std::string(folder) + "networks.csv")) {
    Snapshot& s = networks[line.at("network")];
    std::map<std::string, std::uint32_t>& rows = row[line.at("network")];
    const float value = std::stof(line.at("value"));
    const std::string& kind = line.at("kind");
    if (kind == "grain") {
      rows[line.at("a")] = std::uint32_t(s.particles.size());
      s.particles.id.push_back(ParticleId(std::stoul(line.at("a"))));
      s.particles.position.emplace_back(value, std::stof(line.at("y")), std::stof(line.at("z")));
      s.particles.radius.push_back(std::stof(line.at("radius")));
    } else if (kind == "touch") {
      s.pp.row.push_back({rows.at(line.at("a")), rows.at(line.at("b"))});
      s.pp.normal_force.push_back(value);
    } else {
      s.pw.row.push_back(rows.at(line.at("a")));
      s.pw.wall.push_back(kind == "blade" ? hand_made::blade_wall : hand_made::vessel_wall);
      s.pw.normal_force.push_back(value);
    }
  }
  return networks;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

Communities components_as_communities(FrameNetwork& n) {
  return {n.components().label, n.components().size, 0, 0};
}

// Not in the tables as they are.
const std::map<std::string, std::function<double(FrameNetwork&)>> others{
    {"largest_betweenness", [](FrameNetwork& n) { return largest(betweenness(n.graph).particle); }},
    {"largest_contact_betweenness", [](FrameNetwork& n) { return largest(betweenness(n.graph).contact); }},
    {"largest_force_betweenness", [](FrameNetwork& n) { return largest(betweenness(n.graph, inverse_forces(n.graph)).particle); }},
    {"largest_contact_force_betweenness", [](FrameNetwork& n) { return largest(betweenness(n.graph, inverse_forces(n.graph)).contact); }},
    {"force_efficiency", [](FrameNetwork& n) { return path_lengths(n.graph, inverse_forces(n.graph)).efficiency; }},
    {"gap_factor_of_components", [](FrameNetwork& n) { return gap_factor(n.graph, components_as_communities(n)); }},
    {"hull_ratio_of_components", [](FrameNetwork& n) { return hull_ratio(n.graph, components_as_communities(n)); }},
    {"mean_force_clustering",
     [](FrameNetwork& n) {
       double sum = 0, count = 0;
       for (const double c : force_clustering(n.graph))
         if (!std::isnan(c)) sum += c, count += 1;
       return sum / count;
     }},
    {"mean_largest_compression",
     [](FrameNetwork& n) {
       double sum = 0;
       for (const Load& load : n.loads()) sum += load.pressure;
       return sum / double(n.loads().size());
     }},
    {"zero_modes_without_walls", [](FrameNetwork& n) { return double(n.rigid().zero_modes()); }},
    {"self_stresses_without_walls", [](FrameNetwork& n) { return double(n.rigid().self_stresses()); }},
};

// The walls of these networks are forces without place or direction; the tessellation has no use for them.
RunInfo run_of_networks() {
  RunInfo run = hand_made::hand_made_run();
  for (Wall& wall : run.walls) wall.kind = "mesh";
  return run;
}

TEST(MetricsReference, RealFramesAndRandomGraphsAgreeWithIndependentPrograms) {
  const std::map<std::string, Snapshot> networks = read_networks();
  EXPECT_EQ(networks.size(), 53u);
  const RunInfo run = run_of_networks();
  std::map<std::string, std::pair<std::unique_ptr<ContactGraph>, std::unique_ptr<FrameNetwork>>> known;
  for (const auto& [name, snapshot] : networks) {
    auto& [graph, network] = known[name];
    graph = std::make_unique<ContactGraph>(snapshot, run.walls);
    network = std::make_unique<FrameNetwork>(*graph, run);
  }
  std::map<std::string, std::size_t> compared;
  for (const support::Row& line : support::read_csv(std::string(folder) + "metrics.csv")) {
    const std::string& name = line.at("network");
    const std::string& metric = line.at("metric");
    FrameNetwork& network = *known.at(name).second;
    ++compared[metric];
    const double expected = std::stod(line.at("value"));
    SCOPED_TRACE(metric + " of " + name);
    const auto change = std::find_if(change_metrics().begin(), change_metrics().end(), [&](const ChangeMetric& m) { return m.name == metric; });
    if (change != change_metrics().end()) {
      const std::string before = "geometric_" + std::to_string(std::stoi(name.substr(10)) - 1);
      // POT's solver stops at 1e-9 or so of its costs.
      EXPECT_NEAR(change->value(*known.at(before).second, network), expected, 1e-9 * std::max(1.0, expected));
    } else if (metric == "modularity") {
      // Two searches for a maximum that neither is sure to find: ours may be better, and what it says it has it must have.
      EXPECT_GE(network.groups().modularity, 0.99 * expected);
      EXPECT_NEAR(network.groups().quality, community_quality(network.graph, network.groups().label), 1e-12);
    } else {
      const Metric* const row = find_metric(metric);
      ASSERT_TRUE(row != nullptr || others.count(metric));
      const double value = row != nullptr ? row->value(network) : others.at(metric)(network);
      // Sums in another order: a rounding for each of up to 3000 terms, of which most cancel. Eigenvalues of a thousand
      // rows lose some digits more, and numpy's arccosine half of them where a chain is straight.
      const double relative = metric == "algebraic_connectivity" ? 1e-10 : metric == "chain_bend" ? 1e-7 : 1e-12;
      EXPECT_NEAR(value, expected, relative * std::max(1.0, std::abs(expected)));
    }
  }
  EXPECT_EQ(compared.size(), 60u);
  // Chains have a shape where there are chains; distances lead from one random network to the next.
  for (const auto& [metric, count] : compared) EXPECT_GE(count, metric.find("chain") == std::string::npos ? 49u : 20u) << metric;
}

// Friction, ages, what becomes of contacts, and jams, in three frames of a small run, against h5py, numpy and networkx.
TEST(MetricsReference, FramesOfARunAgreeWithIndependentPrograms) {
  const SnapshotSource source = open_jamscope_file(std::string(folder) + "pea.h5");
  ASSERT_EQ(source.frames, 3u);
  Criteria criteria;
  criteria.jam_force = 0.5;
  std::vector<Snapshot> frames;
  for (std::size_t k = 0; k < 3; ++k) frames.push_back(source.read(k));
  std::vector<std::unique_ptr<ContactGraph>> graphs;
  std::vector<std::unique_ptr<FrameNetwork>> networks;
  for (const Snapshot& frame : frames) {
    graphs.push_back(std::make_unique<ContactGraph>(frame, source.info.walls));
    networks.push_back(std::make_unique<FrameNetwork>(*graphs.back(), source.info, criteria));
  }
  std::size_t compared = 0;
  for (const support::Row& line : support::read_csv(std::string(folder) + "pea.csv")) {
    const auto k = std::size_t(std::stoul(line.at("frame")));
    const std::string& metric = line.at("metric");
    SCOPED_TRACE(metric + " of frame " + line.at("frame"));
    const auto change = std::find_if(change_metrics().begin(), change_metrics().end(), [&](const ChangeMetric& m) { return m.name == metric; });
    const Metric* const row = find_metric(metric);
    ASSERT_TRUE((change != change_metrics().end()) != (row != nullptr));
    const double value = row != nullptr ? row->value(*networks[k]) : change->value(*networks[k - 1], *networks[k]);
    const double expected = std::stod(line.at("value"));
    EXPECT_NEAR(value, expected, 1e-12 * std::max(1e-3, std::abs(expected)));
    ++compared;
  }
  EXPECT_EQ(compared, 3u * 6 + 2 * 4);
}

// In the box around all spheres of the network, as the script gives it to voro++. Cells that are open to us, farther than four radii,
// voro++ closes at the box.
TEST(MetricsReference, VolumesOfPowerCellsAgreeWithVoro) {
  const std::map<std::string, Snapshot> networks = read_networks();
  std::map<std::string, std::map<ParticleId, double>> volume;
  for (const char* name : {"quick", "lammps", "liggghts"}) {
    Snapshot s = networks.at(name);
    std::vector<Wall> box(6);
    for (int k = 0; k < 3; ++k) {
      double low = 1e9, high = -1e9;
      for (std::size_t v = 0; v < s.particles.size(); ++v) {
        low = std::min(low, double{s.particles.position[v][k]} - double{s.particles.radius[v]});
        high = std::max(high, double{s.particles.position[v][k]} + double{s.particles.radius[v]});
      }
      for (Wall* wall : {&box[std::size_t(2 * k)], &box[std::size_t(2 * k + 1)]}) wall->kind = "plane";
      box[std::size_t(2 * k)].point = low * Vec3::Unit(k), box[std::size_t(2 * k)].axis = Vec3::Unit(k);
      box[std::size_t(2 * k + 1)].point = high * Vec3::Unit(k), box[std::size_t(2 * k + 1)].axis = -Vec3::Unit(k);
    }
    s.walls.resize(6);
    const std::vector<double> found = power_cell_volumes(s, box);
    for (std::size_t v = 0; v < found.size(); ++v) volume[name][s.particles.id[v]] = found[v];
  }
  std::size_t closed = 0;
  for (const support::Row& line : support::read_csv(std::string(folder) + "cells.csv")) {
    const double ours = volume.at(line.at("network")).at(ParticleId(std::stoul(line.at("id")))), voro = std::stod(line.at("volume"));
    if (std::isnan(ours)) continue;
    ++closed;
    EXPECT_NEAR(ours, voro, 6e-6 * voro) << line.at("network") << " " << line.at("id");  // it prints six digits
  }
  EXPECT_GT(closed, 2900u);
}

}  // namespace
}  // namespace jam
