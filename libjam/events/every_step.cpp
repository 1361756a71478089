#include "libjam/events/every_step.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "libjam/snapshot/schema.hpp"

namespace jam {

std::uint32_t Sites::of(const Vec3& x) const {
  const double turn = std::atan2(x.y(), x.x()) / (2 * std::numbers::pi) + 0.5 / sectors;
  const auto sector = std::uint32_t(std::floor((turn - std::floor(turn)) * sectors)) % sectors;
  const double height = z_high > z_low ? (x.z() - z_low) / (z_high - z_low) : 0.0;
  const auto layer = std::uint32_t(std::clamp(std::floor(height * layers), 0.0, double(layers - 1)));
  return sector + sectors * layer;
}

Excursions last_word(const Excursions& excursions) {
  // Of each stay the row that came last.
  std::map<std::pair<std::uint64_t, ParticleId>, std::size_t> last;
  for (std::size_t k = 0; k < excursions.size(); ++k) last[{excursions.first_step[k], excursions.particle[k]}] = k;
  Excursions kept;
  std::vector<std::size_t> rows;
  for (const auto& [key, row] : last) rows.push_back(row);
  std::vector<void*> columns;
  schema::visit_excursions(kept, [&](const schema::Item&, auto& values) { columns.push_back(&values); });
  std::size_t next = 0;
  schema::visit_excursions(excursions, [&]<class Column>(const schema::Item&, const Column& values) {
    auto& to = *static_cast<Column*>(columns[next++]);
    for (const std::size_t row : rows) to.push_back(values[row]);
  });
  return kept;
}

std::vector<StepJam> step_jams(const Excursions& e, JamStream stream, const Detector& detector, std::span<const BladePose> poses,
                               const Sites& sites, double dt, std::uint64_t stride, std::uint64_t first_step) {
  const double pause = detector.hold_off * (1 + 1e-9);
  const auto site_of = [&](std::size_t k) {
    return sites.of(in_blade_frame(poses, double(e.peak_step[k]) * dt, e.peak_position[k].cast<double>()));
  };
  const auto entity_of = [&](std::size_t k) -> std::uint32_t {
    return stream == JamStream::global ? 0 : stream == JamStream::particle ? e.particle[k] : site_of(k);
  };
  struct Open {
    StepJam jam;
    std::uint64_t first = 0, last = 0;  // steps
  };
  std::vector<StepJam> jams;
  const auto close = [&](Open& open) {
    StepJam& jam = open.jam;
    jam.start = double(open.first) * dt;
    jam.end = double(open.last) * dt;
    jam.duration = double(open.last - open.first + stride) * dt;
    if (!(jam.peak_force > detector.start_force) || jam.duration < detector.shortest * (1 - 1e-9)) return;
    std::sort(jam.members.begin(), jam.members.end());
    jam.members.erase(std::unique(jam.members.begin(), jam.members.end()), jam.members.end());
    jams.push_back(std::move(jam));
  };
  std::map<std::uint32_t, Open> open;
  for (std::size_t k = 0; k < e.size(); ++k) {
    const auto [place, fresh] = open.try_emplace(entity_of(k));
    Open& now = place->second;
    const bool goes_on = !fresh && (e.first_step[k] <= now.last + stride || double(e.first_step[k] - now.last - stride) * dt <= pause);
    if (!goes_on) {
      if (!fresh) close(now);
      now = Open{{}, e.first_step[k], e.last_step[k]};
      now.jam.open_at_start = e.first_step[k] <= first_step;
    }
    StepJam& jam = now.jam;
    // Open at its end: the stay that reaches farthest is.
    if (!goes_on || e.last_step[k] > now.last) jam.open_at_end = e.open[k] != 0;
    if (goes_on && e.last_step[k] == now.last) jam.open_at_end = jam.open_at_end || e.open[k] != 0;
    now.last = std::max(now.last, e.last_step[k]);
    ++jam.stays;
    jam.impulse += double{e.impulse[k]};
    jam.work += double{e.work[k]};
    jam.members.push_back(e.particle[k]);
    if (double{e.peak_force[k]} > jam.peak_force) {
      jam.peak_force = double{e.peak_force[k]};
      jam.peak_time = double(e.peak_step[k]) * dt;
      jam.peak_particle = e.particle[k];
      jam.path = double{e.path[k]};
      jam.turned = double{e.turned[k]};
      jam.site = site_of(k);
    }
  }
  for (auto& [entity, last] : open) close(last);
  std::sort(jams.begin(), jams.end(),
            [](const StepJam& a, const StepJam& b) { return std::tie(a.start, a.members) < std::tie(b.start, b.members); });
  return jams;
}

}  // namespace jam
