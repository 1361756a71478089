#include "libdem/case/size_distribution.hpp"

#include <algorithm>
#include <cmath>

namespace dem {

double size_share_below(const Bed& bed, double x) {
  const double a = bed.size_low, b = bed.size_high;
  if (x >= b) return 1;
  if (x <= a) return 0;
  if (bed.sizes == Bed::Sizes::by_number) return (x - a) / (b - a);
  return (1 / (a * a) - 1 / (x * x)) / (1 / (a * a) - 1 / (b * b));
}

double size_quantile(const Bed& bed, double u) {
  const double a = bed.size_low, b = bed.size_high;
  if (bed.sizes == Bed::Sizes::by_number) return a + u * (b - a);
  // Rounding must not carry a grain out of its range.
  return std::clamp(1 / std::sqrt(1 / (a * a) - u * (1 / (a * a) - 1 / (b * b))), a, b);
}

double mean_size(const Bed& bed) {
  const double a = bed.size_low, b = bed.size_high;
  return bed.sizes == Bed::Sizes::by_number ? (a + b) / 2 : 2 * a * b / (a + b);
}

double mean_cubed_size(const Bed& bed) {
  const double a = bed.size_low, b = bed.size_high;
  return bed.sizes == Bed::Sizes::by_number ? (a + b) * (a * a + b * b) / 4 : 2 * a * a * b * b / (a + b);
}

}  // namespace dem
