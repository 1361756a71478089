// How far two persistence diagrams (persistence.hpp) are from each other: how much a force network has changed between two frames
// (Kramar et al., Physica D 283, 37, 2014). The points of the two are matched with each other or with the diagonal, where births are
// deaths; the distance of two points is the larger difference of their coordinates, that of a point from the diagonal half its
// persistence.
//
//   bottleneck_distance     least possible largest distance in a matching, N (Edelsbrunner and Harer, Computational Topology, 2010, VIII.2)
//   wasserstein_distance    least possible (sum of distances^q)^(1/q), N, q >= 1
//
// Both are exact but for rounding. Points near the diagonal hardly see each other, so only near pairs are looked at: seconds for ten
// thousand points.
#pragma once
#include "libjam/graph/persistence.hpp"

namespace jam {

double bottleneck_distance(const PersistenceDiagram& a, const PersistenceDiagram& b);
double wasserstein_distance(const PersistenceDiagram& a, const PersistenceDiagram& b, double q = 1);

}  // namespace jam
