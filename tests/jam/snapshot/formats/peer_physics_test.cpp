#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libjam/snapshot/formats/assemble.hpp"
#include "libjam/snapshot/formats/table.hpp"
#include "libjam/snapshot/open_source.hpp"
#include "tests/jam/snapshot/formats/peer_data.hpp"

namespace jam {
namespace {

using namespace jam::test;

// Sum of the forces of a snapshot's contacts on every particle, as a reader of the snapshot would add them up.
std::vector<Vec3> contact_forces(const Snapshot& s) {
  std::vector<Vec3> sum(s.particles.size(), Vec3::Zero());
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    const Vec3 n = (s.particles.position[b] - s.particles.position[a]).cast<double>().normalized();
    const Vec3 force = s.pp.tangential_force[c].cast<double>() - double{s.pp.normal_force[c]} * n;
    sum[a] += force;
    sum[b] -= force;
  }
  for (std::size_t c = 0; c < s.pw.size(); ++c) {
    sum[s.pw.row[c]] +=
        s.pw.tangential_force[c].cast<double>() - double{s.pw.normal_force[c]} * s.pw.normal[c].cast<double>();
  }
  return sum;
}

// Total force minus weight of every particle, in the order of the snapshot (ascending id).
std::vector<Vec3> driving_forces(const std::string& path, const ImportMap& map, std::size_t frame) {
  const std::vector<Field> fields = ordered_fields(map.particles.columns, known_particle_fields(), "test");
  FrameCursor cursor(path, open_frames<DumpReader>(path, fields));
  const Table table = cursor.read(frame);
  std::vector<std::pair<double, Vec3>> rows;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double radius = table.at(r, table.find("radius"));
    const double mass = 2500 * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    rows.emplace_back(table.at(r, table.find("id")), table.vector_at(r, table.find("fx")) - mass * map.gravity);
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec3> forces;
  for (const auto& row : rows) forces.push_back(row.second);
  return forces;
}

TEST(LiggghtsDump, EveryGrainAtRestIsInBalanceWithItsListedAndRecoveredContacts) {
  const ImportMap map = liggghts_map();
  const SnapshotSource source = open_source(liggghts_files(), &map);
  const Snapshot s = source.read(0);
  const std::vector<Vec3> sum = contact_forces(s), wanted = driving_forces(liggghts_files()[0], map, 0);
  ASSERT_EQ(sum.size(), wanted.size());
  ASSERT_GT(s.pp.size(), 5U);
  for (std::size_t row = 0; row < sum.size(); ++row) {
    // Six printed digits of forces up to 0.65 N; here they are below 2e-4 N (and float32 adds 1e-7 of that).
    EXPECT_LT((sum[row] - wanted[row]).norm(), 1e-9 + 2e-6 * wanted[row].norm()) << "particle " << s.particles.id[row];
  }
}

TEST(LammpsDump, GrainsWithAllTheirNeighboursAreInBalanceButForUnlistedNecks) {
  const ImportMap map = lammps_map();
  const SnapshotSource source = open_source(lammps_files(), &map);
  ASSERT_EQ(source.frames, 2U);
  for (std::size_t frame = 0; frame < source.frames; ++frame) {
    const Snapshot s = source.read(frame);
    const std::vector<Vec3> sum = contact_forces(s), wanted = driving_forces(lammps_files()[0], map, frame);
    const double angle = 21.2 * s.time;
    const Vec3 middle(0.011 * std::cos(angle), 0.011 * std::sin(angle), 0.003);
    std::vector<double> missing;
    for (std::size_t row = 0; row < sum.size(); ++row) {
      // The cut is a ball of 4.2 mm; beads are at most 1.11 mm across, so those within 3 mm have all their neighbours.
      if ((s.particles.position[row].cast<double>() - middle).norm() < 3e-3)
        missing.push_back((sum[row] - wanted[row]).norm());
    }
    ASSERT_GT(missing.size(), 60U);
    std::sort(missing.begin(), missing.end());
    // Early on the beads hardly move: six printed digits of forces around 1e-3 N leave 1e-7 N. In motion the dump's
    // second evaluation of the damping adds a few 1e-6 N.
    EXPECT_LT(missing[missing.size() / 2], frame == 0 ? 1e-7 : 1e-5);
    EXPECT_LT(missing[missing.size() * 8 / 10], frame == 0 ? 1e-7 : 3e-5);
    // The rest has necks, which are not in the dump: 1.5 pi W R* with R* <= 0.28 mm is 3.6e-4 N each.
    EXPECT_LT(missing.back(), 2 * 3.6e-4);
  }
}

TEST(LiggghtsDump, GrainsWedgedInTheGapAreLoadedByBladeAndCylinder) {
  const ImportMap map = liggghts_map();
  const SnapshotSource source = open_source(liggghts_files(), &map);
  std::vector<int> wedged;
  for (std::size_t frame = 0; frame < source.frames; ++frame) {
    const Snapshot s = source.read(frame);
    std::vector<double> by_blade(s.particles.size(), 0), by_cylinder(s.particles.size(), 0);
    for (std::size_t c = 0; c < s.pw.size(); ++c) {
      if (s.pw.wall[c] == 2) by_blade[s.pw.row[c]] += double{s.pw.normal_force[c]};
      if (s.pw.wall[c] == 1) by_cylinder[s.pw.row[c]] += double{s.pw.normal_force[c]};
    }
    int count = 0;
    for (std::size_t row = 0; row < by_blade.size(); ++row) {
      if (by_blade[row] <= 20) continue;
      ++count;
      // Within what friction on blade (0.3) and cylinder (0.5) can carry along, the two squeeze the grain equally; a
      // grain that is being accelerated differs more.
      EXPECT_GT(by_cylinder[row], 0.5 * by_blade[row]) << "step " << s.step << " particle " << s.particles.id[row];
      EXPECT_LT(by_cylinder[row], 1.5 * by_blade[row]) << "step " << s.step << " particle " << s.particles.id[row];
    }
    wedged.push_back(count);
  }
  EXPECT_EQ(wedged.size(), 4U);
  EXPECT_EQ(wedged.front(), 0);  // the blade has not moved yet
  EXPECT_THAT(std::vector<int>(wedged.begin() + 1, wedged.end()), testing::Each(testing::Ge(5)));
}

TEST(LiggghtsDump, AGrainOnTheEdgeOfTwoTrianglesGetsBothForces) {
  const ImportMap map = liggghts_map();
  const std::vector<std::string> files{data_file("liggghts_edge.particles.dump.xz"),
                                       data_file("liggghts_edge.pair.local.xz"),
                                       data_file("liggghts_edge.wall.local.xz")};
  const SnapshotSource source = open_source(files, &map);
  const ParticleId on_edge[2] = {3526, 1097};
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const Snapshot s = source.read(frame);
    const auto row = static_cast<std::size_t>(std::find(s.particles.id.begin(), s.particles.id.end(), on_edge[frame]) -
                                              s.particles.id.begin());
    ASSERT_LT(row, s.particles.size());
    const double missing = (contact_forces(s)[row] - driving_forces(files[0], map, frame)[row]).norm();
    // The two listed forces, merged into one touch.
    std::vector<double> listed;
    for (std::size_t c = 0; c < s.pw.size(); ++c) {
      if (s.pw.row[c] != row) continue;
      listed.push_back(double{s.pw.normal_force[c]});
      EXPECT_EQ(s.pw.flags[c], contact_merged);
    }
    ASSERT_EQ(listed.size(), 1U);
    // Either of them alone would leave about half of their sum. 0.3 % is what the second evaluation of the law for the
    // dump leaves in motion; at rest 1e-5, the printed digits.
    EXPECT_LT(missing, (frame == 0 ? 1e-5 : 3e-3) * listed[0]);
  }
}

TEST(LiggghtsDump, ContactPointsLieOnTheBladeWhereTheMapMovesIt) {
  const ImportMap map = liggghts_map();
  const SnapshotSource source = open_source(liggghts_files(), &map);
  for (std::size_t frame = 0; frame < source.frames; ++frame) {
    const Snapshot s = source.read(frame);
    for (std::size_t c = 0; c < s.pw.size(); ++c) {
      if (s.pw.wall[c] != 2) continue;
      const Vec3 body = s.walls[2].orientation.conjugate() * (s.pw.point[c].cast<double>() - s.walls[2].position);
      const double off = nearest_on_triangle(source.info.walls[2], s.pw.facet[c], body, 1e-7).distance;
      // Contact points have six digits (5e-8 m); a merged touch lies between its two points, 1/10 of a radius apart.
      EXPECT_LT(off, (s.pw.flags[c] & contact_merged) != 0 ? 2e-5 : 3e-7) << "step " << s.step;
    }
  }
}

TEST(LiggghtsDump, TheBladeLoadFromTheContactsIsTheOneTheCodeReports) {
  const ImportMap map = liggghts_map();
  std::vector<std::string> files = liggghts_files();
  files.push_back(data_file("liggghts.blade.txt.xz"));
  const SnapshotSource source = open_source(files, &map);
  ASSERT_EQ(source.series.size(), 90U);
  ASSERT_EQ(source.series.walls.size(), 3U);
  const Snapshot s = source.read(3);
  const auto row =
      static_cast<std::size_t>(std::lower_bound(source.series.time.begin(), source.series.time.end(), s.time - 1e-9) -
                               source.series.time.begin());
  ASSERT_NEAR(source.series.time[row], s.time, 1e-9);
  const Vec3 reported = source.series.walls[2].force[row];
  // The cut leaves out beads with small forces on the blade, the largest 0.1 N, and the report is of one step earlier.
  EXPECT_LT((s.walls[2].force - reported).norm(), 0.01 * reported.norm());
  EXPECT_NEAR(s.walls[2].torque.z(), source.series.walls[2].torque[row].z(),
              0.01 * std::abs(source.series.walls[2].torque[row].z()));
  // The blade pushes the grains: it puts power in.
  EXPECT_GT(source.series.walls[2].power[row], 0);
}

TEST(LammpsDump, WallArraysGiveTheSameGapAndNormalsTowardsTheirWalls) {
  const ImportMap map = lammps_map();
  const SnapshotSource source = open_source(lammps_files(), &map);
  EXPECT_NEAR(source.info.gap.tip_radius, std::hypot(11.15e-3, 3.7e-3), 1e-9);
  EXPECT_DOUBLE_EQ(source.info.gap.vessel_radius, 12.5e-3);
  EXPECT_NEAR(source.info.gap.z_low, -3e-3, 1e-9);
  EXPECT_NEAR(source.info.gap.z_high, 3e-3, 1e-9);
  const Snapshot s = source.read(1);
  EXPECT_NEAR(s.time, 0.025, 1e-12);
  std::size_t on_wing = 0;
  for (std::size_t c = 0; c < s.pw.size(); ++c) {
    const Vec3 n = s.pw.normal[c].cast<double>(), p = s.pw.point[c].cast<double>();
    if (s.pw.wall[c] == 0) {
      EXPECT_NEAR(n.z(), -1, 1e-6);
      EXPECT_NEAR(p.z(), 0, 1e-9);
    } else if (s.pw.wall[c] == 1) {
      EXPECT_NEAR(std::hypot(p.x(), p.y()), 12.5e-3, 1e-7);  // six printed digits
    } else {
      ++on_wing;
      const Vec3 body = s.walls[2].orientation.conjugate() * (p - s.walls[2].position);
      double nearest = 1;
      for (std::uint32_t t = 0; t < 12; ++t)
        nearest = std::min(nearest, nearest_on_triangle(source.info.walls[2], t, body, 1e-7).distance);
      EXPECT_LT(nearest, 3e-7);
    }
  }
  EXPECT_GT(on_wing, 3U);
}

}  // namespace
}  // namespace jam
