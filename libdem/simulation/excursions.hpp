// Grains under a large compressive force, followed from step to step: when each such stay begins and ends, and what happens in it.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/case/case.hpp"

namespace dem {

// An uninterrupted stay of a grain above its limit (Setup::watch_force). It is looked at whenever all contacts are evaluated: every step, or every
// 2^levels steps where contacts step at their own rate; sums and integrals are over these instants, each for the time to the next.
struct Excursion {
  std::uint32_t id = 0;                                      // of the grain
  std::uint64_t first_step = 0, last_step = 0, peak_step = 0;  // first and last above; ties of the peak: the first
  double peak_force = 0;                                     // N, compressive
  double impulse = 0;                                        // N s, integral of the compressive force
  double work = 0;                                           // J, that walls did on the grain at their contacts
  double path = 0, turned = 0;                               // m, rad: integrals of speed and of angular speed
  Vec3 first_position = Vec3::Zero(), peak_position = Vec3::Zero(), last_position = Vec3::Zero();  // m, centre
};

// A grain above the watched force at one instant.
struct WatchedGrain {
  std::uint32_t row = 0, id = 0;
  double force = 0, power = 0, speed = 0, spin = 0;  // N, W of walls, m/s, rad/s
  Vec3 position;                                     // m
};

class ExcursionTracker {
 public:
  // Those that a stored run was in the middle of, ascending by id.
  explicit ExcursionTracker(std::vector<Excursion> open = {}) : open_(std::move(open)) {}

  // All grains that are above at a step, ascending by id; `duration`, s, until the next look. What is no longer above has ended.
  void look(std::uint64_t step, double duration, const std::vector<WatchedGrain>& above);

  const std::vector<Excursion>& open() const { return open_; }  // ascending by id
  const std::vector<Excursion>& ended() const { return ended_; }  // since take_ended()
  // Those that have ended since the last call, by the step after their last, then by id.
  std::vector<Excursion> take_ended();

 private:
  std::vector<Excursion> open_, ended_, now_;
};

}  // namespace dem
