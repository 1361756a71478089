// Makes a recorded run of a shallow bed as large as one of a deep bed, for measuring what a report of a full-size run costs:
//
//   deep_bed RUN.h5 BED.h5 OUT.h5 [HEIGHT [CLEAR]]
//
// Every frame of RUN.h5 is kept as it is, with its jams, series and stays. Above HEIGHT (m, default 0.009) stand the grains of the last frame of BED.h5
// farther than CLEAR (m, default 0.0035) from the z axis, which is where a blade's shaft is. They turn slowly about the z axis as one body, with the round
// vessel's contacts, and each contact carries a force of its own in each frame, so that no two frames have the same bytes. Both files need the same walls
// and columns, as those of data/cases/ft4_quick.toml and data/cases/ft4_a_down.toml have. RUN's capture.h5 is a run like any other to this program.
//
// What apps/report/README.md says of a full-size run was measured on
//
//   jamscope simulate data/cases/ft4_quick.toml -o shallow --set material.glass.young="6.3 MPa" --set material.steel.young="21 MPa"
//     --set interaction.glass-glass.work_of_adhesion="6.88 mJ/m2" --set interaction.glass-steel.work_of_adhesion="6.88 mJ/m2"
//     --set motion.tip_speed="400 mm/s" --set motion.helix_angle="-0.1 deg" --set run.step=auto --set run.duration="2 s"
//     --set output.frame_interval="2 ms" --set output.series_interval="0.1 ms" --set analysis.jam_force="220 mN"
//   jamscope simulate data/cases/ft4_a_down.toml -o bed --until "0.2 ms"
//   deep_bed shallow/run.h5 bed/run.h5 run.h5
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <utility>

#include "libjam/snapshot/open_source.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/writer.hpp"

namespace {

using namespace jam;

constexpr double turning = 0.5;  // rad/s

// The grains of `s` that stand above, without what they touch below.
Snapshot upper_part(const Snapshot& s, const RunInfo& info, double height, double clear) {
  Snapshot upper;
  std::vector<std::uint32_t> place(s.particles.size(), std::uint32_t(-1));
  const auto& p = s.particles;
  for (std::uint32_t v = 0; v < p.size(); ++v) {
    if (std::hypot(p.position[v].x(), p.position[v].y()) < float(clear)) continue;
    place[v] = std::uint32_t(upper.particles.size());
    upper.particles.id.push_back(p.id[v]);
    upper.particles.position.emplace_back(p.position[v] + Vec3f(0, 0, float(height)));
    upper.particles.velocity.push_back(p.velocity[v]);
    upper.particles.angular_velocity.push_back(p.angular_velocity[v]);
    upper.particles.radius.push_back(p.radius[v]);
    upper.particles.material.push_back(p.material[v]);
    upper.particles.compressive_force.push_back(p.compressive_force[v]);
  }
  const auto is_kept = [&](std::uint32_t v) { return place[v] != std::uint32_t(-1); };
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    if (!is_kept(s.pp.row[c][0]) || !is_kept(s.pp.row[c][1])) continue;
    upper.pp.row.push_back({place[s.pp.row[c][0]], place[s.pp.row[c][1]]});
    upper.pp.normal_force.push_back(s.pp.normal_force[c]);
    upper.pp.damping_force.push_back(s.pp.damping_force[c]);
    upper.pp.tangential_force.push_back(s.pp.tangential_force[c]);
    upper.pp.overlap.push_back(s.pp.overlap[c]);
    upper.pp.birth_step.push_back(0);
    upper.pp.flags.push_back(s.pp.flags[c]);
  }
  for (std::size_t c = 0; c < s.pw.size(); ++c) {
    if (!is_kept(s.pw.row[c]) || info.walls[s.pw.wall[c]].kind != "cylinder") continue;
    upper.pw.row.push_back(place[s.pw.row[c]]);
    upper.pw.wall.push_back(s.pw.wall[c]);
    upper.pw.facet.push_back(s.pw.facet[c]);
    upper.pw.feature.push_back(s.pw.feature[c]);
    upper.pw.point.emplace_back(s.pw.point[c] + Vec3f(0, 0, float(height)));
    upper.pw.normal.push_back(s.pw.normal[c]);
    upper.pw.normal_force.push_back(s.pw.normal_force[c]);
    upper.pw.damping_force.push_back(s.pw.damping_force[c]);
    upper.pw.tangential_force.push_back(s.pw.tangential_force[c]);
    upper.pw.overlap.push_back(s.pw.overlap[c]);
    upper.pw.birth_step.push_back(0);
    upper.pw.flags.push_back(s.pw.flags[c]);
  }
  return upper;
}

template <class T>
void extend(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

// `frame` with the grains of `upper` above its own, turned by as much as they have by then, every contact's force times `scale` and a random factor.
Snapshot stacked(Snapshot frame, const Snapshot& upper, float scale) {
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(float(turning * frame.time), Vec3f::UnitZ()).toRotationMatrix();
  std::mt19937_64 random(frame.step);
  std::lognormal_distribution<float> spread(0, 0.5F);
  const auto first = std::uint32_t(frame.particles.size());
  const ParticleId first_id = frame.particles.id.back() + 1;
  Particles& p = frame.particles;
  for (std::size_t v = 0; v < upper.particles.size(); ++v) {
    const Vec3f at = turn * upper.particles.position[v];
    p.id.push_back(first_id + ParticleId(v));
    p.position.push_back(at);
    p.velocity.emplace_back(-float(turning) * at.y(), float(turning) * at.x(), 0.F);
    p.angular_velocity.emplace_back(0.F, 0.F, float(turning));
  }
  extend(p.radius, upper.particles.radius);
  extend(p.material, upper.particles.material);
  p.compressive_force.resize(p.size(), 0.F);
  for (std::size_t c = 0; c < upper.pp.size(); ++c) {
    const float factor = scale * spread(random);
    const auto [a, b] = upper.pp.row[c];
    frame.pp.row.push_back({first + a, first + b});
    frame.pp.normal_force.push_back(factor * upper.pp.normal_force[c]);
    frame.pp.damping_force.push_back(0);
    frame.pp.tangential_force.emplace_back(factor * turn * upper.pp.tangential_force[c]);
    for (const std::uint32_t v : {first + a, first + b}) p.compressive_force[v] += std::max(0.F, frame.pp.normal_force.back());
  }
  extend(frame.pp.overlap, upper.pp.overlap);
  extend(frame.pp.birth_step, upper.pp.birth_step);
  extend(frame.pp.flags, upper.pp.flags);
  for (std::size_t c = 0; c < upper.pw.size(); ++c) {
    const float factor = scale * spread(random);
    frame.pw.row.push_back(first + upper.pw.row[c]);
    frame.pw.point.emplace_back(turn * upper.pw.point[c]);
    frame.pw.normal.emplace_back(turn * upper.pw.normal[c]);
    frame.pw.normal_force.push_back(factor * upper.pw.normal_force[c]);
    frame.pw.damping_force.push_back(0);
    frame.pw.tangential_force.emplace_back(factor * turn * upper.pw.tangential_force[c]);
    p.compressive_force[frame.pw.row.back()] += std::max(0.F, frame.pw.normal_force.back());
  }
  extend(frame.pw.wall, upper.pw.wall);
  extend(frame.pw.facet, upper.pw.facet);
  extend(frame.pw.feature, upper.pw.feature);
  extend(frame.pw.overlap, upper.pw.overlap);
  extend(frame.pw.birth_step, upper.pw.birth_step);
  extend(frame.pw.flags, upper.pw.flags);
  return frame;
}

// Brings the load of the resting grains to a hundredth of what the run watches for, so that they never count as jammed.
float calm(const Snapshot& upper, const RunInfo& run) {
  float largest = 0;
  for (const float f : upper.particles.compressive_force) largest = std::max(largest, f);
  return run.watch_force > 0 ? std::min(1.F, float(run.watch_force) / 100 / largest) : 1.F;
}

void run(const char* const* words, int count) {
  const SnapshotSource shallow = open_source({words[0]}), bed = open_source({words[1]});
  const double height = count > 3 ? std::atof(words[3]) : 0.009, clear = count > 4 ? std::atof(words[4]) : 0.0035;
  const Snapshot upper = upper_part(bed.read(bed.frames - 1), bed.info, height, clear);
  const float scale = calm(upper, shallow.info);
  SnapshotWriter writer = SnapshotWriter::create(words[2], shallow.info);
  std::size_t written = 0;
  for (std::size_t k = 0; k < shallow.frames; ++k) {
    const Snapshot frame = shallow.read(k);
    const auto& steps = shallow.series.step;
    const auto rows = std::size_t(std::upper_bound(steps.begin(), steps.end(), frame.step) - steps.begin());
    writer.append(stacked(frame, upper, scale), rows > written ? schema::rows_of(shallow.series, written, rows) : Series{});
    written = std::max(written, rows);
  }
  std::printf("%zu frames of %zu grains in %s\n", shallow.frames, shallow.read(0).particles.size() + upper.particles.size(), words[2]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 6) {
    std::fprintf(stderr, "usage: deep_bed RUN.h5 BED.h5 OUT.h5 [HEIGHT [CLEAR]]\n");
    return 2;
  }
  try {
    run(argv + 1, argc - 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
