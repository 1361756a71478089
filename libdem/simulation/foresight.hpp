// How much nearer two bodies may have come, or may yet come: upper bounds on which lists, levels and contacts that are left alone rely.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/simulation/motion.hpp"

namespace dem {

class Foresight {
 public:
  // step: s, of level 0. wall_speed: m/s, upper bound of the speed of any point of a wall.
  Foresight(double step, std::uint8_t levels, double wall_speed);

  // The grains are in so many other chunks now.
  void lay_out(std::size_t chunks);
  // A run begins: how the grains of these rows move.
  void begin(const LargeArray<GrainRow>& rows, const RowChunks& chunks);
  // How the grains of a chunk that are due have moved. From any thread, each for chunks of its own.
  void remember(const ChunkMotion& motion, std::size_t chunk, bool all_due);
  // To when all are due again, which they are now.
  void look_ahead();
  // By one step.
  void go_on() { odometer += closing_speed() * step_; }

  // m/s, upper bound of the speed at which two bodies near each other.
  double closing_speed() const { return closing_speed(0); }
  double wall_speed() const { return wall_speed_; }  // m/s
  // m, by which the odometer will not quite grow until all are due again unless speeds double; they are due now.
  double travel_until_all_due() const;

  // What a state remembers.
  double odometer = 0;       // m, upper bound of how far any two bodies have come nearer since the run began
  double until_all_due = 0;  // m, upper bound of what the odometer gains until all are due again
  std::vector<double> closing_jolt;  // [chunks] m/s, by how much two bodies' speeds may change until then, when all were due last

 private:
  // If every grain is at most `excess` faster than the fastest component of a velocity.
  double closing_speed(double excess) const;

  double step_, wall_speed_;
  std::uint8_t levels_;
  // Of each chunk since all were due: largest component of a velocity, m/s, and of its change until all are due again if it goes on
  // like this.
  std::vector<double> chunk_speed_, chunk_jolt_;
};

}  // namespace dem
