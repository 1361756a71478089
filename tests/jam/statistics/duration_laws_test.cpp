#include "libjam/statistics/duration_laws.hpp"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/jam/statistics/reference_table.hpp"

namespace jam {
namespace {

std::vector<Lifetime> durations_of(const std::string& name) {
  std::vector<Lifetime> all;
  for (const reference::Row& r : reference::table("lifetimes.csv"))
    if (r.text("case") == name) all.push_back({r.number("time"), r.number("ended") != 0});
  for (const reference::Row& r : reference::table("tails.csv"))
    if (r.text("case") == name) all.push_back({r.number("time")});
  return all;
}

// survreg's are the largest to rounding, those of the mixed tail too. On a pure power law the log-normal and the stretched law run away to it, and
// both searches end somewhere on the way.
TEST(DurationLaws, FitAsRsSurvivalAndPoweRlaw) {
  for (const reference::Row& r : reference::table("fits.csv")) {
    const DurationLaw& law = *find_duration_law(r.text("law"));
    const DurationFit fit = law.fit(durations_of(r.text("case")), r.number("shortest"));
    const double theirs = r.number("log_likelihood");
    EXPECT_GT(fit.log_likelihood, theirs - (r.text("case") == "pareto" ? 0.01 : 1e-6)) << r.text("case") << " " << law.name;
    if (r.number("shortest") == 0) {
      EXPECT_NEAR(fit.log_likelihood, theirs, 1e-6) << r.text("case") << " " << law.name;
      EXPECT_NEAR(fit.parameter[0], r.number("first"), 1e-4 * std::abs(r.number("first")));
      if (law.parameters == 2) {
        EXPECT_NEAR(fit.parameter[1], r.number("second"), 1e-4 * r.number("second"));
      }
    } else {
      EXPECT_NEAR(fit.log_likelihood, theirs, 0.5) << r.text("case") << " " << law.name;
    }
    if (r.text("case") == "mixed") {
      EXPECT_NEAR(fit.log_likelihood, theirs, 1e-5) << law.name;
      EXPECT_NEAR(fit.parameter[0], r.number("first"), 1e-3 * std::abs(r.number("first")));
    }
  }
}

// A law that holds another as a special case fits at least as well.
TEST(DurationLaws, WithACutOffFitAtLeastAsWellAsThePurePowerLaw) {
  std::vector<std::vector<Lifetime>> all{durations_of("pareto"), durations_of("mixed"), durations_of("whole"), durations_of("censored")};
  // Of 29 jams most last microseconds and a few milliseconds: an exponent close to 1.
  std::vector<Lifetime> few;
  for (const double t : {1e-7, 2e-7, 1.5e-6, 2.2e-6, 3e-6, 9e-6, 9.1e-6, 1.2e-5, 4e-5, 1.1e-3, 6.5e-3, 8e-3, 1.1e-2}) few.push_back({t});
  all.push_back(few);
  for (const auto& durations : all) {
    double t0 = 1;
    for (const Lifetime& d : durations) t0 = std::min(t0, d.time);
    const DurationLaw &power = *find_duration_law("power"), &cut_off = *find_duration_law("power_cut_off");
    const DurationFit with = cut_off.fit(durations, t0), without = power.fit(durations, t0);
    EXPECT_GE(with.log_likelihood, without.log_likelihood);
    double sum = 0;
    for (const Lifetime& d : durations) sum += d.ended ? cut_off.log_density(d.time, t0, with.parameter) : cut_off.log_share(d.time, t0, with.parameter);
    EXPECT_NEAR(sum, with.log_likelihood, 1e-5 * std::abs(sum));
  }
}

TEST(DurationLaws, CompareAsPoweRlaw) {
  for (const reference::Row& r : reference::table("likelihood_ratios.csv")) {
    // poweRlaw's stretched and log-normal fits of a pure power law run away to the power law itself.
    if (r.text("case") == "pareto" && r.text("other") != "exponential") continue;
    const auto durations = durations_of(r.text("case"));
    const DurationLaw &one = *find_duration_law(r.text("one")), &other = *find_duration_law(r.text("other"));
    const double t0 = r.number("shortest");
    const LikelihoodRatio ratio = compare_laws(one, one.fit(durations, t0), other, other.fit(durations, t0), durations, t0);
    EXPECT_NEAR(ratio.statistic, r.number("statistic"), 1e-3 * std::abs(r.number("statistic"))) << r.text("other");
    EXPECT_NEAR(ratio.p, r.number("p"), 2e-2 * r.number("p"));
  }
}

class EveryDurationLaw : public testing::TestWithParam<const DurationLaw*> {};

constexpr double t0 = 2e-3;
std::array<double, 2> some_parameters(const DurationLaw& law) {
  if (law.name == "exponential") return {8e-3, 0};
  if (law.name == "stretched") return {6e-3, 0.7};
  if (law.name == "log_normal") return {std::log(6e-3), 0.8};
  if (law.name == "power") return {2.4, 0};
  return {1.4, 12e-3};
}

// The density is less the slope of the share, which is 1 at t0.
TEST_P(EveryDurationLaw, DensityIsTheSlopeOfTheShare) {
  const DurationLaw& law = *GetParam();
  const auto p = some_parameters(law);
  EXPECT_NEAR(law.log_share(t0, t0, p), 0, 1e-12);
  for (const double t : {2.5e-3, 5e-3, 20e-3}) {
    const double from_density = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double x) { return std::exp(law.log_density(x, t0, p)); }, t0, t, 12, 1e-11);
    EXPECT_NEAR(1 - std::exp(law.log_share(t, t0, p)), from_density, 1e-7);
  }
}

// Draws by inverting the share, some cut off: the fit finds the parameters again within a few times their spread, and no neighbouring parameters
// are likelier.
TEST_P(EveryDurationLaw, FindsItsOwnParameters) {
  const DurationLaw& law = *GetParam();
  const auto truth = some_parameters(law);
  std::mt19937_64 random(6);
  const auto uniform = [&] { return (double(random() >> 11) + 0.5) * 0x1p-53; };
  std::vector<Lifetime> durations;
  for (int k = 0; k < 3000; ++k) {
    const double log_share = std::log(uniform());
    double low = t0, high = 1e3;
    for (int b = 0; b < 60; ++b) {
      const double middle = std::sqrt(low * high);
      (law.log_share(middle, t0, truth) > log_share ? low : high) = middle;
    }
    const double cut = t0 - 40e-3 * std::log(uniform());
    durations.push_back({std::min(low, cut), low <= cut});
  }
  const DurationFit fit = law.fit(durations, t0);
  const auto log_likelihood = [&](const std::array<double, 2>& p) {
    double sum = 0;
    for (const Lifetime& d : durations) sum += d.ended ? law.log_density(d.time, t0, p) : law.log_share(d.time, t0, p);
    return sum;
  };
  EXPECT_NEAR(fit.log_likelihood, log_likelihood(fit.parameter), 1e-6);
  // Twice the gain over the truth is chi^2 with as many degrees as parameters: below 14 in all but one in a thousand.
  EXPECT_GE(fit.log_likelihood, log_likelihood(truth) - 1e-6);
  EXPECT_LT(2 * (fit.log_likelihood - log_likelihood(truth)), 14);
  for (int which = 0; which < law.parameters; ++which)
    for (const double change : {0.999, 1.001}) {
      auto near = fit.parameter;
      near[std::size_t(which)] *= change;
      EXPECT_LE(log_likelihood(near), fit.log_likelihood + 1e-4);
    }
}

TEST_P(EveryDurationLaw, GivesNoFitWithoutAnything) {
  EXPECT_TRUE(std::isinf(GetParam()->fit({}, t0).log_likelihood));
  EXPECT_FALSE(GetParam()->doc.empty());
}

std::vector<const DurationLaw*> all_laws() {
  std::vector<const DurationLaw*> all;
  for (const DurationLaw& law : duration_laws()) all.push_back(&law);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Table, EveryDurationLaw, testing::ValuesIn(all_laws()), [](const auto& row) { return std::string(row.param->name); });

}  // namespace
}  // namespace jam
