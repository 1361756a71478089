// Jams as the simulation saw them at every step, from the stays of particles above a force (Excursions): no sampling, so every duration is true
// to a step and none is missed.
//
// One detector makes the events of all streams. A jam begins where the force of its stream passes Detector::end_force, lasts while it stays
// above, and over pauses of up to `hold_off`; it counts if it passed `start_force` and lasted `shortest` at least. With start_force =
// end_force and no hold-off this is the paper's rule, without its sampling.
//
// The streams are never mixed:
//   global     some particle is above: the paper's. Two jams at once at two places of the blade are one event
//   particle   each particle by itself: a jam that one grain hands to the next is two
//   site       each sector of the blade and layer of its height by itself, where the stay had its peak
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "libjam/events/blade_pose.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct Detector {
  double start_force = 20, end_force = 20;  // N, start_force >= end_force
  double hold_off = 0, shortest = 0;        // s
};

// Sectors around the blade's axis, the first centred on its x axis, and layers between z_low and z_high, the outer ones open.
struct Sites {
  std::uint32_t sectors = 2, layers = 4;
  double z_low = 0, z_high = 0;  // m, in the blade's frame
  std::uint32_t of(const Vec3& in_blade_frame) const;  // sector + sectors * layer
};

struct StepJam {
  double start = 0, end = 0;                        // s, of the first and the last step above
  double duration = 0;                              // s, steps above and pauses between them
  bool open_at_start = false, open_at_end = false;  // it was there when the record began; it is there where it ends
  double peak_force = 0, peak_time = 0;             // N, s; ties: the stay that began first, then smaller id
  ParticleId peak_particle = 0;
  std::uint32_t site = 0;                           // of the peak
  double impulse = 0, work = 0;                     // N s, J, sums over its stays
  double share_of_flow_energy = 0;                  // work over that of the blades in the whole record; NaN where it is not known
  double path = 0, turned = 0;                      // m, rad, of the stay with the peak
  std::uint32_t stays = 0;
  std::vector<ParticleId> members;                  // ascending, each once
};

enum class JamStream : std::uint8_t { global, particle, site };
inline constexpr std::string_view jam_stream_names[] = {"global", "particle", "site"};

// The stays without those whose place a later row takes; by first step, then particle.
Excursions last_word(const Excursions& excursions);

// `excursions` as last_word() gives them; `dt`, s, of a step; `stride`: steps between two looks; `first_step`, at which the
// record begins. By start, then smallest member.
std::vector<StepJam> step_jams(const Excursions& excursions, JamStream stream, const Detector& detector, std::span<const BladePose> poses,
                               const Sites& sites, double dt, std::uint64_t stride, std::uint64_t first_step);

}  // namespace jam
