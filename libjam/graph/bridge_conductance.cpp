#include "libjam/graph/bridge_conductance.hpp"

#include <Eigen/SparseCholesky>
#include <limits>
#include <vector>

#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

double at_wall(const ContactGraph& graph, ContactGraph::Vertex v, WallRole role) {
  double sum = 0;
  for (const std::uint32_t c : graph.wall_contacts(v, role)) sum += repulsive_force(graph.snapshot().pw, c);
  return sum;
}

// Particles that a path of repulsive contacts, the last of them with the vessel, joins to it.
std::vector<ContactGraph::Vertex> joined_to_vessel(const ContactGraph& graph) {
  std::vector<ContactGraph::Vertex> found;
  std::vector<std::uint8_t> seen(graph.vertex_count(), 0);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (at_wall(graph, v, WallRole::vessel) > 0) {
      found.push_back(v);
      seen[v] = 1;
    }
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const ContactGraph::Neighbor& n : graph.neighbors(found[k]))
      if (!seen[n.vertex] && repulsive_force(graph.snapshot().pp, n.contact) > 0) {
        seen[n.vertex] = 1;
        found.push_back(n.vertex);
      }
  return found;
}

}  // namespace

double bridge_conductance(const ContactGraph& graph) {
  // Without those that do not reach the vessel (no current flows there) the matrix is positive definite.
  const std::vector<ContactGraph::Vertex> particles = joined_to_vessel(graph);
  std::vector<std::uint32_t> row(graph.vertex_count(), none);
  for (std::size_t k = 0; k < particles.size(); ++k) row[particles[k]] = std::uint32_t(k);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd fed(Eigen::Index(particles.size()));
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const ContactGraph::Vertex v = particles[k];
    fed[Eigen::Index(k)] = at_wall(graph, v, WallRole::blade);
    double diagonal = fed[Eigen::Index(k)] + at_wall(graph, v, WallRole::vessel);
    for (const ContactGraph::Neighbor& n : graph.neighbors(v)) {
      const double force = repulsive_force(graph.snapshot().pp, n.contact);
      if (force <= 0) continue;
      diagonal += force;
      if (row[n.vertex] < k) entries.emplace_back(int(k), int(row[n.vertex]), -force);
    }
    entries.emplace_back(int(k), int(k), diagonal);
  }
  if (fed.size() == 0 || fed.maxCoeff() <= 0) return 0;
  Eigen::SparseMatrix<double> laplacian(fed.size(), fed.size());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(laplacian);
  const Eigen::VectorXd potential = factors.solve(fed);
  return fed.dot(Eigen::VectorXd::Ones(fed.size()) - potential);
}

}  // namespace jam
