// Metrics of real frames (quick case, LAMMPS, LIGGGHTS) and of random geometric graphs against networkx and numpy. The values and the
// script that made them are in data/reference/networks.
#include <gtest/gtest.h>

#include <map>

#include "libjam/metrics/metrics.hpp"
#include "tests/jam/graph/hand_made_network.hpp"
#include "tests/support/csv.hpp"

namespace jam {
namespace {

std::map<std::string, Snapshot> read_networks() {
  std::map<std::string, Snapshot> networks;
  std::map<std::string, std::map<std::string, std::uint32_t>> row;
  for (const support::Row& line : support::read_csv(JAMSCOPE_DATA_DIR "/reference/networks/networks.csv")) {
    Snapshot& s = networks[line.at("network")];
    std::map<std::string, std::uint32_t>& rows = row[line.at("network")];
    const float value = std::stof(line.at("value"));
    const std::string& kind = line.at("kind");
    if (kind == "grain") {
      rows[line.at("a")] = std::uint32_t(s.particles.size());
      s.particles.id.push_back(ParticleId(std::stoul(line.at("a"))));
      s.particles.position.emplace_back(value, std::stof(line.at("y")), std::stof(line.at("z")));
      s.particles.radius.push_back(1e-3f);
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

TEST(MetricsReference, RealFramesAndRandomGraphsAgreeWithNetworkxAndNumpy) {
  const std::map<std::string, Snapshot> networks = read_networks();
  EXPECT_EQ(networks.size(), 53u);
  const RunInfo run = hand_made::hand_made_run();
  std::size_t compared = 0;
  for (const support::Row& line : support::read_csv(JAMSCOPE_DATA_DIR "/reference/networks/metrics.csv")) {
    const Metric* const metric = find_metric(line.at("metric"));
    ASSERT_NE(metric, nullptr) << line.at("metric");
    const ContactGraph graph(networks.at(line.at("network")), run.walls);
    FrameNetwork network(graph);
    const double expected = std::stod(line.at("value"));
    // Sums in another order: a rounding for each of up to 3000 terms, of which most cancel.
    EXPECT_NEAR(metric->value(network), expected, 1e-12 * std::max(1.0, std::abs(expected)))
        << line.at("metric") << " of " << line.at("network");
    ++compared;
  }
  EXPECT_EQ(compared, 53u * 22);
}

}  // namespace
}  // namespace jam
