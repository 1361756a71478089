// Do two groups of runs differ? Runs of different seeds are independent of each other, what happens within one is not: a jam
// follows from those before it, a frame from the last. So runs are what is drawn. If the groups do not differ, which run is in which
// group is chance, and a difference is judged by how often other ways of dealing the runs out show one as large (Fisher's and Pitman's
// permutation test, J. R. Stat. Soc. Suppl. 4, 119, 1937): exact for any law of the values, within a run and between runs.
#pragma once
#include <span>
#include <vector>

namespace jam {

struct GroupTest {
  double difference = 0;  // of the groups; as each test says
  // Share of all ways to deal the runs out to groups of these sizes that differ by at least as much. All ways where there are at most
  // 10,000, else so many random ones, with a fixed seed.
  double p = 1;
};

// How runs are dealt out. Where run k of a and run k of b have their start in common, the same bed, what differs between beds is left out of
// the comparison: only the two runs of a pair are swapped (Fisher, The Design of Experiments, 1935, section 21). Condition: then the groups
// are of one size.
enum class Dealt { among_all, within_pairs };

// How much of something in how much of a run: jams in its record, s; or a quantity of a run as a whole, over 1.
struct RunShare {
  double amount = 0, over = 1;
};

// By sum of amounts over sum of what they are over: `difference` is that of b less that of a. NaN and p = 1 where a group is empty.
GroupTest same_share(std::span<const RunShare> a, std::span<const RunShare> b, Dealt dealt = Dealt::among_all);

// By the largest distance of the distributions of all values of the runs of a group, Kolmogorov's and Smirnov's: `difference`, 0 to 1. At all
// values that occur where they are at most 256, else at so many of their quantiles. Runs may have any number of values; NaN and p = 1
// where a group has none.
GroupTest same_distribution(std::span<const std::vector<double>> a, std::span<const std::vector<double>> b, Dealt dealt = Dealt::among_all);

// The power of these tests: the factor by which all values (amounts) of one group would have to be larger for 80 of 100 such
// comparisons to give p < 0.05, if runs scatter as these do: runs of both groups together (or pairs, either way around) are drawn anew, 200
// times, with a fixed seed; where the groups do differ that is more than within each. NaN where not even a factor of 100 would do: always
// where there are too few runs, fewer than four against four or than six pairs.
double seen_factor(std::span<const RunShare> a, std::span<const RunShare> b, Dealt dealt = Dealt::among_all);
double seen_factor(std::span<const std::vector<double>> a, std::span<const std::vector<double>> b, Dealt dealt = Dealt::among_all);

}  // namespace jam
