#include "libdem/case/automatic_step.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libdem/case/derived.hpp"

namespace dem {
namespace {

// s, the largest time of which all intervals are whole multiples; to a picosecond, 0 where one is shorter than that.
double common_interval(const Case& c) {
  constexpr double unit = 1e-12;
  std::int64_t common = 0;
  for (const double interval : {c.duration, c.output.frame_interval, c.output.series_interval, c.output.checkpoint_interval, c.output.capture.interval})
    common = std::gcd(common, std::llround(std::min(interval / unit, 9e18)));
  return double(common) * unit;
}

}  // namespace

StepChoice choose_steps(const Case& c) {
  const Material& grain = c.materials[material_index(c, c.bed.material)];
  const double diameter = c.bed.mean_diameter;
  const Derived d = derive(c);
  const double squeezed = d.mean_in_gap.force > 0 ? d.mean_in_gap.critical_step
                                                  : squeeze(grain, grain, grain, diameter, 0.95 * diameter).critical_step;
  // Hertz under F = 10 m g: a^3 = 3 F R* / (4 E*), k = 2 E* a.
  const double force = 10 * d.mean_mass * c.gravity.norm();
  const double radius = std::cbrt(3 * force * d.reduced_radius / (4 * d.modulus));
  const double omega = std::sqrt(2 * d.modulus * radius / (0.5 * d.mean_mass));

  StepChoice choice;
  choice.stiffest = c.accuracy * squeezed;
  choice.softest = std::max(2 * c.accuracy / omega, choice.stiffest);
  const double common = common_interval(c);
  double longest = std::min(choice.softest, choice.stiffest * double(1U << most_levels));
  if (common > 0) longest = common / std::ceil(common / longest);
  choice.levels = std::uint8_t(std::clamp(std::ceil(std::log2(longest / choice.stiffest)), 0.0, double(most_levels)));
  choice.step = longest / double(1U << choice.levels);
  return choice;
}

}  // namespace dem
