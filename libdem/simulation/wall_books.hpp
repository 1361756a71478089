// What the grains do to the walls, step by step: loads, their means and extremes over a window, and the work of the walls on the grains.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libdem/contact/contact_store.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

class WallBooks {
 public:
  explicit WallBooks(std::size_t walls);

  void begin_window();
  // The loads of the contacts that were evaluated, those of these chunks of grains.
  void sum(const WallContacts& walls, std::span<const std::uint32_t> due_chunks, bool all_due);
  // Likewise, and into the window and the work. step: s.
  void record(const WallContacts& walls, std::span<const std::uint32_t> due_chunks, bool all_due, const std::vector<WallPose>& poses,
              double step);
  // The work begins from what is summed now.
  void begin_work(const std::vector<WallPose>& poses);

  const std::vector<WallLoad>& loads() const { return loads_; }
  // Of a window of so many steps.
  std::vector<Window::Load> means(double steps) const;

  // [walls] J, and W of the last evaluation: what a state remembers.
  std::vector<double> work, last_power;

 private:
  // W, that the wall puts into the grains at this instant.
  double power_into_grains(std::size_t wall, const std::vector<WallPose>& poses) const;

  std::vector<WallLoad> loads_;   // [walls] of the last evaluation of all contacts
  std::vector<WallLoad> shares_;  // [walls] of this step, in the mean over the steps (WallContacts::Chunk)
  std::vector<Window::Load> sum_;
};

}  // namespace dem
