#include "libjam/metrics/metrics.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "libjam/graph/bridge_conductance.hpp"
#include "libjam/metrics/clustering_metrics.hpp"
#include "libjam/metrics/component_metrics.hpp"
#include "libjam/metrics/coordination.hpp"
#include "libjam/metrics/coordination_with_walls.hpp"
#include "libjam/metrics/fabric.hpp"
#include "libjam/metrics/force_chain_metrics.hpp"
#include "libjam/metrics/mechanical_coordination.hpp"
#include "libjam/metrics/sliding_share.hpp"
#include "libjam/metrics/strong_contact_share.hpp"

namespace jam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// A function of the graph alone as a metric.
template <double (*F)(const ContactGraph&)>
double of_graph(FrameNetwork& network) {
  return F(network.graph);
}

// Numbers of any kind as values of a metric.
template <class Numbers>
std::vector<double> as_values(const Numbers& numbers) {
  return {numbers.begin(), numbers.end()};
}
template <class Numbers>
double sum(const Numbers& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}
template <class F>
std::vector<double> of_particles(FrameNetwork& network, F f) {
  std::vector<double> values(network.graph.vertex_count());
  for (ContactGraph::Vertex v = 0; v < values.size(); ++v) values[v] = f(v);
  return values;
}
template <class F>
std::vector<double> of_contacts(FrameNetwork& network, F f) {
  std::vector<double> values(network.graph.edge_count());
  for (std::uint32_t c = 0; c < values.size(); ++c) values[c] = f(c);
  return values;
}

// To add a metric: write a free function in a header of its own, or in that of its closest kin, whose comment states formula,
// reference and what happens where it is undefined (NaN), include it above, and add its row to the table of what it is a number of.
// What other metrics need as well belongs into FrameNetwork. The suites in tests/jam/metrics run over these tables: the new row is tested
// for invariance under reordering and relabelling of the particles, for rigid motions, for empty frames, and for having a unit and a
// doc line. It appears on the command line by itself.
constexpr auto of_frames = std::to_array<Metric>({
    {"coordination", "1", "mean number of particle contacts per particle, walls not counted", of_graph<coordination>},
    {"coordination_with_walls", "1", "mean number of contacts per particle, walls counted", of_graph<coordination_with_walls>},
    {"mechanical_coordination", "1", "coordination of the particles with two or more contacts (Thornton)",
     of_graph<mechanical_coordination>},
    {"mean_repulsive_force", "N", "mean normal force of the compressed particle contacts",
     [](FrameNetwork& n) { return n.mean_force(); }},
    {"strong_contact_share", "1", "share of compressed particle contacts above their mean force", of_graph<strong_contact_share>},
    {"component_count", "1", "connected components of the contact network",
     [](FrameNetwork& n) { return component_count(n.components()); }},
    {"largest_component_share", "1", "share of particles in the largest component",
     [](FrameNetwork& n) { return largest_component_share(n.graph, n.components()); }},
    {"rattler_share", "1", "share of particles that their contacts cannot hold, with friction",
     [](FrameNetwork& n) { return n.loose().empty() ? unknown : sum(n.loose()) / double(n.loose().size()); }},
    {"sliding_share", "1", "share of particle contacts at their friction limit", of_graph<sliding_share>},
    {"largest_core_number", "1", "largest k for which there is a k-core",
     [](FrameNetwork& n) { return n.cores().empty() ? unknown : double(*std::max_element(n.cores().begin(), n.cores().end())); }},
    {"triangle_count", "1", "triples of particles that touch each other", [](FrameNetwork& n) { return triangle_count(n.corners()); }},
    {"transitivity", "1", "share of pairs of contacts at a particle that a third contact closes",
     [](FrameNetwork& n) { return transitivity(n.graph, n.corners()); }},
    {"mean_clustering", "1", "mean clustering coefficient of the particles with two or more contacts",
     [](FrameNetwork& n) { return mean_clustering(n.graph, n.corners()); }},
    {"independent_cycles", "1", "cyclomatic number of the contact network",
     [](FrameNetwork& n) { return independent_cycles(n.graph, n.components()); }},
    {"cut_edge_count", "1", "contacts without which their component falls in two (bridges of graph theory)",
     [](FrameNetwork& n) { return sum(n.biconnected().cut_edge); }},
    {"articulation_point_count", "1", "particles without which their component falls apart",
     [](FrameNetwork& n) { return sum(n.biconnected().articulation_point); }},
    {"fabric_anisotropy", "1", "anisotropy of the contacts' directions", of_graph<fabric_anisotropy>},
    {"force_fabric_anisotropy", "1", "the same, contacts weighted by their repulsive force", of_graph<force_fabric_anisotropy>},
    {"strong_fabric_anisotropy", "1", "the same of the contacts above the mean repulsive force", of_graph<strong_fabric_anisotropy>},
    {"weak_fabric_anisotropy", "1", "the same of the other repulsive contacts", of_graph<weak_fabric_anisotropy>},
    {"force_chain_count", "1", "linear force chains (Peters et al.)", [](FrameNetwork& n) { return double(n.chains().size()); }},
    {"force_chain_share", "1", "share of particles in force chains",
     [](FrameNetwork& n) { return force_chain_share(n.graph, n.chains()); }},
    {"mean_force_chain_length", "1", "particles of a force chain in the mean",
     [](FrameNetwork& n) { return mean_force_chain_length(n.chains()); }},
    {"bridging_force_chains", "1", "force chains from blade to vessel", [](FrameNetwork& n) { return bridging_force_chains(n.chains()); }},
    {"bridge_strength", "N", "weakest contact of the strongest path from blade to vessel",
     [](FrameNetwork& n) { return n.bridge().strength; }},
    {"largest_bridge_betweenness", "1", "largest betweenness of a particle on the shortest paths from blade to vessel",
     [](FrameNetwork& n) {
       const std::vector<double>& through = n.between();
       return through.empty() ? unknown : *std::max_element(through.begin(), through.end());
     }},
    {"bridge_flow", "N", "maximum flow of repulsive force from blade to vessel", [](FrameNetwork& n) { return n.flow().value; }},
    {"bridge_conductance", "N", "conductance from blade to vessel, a contact's being its repulsive force", of_graph<bridge_conductance>},
    {"contact_disjoint_load_paths", "1", "paths from blade to vessel that share no contact",
     [](FrameNetwork& n) { return double(contact_disjoint_load_paths(n.graph)); }},
    {"particle_disjoint_load_paths", "1", "paths from blade to vessel that share no particle",
     [](FrameNetwork& n) { return double(particle_disjoint_load_paths(n.graph)); }},
});

constexpr auto of_each_particle = std::to_array<ParticleMetric>({
    {"contacts", "1", "contacts with other particles",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.graph.degree(v)); }); }},
    {"wall_contacts", "1", "contacts with walls",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.graph.wall_contacts(v).size()); }); }},
    {"component_size", "1", "particles of the component that it belongs to",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.components().size[n.components().label[v]]); }); }},
    {"rattler", "1", "1 where its contacts cannot hold it, with friction", [](FrameNetwork& n) { return as_values(n.loose()); }},
    {"core_number", "1", "largest k for which it belongs to the k-core", [](FrameNetwork& n) { return as_values(n.cores()); }},
    {"triangles", "1", "triangles of contacts that it is a corner of", [](FrameNetwork& n) { return as_values(n.corners()); }},
    {"clustering_coefficient", "1", "share of pairs of its partners that touch each other; none with fewer than two partners",
     [](FrameNetwork& n) { return clustering_coefficient(n.graph, n.corners()); }},
    {"mean_stress", "Pa", "third of the trace of its stress, per volume of the sphere; compression is negative",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return n.stress()[v].trace() / 3; }); }},
    {"largest_compression", "Pa", "most compressive principal stress, > 0; 0 where nothing compresses it",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return n.loads()[v].pressure; }); }},
    {"force_chain_length", "1", "particles of the force chain that it belongs to; 0 outside chains",
     [](FrameNetwork& n) {
       std::vector<double> length(n.graph.vertex_count(), 0.0);
       for (const ForceChain& chain : n.chains())
         for (const ContactGraph::Vertex v : chain.particles) length[v] = double(chain.particles.size());
       return length;
     }},
    {"articulation_point", "1", "1 where its component falls apart without it",
     [](FrameNetwork& n) { return as_values(n.biconnected().articulation_point); }},
    {"bridge_betweenness", "1", "shortest paths from blade to vessel through it, shared among equal ones",
     [](FrameNetwork& n) { return n.between(); }},
    {"on_strongest_bridge", "1", "1 on the strongest path from blade to vessel",
     [](FrameNetwork& n) {
       std::vector<double> on(n.graph.vertex_count(), 0.0);
       for (const ContactGraph::Vertex v : n.bridge().particles) on[v] = 1;
       return on;
     }},
    {"blade_side_of_cut", "1", "1 on the blade's side of the smallest cut between blade and vessel",
     [](FrameNetwork& n) { return as_values(n.flow().blade_side); }},
});

constexpr auto of_each_contact = std::to_array<ContactMetric>({
    {{"normal_force", "N", "the whole of it, damping included; > 0 is repulsive",
      [](FrameNetwork& n) { return of_contacts(n, [&](auto c) { return normal_force(n.graph.snapshot().pp, c); }); }}},
    {{"relative_force", "1", "repulsive normal force over the mean of those that are repulsive",
      [](FrameNetwork& n) {
        return of_contacts(n, [&](auto c) { return repulsive_force(n.graph.snapshot().pp, c) / n.mean_force(); });
      }}},
    {{"cut_edge", "1", "1 where its component falls in two without it",
      [](FrameNetwork& n) { return as_values(n.biconnected().cut_edge); }}},
    {{"in_smallest_cut", "1", "1 for a contact of the smallest cut between blade and vessel",
      [](FrameNetwork& n) {
        std::vector<double> cut(n.graph.edge_count(), 0.0);
        for (const std::uint32_t c : n.flow().cut_pp) cut[c] = 1;
        return cut;
      }}},
});

}  // namespace

std::span<const Metric> metrics() {
  return of_frames;
}
std::span<const ParticleMetric> particle_metrics() {
  return of_each_particle;
}
std::span<const ContactMetric> contact_metrics() {
  return of_each_contact;
}

const Metric* find_metric(std::string_view name) {
  const auto row = std::find_if(of_frames.begin(), of_frames.end(), [&](const Metric& m) { return m.name == name; });
  return row == of_frames.end() ? nullptr : &*row;
}

}  // namespace jam
