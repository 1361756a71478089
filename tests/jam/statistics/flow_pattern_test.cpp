#include "libjam/statistics/flow_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "libjam/jamming/gap.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;

// Of hand_made_run(): rings of 11/6 mm, layers of 4/3 mm from 6 mm below the blade's origin to 6 mm above it.
const RunInfo info = hand_made_run();
const double tip_radius = info.gap.tip_radius, ring_width = info.gap.vessel_radius / FlowBin::rings, layer_height = 4e-3 / 3, lowest = -6e-3;
const Criteria criteria;

Snapshot frame_of(double angular_velocity, const Vec3& blade = Vec3::Zero()) {
  Snapshot s;
  s.walls.resize(3);
  s.walls[blade_wall].position = blade;
  s.walls[blade_wall].angular_velocity = Vec3(0, 0, angular_velocity);
  return s;
}

void put(Snapshot& s, const Vec3& position, const Vec3& velocity, double radius = 1e-4) {
  s.particles.id.push_back(ParticleId(s.particles.size()));
  s.particles.position.push_back(position.cast<float>());
  s.particles.velocity.push_back(velocity.cast<float>());
  s.particles.radius.push_back(float(radius));
}

// In each bin, outside the gap, 120 grains evenly around the axis at one distance from it; velocity_at(position from the blade).
constexpr int around = 120;
double radius_in(std::size_t ring) { return (double(ring) + 0.3) * ring_width; }
template <class VelocityAt>
Snapshot rings_of_grains(double angular_velocity, const Vec3& blade, VelocityAt velocity_at) {
  Snapshot s = frame_of(angular_velocity, blade);
  for (std::size_t layer = 0; layer < FlowBin::layers; ++layer)
    for (std::size_t ring = 0; ring < FlowBin::rings; ++ring)
      for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.5) / around, r = radius_in(ring);
        const Vec3 at(r * std::cos(angle), r * std::sin(angle), lowest + (double(layer) + 0.4) * layer_height);
        put(s, blade + at, velocity_at(at));
      }
  return s;
}

std::vector<FlowBin> pattern_of(const std::vector<Snapshot>& frames, const RunInfo& run = info) {
  FlowSums sums;
  for (const Snapshot& s : frames) add(sums, flow_sums(s, run, criteria));
  return flow_pattern(sums, run.gap);
}

double uniform(std::mt19937_64& random, double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1.0p-53; }

// Grains everywhere, some out of all bins and some in the gap, none within `margin` of an edge of a bin or of the gap.
Snapshot random_frame(unsigned seed, std::size_t grains, double margin = 0) {
  std::mt19937_64 random(seed);
  const double omega = uniform(random, 2, 20), blade_x = uniform(random, -1e-3, 1e-3);
  Snapshot s = frame_of(omega, Vec3(blade_x, 2e-3, uniform(random, -1e-3, 1e-3)));
  s.walls[blade_wall].velocity = Vec3(0, 0, -0.02);
  const auto near = [&](double x, double edge) { return std::abs(x - edge) < margin; };
  while (s.particles.size() < grains) {
    const Vec3 at(uniform(random, -0.012, 0.012), uniform(random, -0.012, 0.012), uniform(random, -0.008, 0.008));
    const Vec3 velocity(uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2));
    const double radius = uniform(random, 3e-4, 6e-4), r = std::hypot(at.x(), at.y());
    bool on_edge = near(r, tip_radius - radius) || near(std::abs(at.z()), 2e-3 + 2 * radius) || r < 3e2 * margin;
    for (std::size_t k = 0; k <= FlowBin::rings; ++k) on_edge = on_edge || near(r, double(k) * ring_width);
    for (std::size_t k = 0; k <= FlowBin::layers; ++k) on_edge = on_edge || near(at.z(), lowest + double(k) * layer_height);
    if (!on_edge) put(s, s.walls[blade_wall].position + at, velocity, radius);
  }
  return s;
}

void expect_near(const std::vector<FlowBin>& a, const std::vector<FlowBin>& b, double tolerance) {
  ASSERT_EQ(a.size(), FlowBin::count);
  ASSERT_EQ(b.size(), FlowBin::count);
  std::size_t known = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(a[k].samples, b[k].samples);
    for (const auto mean : {&FlowBin::azimuthal, &FlowBin::radial, &FlowBin::vertical}) {
      ASSERT_EQ(std::isnan(a[k].*mean), std::isnan(b[k].*mean));
      if (std::isnan(a[k].*mean)) continue;
      EXPECT_NEAR(a[k].*mean, b[k].*mean, tolerance);
      ++known;
    }
  }
  EXPECT_GT(known, FlowBin::count);  // most of them
}

bool same(const FlowSums::Bin& a, const FlowSums::Bin& b) {
  return a.samples == b.samples && a.tip == b.tip && a.azimuthal == b.azimuthal && a.radial == b.radial && a.vertical == b.vertical;
}

TEST(FlowPattern, BinsFollowFromTheGeometryAlone) {
  const std::vector<FlowBin> pattern = pattern_of({frame_of(10)});
  ASSERT_EQ(pattern.size(), FlowBin::count);
  EXPECT_EQ(pattern.front().radius_low, 0);
  EXPECT_DOUBLE_EQ(pattern.back().radius_high, 0.011);
  EXPECT_DOUBLE_EQ(pattern.front().height_low, -0.006);
  EXPECT_NEAR(pattern.back().height_high, 0.006, 1e-17);  // rounding
  for (std::size_t k = 0; k < FlowBin::count; ++k) {
    EXPECT_EQ(pattern[k].radius_low, k % FlowBin::rings > 0 ? pattern[k - 1].radius_high : 0.0);
    EXPECT_EQ(pattern[k].height_low, k >= FlowBin::rings ? pattern[k - FlowBin::rings].height_high : pattern[0].height_low);
  }
}

// What turns with the blade has r/R, also while the blade speeds up: positions and velocities are floats, each right to 6e-8.
TEST(FlowPattern, OfARigidRotationIsTheRadiusOverThatOfTheTip) {
  for (const Vec3& blade : {Vec3(0, 0, 0), Vec3(4e-3, -3e-3, 7e-3)}) {
    std::vector<Snapshot> frames;
    for (const double omega : {0.5, 20.0}) frames.push_back(rings_of_grains(omega, blade, [&](const Vec3& at) { return Vec3(Vec3(0, 0, omega).cross(at)); }));
    const std::vector<FlowBin> pattern = pattern_of(frames);
    // About the origin only the velocity is rounded; elsewhere places are, to half a unit of 1e-2 m, 5e-10 m.
    const double tolerance = blade.isZero() ? 2e-7 : 5e-10 / radius_in(0) + 2e-7;
    for (std::size_t k = 0; k < FlowBin::count; ++k) {
      EXPECT_EQ(pattern[k].samples, 2u * around);
      EXPECT_NEAR(pattern[k].azimuthal, radius_in(k % FlowBin::rings) / tip_radius, tolerance);
      EXPECT_NEAR(pattern[k].radial, 0, tolerance);
      EXPECT_EQ(pattern[k].vertical, 0);
    }
  }
}

// All grains at one velocity: only its vertical part is left around the axis. The blade sinks too, which makes its tip faster.
TEST(FlowPattern, OfATranslationIsItsVerticalPart) {
  Snapshot s = rings_of_grains(20, Vec3(0, 0, 1e-3), [](const Vec3&) { return Vec3(0.1, -0.05, 0.03); });
  s.walls[blade_wall].velocity = Vec3(0, 0, -0.15);
  for (const FlowBin& bin : pattern_of({s})) {
    EXPECT_NEAR(bin.vertical, 0.03 / 0.25, 1e-7);  // hypot(20 * 0.01, 0.15) = 0.25; floats
    EXPECT_NEAR(bin.azimuthal, 0, 1e-6);           // 120 places around the axis, each a float
    EXPECT_NEAR(bin.radial, 0, 1e-6);
  }
}

TEST(FlowPattern, RadialIsOutward) {
  const auto outward = [](const Vec3& at) { return Vec3(0.1 * Vec3(at.x(), at.y(), 0).normalized()); };
  for (const FlowBin& bin : pattern_of({rings_of_grains(20, Vec3::Zero(), outward)})) {
    EXPECT_NEAR(bin.radial, 0.5, 1e-6);
    EXPECT_NEAR(bin.azimuthal, 0, 1e-6);
  }
}

// Mirrored, with the blade turning the other way, the pattern is the same to the last bit; where only the blade turns the other way, grains go against it.
TEST(FlowPattern, IsPositiveAlongTheBladesOwnSense) {
  const Snapshot s = random_frame(1, 20'000);
  Snapshot mirrored = s, reversed = s;
  mirrored.walls[blade_wall].position.y() *= -1;
  mirrored.walls[blade_wall].angular_velocity *= -1;
  reversed.walls[blade_wall].angular_velocity *= -1;
  for (std::size_t k = 0; k < s.particles.size(); ++k) mirrored.particles.position[k].y() *= -1, mirrored.particles.velocity[k].y() *= -1;
  expect_near(pattern_of({s}), pattern_of({mirrored}), 0);
  std::vector<FlowBin> against = pattern_of({reversed});
  for (FlowBin& bin : against) bin.azimuthal *= -1;
  expect_near(pattern_of({s}), against, 0);
}

TEST(FlowPattern, DoesNotChangeWhenEverythingIsTurnedAndMoved) {
  const Snapshot s = random_frame(2, 20'000, 1e-6);
  const Eigen::AngleAxisd turn(0.7, Vec3::UnitZ());
  const Vec3 shift(3e-3, -4e-3, 5e-3);
  Snapshot moved = s;
  moved.walls[blade_wall].position = turn * s.walls[blade_wall].position + shift;
  for (std::size_t k = 0; k < s.particles.size(); ++k) {
    moved.particles.position[k] = (turn * s.particles.position[k].cast<double>() + shift).cast<float>();
    moved.particles.velocity[k] = (turn * s.particles.velocity[k].cast<double>()).cast<float>();
  }
  // Places are floats of up to 0.02 m, right to 1e-9 m; at the least distance from the axis of 0.3 mm a direction is, to 3e-6, at up to a few tip speeds.
  expect_near(pattern_of({s}), pattern_of({moved}), 2e-5);
}

// Bin by bin and component by component as the header says it, in long double.
std::vector<FlowBin> by_brute_force(const std::vector<Snapshot>& frames, std::vector<FlowBin> bins) {
  for (FlowBin& bin : bins) {
    bin.samples = 0;
    long double tip = 0, azimuthal = 0, radial = 0, vertical = 0;
    for (const Snapshot& s : frames) {
      const WallState& blade = s.walls[blade_wall];
      for (std::size_t k = 0; k < s.particles.size(); ++k) {
        const Vec3 at = s.particles.position[k].cast<double>() - blade.position, v = s.particles.velocity[k].cast<double>();
        const double r = std::hypot(at.x(), at.y()), d = 2 * double{s.particles.radius[k]};
        if (r < bin.radius_low || r >= bin.radius_high || at.z() < bin.height_low || at.z() >= bin.height_high) continue;
        if (r > tip_radius - 0.5 * d && at.z() >= -2e-3 - d && at.z() <= 2e-3 + d) continue;
        const double angle = std::atan2(at.y(), at.x()), volume = d * d * d;
        ++bin.samples;
        azimuthal += volume * (-std::sin(angle) * v.x() + std::cos(angle) * v.y());
        radial += volume * (std::cos(angle) * v.x() + std::sin(angle) * v.y());
        vertical += volume * v.z();
        tip += volume * std::hypot(blade.angular_velocity.z() * tip_radius, blade.velocity.z());
      }
    }
    const bool known = bin.samples >= 100;
    bin.azimuthal = known ? double(azimuthal / tip) : NAN;
    bin.radial = known ? double(radial / tip) : NAN;
    bin.vertical = known ? double(vertical / tip) : NAN;
  }
  return bins;
}

TEST(FlowPattern, IsWhatBruteForceFinds) {
  std::vector<Snapshot> frames;
  for (unsigned k = 0; k < 12; ++k) frames.push_back(random_frame(10 + k, 1500));
  const std::vector<FlowBin> pattern = pattern_of(frames);
  // Doubles: 1e-16 of some thousand terms. Rarely visited bins are there too.
  expect_near(pattern, by_brute_force(frames, pattern), 1e-12);
  EXPECT_TRUE(std::any_of(pattern.begin(), pattern.end(), [](const FlowBin& bin) { return bin.samples < FlowBin::least_samples; }));
}

TEST(FlowPattern, WeighsGrainsByTheirVolume) {
  Snapshot s = frame_of(20);
  for (int k = 0; k < 100; ++k) put(s, Vec3(5e-3, 0, 0), Vec3(0, 0, k % 2 ? 0.1 : 0.2), k % 2 ? 1e-4 : 2e-4);
  EXPECT_NEAR(pattern_of({s})[4 * FlowBin::rings + 2].vertical, (0.1 + 8 * 0.2) / 9 / 0.2, 1e-7);  // floats
}

// Grains in the gap count nowhere, those beside it in the same ring do.
TEST(FlowPattern, LeavesOutTheGap) {
  const auto still = [](const Vec3&) { return Vec3(0, 0, 0.01); };
  Snapshot s = rings_of_grains(20, Vec3::Zero(), still);
  const std::vector<FlowBin> without = pattern_of({s});
  // Of radius 0.1 mm: the gap is beyond 9.9 mm, from 2.2 mm below the blade's origin to as much above.
  for (const double z : {-2.19e-3, 0.0, 2.19e-3})
    for (const double r : {9.91e-3, 10.5e-3}) put(s, Vec3(r, 0, z), Vec3(5, 5, 5));
  expect_near(pattern_of({s}), without, 0);
  put(s, Vec3(9.89e-3, 0, 0.1e-3), Vec3(0, 0, 0.01));
  put(s, Vec3(10.5e-3, 0, 2.21e-3), Vec3(0, 0, 0.01));
  std::vector<FlowBin> more = pattern_of({s});
  for (const std::size_t bin : {4 * FlowBin::rings + 5, 6 * FlowBin::rings + 5}) {
    EXPECT_EQ(more[bin].samples, without[bin].samples + 1) << bin;
    --more[bin].samples;
  }
  expect_near(more, without, 1e-12);  // rounding: all go at the same velocity
}

// The pattern is that around the first blade; what is in the gap of another one is left out of it.
TEST(FlowPattern, LeavesOutTheGapsOfAllBlades) {
  RunInfo run = info;
  run.walls.push_back(info.walls[blade_wall]);
  Snapshot s = random_frame(6, 20'000);
  s.walls.push_back(s.walls[blade_wall]);
  s.walls.back().position += Vec3(2e-3, 0, 5e-3);
  Snapshot kept = frame_of(0);
  kept.walls = s.walls;
  for (std::size_t k = 0; k < s.particles.size(); ++k)
    if (!in_gap(s, k, run, criteria)) put(kept, s.particles.position[k].cast<double>(), s.particles.velocity[k].cast<double>(), s.particles.radius[k]);
  ASSERT_LT(kept.particles.size(), s.particles.size());
  kept.walls.pop_back();
  expect_near(pattern_of({s}, run), pattern_of({kept}), 0);
}

TEST(FlowPattern, DoesNotDependOnHowFramesAreGroupedAndAdded) {
  std::vector<FlowSums> frames;
  for (unsigned k = 0; k < 40; ++k) frames.push_back(flow_sums(random_frame(100 + k, 500), info, criteria));
  FlowSums in_order;
  for (const FlowSums& sums : frames) add(in_order, sums);
  std::mt19937_64 random(5);
  for (int repetition = 0; repetition < 20; ++repetition) {
    std::vector<FlowSums> left = frames;
    while (left.size() > 1) {
      std::swap(left[random() % left.size()], left.back());
      FlowSums& other = left[random() % (left.size() - 1)];
      add(other, left.back());
      left.pop_back();
    }
    EXPECT_TRUE(std::equal(left[0].bins.begin(), left[0].bins.end(), in_order.bins.begin(), in_order.bins.end(), same));
  }
}

TEST(FlowPattern, IsUnknownInBinsThatAreRarelyVisited) {
  Snapshot s = frame_of(20);
  for (std::uint64_t k = 0; k < FlowBin::least_samples - 1; ++k) put(s, Vec3(5e-3, 0, 0), Vec3(0, 0.1, 0));
  const std::size_t bin = 4 * FlowBin::rings + 2;
  EXPECT_EQ(pattern_of({s})[bin].samples, FlowBin::least_samples - 1);
  EXPECT_TRUE(std::isnan(pattern_of({s})[bin].azimuthal) && std::isnan(pattern_of({s})[bin].radial) && std::isnan(pattern_of({s})[bin].vertical));
  put(s, Vec3(5e-3, 0, 0), Vec3(0, 0.1, 0));
  EXPECT_NEAR(pattern_of({s})[bin].azimuthal, 0.5, 1e-7);  // floats
  EXPECT_TRUE(std::isnan(pattern_of({s})[0].azimuthal));
}

TEST(FlowPattern, IsAbsentWhereSomethingIsNotKnown) {
  const Snapshot s = random_frame(3, 100);
  ASSERT_EQ(flow_sums(s, info, criteria).bins.size(), FlowBin::count);
  RunInfo run = info;
  run.gap.tip_radius = 0;
  EXPECT_TRUE(pattern_of({s}, run).empty());
  run.gap = info.gap;
  run.gap.vessel_radius = 0;
  EXPECT_TRUE(pattern_of({s}, run).empty());
  run.gap = info.gap;
  run.gap.z_high = run.gap.z_low;
  EXPECT_TRUE(pattern_of({s}, run).empty());
  run = info;
  run.walls[blade_wall].role = WallRole::other;
  EXPECT_TRUE(pattern_of({s}, run).empty());
  Snapshot still = s, slow = s;
  still.walls[blade_wall].angular_velocity = Vec3(3, 0, 0);  // but not about the vertical
  slow.particles.velocity.clear();
  EXPECT_TRUE(pattern_of({still, slow}).empty());
  // Such frames change nothing beside others; nor do frames without grains, which have bins and no samples.
  expect_near(pattern_of({still, random_frame(4, 20'000), slow, frame_of(20)}), pattern_of({random_frame(4, 20'000)}), 0);
  const std::vector<FlowBin> nothing = pattern_of({frame_of(20)});
  EXPECT_TRUE(std::all_of(nothing.begin(), nothing.end(), [](const FlowBin& bin) { return bin.samples == 0 && std::isnan(bin.vertical); }));
}

// Numbers that no flow has give a number, and grains on the axis none to a direction that they do not have.
TEST(FlowPattern, StandsWhateverNumbersThereAre) {
  Snapshot s = frame_of(20);
  for (int k = 0; k < 100; ++k) put(s, Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1));
  for (int k = 0; k < 100; ++k) put(s, Vec3(5e-3, 0, 0), Vec3(0, 3e38, -3e38));
  const std::vector<FlowBin> pattern = pattern_of({s});
  const FlowBin &axis = pattern[4 * FlowBin::rings], &huge = pattern[4 * FlowBin::rings + 2];
  EXPECT_EQ(axis.azimuthal, 0);
  EXPECT_EQ(axis.radial, 0);
  EXPECT_NEAR(axis.vertical, 0.5, 1e-7);  // floats
  EXPECT_EQ(huge.samples, 100u);
  // The bound of a sum, 2^20 m/s, over 100 grains of a hundredth of the tip's radius at its speed of 0.2 m/s; the radius is a float.
  EXPECT_NEAR(huge.azimuthal / (0x1p20 / (100 * 1e-6 * 0.2)), 1, 2e-7);
  EXPECT_EQ(huge.vertical, -huge.azimuthal);
}

}  // namespace
}  // namespace jam
