#include "libdem/simulation/check_input.hpp"

#include <string>

#include "libdem/errors.hpp"
#include "libdem/simulation/guards.hpp"

namespace dem {

void check_input(const Setup& setup, const Particles& p, std::uint64_t step) {
  const std::size_t n = p.size(), m = setup.materials.size();
  if (!(setup.step > 0)) throw CaseError("the time step is " + number(setup.step) + " s, expected > 0");
  if (setup.levels > most_levels)
    throw CaseError(std::to_string(setup.levels) + " levels of time steps, expected at most " + std::to_string(most_levels));
  if (setup.levels > 0 && !(setup.accuracy > 0 && setup.accuracy <= most_accuracy))
    throw CaseError("the accuracy of the time steps is " + number(setup.accuracy) + ", expected 0 < accuracy <= " +
                    number(most_accuracy));
  if (const std::uint64_t stride_of_all = std::uint64_t{1} << setup.levels; step % stride_of_all != 0)
    throw CaseError("the stored state is of step " + std::to_string(step) +
                    ", at which not all contacts are due, expected a multiple of " + std::to_string(stride_of_all));
  if (const auto why = incompatible(setup.law)) throw CaseError(*why);
  if (!(setup.local_damping >= 0 && setup.local_damping < 1))
    throw CaseError("the local damping is " + number(setup.local_damping) + ", expected 0 <= damping < 1");
  if (setup.keep_ledger && setup.local_damping != 0)
    throw CaseError("an energy ledger knows no local damping, got " + number(setup.local_damping));
  if (setup.interactions.size() != m) throw CaseError("expected one row of interactions per material");
  for (const auto& row : setup.interactions)
    if (row.size() != m) throw CaseError("expected one interaction per pair of materials");
  if (p.material.size() != n || p.radius.size() != n || p.position.size() != n || p.velocity.size() != n ||
      p.angular_velocity.size() != n)
    throw CaseError("the grains' arrays differ in length");
  for (std::size_t i = 0; i < n; ++i)
    if (p.material[i] >= m || !(p.radius[i] > 0) || !p.position[i].allFinite())
      throw CaseError("grain " + std::to_string(p.id[i]) + " has no material, radius or position");
  for (const Wall& w : setup.walls) {
    if (w.material >= m) throw CaseError("wall '" + w.name + "' has no material");
    validate_wall(w);
  }
}

}  // namespace dem
