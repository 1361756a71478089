#include "libjam/graph/diagram_distance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace jam {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double infinite = std::numeric_limits<double>::infinity();

double distance(const PersistencePair& p, const PersistencePair& q) {
  return std::max(std::abs(p.birth - q.birth), std::abs(p.death - q.death));
}
double from_diagonal(const PersistencePair& p) {
  return p.persistence() / 2;
}

// Can every point of `from` farther than `reach` from the diagonal be given a partner of its own in `to` within `reach`?
class Cover {
 public:
  Cover(const PersistenceDiagram& from, const PersistenceDiagram& to, double reach)
      : from_(from), to_(to), reach_(reach), partner_(to.size(), none), seen_(to.size(), none), taken_by_(to.size(), none) {}
  bool possible() {
    for (std::uint32_t k = 0; k < from_.size(); ++k)
      if (from_diagonal(from_[k]) > reach_ && !give(k)) return false;
    return true;
  }

 private:
  // Frees a partner for `start` by a search breadth first over those who could move to another.
  bool give(std::uint32_t start) {
    std::vector<std::uint32_t> front{start};
    for (std::size_t k = 0; k < front.size(); ++k) {
      // `to` descends with birth, so the candidates stand together.
      const double birth = from_[front[k]].birth;
      auto near = std::partition_point(to_.begin(), to_.end(), [&](const PersistencePair& p) { return p.birth > birth + 2 * reach_; });
      for (; near != to_.end() && near->birth >= birth - 2 * reach_; ++near) {
        const std::uint32_t at = std::uint32_t(near - to_.begin());
        if (seen_[at] == start || distance(from_[front[k]], *near) > reach_) continue;
        seen_[at] = start;
        taken_by_[at] = front[k];
        if (partner_[at] != none) {
          front.push_back(partner_[at]);
          continue;
        }
        for (std::uint32_t place = at; place != none;) {
          const std::uint32_t owner = taken_by_[place];
          const auto before = std::find(partner_.begin(), partner_.end(), owner);
          partner_[place] = owner;
          place = owner == start ? none : std::uint32_t(before - partner_.begin());
        }
        return true;
      }
    }
    return false;
  }

  const PersistenceDiagram &from_, &to_;
  double reach_;
  std::vector<std::uint32_t> partner_;  // of each of `to`
  std::vector<std::uint32_t> seen_;     // last search that came to each of `to`
  std::vector<std::uint32_t> taken_by_;  // who would take it in that search
};

// The matching of largest saving against leaving all points to the diagonal: shortest augmenting paths over the pairs that save something
// (Jonker and Volgenant, Computing 38, 325, 1987).
class Assignment {
 public:
  Assignment(const PersistenceDiagram& a, const PersistenceDiagram& b, double q)
      : pairs_(a.size()), profit_(a.size(), 0.0), price_(b.size(), 0.0), loss_(b.size(), infinite), via_(b.size(), none),
        mate_of_a_(a.size(), none), mate_of_b_(b.size(), none), settled_(b.size(), 0) {
    const auto power = [q](double x) { return q == 1 ? x : q == 2 ? x * x : std::pow(x, q); };
    for (const PersistencePair& p : b) cost_ += power(from_diagonal(p));
    for (std::uint32_t i = 0; i < a.size(); ++i) {
      cost_ += power(from_diagonal(a[i]));
      for (std::uint32_t j = 0; j < b.size(); ++j) {
        const double apart = distance(a[i], b[j]);
        if (apart >= from_diagonal(a[i]) + from_diagonal(b[j])) continue;  // nor is its power below the sum of theirs
        const double saved = power(from_diagonal(a[i])) + power(from_diagonal(b[j])) - power(apart);
        if (saved > 0) pairs_[i].push_back({j, saved});
      }
    }
    for (std::uint32_t i = 0; i < a.size(); ++i) insert(i);
    for (std::uint32_t i = 0; i < a.size(); ++i)
      for (const Pair& pair : pairs_[i])
        if (pair.j == mate_of_a_[i]) cost_ -= pair.saved;
  }
  double cost() const { return std::max(cost_, 0.0); }

 private:
  struct Pair {
    std::uint32_t j;
    double saved;
  };
  struct Entry {
    double loss;
    std::uint32_t j;
    bool operator<(const Entry& other) const { return loss > other.loss || (loss == other.loss && j > other.j); }
  };

  // Point i comes in. The chain of swaps that loses least of its profit ends at a free point of `b`, or with somebody, perhaps i itself,
  // who goes to the diagonal. Duals: profit_i + price_j >= saved_ij, with equality for mates; both >= 0, and 0 for who has no mate.
  void insert(std::uint32_t i) {
    for (const Pair& pair : pairs_[i]) profit_[i] = std::max(profit_[i], pair.saved - price_[pair.j]);
    double best = profit_[i];
    std::uint32_t last_i = i, last_j = none;  // ends with last_i on the diagonal, or at the free last_j
    std::priority_queue<Entry> front;
    std::vector<std::uint32_t> touched;
    std::vector<std::pair<std::uint32_t, double>> reached{{i, 0.0}};  // points of `a` with the loss at which the search came to them
    while (last_j == none) {
      const auto [at, so_far] = reached.back();
      for (const Pair& pair : pairs_[at]) {
        const double loss = so_far + std::max(profit_[at] + price_[pair.j] - pair.saved, 0.0);
        if (settled_[pair.j] || !(loss < loss_[pair.j]) || !(loss < best)) continue;
        if (loss_[pair.j] == infinite) touched.push_back(pair.j);
        loss_[pair.j] = loss;
        via_[pair.j] = at;
        front.push({loss, pair.j});
      }
      while (!front.empty() && settled_[front.top().j]) front.pop();
      if (front.empty() || front.top().loss >= best) break;
      const auto [loss, j] = front.top();
      settled_[j] = 1;
      const std::uint32_t mate = mate_of_b_[j];
      if (mate == none) {
        best = loss;
        last_j = j;
      } else {
        reached.push_back({mate, loss});
        if (loss + profit_[mate] < best) {
          best = loss + profit_[mate];
          last_i = mate;
        }
      }
    }
    for (const auto& [mover, loss] : reached) profit_[mover] -= std::max(best - loss, 0.0);
    for (const std::uint32_t j : touched)
      if (settled_[j]) price_[j] += std::max(best - loss_[j], 0.0);
    if (last_j == none) {
      last_j = mate_of_a_[last_i];
      mate_of_a_[last_i] = none;
    }
    while (last_j != none) {  // back along the chain: each takes the one by which the search went on
      const std::uint32_t taker = via_[last_j];
      mate_of_b_[last_j] = taker;
      std::swap(last_j, mate_of_a_[taker]);
    }
    for (const std::uint32_t j : touched) loss_[j] = infinite, settled_[j] = 0;
  }

  std::vector<std::vector<Pair>> pairs_;  // of each of `a`
  std::vector<double> profit_, price_, loss_;
  std::vector<std::uint32_t> via_, mate_of_a_, mate_of_b_;
  std::vector<std::uint8_t> settled_;
  double cost_ = 0;
};

}  // namespace

double bottleneck_distance(const PersistenceDiagram& a, const PersistenceDiagram& b) {
  // A matching that covers the far points of one side and another that covers those of the other side make one that covers both
  // (Mendelsohn and Dulmage, Can. J. Math. 10, 517, 1958).
  const auto possible = [&](double reach) { return Cover(a, b, reach).possible() && Cover(b, a, reach).possible(); };
  double highest = 0;
  for (const PersistenceDiagram* diagram : {&a, &b})
    for (const PersistencePair& p : *diagram) highest = std::max(highest, from_diagonal(p));
  if (possible(0)) return 0;
  // Bisection over the floating-point numbers themselves: the answer is the smallest of them that is possible.
  std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(highest);
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (possible(std::bit_cast<double>(middle)) ? high : low) = middle;
  }
  return std::bit_cast<double>(high);
}

double wasserstein_distance(const PersistenceDiagram& a, const PersistenceDiagram& b, double q) {
  const double cost = Assignment(a, b, q).cost();
  return q == 1 ? cost : std::pow(cost, 1 / q);
}

}  // namespace jam
