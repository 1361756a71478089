#include "libjam/graph/algebraic_connectivity.hpp"

#include <Spectra/MatOp/SparseSymShiftSolve.h>
#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <limits>
#include <vector>

#include "libjam/graph/components.hpp"

namespace jam {

double algebraic_connectivity(const ContactGraph& graph, std::span<const double> weight) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto weight_of = [&](std::uint32_t c) { return weight.empty() ? 1.0 : weight[c]; };
  std::vector<std::uint8_t> joins(graph.edge_count());
  for (std::uint32_t c = 0; c < joins.size(); ++c) joins[c] = weight_of(c) > 0;
  const Components components = connected_components(graph, joins);
  if (components.size.empty() || components.size[0] < 2) return unknown;

  const int n = int(components.size[0]);
  std::vector<int> place(graph.vertex_count(), -1);
  int next = 0;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (components.label[v] == 0) place[v] = next++;
  std::vector<Eigen::Triplet<double>> entries;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    if (place[v] < 0) continue;
    double diagonal = 0;
    for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
      if (!joins[neighbor.contact]) continue;
      const double w = weight_of(neighbor.contact);
      entries.emplace_back(place[v], place[neighbor.vertex], -w);
      diagonal += w;
    }
    entries.emplace_back(place[v], place[v], diagonal);
  }
  Eigen::SparseMatrix<double> laplacian(n, n);
  laplacian.setFromTriplets(entries.begin(), entries.end());

  constexpr int small = 200;
  if (n <= small) return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(laplacian), Eigen::EigenvaluesOnly).eigenvalues()[1];
  // The two smallest, 0 and lambda_2: those nearest to a shift just below 0.
  const double shift = -1e-6 * laplacian.diagonal().sum() / n;
  Spectra::SparseSymShiftSolve<double> solve(laplacian);
  Spectra::SymEigsShiftSolver<Spectra::SparseSymShiftSolve<double>> solver(solve, 2, 40, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-12);
  if (solver.info() != Spectra::CompInfo::Successful) return unknown;
  return solver.eigenvalues().maxCoeff();
}

}  // namespace jam
