#include "libjam/statistics/run_groups.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_quantiles = 256;

// Which runs of a + b are in the first group, a of them.
using Dealing = std::vector<std::uint32_t>;

// Number of ways, or more than `most`.
std::size_t ways(std::size_t a, std::size_t b, std::size_t most) {
  double n = 1;
  for (std::size_t k = 1; k <= std::min(a, b); ++k) n *= double(a + b + 1 - k) / double(k);
  return n > double(most) ? most + 1 : std::size_t(std::lround(n));
}

// As they are first; then all others, or, where they are more than `most`, random ones.
std::vector<Dealing> dealings_among_all(std::size_t a, std::size_t b, std::size_t most) {
  Dealing dealing(a);
  std::iota(dealing.begin(), dealing.end(), 0U);
  std::vector<Dealing> all{dealing};
  if (ways(a, b, most) > most) {
    std::mt19937_64 random(1);
    std::vector<std::uint32_t> runs(a + b);
    std::iota(runs.begin(), runs.end(), 0U);
    while (all.size() < most) {
      for (std::size_t k = 0; k < a; ++k) std::swap(runs[k], runs[k + random() % (a + b - k)]);
      all.emplace_back(runs.begin(), runs.begin() + std::ptrdiff_t(a));
    }
    return all;
  }
  for (;;) {  // the next in order of the alphabet
    std::size_t k = a;
    while (k > 0 && dealing[k - 1] == b + k - 1) --k;
    if (k == 0) return all;
    ++dealing[k - 1];
    for (; k < a; ++k) dealing[k] = dealing[k - 1] + 1;
    all.push_back(dealing);
  }
}

// Likewise of pairs: the first group has run k or run n + k.
std::vector<Dealing> dealings_within_pairs(std::size_t n, std::size_t most) {
  const bool all_of_them = n < 64 && (std::uint64_t{1} << n) <= most;
  std::mt19937_64 random(1);
  std::vector<Dealing> all;
  while (all.size() < (all_of_them ? std::size_t{1} << n : most)) {
    std::uint64_t swapped = all.size();  // bit k % 64: pair k is
    Dealing& dealing = all.emplace_back(n);
    for (std::size_t k = 0; k < n; ++k) {
      if (!all_of_them && all.size() > 1 && k % 64 == 0) swapped = random();
      dealing[k] = std::uint32_t((swapped >> k % 64 & 1) != 0 ? n + k : k);
    }
  }
  return all;
}

std::vector<Dealing> dealings(std::size_t a, std::size_t b, std::size_t most, Dealt dealt) {
  return dealt == Dealt::within_pairs ? dealings_within_pairs(a, most) : dealings_among_all(a, b, most);
}

// A run with its values times a factor.
struct Member {
  std::size_t run;
  double factor;
};

// What runs contribute to their groups, [run][k], summed over each group, and how far apart two such sums are.
using Contributions = std::vector<std::vector<double>>;
template <class Contribute, class Difference>
class Comparison {
 public:
  Comparison(std::size_t a, std::size_t b, Dealt dealt, Contribute contribute, Difference difference)
      : a_(a), b_(b), dealt_(dealt), dealings_(dealings(a, b, 10000, dealt)), trial_dealings_(dealings(a, b, 1000, dealt)),
        contribute_(contribute), difference_(difference) {}

  GroupTest test() const {
    std::vector<Member> members;
    for (std::size_t run = 0; run < a_ + b_; ++run) members.push_back({run, 1});
    return judge(members, dealings_);
  }

  double seen_factor() const {
    constexpr double wanted = 0.8, highest = 100;
    if (2.0 / double(dealings_.size()) >= 0.05 || share_seen(highest) < wanted) return nan;
    double low = 0, high = std::log(highest);
    while (high - low > 0.01) {
      const double middle = (low + high) / 2;
      (share_seen(std::exp(middle)) < wanted ? low : high) = middle;
    }
    return std::exp(high);
  }

 private:
  static constexpr std::size_t trials = 200;

  GroupTest judge(std::span<const Member> members, const std::vector<Dealing>& dealings) const {
    const Contributions rows = contribute_(members);
    const std::size_t columns = rows[0].size();
    std::vector<double> total(columns, 0.0), a(columns), b(columns);
    for (const std::vector<double>& row : rows)
      for (std::size_t k = 0; k < columns; ++k) total[k] += row[k];
    GroupTest test;
    std::size_t as_far = 0;
    for (std::size_t d = 0; d < dealings.size(); ++d) {
      std::fill(a.begin(), a.end(), 0.0);
      for (const std::uint32_t run : dealings[d])
        for (std::size_t k = 0; k < columns; ++k) a[k] += rows[run][k];
      for (std::size_t k = 0; k < columns; ++k) b[k] = total[k] - a[k];
      const double difference = difference_(a, b);
      if (d == 0) test.difference = difference;
      // Equal ones, but for rounding, count; one that cannot be told is not as far.
      as_far += std::abs(difference) >= std::abs(test.difference) * (1 - 1e-9);
    }
    test.p = std::isnan(test.difference) ? 1 : double(as_far) / double(dealings.size());
    return test;
  }

  // The same draws for every factor, so that the share that is seen grows with it but for the discreteness of p.
  double share_seen(double factor) const {
    std::mt19937_64 random(1);
    std::size_t seen = 0;
    std::vector<Member> members(a_ + b_);
    for (std::size_t trial = 0; trial < trials; ++trial) {
      if (dealt_ == Dealt::within_pairs) {
        for (std::size_t m = 0; m < a_; ++m) {
          const std::size_t pair = random() % a_, around = random() % 2;
          members[m] = {pair + around * a_, 1};
          members[a_ + m] = {pair + (1 - around) * a_, factor};
        }
      } else {
        for (std::size_t m = 0; m < members.size(); ++m) members[m] = {random() % members.size(), m < a_ ? 1 : factor};
      }
      seen += judge(members, trial_dealings_).p < 0.05;
    }
    return double(seen) / double(trials);
  }

  std::size_t a_, b_;
  Dealt dealt_;
  std::vector<Dealing> dealings_, trial_dealings_;
  Contribute contribute_;
  Difference difference_;
};

// Both groups in one.
template <class T>
std::vector<T> together(std::span<const T> a, std::span<const T> b) {
  std::vector<T> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

auto of_shares(std::span<const RunShare> a, std::span<const RunShare> b, Dealt dealt) {
  const auto contribute = [runs = together(a, b)](std::span<const Member> members) {
    Contributions rows;
    for (const Member& m : members) rows.push_back({m.factor * runs[m.run].amount, runs[m.run].over});
    return rows;
  };
  const auto difference = [](const std::vector<double>& in_a, const std::vector<double>& in_b) { return in_b[0] / in_b[1] - in_a[0] / in_a[1]; };
  return Comparison(a.size(), b.size(), dealt, contribute, difference);
}

using Values = std::vector<double>;
auto of_distributions(std::span<const Values> a, std::span<const Values> b, Dealt dealt) {
  std::vector<Values> sorted = together(a, b);
  for (Values& values : sorted) std::sort(values.begin(), values.end());
  // Numbers of values up to each of some; then of all.
  const auto contribute = [runs = std::move(sorted)](std::span<const Member> members) {
    Values all;
    for (const Member& m : members)
      for (const double value : runs[m.run]) all.push_back(m.factor * value);
    std::sort(all.begin(), all.end());
    Values places = all;
    places.erase(std::unique(places.begin(), places.end()), places.end());
    if (places.size() > most_quantiles) {
      places.resize(most_quantiles);
      for (std::size_t k = 0; k < most_quantiles; ++k) places[k] = all[(k + 1) * (all.size() - 1) / (most_quantiles + 1)];
    }
    Contributions rows;
    for (const Member& m : members) {
      Values& row = rows.emplace_back();
      std::size_t below = 0;
      for (const double place : places) {
        while (below < runs[m.run].size() && m.factor * runs[m.run][below] <= place) ++below;
        row.push_back(double(below));
      }
      row.push_back(double(runs[m.run].size()));
    }
    return rows;
  };
  const auto difference = [](const Values& in_a, const Values& in_b) {
    double largest = in_a.back() > 0 && in_b.back() > 0 ? 0 : nan;
    for (std::size_t k = 0; k + 1 < in_a.size(); ++k) largest = std::max(largest, std::abs(in_a[k] / in_a.back() - in_b[k] / in_b.back()));
    return largest;
  };
  return Comparison(a.size(), b.size(), dealt, contribute, difference);
}

bool nothing_in(std::span<const Values> runs) {
  return std::all_of(runs.begin(), runs.end(), [](const Values& values) { return values.empty(); });
}

}  // namespace

GroupTest same_share(std::span<const RunShare> a, std::span<const RunShare> b, Dealt dealt) {
  return a.empty() || b.empty() ? GroupTest{nan, 1} : of_shares(a, b, dealt).test();
}

GroupTest same_distribution(std::span<const Values> a, std::span<const Values> b, Dealt dealt) {
  return nothing_in(a) || nothing_in(b) ? GroupTest{nan, 1} : of_distributions(a, b, dealt).test();
}

double seen_factor(std::span<const RunShare> a, std::span<const RunShare> b, Dealt dealt) { return of_shares(a, b, dealt).seen_factor(); }

double seen_factor(std::span<const Values> a, std::span<const Values> b, Dealt dealt) { return of_distributions(a, b, dealt).seen_factor(); }

}  // namespace jam
