// The distribution of grain sizes x = diameter / mean_diameter of a bed: uniform in [a, b] by number, or by mass.
//
// By number the density of x is 1/(b - a). By mass the weight of the grains in dx is uniform, so that their number goes as
// 1/x^3: the density of x is 2 x^-3 / (a^-2 - b^-2). Both are sampled by inversion of the cumulative distribution. A bed
// whose a and b are equal has one size; every formula below has that limit without a division by zero. Conditions: 0 < a <= b.
#pragma once
#include "libdem/case/case.hpp"

namespace dem {

// Share of the grains that are not larger than x, in [0, 1]: (x - a)/(b - a), or (a^-2 - x^-2)/(a^-2 - b^-2).
double size_share_below(const Bed& bed, double x);

// The x below which a share u in [0, 1] of the grains lies: a + u (b - a), or (a^-2 - u (a^-2 - b^-2))^(-1/2).
double size_quantile(const Bed& bed, double u);

// <x> over the grains: (a + b)/2, or 2 a b / (a + b).
double mean_size(const Bed& bed);

// <x^3> over the grains, their mean volume in units of pi/6 mean_diameter^3: (a + b)(a^2 + b^2)/4, or 2 a^2 b^2 / (a + b).
double mean_cubed_size(const Bed& bed);

}  // namespace dem
