#include "libdem/simulation/foresight.hpp"

#include <algorithm>

namespace dem {
namespace {

constexpr double root_three = 1.7320508075688774;  // rounded up: a vector is at most so much longer than its largest component

// Of values >= 0.
double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, value);
  return most;
}

}  // namespace

Foresight::Foresight(double step, std::uint8_t levels, double wall_speed) : step_(step), wall_speed_(wall_speed), levels_(levels) {}

void Foresight::lay_out(std::size_t chunks) {
  chunk_speed_.assign(chunks, 0.0);
  chunk_jolt_.assign(chunks, 0.0);
  closing_jolt.assign(chunks, largest(closing_jolt));
}

void Foresight::begin(const LargeArray<GrainRow>& rows, const RowChunks& chunks) {
  for (std::size_t c = 0; c < chunks.count(); ++c)
    for (std::size_t r = chunks.begin(c); r < chunks.end(c); ++r)
      chunk_speed_[c] = std::max(chunk_speed_[c], rows[r].velocity().cwiseAbs().maxCoeff());
  look_ahead();
}

void Foresight::remember(const ChunkMotion& motion, std::size_t chunk, bool all_due) {
  const double speed = motion.speed.maxCoeff(), jolt = motion.jolt.maxCoeff();
  chunk_speed_[chunk] = all_due ? speed : std::max(chunk_speed_[chunk], speed);
  chunk_jolt_[chunk] = all_due ? jolt : std::max(chunk_jolt_[chunk], jolt);
}

void Foresight::look_ahead() {
  if (levels_ == 0) return;
  for (std::size_t c = 0; c < closing_jolt.size(); ++c) closing_jolt[c] = 2 * root_three * chunk_jolt_[c];
  until_all_due = step_ * stride(levels_) * closing_speed(largest(chunk_jolt_));
}

double Foresight::travel_until_all_due() const { return levels_ == 0 ? 0 : 2 * step_ * stride(levels_) * closing_speed(); }

double Foresight::closing_speed(double excess) const {
  const double speed = root_three * (largest(chunk_speed_) + excess);
  return speed + std::max(speed, wall_speed_);
}

}  // namespace dem
