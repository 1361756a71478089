#include "libjam/graph/minimum_cut.hpp"

#include <algorithm>
#include <numeric>

namespace jam {
namespace {

constexpr std::uint32_t nobody = ~0u;

// Flow runs backwards here: excess starts at the sink and is pushed towards the source along arcs that can still carry flow the other
// way. Where it can no longer get to is then beyond the smallest cut around the source, and no second pass is needed to take it home.
class BackwardPreflow {
 public:
  BackwardPreflow(std::uint32_t nodes, std::span<const FlowLink> links, std::uint32_t source, std::uint32_t sink)
      : first_(nodes + 1, 0), arcs_(2 * links.size()), excess_(nodes, 0), level_(nodes), current_(nodes), next_active_(nodes),
        next_(nodes), previous_(nodes), active_(nodes + 1, nobody), member_(nodes + 1, nobody), goal_(source), origin_(sink),
        unreachable_(nodes) {
    front_.reserve(nodes);
    lay_out(links);
    for (std::uint32_t a = first_[sink]; a < first_[sink + 1]; ++a) {
      const std::int64_t all = arcs_[a].residual;
      excess_[arcs_[a].to] += all;
      arcs_[arcs_[a].twin].residual += all;
      arcs_[a].residual = 0;
    }
  }

  void run() {
    find_distances();
    while (true) {
      while (top_ > 0 && active_[top_] == nobody) --top_;
      if (top_ == 0) return;
      const std::uint32_t v = active_[top_];
      active_[top_] = next_active_[v];
      discharge(v);
      // Levels drift from the true distances. Looking at each arc six times costs as much as finding them anew is worth.
      if (looked_at_ > 6 * arcs_.size()) find_distances();
    }
  }

  MinimumCut cut() {
    find_distances();
    MinimumCut cut{excess_[goal_], std::vector<std::uint8_t>(level_.size())};
    for (std::size_t v = 0; v < level_.size(); ++v) cut.source_side[v] = level_[v] != unreachable_;
    return cut;
  }

 private:
  struct Arc {
    std::uint32_t to, twin;  // twin: the same link seen from the other end
    std::int64_t residual;   // what can still be pushed to `to`, that is, what flow from `to` to here can still be added
  };

  void lay_out(std::span<const FlowLink> links) {
    for (const FlowLink& l : links) ++first_[l.from + 1], ++first_[l.to + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::copy(first_.begin(), first_.end() - 1, current_.begin());
    for (const FlowLink& l : links) {
      const std::uint32_t a = current_[l.from]++, b = current_[l.to]++;
      arcs_[a] = {l.to, b, l.back};
      arcs_[b] = {l.from, a, l.forth};
    }
  }

  // Every node's distance to the goal along arcs with a residual, breadth first; nothing is a level of those that cannot reach it.
  void find_distances() {
    looked_at_ = 0;
    std::fill(level_.begin(), level_.end(), unreachable_);
    std::fill_n(active_.begin(), highest_ + 1, nobody);
    std::fill_n(member_.begin(), highest_ + 1, nobody);
    top_ = highest_ = 0;
    level_[goal_] = 0;
    front_.assign(1, goal_);
    for (std::size_t k = 0; k < front_.size(); ++k) {
      const std::uint32_t v = front_[k];
      join_level(v);
      current_[v] = first_[v];
      if (v != goal_ && excess_[v] > 0) activate(v);
      for (std::uint32_t a = first_[v]; a < first_[v + 1]; ++a) {
        const std::uint32_t u = arcs_[a].to;
        if (level_[u] != unreachable_ || u == origin_ || arcs_[arcs_[a].twin].residual == 0) continue;
        level_[u] = level_[v] + 1;
        front_.push_back(u);
      }
    }
  }

  void activate(std::uint32_t v) {
    next_active_[v] = active_[level_[v]];
    active_[level_[v]] = v;
    top_ = std::max(top_, level_[v]);
  }

  void join_level(std::uint32_t v) {
    const std::uint32_t level = level_[v];
    previous_[v] = nobody;
    next_[v] = member_[level];
    if (next_[v] != nobody) previous_[next_[v]] = v;
    member_[level] = v;
    highest_ = std::max(highest_, level);
  }

  void leave_level(std::uint32_t v) {
    (previous_[v] == nobody ? member_[level_[v]] : next_[previous_[v]]) = next_[v];
    if (next_[v] != nobody) previous_[next_[v]] = previous_[v];
  }

  // Pushes all that v has one level down, and lifts v where that is not enough.
  void discharge(std::uint32_t v) {
    while (true) {
      std::uint32_t a = current_[v];
      for (; a < first_[v + 1]; ++a) {
        Arc& arc = arcs_[a];
        if (arc.residual == 0 || level_[arc.to] + 1 != level_[v]) continue;
        const std::int64_t pushed = std::min(excess_[v], arc.residual);
        arc.residual -= pushed;
        arcs_[arc.twin].residual += pushed;
        if (excess_[arc.to] == 0 && arc.to != goal_) activate(arc.to);
        excess_[arc.to] += pushed;
        if ((excess_[v] -= pushed) == 0) break;
      }
      current_[v] = a;
      if (excess_[v] == 0 || !lift(v)) return;
    }
  }

  // To just above its lowest neighbour; false where the goal is out of reach from there.
  bool lift(std::uint32_t v) {
    std::uint32_t lowest = unreachable_;
    for (std::uint32_t a = first_[v]; a < first_[v + 1]; ++a)
      if (arcs_[a].residual > 0 && level_[arcs_[a].to] < lowest) lowest = level_[arcs_[a].to], current_[v] = a;
    looked_at_ += first_[v + 1] - first_[v];
    leave_level(v);
    const std::uint32_t left = level_[v];
    if (member_[left] == nobody) {
      give_up_from(left);
      level_[v] = unreachable_;
      return false;
    }
    level_[v] = lowest == unreachable_ ? unreachable_ : lowest + 1;
    if (level_[v] == unreachable_) return false;
    join_level(v);
    return true;
  }

  // No node has this level: none above it has a way down.
  void give_up_from(std::uint32_t empty) {
    for (std::uint32_t level = empty; level <= highest_; ++level) {
      for (std::uint32_t v = member_[level]; v != nobody; v = next_[v]) level_[v] = unreachable_;
      member_[level] = active_[level] = nobody;
    }
    highest_ = empty;
  }

  std::vector<std::uint32_t> first_;  // [nodes + 1] into arcs_
  std::vector<Arc> arcs_;             // [2 links] by the node that they leave
  std::vector<std::int64_t> excess_;
  std::vector<std::uint32_t> level_, current_, next_active_, next_, previous_;  // [nodes]
  std::vector<std::uint32_t> active_, member_;  // [nodes + 1] first of each level's list: nodes with excess, and all
  std::vector<std::uint32_t> front_;
  std::uint32_t goal_, origin_, unreachable_, top_ = 0, highest_ = 0;
  std::size_t looked_at_ = 0;
};

}  // namespace

MinimumCut minimum_cut(std::uint32_t nodes, std::span<const FlowLink> links, std::uint32_t source, std::uint32_t sink) {
  BackwardPreflow flow(nodes, links, source, sink);
  flow.run();
  return flow.cut();
}

}  // namespace jam
