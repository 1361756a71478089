// Grains that are pressed with more than the watched force: found as forces are summed, chunk by chunk, and followed as excursions.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libdem/contact/contact_store.hpp"
#include "libdem/simulation/excursions.hpp"
#include "libdem/simulation/grain_store.hpp"

namespace dem {

class ForceWatch {
 public:
  // watch_force, N, and watch_radius, m, as in Setup. smallest_radius: m, of the grains. `open`: excursions that a stored run was in the
  // middle of; throws CaseError where they are not ascending by id.
  ForceWatch(double watch_force, double watch_radius, double smallest_radius, std::vector<Excursion> open);

  // The grains are in so many other chunks now.
  void lay_out(std::size_t chunks);
  // The forces on the grains of a chunk that are due, with its first row first in the sheet. From any thread, each for chunks of its own.
  void look(std::size_t chunk, const GrainStore& grains, std::span<const std::uint32_t> rows, const ForceSheet& forces);
  // N, the largest compressive force on a grain of the chunk when it was looked at last.
  double largest(std::size_t chunk) const { return pressed_[chunk].largest; }
  // All grains have been looked at, at this step and until the next look in `duration`, s. Returns how many are above their limit.
  std::size_t follow(std::uint64_t step, double duration, const WallContacts& walls, const std::vector<WallPose>& poses);

  const ExcursionTracker& excursions() const { return excursions_; }
  std::vector<Excursion> take_ended() { return excursions_.take_ended(); }

 private:
  // N, of a grain of this radius.
  double limit(double radius) const;

  double force_, radius_, least_;  // N; m; N, the lowest limit of a grain
  struct Pressed {
    double largest = 0;
    std::vector<WatchedGrain> above;
  };
  std::vector<Pressed> pressed_;  // [chunks]
  std::vector<WatchedGrain> above_;  // of all chunks
  ExcursionTracker excursions_;
};

}  // namespace dem
