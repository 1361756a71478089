#include "libdem/simulation/wall_books.hpp"

#include <limits>

namespace dem {

WallBooks::WallBooks(std::size_t walls) : work(walls, 0.0), last_power(walls, 0.0), loads_(walls), shares_(walls), sum_(walls) { begin_window(); }

void WallBooks::begin_window() {
  const double inf = std::numeric_limits<double>::infinity();
  Window::Load empty;
  empty.force_min = empty.torque_min = Vec3::Constant(inf);
  empty.force_max = empty.torque_max = Vec3::Constant(-inf);
  sum_.assign(sum_.size(), empty);
}

void WallBooks::sum(const WallContacts& walls, std::span<const std::uint32_t> due_chunks, bool all_due) {
  shares_.assign(shares_.size(), WallLoad{});
  for (const std::uint32_t c : due_chunks)
    for (const WallContacts::Chunk& chunk : walls.chunks_of(c)) shares_[chunk.wall] += chunk.share;
  if (!all_due) return;
  loads_.assign(loads_.size(), WallLoad{});
  for (const WallContacts::Chunk& chunk : walls.chunk) loads_[chunk.wall] += chunk.load;
}

void WallBooks::record(const WallContacts& walls, std::span<const std::uint32_t> due_chunks, bool all_due, const std::vector<WallPose>& poses,
                       double step) {
  sum(walls, due_chunks, all_due);
  for (const std::uint32_t c : due_chunks)
    for (const WallContacts::Chunk& chunk : walls.chunks_of(c))
      for (std::size_t l = 0; l < facet_labels; ++l) sum_[chunk.wall].of_label[l] += chunk.share_of_label[l];
  for (std::size_t w = 0; w < sum_.size(); ++w) {
    Window::Load& sum = sum_[w];
    sum.force += shares_[w].force;
    sum.torque += shares_[w].torque;
    if (all_due) {
      sum.force_min = sum.force_min.cwiseMin(loads_[w].force);
      sum.force_max = sum.force_max.cwiseMax(loads_[w].force);
      sum.torque_min = sum.torque_min.cwiseMin(loads_[w].torque);
      sum.torque_max = sum.torque_max.cwiseMax(loads_[w].torque);
    }
    const double power = power_into_grains(w, poses);
    sum.power += power;
    work[w] += 0.5 * step * (last_power[w] + power);
    last_power[w] = power;
  }
}

void WallBooks::begin_work(const std::vector<WallPose>& poses) {
  for (std::size_t w = 0; w < last_power.size(); ++w) last_power[w] = power_into_grains(w, poses);
}

std::vector<Window::Load> WallBooks::means(double steps) const {
  std::vector<Window::Load> loads = sum_;
  for (Window::Load& load : loads) {
    if (steps == 0) {
      load = Window::Load{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0, {}};
      continue;
    }
    for (WallLoad& part : load.of_label) {
      part.force /= steps;
      part.torque /= steps;
    }
    load.force /= steps;
    load.torque /= steps;
    load.power /= steps;
  }
  return loads;
}

double WallBooks::power_into_grains(std::size_t wall, const std::vector<WallPose>& poses) const {
  return -(shares_[wall].force.dot(poses[wall].velocity) + shares_[wall].torque.dot(poses[wall].angular_velocity));
}

}  // namespace dem
