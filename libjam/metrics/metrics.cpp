#include "libjam/metrics/metrics.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "libjam/graph/algebraic_connectivity.hpp"
#include "libjam/graph/bridge_conductance.hpp"
#include "libjam/graph/contact_length.hpp"
#include "libjam/graph/diagram_distance.hpp"
#include "libjam/metrics/chain_shape.hpp"
#include "libjam/metrics/clustering_metrics.hpp"
#include "libjam/metrics/community_metrics.hpp"
#include "libjam/metrics/component_metrics.hpp"
#include "libjam/metrics/contact_turnover.hpp"
#include "libjam/metrics/coordination.hpp"
#include "libjam/metrics/coordination_with_walls.hpp"
#include "libjam/metrics/fabric.hpp"
#include "libjam/metrics/force_chain_metrics.hpp"
#include "libjam/metrics/mechanical_coordination.hpp"
#include "libjam/metrics/sliding_share.hpp"
#include "libjam/metrics/solid_fraction.hpp"
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

double mean(const std::vector<double>& values) {
  return values.empty() ? unknown : sum(values) / double(values.size());
}
double largest(const std::vector<double>& values) {
  return values.empty() ? unknown : *std::max_element(values.begin(), values.end());
}
std::vector<double> or_unknown(std::vector<double> values, std::size_t size) {
  if (values.size() != size) values.assign(size, unknown);
  return values;
}

// To add a metric: write a free function in a header of its own, or in that of its closest kin, whose comment states formula,
// reference and what happens where it is undefined (NaN), include it above, and add its row to the table of what it is a number of.
// What other metrics need as well belongs into FrameNetwork. The suites in tests/jam/metrics run over these tables: the new row is tested
// for invariance under reordering and relabelling of the particles, for rigid motions, for empty frames, and for having a unit and a
// doc line. It appears on the command line by itself.
constexpr auto of_frames = std::to_array<Metric>({
    {"coordination", "1", "mean number of particle contacts per particle, walls not counted", of_graph<coordination>, Cost::low,
     "no particles"},
    {"coordination_with_walls", "1", "mean number of contacts per particle, walls counted", of_graph<coordination_with_walls>, Cost::low,
     "no particles"},
    {"mechanical_coordination", "1", "coordination of the particles with two or more contacts (Thornton)",
     of_graph<mechanical_coordination>, Cost::low,
     "no particle has two contacts"},
    {"isostatic_coordination", "1", "coordination at which constraints and freedoms are as many, by the sliding contacts there are",
     [](FrameNetwork& n) { return isostatic_coordination(sliding_per_particle(n.graph)); }, Cost::low,
     "no particles, or the source does not know which contacts slide"},
    {"solid_fraction", "1", "volume of the particles over that of their power cells, open cells left out",
     [](FrameNetwork& n) { return solid_fraction(n.graph.snapshot(), n.cells()); }, Cost::high,
     "no power cell is closed"},
    {"mean_compressive_force", "N", "mean over the particles of the sum of their repulsive normal forces, walls included",
     [](FrameNetwork& n) { return mean(n.compressive()); }, Cost::low,
     "no particles"},
    {"largest_compressive_force", "N", "largest of them", [](FrameNetwork& n) { return largest(n.compressive()); }, Cost::low,
     "no particles"},
    {"jammed_particles", "1", "particles whose compressive force is above the jam force (20 N)", [](FrameNetwork& n) { return double(n.jammed().size()); }},
    {"bridging_clusters", "1", "clusters of jammed particles loaded by blade and vessel",
     [](FrameNetwork& n) {
       return double(std::count_if(n.clusters().begin(), n.clusters().end(), [](const Cluster& c) { return c.bridges; }));
     }},
    {"mean_repulsive_force", "N", "mean normal force of the compressed particle contacts",
     [](FrameNetwork& n) { return n.mean_force(); }, Cost::low,
     "no contact pushes"},
    {"strong_contact_share", "1", "share of compressed particle contacts above their mean force", of_graph<strong_contact_share>, Cost::low,
     "no contact pushes"},
    {"component_count", "1", "connected components of the contact network",
     [](FrameNetwork& n) { return component_count(n.components()); }},
    {"largest_component_share", "1", "share of particles in the largest component",
     [](FrameNetwork& n) { return largest_component_share(n.graph, n.components()); }, Cost::low,
     "no particles"},
    {"rattler_share", "1", "share of particles that their contacts cannot hold, with friction",
     [](FrameNetwork& n) { return n.loose().empty() ? unknown : sum(n.loose()) / double(n.loose().size()); }, Cost::low,
     "no particles"},
    {"sliding_share", "1", "share of particle contacts at their friction limit", of_graph<sliding_share>, Cost::low,
     "no contacts, or the source does not know which slide"},
    {"largest_sliding_cluster_share", "1", "share of particles in the largest cluster joined by sliding contacts",
     of_graph<largest_sliding_cluster_share>, Cost::low,
     "no particles, or the source does not know which contacts slide"},
    {"mean_mobilisation", "1", "tangential force over the friction limit, mean of the contacts that have one",
     [](FrameNetwork& n) { return mean_mobilisation(n.mobilised()); }, Cost::low,
     "no contact has a friction limit, or the source does not know tangential forces, materials or friction"},
    {"mean_contact_age", "s", "mean time for which the contacts have held",
     [](FrameNetwork& n) { return mean(contact_ages(n.graph.snapshot(), n.run.dt)); }, Cost::low,
     "no contacts, or the source does not know when they formed"},
    {"largest_core_number", "1", "largest k for which there is a k-core",
     [](FrameNetwork& n) { return n.cores().empty() ? unknown : double(*std::max_element(n.cores().begin(), n.cores().end())); }, Cost::low,
     "no particles"},
    {"triangle_count", "1", "triples of particles that touch each other", [](FrameNetwork& n) { return triangle_count(n.corners()); }},
    {"transitivity", "1", "share of pairs of contacts at a particle that a third contact closes",
     [](FrameNetwork& n) { return transitivity(n.graph, n.corners()); }, Cost::low,
     "no particle has two contacts"},
    {"mean_clustering", "1", "mean clustering coefficient of the particles with two or more contacts",
     [](FrameNetwork& n) { return mean_clustering(n.graph, n.corners()); }, Cost::low,
     "no particle has two contacts"},
    {"independent_cycles", "1", "cyclomatic number of the contact network",
     [](FrameNetwork& n) { return independent_cycles(n.graph, n.components()); }},
    {"basis_cycles_of_3", "1", "cycles of three contacts in a minimum cycle basis",
     [](FrameNetwork& n) { return double(n.basis_cycles()[3]); }, Cost::high},
    {"basis_cycles_of_4", "1", "cycles of four contacts in a minimum cycle basis",
     [](FrameNetwork& n) { return double(n.basis_cycles()[4]); }, Cost::high},
    {"basis_cycles_of_5", "1", "cycles of five contacts in a minimum cycle basis",
     [](FrameNetwork& n) { return double(n.basis_cycles()[5]); }, Cost::high},
    {"basis_cycles_of_6", "1", "cycles of six contacts in a minimum cycle basis",
     [](FrameNetwork& n) { return double(n.basis_cycles()[6]); }, Cost::high},
    {"cut_edge_count", "1", "contacts without which their component falls in two (bridges of graph theory)",
     [](FrameNetwork& n) { return sum(n.biconnected().cut_edge); }},
    {"articulation_point_count", "1", "particles without which their component falls apart",
     [](FrameNetwork& n) { return sum(n.biconnected().articulation_point); }},
    {"path_efficiency", "1", "mean over the pairs of particles of 1 over the contacts on their shortest path",
     [](FrameNetwork& n) { return n.paths().efficiency; }, Cost::high,
     "fewer than two particles"},
    {"mean_path_length", "1", "contacts on the shortest path, mean of the pairs that one joins",
     [](FrameNetwork& n) { return n.paths().mean; }, Cost::high,
     "no contacts"},
    {"longest_path_length", "1", "contacts on the longest of the shortest paths: the diameter",
     [](FrameNetwork& n) { return n.paths().longest; }, Cost::high,
     "no contacts"},
    {"algebraic_connectivity", "1", "second smallest eigenvalue of the Laplacian of the largest component",
     [](FrameNetwork& n) { return algebraic_connectivity(n.graph); }, Cost::high,
     "no contacts, or the iteration for it does not converge"},
    {"zero_modes", "1", "motions of the particles that no contact resists, walls held still",
     [](FrameNetwork& n) { return double(n.rigid().zero_modes()); }, Cost::high},
    {"self_stresses", "1", "independent sets of contact forces in balance by themselves",
     [](FrameNetwork& n) { return double(n.rigid().self_stresses()); }, Cost::high},
    {"community_count", "1", "communities of the force network, single particles included",
     [](FrameNetwork& n) { return n.groups().size.empty() ? unknown : double(n.groups().size.size()); }, Cost::high,
     "no particles"},
    {"modularity", "1", "quality of the communities against the geographical null model, over the sum of all repulsive forces",
     [](FrameNetwork& n) { return n.groups().modularity; }, Cost::high,
     "no contact pushes"},
    {"gap_factor", "1", "how far the communities branch and enclose gaps; near 0 for a compact block",
     [](FrameNetwork& n) { return gap_factor(n.graph, n.groups()); }, Cost::high,
     "no community in which both distances vary"},
    {"hull_ratio", "1", "volume of the convex hull of a community over that of its particles, mean",
     [](FrameNetwork& n) { return hull_ratio(n.graph, n.groups()); }, Cost::high,
     "no community of four particles that are not in one plane"},
    {"parts_at_mean_force", "1", "parts of the network of the contacts above the mean force (Betti number 0)",
     [](FrameNetwork& n) { return double(betti_number(n.parts(), n.mean_force())); }},
    {"loops_at_mean_force", "1", "loops of that network that its triangles do not fill (Betti number 1)",
     [](FrameNetwork& n) { return double(betti_number(n.loops(), n.mean_force())); }},
    {"persistence_of_parts", "1", "sum over the parts of birth less death, over the mean force",
     [](FrameNetwork& n) { return n.parts().empty() ? unknown : total_persistence(n.parts()) / n.mean_force(); }, Cost::low,
     "no contact pushes"},
    {"persistence_of_loops", "1", "the same of the loops that triangles do not fill",
     [](FrameNetwork& n) { return n.parts().empty() ? unknown : total_persistence(n.loops()) / n.mean_force(); }, Cost::low,
     "no contact pushes"},
    {"fabric_anisotropy", "1", "anisotropy of the contacts' directions", of_graph<fabric_anisotropy>, Cost::low,
     "no contacts"},
    {"force_fabric_anisotropy", "1", "the same, contacts weighted by their repulsive force", of_graph<force_fabric_anisotropy>, Cost::low,
     "no contact pushes"},
    {"strong_fabric_anisotropy", "1", "the same of the contacts above the mean repulsive force", of_graph<strong_fabric_anisotropy>, Cost::low,
     "no contact pushes with more than the mean"},
    {"weak_fabric_anisotropy", "1", "the same of the other repulsive contacts", of_graph<weak_fabric_anisotropy>, Cost::low,
     "no contact pushes with less than the mean"},
    {"force_chain_count", "1", "linear force chains (Peters et al.)", [](FrameNetwork& n) { return double(n.chains().size()); }},
    {"force_chain_share", "1", "share of particles in force chains",
     [](FrameNetwork& n) { return force_chain_share(n.graph, n.chains()); }, Cost::low,
     "no particles"},
    {"mean_force_chain_length", "1", "particles of a force chain in the mean",
     [](FrameNetwork& n) { return mean_force_chain_length(n.chains()); }, Cost::low,
     "no force chains"},
    {"bridging_force_chains", "1", "force chains from blade to vessel", [](FrameNetwork& n) { return bridging_force_chains(n.chains()); }},
    {"chain_straightness", "1", "end-to-end distance of a force chain over its length along the links, mean",
     [](FrameNetwork& n) { return chain_straightness(n.graph, n.chains()); }, Cost::low,
     "no force chains"},
    {"chain_bend", "rad", "turn from one link of a force chain to the next, mean",
     [](FrameNetwork& n) { return chain_bend(n.graph, n.chains()); }, Cost::low,
     "no force chains"},
    {"chain_across_gap", "1", "|cos| between a force chain and the radius from the blade's axis, mean",
     [](FrameNetwork& n) { return chain_alignment(n.graph, n.run.walls, n.chains(), GapDirection::across); }, Cost::low,
     "no force chains, or no blade"},
    {"chain_along_tip", "1", "|cos| between a force chain and the path of the blade's tip, mean",
     [](FrameNetwork& n) { return chain_alignment(n.graph, n.run.walls, n.chains(), GapDirection::along); }, Cost::low,
     "no force chains, or no blade"},
    {"bridge_strength", "N", "weakest contact of the strongest path from blade to vessel",
     [](FrameNetwork& n) { return n.bridge().strength; }},
    {"largest_bridge_betweenness", "1", "largest betweenness of a particle on the shortest paths from blade to vessel",
     [](FrameNetwork& n) { return largest(n.between().particle); }, Cost::high,
     "no particles"},
    {"bridge_flow", "N", "maximum flow of repulsive force from blade to vessel", [](FrameNetwork& n) { return n.flow().value; }},
    {"bridge_conductance", "N", "conductance from blade to vessel, a contact's being its repulsive force", of_graph<bridge_conductance>, Cost::high},
    {"contact_disjoint_load_paths", "1", "paths from blade to vessel that share no contact",
     [](FrameNetwork& n) { return double(contact_disjoint_load_paths(n.graph)); }, Cost::high},
    {"particle_disjoint_load_paths", "1", "paths from blade to vessel that share no particle",
     [](FrameNetwork& n) { return double(particle_disjoint_load_paths(n.graph)); }, Cost::high},
});

constexpr auto of_changes = std::to_array<ChangeMetric>({
    {"contact_survival", "1", "share of the contacts of the frame before that still hold",
     [](FrameNetwork& a, FrameNetwork& b) { return contact_survival(a.graph.snapshot(), b.graph.snapshot()); }, Cost::low,
     "no contacts in the frame before"},
    {"contact_renewal", "1", "share of the contacts that were not there in the frame before",
     [](FrameNetwork& a, FrameNetwork& b) { return contact_renewal(a.graph.snapshot(), b.graph.snapshot()); }, Cost::low,
     "no contacts"},
    {"lost_contact_age", "s", "mean time for which the contacts lost since had held at the frame before",
     [](FrameNetwork& a, FrameNetwork& b) { return lost_contact_age(a.graph.snapshot(), b.graph.snapshot(), a.run.dt); }, Cost::low,
     "no contact is lost, or the source does not know when they formed"},
    {"broken_cluster_share", "1", "share of particles in the largest cluster joined by the contacts lost since",
     [](FrameNetwork& a, FrameNetwork& b) { return broken_cluster_share(a.graph, b.graph.snapshot()); }, Cost::low, "no particles"},
    {"bottleneck_of_parts", "N", "bottleneck distance of the persistence diagrams of parts",
     [](FrameNetwork& a, FrameNetwork& b) { return bottleneck_distance(a.parts(), b.parts()); }, Cost::high},
    {"bottleneck_of_loops", "N", "bottleneck distance of the persistence diagrams of loops that triangles do not fill",
     [](FrameNetwork& a, FrameNetwork& b) { return bottleneck_distance(a.loops(), b.loops()); }, Cost::high},
    {"wasserstein_of_parts", "N", "Wasserstein distance (q = 1) of the persistence diagrams of parts",
     [](FrameNetwork& a, FrameNetwork& b) { return wasserstein_distance(a.parts(), b.parts()); }, Cost::high},
    {"wasserstein_of_loops", "N", "Wasserstein distance (q = 1) of the persistence diagrams of loops that triangles do not fill",
     [](FrameNetwork& a, FrameNetwork& b) { return wasserstein_distance(a.loops(), b.loops()); }, Cost::high},
});

constexpr auto of_each_particle = std::to_array<ParticleMetric>({
    {"contacts", "1", "contacts with other particles",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.graph.degree(v)); }); }},
    {"wall_contacts", "1", "contacts with walls",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.graph.wall_contacts(v).size()); }); }},
    {"compressive_force", "N", "sum of the repulsive normal forces, walls included", [](FrameNetwork& n) { return n.compressive(); }},
    {"largest_contact_force", "N", "largest repulsive normal force, walls included",
     [](FrameNetwork& n) { return compressive_forces(n.graph, CompressiveMeasure::max); }},
    {"jammed", "1", "1 where the compressive force is above the jam force (20 N)",
     [](FrameNetwork& n) {
       std::vector<double> is(n.graph.vertex_count(), 0.0);
       for (const JammedParticle& j : n.jammed()) is[j.row] = 1;
       return is;
     }},
    {"component_size", "1", "particles of the component that it belongs to",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.components().size[n.components().label[v]]); }); }},
    {"rattler", "1", "1 where its contacts cannot hold it, with friction", [](FrameNetwork& n) { return as_values(n.loose()); }},
    {"core_number", "1", "largest k for which it belongs to the k-core", [](FrameNetwork& n) { return as_values(n.cores()); }},
    {"triangles", "1", "triangles of contacts that it is a corner of", [](FrameNetwork& n) { return as_values(n.corners()); }},
    {"clustering_coefficient", "1", "share of pairs of its partners that touch each other; none with fewer than two partners",
     [](FrameNetwork& n) { return clustering_coefficient(n.graph, n.corners()); }, Cost::low,
     "fewer than two contacts"},
    {"force_clustering", "1", "the same with the repulsive forces as weights (Barrat)", [](FrameNetwork& n) { return force_clustering(n.graph); }, Cost::low,
     "fewer than two contacts, or none that pushes"},
    {"community", "1", "number of the community that it belongs to, the largest is 0",
     [](FrameNetwork& n) { return as_values(n.groups().label); }, Cost::high},
    {"community_size", "1", "particles of that community",
     [](FrameNetwork& n) { return of_particles(n, [&](auto v) { return double(n.groups().size[n.groups().label[v]]); }); }, Cost::high},
    {"betweenness", "1", "shortest paths between all other particles through it, each pair once, shared among equal ones",
     [](FrameNetwork& n) { return betweenness(n.graph, {}, BetweennessOf::particles).particle; }, Cost::high},
    {"cell_volume", "m^3", "volume of its power cell, bounded by the walls; none for an open one", [](FrameNetwork& n) { return n.cells(); }, Cost::high,
     "the cell is open: the particle lies at a free surface"},
    {"local_solid_fraction", "1", "its volume over that of its power cell; none for an open one",
     [](FrameNetwork& n) { return local_solid_fraction(n.graph.snapshot(), n.cells()); }, Cost::high,
     "the cell is open: the particle lies at a free surface"},
    {"mean_stress_of_cell", "Pa", "third of the trace of its stress, per volume of its power cell; compression is negative",
     [](FrameNetwork& n) {
       const std::vector<double> fraction = local_solid_fraction(n.graph.snapshot(), n.cells());
       return of_particles(n, [&](auto v) { return n.stress()[v].trace() / 3 * fraction[v]; });
     }, Cost::high,
     "the cell is open: the particle lies at a free surface"},
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
     [](FrameNetwork& n) { return n.between().particle; }, Cost::high},
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
      }, Cost::low,
      "no contact pushes"}},
    {{"cut_edge", "1", "1 where its component falls in two without it",
      [](FrameNetwork& n) { return as_values(n.biconnected().cut_edge); }}},
    {{"tangential_force", "N", "size of the tangential force",
      [](FrameNetwork& n) {
        const ParticleContacts& pp = n.graph.snapshot().pp;
        const bool known = present(pp.tangential_force, pp.size());
        return of_contacts(n, [&](auto c) { return known ? pp.tangential_force[c].template cast<double>().norm() : unknown; });
      }, Cost::low,
      "the source does not know tangential forces"}},
    {{"mobilisation", "1", "tangential force over the friction limit, that of JKR with adhesion", [](FrameNetwork& n) { return n.mobilised(); }, Cost::low,
      "no friction limit, or the source does not know tangential forces, materials or friction"}},
    {{"age", "s", "time for which it has held",
      [](FrameNetwork& n) { return or_unknown(contact_ages(n.graph.snapshot(), n.run.dt), n.graph.edge_count()); }, Cost::low,
      "the source does not know when contacts formed"}},
    {{"bridge_betweenness", "1", "shortest paths from blade to vessel over it, shared among equal ones",
      [](FrameNetwork& n) { return n.between().contact; }, Cost::high}},
    {{"betweenness", "1", "shortest paths between all particles over it, each pair once, shared among equal ones",
      [](FrameNetwork& n) { return betweenness(n.graph).contact; }, Cost::high}},
    {{"force_betweenness", "1", "the same with paths that seek strong contacts: lengths 1/f",
      [](FrameNetwork& n) { return betweenness(n.graph, inverse_forces(n.graph)).contact; }, Cost::high}},
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
std::span<const ChangeMetric> change_metrics() {
  return of_changes;
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
