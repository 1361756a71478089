// Betweenness of the particles (Freeman, Sociometry 40, 35, 1977; the sums of Brandes, J. Math. Sociol. 25, 163, 2001): how many of the
// shortest paths between others lead through a particle. A path is as long as it has contacts; every contact counts, whatever its force;
// walls are no part of paths. Takes time in proportion to the sources times the contacts (blade to
// vessel in 32,581 beads: about a second), memory in proportion to the particles.
#pragma once
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

// [N] sum over the pairs of a source s and another particle t that is a target of n_st(v) / n_st: the share of the shortest paths from
// s to t that lead through v, v being neither; pairs without any path count nothing. Particles that are source and target at once make
// pairs both ways, so with all particles as both it is twice the raw count of undirected graphs. Sources are added in the order given.
std::vector<double> betweenness(const ContactGraph& graph, std::span<const ContactGraph::Vertex> sources,
                                std::span<const ContactGraph::Vertex> targets);

// [N] the same from the particles that touch a blade to those that touch the vessel: the one that fits a gap.
std::vector<double> bridge_betweenness(const ContactGraph& graph);

}  // namespace jam
