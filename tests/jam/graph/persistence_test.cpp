// Persistent homology of force networks against the reduction of whole boundary matrices, and distances of diagrams against all matchings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/diagram_distance.hpp"
#include "libjam/graph/persistence.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::for_random_networks;
using hand_made::hand_made_run;
using hand_made::Network;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// 20,000 forces over 30 orders of magnitude, many equal, many told apart only by their damping part.
TEST(RankedContacts, StandFromTheStrongestToTheWeakest) {
  std::mt19937 random(3);
  Snapshot s;
  s.particles.id = {0, 1};
  s.particles.position.resize(2, Vec3f::Zero());
  s.particles.radius.resize(2, 1.0f);
  for (int c = 0; c < 20000; ++c) {
    s.pp.row.push_back({0, 1});
    const float force = std::ldexp(float(random() % 64), int(random() % 100) - 50);
    s.pp.normal_force.push_back(random() % 5 == 0 ? -force : force);
    s.pp.damping_force.push_back(force * 1e-8f * float(random() % 3));
  }
  const RankedContacts ranked = contacts_by_force(ContactGraph(s, {}));
  std::vector<std::pair<double, std::int64_t>> expected, found;
  for (std::uint32_t c = 0; c < 20000; ++c)
    if (const double force = repulsive_force(s.pp, c); force > 0) expected.emplace_back(-force, c);
  std::sort(expected.begin(), expected.end());
  for (const RankedContact& contact : ranked) found.emplace_back(-contact.force, contact.contact);
  EXPECT_EQ(found, expected);
}

PersistencePair pair(double birth, double death) {
  return {birth, death};
}

TEST(Persistence, OfASquareWithADiagonal) {
  //  1 -9- 2        The parts {1, 2}, born at 9, and {3, 4}, born at 8, meet at 5; the square closes at 3 and the two
  //  | \   |5       triangles of the diagonal (2 N) fill it at 2. Contact 4~5 pulls: grain 5 is not part of it.
  //  3   \ |
  //  4 -8- 3 ..
  const Snapshot s = Network().touch(1, 2, 9).touch(3, 4, 8).touch(2, 3, 5).touch(1, 4, 3).touch(1, 3, 2).touch(4, 5, -1).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  EXPECT_THAT(persistence_of_components(graph, contacts_by_force(graph)), ElementsAre(pair(9, 0), pair(8, 5)));
  EXPECT_THAT(persistence_of_loops(graph, contacts_by_force(graph)), ElementsAre(pair(3, 0), pair(2, 0)));
  EXPECT_THAT(persistence_of_loops_not_filled(graph, contacts_by_force(graph)), ElementsAre(pair(3, 2)));
  EXPECT_EQ(betti_number(persistence_of_components(graph, contacts_by_force(graph)), 8), 2u);
  EXPECT_EQ(betti_number(persistence_of_components(graph, contacts_by_force(graph)), 5), 1u);
  EXPECT_EQ(betti_number(persistence_of_loops_not_filled(graph, contacts_by_force(graph)), 3), 1u);
  EXPECT_EQ(betti_number(persistence_of_loops_not_filled(graph, contacts_by_force(graph)), 2), 0u);
  EXPECT_EQ(total_persistence(persistence_of_components(graph, contacts_by_force(graph))), 12);
}

// A simplex of the flag complex with the force at which it comes in.
struct Simplex {
  double force;
  std::set<ContactGraph::Vertex> corners;
};

// The textbook: all simplices of the complex in order, the matrix of their boundaries reduced column by column from the left.
std::vector<PersistenceDiagram> reduced(const ContactGraph& graph, std::size_t top) {
  const auto& pp = graph.snapshot().pp;
  std::map<std::set<ContactGraph::Vertex>, double> forces;
  for (std::size_t c = 0; c < pp.size(); ++c) {
    const double force = repulsive_force(pp, c);
    if (force <= 0) continue;
    const auto [a, b] = pp.row[c];
    forces[{a, b}] = force;
    for (const auto v : {a, b}) forces[{v}] = std::max(forces[{v}], force);
  }
  if (top == 2)
    for (ContactGraph::Vertex a = 0; a < graph.vertex_count(); ++a)
      for (ContactGraph::Vertex b = a + 1; b < graph.vertex_count(); ++b)
        for (ContactGraph::Vertex c = b + 1; c < graph.vertex_count(); ++c)
          if (forces.count({a, b}) && forces.count({a, c}) && forces.count({b, c}))
            forces[{a, b, c}] = std::min({forces[{a, b}], forces[{a, c}], forces[{b, c}]});
  std::vector<Simplex> simplices;
  for (const auto& [corners, force] : forces) simplices.push_back({force, corners});
  std::stable_sort(simplices.begin(), simplices.end(), [](const Simplex& x, const Simplex& y) {
    return x.force != y.force ? x.force > y.force : x.corners.size() < y.corners.size();
  });
  std::map<std::set<ContactGraph::Vertex>, std::size_t> at;
  for (std::size_t k = 0; k < simplices.size(); ++k) at[simplices[k].corners] = k;
  std::vector<std::set<std::size_t>> columns(simplices.size());
  std::map<std::size_t, std::size_t> column_of;  // by last entry
  std::vector<PersistenceDiagram> diagrams(3);
  std::set<std::size_t> alive;
  for (std::size_t k = 0; k < simplices.size(); ++k) {
    std::set<std::size_t>& column = columns[k];
    if (simplices[k].corners.size() > 1)
      for (const auto corner : simplices[k].corners) {
        auto face = simplices[k].corners;
        face.erase(corner);
        column.insert(at.at(face));
      }
    while (!column.empty() && column_of.count(*column.rbegin()))
      for (const std::size_t row : columns[column_of[*column.rbegin()]])
        if (!column.erase(row)) column.insert(row);
    if (column.empty()) {
      alive.insert(k);
      continue;
    }
    const std::size_t born = *column.rbegin();
    column_of[born] = k;
    alive.erase(born);
    if (simplices[born].force > simplices[k].force)
      diagrams[simplices[born].corners.size() - 1].push_back({simplices[born].force, simplices[k].force});
  }
  for (const std::size_t k : alive) diagrams[simplices[k].corners.size() - 1].push_back({simplices[k].force, 0});
  for (PersistenceDiagram& diagram : diagrams) std::sort(diagram.begin(), diagram.end(), std::greater<>());
  return diagrams;
}

TEST(Persistence, IsThatOfTheWholeBoundaryMatrix) {
  std::size_t filled = 0;
  for_random_networks(18, [&](const ContactGraph& graph) {
    const auto graph_only = reduced(graph, 1), flag = reduced(graph, 2);
    EXPECT_EQ(persistence_of_components(graph, contacts_by_force(graph)), flag[0]);
    EXPECT_EQ(persistence_of_loops(graph, contacts_by_force(graph)), graph_only[1]);
    EXPECT_EQ(persistence_of_loops_not_filled(graph, contacts_by_force(graph)), flag[1]);
    for (const PersistencePair& p : flag[1]) filled += p.death > 0;
  });
  EXPECT_GT(filled, 30u);  // loops that triangles fill later, not at once
}

// Least cost over all ways to match points of a with points of b or with the diagonal.
template <class Combine>
double over_all_matchings(const PersistenceDiagram& a, const PersistenceDiagram& b, Combine combine) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<bool> taken(b.size(), false);
  const auto place = [&](auto self, std::size_t i, double cost) -> void {
    if (i == a.size()) {
      for (std::size_t j = 0; j < b.size(); ++j)
        if (!taken[j]) cost = combine(cost, b[j].persistence() / 2);
      best = std::min(best, cost);
      return;
    }
    self(self, i + 1, combine(cost, a[i].persistence() / 2));
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (taken[j]) continue;
      taken[j] = true;
      self(self, i + 1, combine(cost, std::max(std::abs(a[i].birth - b[j].birth), std::abs(a[i].death - b[j].death))));
      taken[j] = false;
    }
  };
  place(place, 0, 0.0);
  return best;
}

PersistenceDiagram random_diagram(std::mt19937& random, unsigned points) {
  PersistenceDiagram diagram;
  for (unsigned k = 0; k < points; ++k) {
    const double death = double(random() % 1000) / 100, life = double(1 + random() % 500) / 100;
    diagram.push_back({death + life, death});
  }
  std::sort(diagram.begin(), diagram.end(), std::greater<>());
  return diagram;
}

TEST(DiagramDistance, IsTheLeastOverAllMatchings) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 300; ++repeat) {
    const unsigned sizes[] = {unsigned(random() % 6), unsigned(random() % 6)};
    const PersistenceDiagram a = random_diagram(random, sizes[0]), b = random_diagram(random, sizes[1]);
    const double largest = over_all_matchings(a, b, [](double x, double y) { return std::max(x, y); });
    const double sum = over_all_matchings(a, b, [](double x, double y) { return x + y; });
    const double squares = over_all_matchings(a, b, [](double x, double y) { return x + y * y; });
    const double cubes = over_all_matchings(a, b, [](double x, double y) { return x + y * y * y; });
    EXPECT_EQ(bottleneck_distance(a, b), largest);
    EXPECT_NEAR(wasserstein_distance(a, b), sum, 1e-12);
    EXPECT_NEAR(wasserstein_distance(a, b, 2), std::sqrt(squares), 1e-12 + 1e-14 / std::max(std::sqrt(squares), 1e-3));
    EXPECT_NEAR(wasserstein_distance(a, b, 3), std::cbrt(cubes), 1e-9);
  }
}

TEST(DiagramDistance, IsADistance) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const PersistenceDiagram a = random_diagram(random, 60), b = random_diagram(random, 80), c = random_diagram(random, 70);
    for (const auto distance : {+[](const PersistenceDiagram& x, const PersistenceDiagram& y) { return bottleneck_distance(x, y); },
                                +[](const PersistenceDiagram& x, const PersistenceDiagram& y) { return wasserstein_distance(x, y); }}) {
      EXPECT_NEAR(distance(a, a), 0, 1e-12);
      EXPECT_NEAR(distance(a, b), distance(b, a), 1e-10);
      EXPECT_LE(distance(a, c), distance(a, b) + distance(b, c) + 1e-10);
    }
    EXPECT_LE(bottleneck_distance(a, b), wasserstein_distance(a, b) + 1e-12);
  }
}

// A diagram and the empty one: half the persistences. A point moved by 0.3: 0.3 by all measures.
TEST(DiagramDistance, OfPlainCases) {
  const PersistenceDiagram one{pair(9, 1), pair(5, 3)}, moved{pair(9.25, 1), pair(5, 3)};
  EXPECT_EQ(bottleneck_distance(one, {}), 4);
  EXPECT_EQ(wasserstein_distance({}, one), 5);
  EXPECT_EQ(bottleneck_distance(one, moved), 0.25);
  EXPECT_NEAR(wasserstein_distance(one, moved), 0.25, 1e-14);
  EXPECT_EQ(bottleneck_distance({}, {}), 0);
  EXPECT_EQ(wasserstein_distance({}, {}), 0);
}

}  // namespace
}  // namespace jam
