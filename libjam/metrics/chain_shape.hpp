// Shape of the linear force chains of a frame (libjam/graph/force_chains.hpp), rings left out.
//
//   chain_straightness    mean of end-to-end distance over contour length, 1 for straight chains
//   chain_bend            rad, mean over all three successive particles of a chain of the angle by which the second link turns from the
//                         first: the three-particle buckling angle (Tordesillas, Philos. Mag. 87, 4987, 2007) of one instant
//   chain_across_gap      mean of |cos| of the angle between end-to-end line and the radius from the blade's axis, the gap's normal, at
//                         the chain's middle: 1/2 for directions without preference
//   chain_along_tip       the same with the direction in which the blade's tip moves there
//
// The axis is the z axis of the first wall of role blade. NaN without chains, or without a blade.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "libjam/graph/force_chains.hpp"

namespace jam {

// Mean of f(chain's centres in order) over the open chains for which it is a number.
template <class F>
double mean_over_chains(const ContactGraph& graph, const std::vector<ForceChain>& chains, F f) {
  double sum = 0, count = 0;
  for (const ForceChain& chain : chains) {
    if (chain.links >= chain.particles.size()) continue;
    std::vector<Vec3> centres;
    for (const ContactGraph::Vertex v : chain.particles) centres.push_back(graph.snapshot().particles.position[v].cast<double>());
    if (const double value = f(chain, centres); !std::isnan(value)) sum += value, count += 1;
  }
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

inline double chain_straightness(const ContactGraph& graph, const std::vector<ForceChain>& chains) {
  return mean_over_chains(graph, chains, [](const ForceChain& c, const auto&) { return c.end_to_end / c.contour; });
}

inline double chain_bend(const ContactGraph& graph, const std::vector<ForceChain>& chains) {
  double sum = 0, count = 0;
  mean_over_chains(graph, chains, [&](const ForceChain&, const std::vector<Vec3>& x) {
    for (std::size_t k = 2; k < x.size(); ++k) {
      const Vec3 first = x[k - 1] - x[k - 2], second = x[k] - x[k - 1];
      sum += std::atan2(first.cross(second).norm(), first.dot(second));
      count += 1;
    }
    return 0.0;
  });
  return sum / (count > 0 ? count : std::numeric_limits<double>::quiet_NaN());
}

enum class GapDirection { across, along };
inline double chain_alignment(const ContactGraph& graph, const std::vector<Wall>& walls, const std::vector<ForceChain>& chains,
                              GapDirection direction) {
  const auto blade = std::find_if(walls.begin(), walls.end(), [](const Wall& w) { return w.role == WallRole::blade; });
  if (blade == walls.end() || chains.empty()) return std::numeric_limits<double>::quiet_NaN();
  const WallState& state = graph.snapshot().walls[std::size_t(blade - walls.begin())];
  const Vec3 origin = state.position, axis = state.orientation * Vec3::UnitZ();
  return mean_over_chains(graph, chains, [&](const ForceChain&, const std::vector<Vec3>& x) {
    Vec3 radius = (x.front() + x.back()) / 2 - origin;
    radius -= radius.dot(axis) * axis;
    const Vec3 line = direction == GapDirection::across ? radius : Vec3(axis.cross(radius));
    return std::abs((x.back() - x.front()).normalized().dot(line.normalized()));
  });
}

}  // namespace jam
