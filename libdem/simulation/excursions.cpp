#include "libdem/simulation/excursions.hpp"

#include <utility>

namespace dem {

void ExcursionTracker::look(std::uint64_t step, double duration, const std::vector<WatchedGrain>& above) {
  if (above.empty() && open_.empty()) return;
  now_.clear();
  auto before = open_.begin();
  for (const WatchedGrain& grain : above) {
    for (; before != open_.end() && before->id < grain.id; ++before) ended_.push_back(*before);
    if (before != open_.end() && before->id == grain.id) {
      now_.push_back(*before++);
    } else {
      Excursion& fresh = now_.emplace_back();
      fresh.id = grain.id;
      fresh.first_step = step;
      fresh.first_position = grain.position;
    }
    Excursion& stay = now_.back();
    stay.last_step = step;
    stay.last_position = grain.position;
    if (grain.force > stay.peak_force) {
      stay.peak_force = grain.force;
      stay.peak_step = step;
      stay.peak_position = grain.position;
    }
    stay.impulse += duration * grain.force;
    stay.work += duration * grain.power;
    stay.path += duration * grain.speed;
    stay.turned += duration * grain.spin;
  }
  ended_.insert(ended_.end(), before, open_.end());
  std::swap(open_, now_);
}

std::vector<Excursion> ExcursionTracker::take_ended() { return std::exchange(ended_, {}); }

}  // namespace dem
