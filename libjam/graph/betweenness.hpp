// Betweenness of particles and contacts (Freeman, Sociometry 40, 35, 1977; the sums of Brandes, J. Math. Sociol. 25, 163, 2001): how many
// of the shortest paths between particles lead through another one, or over a contact. Raw counts, not divided by the number of pairs.
//
// A path is as long as it has contacts, or as the sum of the lengths given for its contacts (contact_length.hpp). A length is no weight:
// where force shall attract paths, the length is its inverse. Lengths of paths that differ by less than 1e-10 of themselves are equal,
// so that 0.1 + 0.2 and 0.15 + 0.15 share. Walls are no part of paths.
//
// Time in proportion to the sources times the contacts, shared among threads; memory in proportion to the contacts. Sources are summed
// up in portions that do not depend on the number of threads, so neither do the sums.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Betweenness {
  std::vector<double> particle;  // [N]
  std::vector<double> contact;   // [C] of contacts between particles; empty where only particles were asked for, which takes less time
};
enum class BetweennessOf { particles, particles_and_contacts };

// Sums over the pairs of a source s and another particle t that is a target of n_st(x) / n_st: the share of the shortest paths from s to
// t that lead through particle x, x being neither, or over contact x. Pairs without any path count nothing. Particles that are source
// and target at once make pairs both ways, so with all particles as both it is twice the raw count of undirected graphs.
// `length` is [C], or empty for paths counted in contacts; contacts whose length is not positive and finite are not walked.
Betweenness betweenness(const ContactGraph& graph, std::span<const ContactGraph::Vertex> sources,
                        std::span<const ContactGraph::Vertex> targets, std::span<const double> length = {},
                        BetweennessOf of = BetweennessOf::particles_and_contacts);

// Of all pairs of particles, each pair once: the raw count of undirected graphs.
Betweenness betweenness(const ContactGraph& graph, std::span<const double> length = {},
                        BetweennessOf of = BetweennessOf::particles_and_contacts);

// From the particles that touch a blade to those that touch the vessel: the one that fits a gap.
Betweenness bridge_betweenness(const ContactGraph& graph, std::span<const double> length = {});

// Estimate of betweenness(graph).particle from `samples` > 1 sources drawn with equal chance, with replacement. With probability
// `confidence` ALL particles are within their `error` of the exact value: the empirical Bernstein bound (Audibert, Munos and Szepesvari,
// Theor. Comput. Sci. 410, 1876, 2009) of each, shared among the particles. Same seed, same numbers.
struct SampledBetweenness {
  std::vector<double> particle, error;  // [N]
};
SampledBetweenness sampled_betweenness(const ContactGraph& graph, std::size_t samples, std::uint64_t seed, double confidence = 0.95);

}  // namespace jam
