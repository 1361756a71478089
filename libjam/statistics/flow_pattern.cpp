#include "libjam/statistics/flow_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libjam/events/blade_pose.hpp"
#include "libjam/jamming/gap.hpp"

namespace jam {
namespace {

__extension__ using Int128 = __int128;
__extension__ using Word128 = unsigned __int128;
constexpr int fraction_bits = 80;
constexpr double largest = 0x1p20;

Word128 word_of(const ExactSum& sum) { return (Word128(sum[1]) << 64) | Word128(sum[0]); }
ExactSum sum_of(Word128 word) { return {std::uint64_t(word), std::uint64_t(word >> 64)}; }

ExactSum exact(double value) {
  const double bounded = std::abs(value) < largest ? value : std::copysign(largest, value);
  return sum_of(Word128(Int128(std::ldexp(bounded, fraction_bits))));
}
void add(ExactSum& sum, const ExactSum& more) { sum = sum_of(word_of(sum) + word_of(more)); }
double value_of(const ExactSum& sum) { return std::ldexp(double(Int128(word_of(sum))), -fraction_bits); }

// m, of a layer of bins, and where the lowest begins.
double layer_height(const Gap& gap) { return 3 * (gap.z_high - gap.z_low) / double(FlowBin::layers); }
double lowest(const Gap& gap) { return gap.z_low - (gap.z_high - gap.z_low); }
double ring_width(const Gap& gap) { return gap.vessel_radius / double(FlowBin::rings); }

}  // namespace

bool flow_bins_known(const Gap& gap) { return gap.tip_radius > 0 && gap.vessel_radius > 0 && gap.z_high > gap.z_low; }

FlowSums flow_sums(const Snapshot& snapshot, const RunInfo& info, const Criteria& criteria) {
  const Particles& p = snapshot.particles;
  const BladePose blade = blade_of(snapshot, info.walls);
  const double turning = blade.angular_velocity.z();
  if (!flow_bins_known(info.gap) || turning == 0 || !present(p.velocity, p.size())) return {};
  const double low = lowest(info.gap), per_layer = 1 / layer_height(info.gap), per_ring = 1 / ring_width(info.gap), sense = std::copysign(1.0, turning);
  // Of further blades, whose gaps are left out too.
  std::vector<Vec3> others;
  for (std::size_t w = 0, blades = 0; w < info.walls.size(); ++w)
    if (info.walls[w].role == WallRole::blade && blades++ > 0) others.push_back(snapshot.walls[w].position);
  struct Sums {
    std::uint64_t samples = 0;
    double volume = 0, azimuthal = 0, radial = 0, vertical = 0;
  };
  std::array<Sums, FlowBin::count> here{};
  for (std::size_t k = 0; k < p.size(); ++k) {
    // The height first: most grains of a deep bed are out of it.
    const double z = double{p.position[k].z()} - blade.position.z(), layer = (z - low) * per_layer;
    if (!(layer >= 0 && layer < double(FlowBin::layers))) continue;
    const double x = double{p.position[k].x()} - blade.position.x(), y = double{p.position[k].y()} - blade.position.y(), r = std::sqrt(x * x + y * y);
    const double ring = r * per_ring, diameter = 2 * double{p.radius[k]};
    if (!(ring < double(FlowBin::rings)) || beside_tip(r, z, diameter, info.gap, criteria)) continue;
    const auto beside = [&](const Vec3& other) {
      const Vec3 from = p.position[k].cast<double>() - other;
      return beside_tip(std::hypot(from.x(), from.y()), from.z(), diameter, info.gap, criteria);
    };
    if (std::any_of(others.begin(), others.end(), beside)) continue;
    const Vec3 v = p.velocity[k].cast<double>();
    const double scaled = double{p.radius[k]} / info.gap.tip_radius, volume = scaled * scaled * scaled;
    // On the axis itself no direction is outward, nor around: the mean over all that could be is zero.
    const double share = r > 0 ? volume / r : 0;
    Sums& bin = here[std::size_t(layer) * FlowBin::rings + std::size_t(ring)];
    ++bin.samples;
    bin.volume += volume;
    bin.azimuthal += share * sense * (x * v.y() - y * v.x());
    bin.radial += share * (x * v.x() + y * v.y());
    bin.vertical += volume * v.z();
  }
  const double tip = tip_speed(blade, info.gap.tip_radius);
  FlowSums sums;
  for (const Sums& bin : here) sums.bins.push_back({bin.samples, exact(bin.volume * tip), exact(bin.azimuthal), exact(bin.radial), exact(bin.vertical)});
  return sums;
}

void add(FlowSums& sums, const FlowSums& more) {
  if (sums.bins.empty()) sums.bins.resize(more.bins.size());
  for (std::size_t b = 0; b < more.bins.size(); ++b) {
    sums.bins[b].samples += more.bins[b].samples;
    for (const auto sum : {&FlowSums::Bin::tip, &FlowSums::Bin::azimuthal, &FlowSums::Bin::radial, &FlowSums::Bin::vertical}) add(sums.bins[b].*sum, more.bins[b].*sum);
  }
}

std::vector<FlowBin> flow_pattern(const FlowSums& sums, const Gap& gap) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<FlowBin> pattern;
  for (std::size_t b = 0; b < sums.bins.size(); ++b) {
    const auto layer = double(b / FlowBin::rings), ring = double(b % FlowBin::rings);
    const FlowSums::Bin& bin = sums.bins[b];
    FlowBin& mean = pattern.emplace_back(FlowBin{ring * ring_width(gap), (ring + 1) * ring_width(gap), lowest(gap) + layer * layer_height(gap),
                                                 lowest(gap) + (layer + 1) * layer_height(gap), bin.samples, nan, nan, nan});
    if (bin.samples < FlowBin::least_samples) continue;
    const double tip = value_of(bin.tip);
    mean.azimuthal = value_of(bin.azimuthal) / tip;
    mean.radial = value_of(bin.radial) / tip;
    mean.vertical = value_of(bin.vertical) / tip;
  }
  return pattern;
}

}  // namespace jam
