// Sets of particles that are joined one contact after the other (boost::disjoint_sets with memory of its own).
#pragma once
#include <boost/pending/disjoint_sets.hpp>
#include <cstdint>
#include <numeric>
#include <vector>

namespace jam {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : depth_(n, 0), parent_(n), sets_(depth_.data(), parent_.data()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  DisjointSets(const DisjointSets&) = delete;

  // One of the members, the same for all of them until the set is joined to another.
  std::uint32_t of(std::uint32_t v) { return sets_.find_set(v); }
  void join(std::uint32_t a, std::uint32_t b) { sets_.union_set(a, b); }

 private:
  std::vector<std::uint32_t> depth_, parent_;
  boost::disjoint_sets<std::uint32_t*, std::uint32_t*> sets_;
};

}  // namespace jam
