// Statistics of lifetimes and rates, for numbers from anywhere.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"
#include "libjam/statistics/duration_laws.hpp"
#include "libjam/statistics/lifetimes.hpp"
#include "libjam/statistics/rates.hpp"
#include "libjam/statistics/sampled_durations.hpp"

namespace jamscope::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Truths = py::array_t<bool, py::array::c_style | py::array::forcecast>;

std::span<const double> numbers(const Numbers& values, const char* name) {
  if (values.ndim() != 1) throw py::value_error(fmt::format("{} has {} dimensions, expected one", name, values.ndim()));
  return {values.data(), std::size_t(values.size())};
}

void expect_rows(std::size_t rows, std::size_t expected, const char* name) {
  if (rows != expected) throw py::value_error(fmt::format("{} has {} values, expected {}, as many as times", name, rows, expected));
}

void expect_confidence(double confidence) {
  if (!(confidence > 0 && confidence < 1)) throw py::value_error(fmt::format("confidence = {}, expected a number between 0 and 1", confidence));
}

std::vector<jam::Lifetime> lifetimes(const Numbers& time, const std::optional<Truths>& ended, const std::optional<Numbers>& entry) {
  const auto times = numbers(time, "time");
  if (ended) expect_rows(std::size_t(ended->size()), times.size(), "ended");
  if (entry) expect_rows(std::size_t(entry->size()), times.size(), "entry");
  std::vector<jam::Lifetime> all(times.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] = {times[k], !ended || ended->data()[k], entry ? entry->data()[k] : 0.0};
    if (!(all[k].entry >= 0 && all[k].time >= all[k].entry)) throw py::value_error(fmt::format("lifetime {}: from the age {} s to {} s, expected 0 <= entry <= time", k, all[k].entry, all[k].time));
  }
  return all;
}

const jam::DurationLaw& law_named(const std::string& name) {
  if (const jam::DurationLaw* law = jam::find_duration_law(name)) return *law;
  std::vector<std::string> known;
  for (const jam::DurationLaw& law : jam::duration_laws()) known.emplace_back(law.name);
  throw UsageError("unknown law '" + name + "'" + suggestion(name, known));
}

struct FittedLaw {
  const jam::DurationLaw* law;
  jam::DurationFit fit;
  double shortest;
  std::vector<jam::Lifetime> durations;  // that it was fitted to
};

// Of everything that lasted `shortest` or more, or of all, from the shortest that ended.
std::shared_ptr<FittedLaw> fit_durations(const std::string& name, const Numbers& time, const std::optional<Truths>& ended, std::optional<double> shortest) {
  auto found = std::make_shared<FittedLaw>();
  found->law = &law_named(name);
  std::vector<jam::Lifetime> all = lifetimes(time, ended, std::nullopt);
  double least = std::numeric_limits<double>::infinity();
  for (const jam::Lifetime& d : all)
    if (d.ended) least = std::min(least, d.time);
  found->shortest = shortest.value_or(least);
  if (!(found->shortest >= 0 && std::isfinite(found->shortest)))
    throw py::value_error(fmt::format("shortest = {} s, expected a time, and a duration that ended", found->shortest));
  for (const jam::Lifetime& d : all)
    if (d.time >= found->shortest) found->durations.push_back(d);
  if (std::none_of(found->durations.begin(), found->durations.end(), [](const jam::Lifetime& d) { return d.ended; }))
    throw py::value_error(fmt::format("no duration of {} s or more ended, expected one at least", found->shortest));
  found->fit = found->law->fit(found->durations, found->shortest);
  if (!(found->fit.log_likelihood > -std::numeric_limits<double>::max())) throw py::value_error(fmt::format("no {} law from {} s on explains these durations; it may need shortest > 0", name, found->shortest));
  return found;
}

}  // namespace

void bind_statistics(py::module_& m) {
  py::class_<jam::SurvivalCurve>(m, "SurvivalCurve", "The share that outlasts a time: one row for each time at which a lifetime ends, ascending; before the first the share is 1.")
      .def_property_readonly("time", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().time, self); }, "s")
      .def_property_readonly("share", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().share, self); }, "just after the time")
      .def_property_readonly("low", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().low, self); }, "lower end of the confidence band; NaN where the share is 0")
      .def_property_readonly("high", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().high, self); }, "upper end of the band")
      .def_property_readonly("at_risk", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().at_risk, self); }, "lifetimes that could have ended then")
      .def_property_readonly("ended", [](const py::object& self) { return view(self.cast<const jam::SurvivalCurve&>().ended, self); }, "lifetimes that did")
      .def("when_left", &jam::when_left, py::arg("share") = 0.5, "The first time at which the share is `share` or less, and the same of the band; inf where it never gets there.");
  py::class_<jam::Quantile>(m, "Quantile", "A time and its interval.")
      .def_readonly("value", &jam::Quantile::value, "s")
      .def_readonly("low", &jam::Quantile::low, "s")
      .def_readonly("high", &jam::Quantile::high, "s");
  py::class_<jam::TestResult>(m, "TestResult", "A chi-squared test.")
      .def_readonly("statistic", &jam::TestResult::statistic, "chi^2")
      .def_readonly("degrees", &jam::TestResult::degrees, "of freedom")
      .def_readonly("p", &jam::TestResult::p, "probability of a statistic at least as large if nothing differs");
  py::class_<jam::TurnbullEstimate>(m, "TurnbullEstimate", "The distribution of largest likelihood of lifetimes known only to lie in brackets: mass in intervals, ascending.")
      .def_property_readonly("low", [](const py::object& self) { return view(self.cast<const jam::TurnbullEstimate&>().low, self); }, "s")
      .def_property_readonly("high", [](const py::object& self) { return view(self.cast<const jam::TurnbullEstimate&>().high, self); }, "s")
      .def_property_readonly("mass", [](const py::object& self) { return view(self.cast<const jam::TurnbullEstimate&>().mass, self); }, "1, > 0")
      .def("share_after", &jam::TurnbullEstimate::share_after, py::arg("time"), "Share that outlasts `time`; within an interval of mass the one before it.");
  py::class_<jam::Rate>(m, "Rate", "Events per time, with an interval.")
      .def_readonly("value", &jam::Rate::value, "1/s")
      .def_readonly("low", &jam::Rate::low, "1/s")
      .def_readonly("high", &jam::Rate::high, "1/s");
  py::class_<jam::IndependenceTest>(m, "IndependenceTest", "Lilliefors' test of exponential distances.")
      .def_readonly("distance", &jam::IndependenceTest::distance, "largest, of the empirical from the fitted distribution")
      .def_readonly("p", &jam::IndependenceTest::p, "its probability if they are exponential; NaN for fewer than three starts");
  py::class_<jam::Overlapping>(m, "Overlapping", "When at least one of many independent events is there.")
      .def_readonly("share", &jam::Overlapping::share, "of the time")
      .def_readonly("rate", &jam::Overlapping::rate, "1/s, at which it begins to be so")
      .def_readonly("mean_duration", &jam::Overlapping::mean_duration, "s, for which it is so; NaN for a rate of 0");
  py::class_<jam::BlockMean>(m, "BlockMean", "A mean and its bootstrap interval.")
      .def_readonly("value", &jam::BlockMean::value, "the mean")
      .def_readonly("low", &jam::BlockMean::low, "lower end")
      .def_readonly("high", &jam::BlockMean::high, "upper end");
  py::class_<jam::ExponentialDurations>(m, "ExponentialDurations", "What samples say of all events, those that none of them saw too, if durations are exponential.")
      .def_readonly("mean", &jam::ExponentialDurations::mean, "s")
      .def_readonly("low", &jam::ExponentialDurations::low, "s, lower end of the mean's interval")
      .def_readonly("high", &jam::ExponentialDurations::high, "s, upper end")
      .def_readonly("unseen", &jam::ExponentialDurations::unseen, "share of the events that no sample saw")
      .def_readonly("rate", &jam::ExponentialDurations::rate, "1/s, of all events");
  py::class_<jam::DurationLaw>(m, "DurationLaw", "A law of durations.")
      .def_property_readonly("name", [](const jam::DurationLaw& l) { return std::string(l.name); }, "Its name.")
      .def_property_readonly("doc", [](const jam::DurationLaw& l) { return std::string(l.doc); }, "What its parameters are.")
      .def_readonly("parameters", &jam::DurationLaw::parameters, "How many it has.");
  py::class_<FittedLaw, std::shared_ptr<FittedLaw>>(m, "FittedLaw", "A law of durations with the parameters of largest likelihood.")
      .def_property_readonly("name", [](const FittedLaw& f) { return std::string(f.law->name); }, "Of the law.")
      .def_property_readonly("parameters", [](const FittedLaw& f) { return std::vector<double>(f.fit.parameter.begin(), f.fit.parameter.begin() + f.law->parameters); }, "In the order of the law's doc.")
      .def_property_readonly("log_likelihood", [](const FittedLaw& f) { return f.fit.log_likelihood; }, "Of the durations.")
      .def_property_readonly("akaike", [](const FittedLaw& f) { return 2 * f.law->parameters - 2 * f.fit.log_likelihood; }, "2 parameters - 2 log-likelihood: smaller explains more")
      .def_property_readonly("shortest", [](const FittedLaw& f) { return f.shortest; }, "s, shorter ones were left out")
      .def(
          "share_after", [](const FittedLaw& f, double time) { return time <= f.shortest ? 1.0 : std::exp(f.law->log_share(time, f.shortest, f.fit.parameter)); }, py::arg("time"),
          "Share of the durations of `shortest` or more that outlasts `time`.");
  py::class_<jam::LikelihoodRatio>(m, "LikelihoodRatio", "Vuong's test of two laws.")
      .def_readonly("statistic", &jam::LikelihoodRatio::statistic, "> 0 where the first explains more")
      .def_readonly("p", &jam::LikelihoodRatio::p, "probability of such a difference either way if neither is better");

  m.def(
      "kaplan_meier",
      [](const Numbers& time, const std::optional<Truths>& ended, const std::optional<Numbers>& entry, double confidence) {
        expect_confidence(confidence);
        return jam::kaplan_meier(lifetimes(time, ended, entry), confidence);
      },
      py::arg("time"), py::arg("ended") = py::none(), py::arg("entry") = py::none(), py::arg("confidence") = 0.95,
      "Kaplan and Meier's estimate of survival with Greenwood's variance and the pointwise band on the scale of log(-log S). time: [n] s, ages up to which lifetimes are known; "
      "ended: [n] false where cut off there; entry: [n] s, ages from which they are known.");
  m.def(
      "log_rank",
      [](const std::vector<Numbers>& time, const std::optional<std::vector<Truths>>& ended, const std::optional<std::vector<Numbers>>& entry) {
        if (ended && ended->size() != time.size()) throw py::value_error("as many groups of ended as of time are needed");
        if (entry && entry->size() != time.size()) throw py::value_error("as many groups of entry as of time are needed");
        std::vector<std::vector<jam::Lifetime>> groups;
        for (std::size_t g = 0; g < time.size(); ++g)
          groups.push_back(lifetimes(time[g], ended ? std::optional(ended->at(g)) : std::nullopt, entry ? std::optional(entry->at(g)) : std::nullopt));
        return jam::log_rank(groups);
      },
      py::arg("time"), py::arg("ended") = py::none(), py::arg("entry") = py::none(), "Mantel's log-rank test: do groups of lifetimes follow one law? Each argument as in kaplan_meier, one array per group.");
  m.def(
      "turnbull",
      [](const Numbers& low, const Numbers& high) {
        const auto lows = numbers(low, "low"), highs = numbers(high, "high");
        expect_rows(highs.size(), lows.size(), "high");
        std::vector<jam::LifetimeBracket> brackets(lows.size());
        for (std::size_t k = 0; k < brackets.size(); ++k) {
          brackets[k] = {lows[k], highs[k]};
          if (!(brackets[k].low >= 0 && brackets[k].high >= brackets[k].low)) throw py::value_error(fmt::format("bracket {}: ({}, {}] s, expected 0 <= low <= high", k, lows[k], highs[k]));
        }
        return jam::turnbull(brackets);
      },
      py::arg("low"), py::arg("high"), "Turnbull's estimate for lifetimes known to lie in (low, high], s; high = inf where cut off, low = high where exact.");
  m.def(
      "poisson_rate",
      [](std::uint64_t events, double observed_time, double confidence) {
        expect_confidence(confidence);
        return jam::poisson_rate(events, observed_time, confidence);
      },
      py::arg("events"), py::arg("observed_time"), py::arg("confidence") = 0.95, "Rate of events that come independently, with Garwood's exact interval. observed_time: s.");
  m.def("same_rate_probability", &jam::same_rate_probability, py::arg("events_a"), py::arg("time_a"), py::arg("events_b"), py::arg("time_b"),
        "Probability of counts at least as unlikely if both rates are the same (Przyborowski and Wilenski).");
  m.def(
      "fano_factor", [](const Numbers& start, double begin, double end, std::size_t windows) { return jam::fano_factor(numbers(start, "start"), begin, end, windows); }, py::arg("start"), py::arg("begin"),
      py::arg("end"), py::arg("windows") = 20, "Variance over mean of the counts of start times, s, in equal windows: 1 where events come independently, more in bursts.");
  m.def(
      "exponential_distances", [](const Numbers& start) { return jam::exponential_distances(numbers(start, "start")); }, py::arg("start"),
      "Are the distances of consecutive start times, s, exponential, as they are if events come independently? Lilliefors' test.");
  m.def(
      "overlapping",
      [](double rate, double mean_duration) {
        if (!(rate >= 0 && mean_duration >= 0)) throw py::value_error(fmt::format("rate {} 1/s, mean_duration {} s, expected numbers >= 0", rate, mean_duration));
        return jam::overlapping(rate, mean_duration);
      },
      py::arg("rate"), py::arg("mean_duration"),
      "At least one of events that begin independently, 1/s, and last so long in the mean, s: for 1 - exp(-n) of the time, n = rate mean_duration (busy periods, Takacs 1962).");
  m.def(
      "bootstrap_mean",
      [](const Numbers& blocks, double confidence) {
        expect_confidence(confidence);
        return jam::bootstrap_mean(numbers(blocks, "blocks"), confidence);
      },
      py::arg("blocks"), py::arg("confidence") = 0.95, "Mean over runs or blocks with the interval of its bootstrap; the same blocks give the same interval.");
  m.def(
      "exponential_durations",
      [](const std::vector<std::uint32_t>& samples, double interval, double observed_time, double confidence, std::uint64_t cut_off) {
        expect_confidence(confidence);
        return jam::exponential_durations(samples, interval, observed_time, confidence, cut_off);
      },
      py::arg("samples"), py::arg("interval"), py::arg("observed_time"), py::arg("confidence") = 0.95, py::arg("cut_off") = 0,
      "Mean and rate of all events from the numbers of samples, `interval` s apart, of those that were seen whole, if durations are exponential; cut_off: further events that began.");
  m.def(
      "duration_laws", [] { return std::vector<jam::DurationLaw>(jam::duration_laws().begin(), jam::duration_laws().end()); }, "All laws of durations.");
  m.def("fit_durations", &fit_durations, py::arg("law"), py::arg("time"), py::arg("ended") = py::none(), py::arg("shortest") = py::none(),
        "A law fitted by largest likelihood to all durations of `shortest` s or more, cut-off ones (ended false) included; shortest: default the shortest that ended.");
  m.def(
      "compare_laws",
      [](const FittedLaw& one, const FittedLaw& other) {
        const bool same = one.shortest == other.shortest && std::equal(one.durations.begin(), one.durations.end(), other.durations.begin(), other.durations.end(), [](const jam::Lifetime& a, const jam::Lifetime& b) {
                            return a.time == b.time && a.ended == b.ended;
                          });
        if (!same) throw py::value_error("the laws were fitted to different durations");
        return jam::compare_laws(*one.law, one.fit, *other.law, other.fit, one.durations, one.shortest);
      },
      py::arg("one"), py::arg("other"), "Vuong's test: which of two laws fitted to the same durations explains them better?");
}

}  // namespace jamscope::python
