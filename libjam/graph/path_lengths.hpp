// Lengths of the shortest paths between all pairs of particles. Walls are no part of paths.
//
//   efficiency   1/(N (N - 1)) sum over the pairs (both ways) of 1/d; a pair that no path joins adds nothing (Latora and Marchiori, Phys.
//                Rev. Lett. 87, 198701, 2001)
//   mean         mean of d over the pairs that a path joins
//   longest      largest d: the diameter of the largest component by d
//
// NaN where there is no pair to take it of.
#pragma once
#include <span>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct PathLengths {
  double efficiency, mean, longest;
};

// d counted in contacts. Searches from 512 particles at a time, bit by bit; counts are whole numbers, so the result is exact. A few
// seconds for 35,000 particles.
PathLengths path_lengths(const ContactGraph& graph);

// d as the sum of `length` [C] (contact_length.hpp) along the path; contacts whose length is not positive and finite are not walked.
// Dijkstra from each particle: minutes for 35,000.
PathLengths path_lengths(const ContactGraph& graph, std::span<const double> length);

}  // namespace jam
