"""Statistics: the references that R made (data/reference/statistics/make.R), and cases one can do by hand."""
import math
import unittest

import numpy

import jamscope.statistics as statistics
from jamscope import UsageError
from support import reference


def lifetimes(case):
    """time, ended, entry of each group of a case."""
    groups = {}
    for row in reference("lifetimes.csv"):
        if row["case"] == case:
            groups.setdefault(row["group"], []).append((float(row["time"]), row["ended"] == "1", float(row["entry"])))
    return [tuple(map(numpy.array, zip(*group))) for _, group in sorted(groups.items())]


class Survival(unittest.TestCase):
    def test_kaplan_meier_as_in_r(self):
        for case in ("whole", "censored", "ties", "truncated"):
            time, ended, entry = lifetimes(case)[0]
            curve = statistics.kaplan_meier(time, ended, entry)
            theirs = [row for row in reference("kaplan_meier.csv") if row["case"] == case]
            for ours, column in ((curve.time, "time"), (curve.share, "share"), (curve.at_risk, "at_risk"), (curve.ended, "ended"), (curve.low, "low"), (curve.high, "high")):
                expected = [float(row[column].replace("NA", "nan")) for row in theirs]
                numpy.testing.assert_allclose(ours, expected, rtol=0 if column in ("at_risk", "ended") else 1e-9, err_msg=f"{case} {column}")
            median = next(row for row in reference("medians.csv") if row["case"] == case)
            self.assertAlmostEqual(curve.when_left().low, float(median["low"]), 12)
            self.assertAlmostEqual(curve.when_left(0.5).high, float(median["high"]), 12)

    def test_kaplan_meier_by_hand(self):
        curve = statistics.kaplan_meier([1, 2, 2, 4])
        self.assertEqual(curve.time.tolist(), [1, 2, 4])
        self.assertEqual(curve.share.tolist(), [0.75, 0.25, 0])
        self.assertEqual(curve.when_left(0.5).value, 2)
        narrow = statistics.kaplan_meier([1, 2, 2, 4], confidence=0.5)
        self.assertGreater(narrow.low[0], curve.low[0])

    def test_log_rank_as_in_r(self):
        for row in reference("log_rank.csv"):
            time, ended, _ = zip(*lifetimes(row["case"]))
            test = statistics.log_rank(list(time), list(ended))
            self.assertTrue(math.isclose(test.statistic, float(row["statistic"]), rel_tol=1e-9))
            self.assertEqual(test.degrees, int(row["degrees"]))
            self.assertTrue(math.isclose(test.p, float(row["p"]), rel_tol=1e-9))

    def test_turnbull_as_in_r(self):
        brackets = reference("brackets.csv")
        for case in {row["case"] for row in brackets}:
            those = [row for row in brackets if row["case"] == case]
            estimate = statistics.turnbull([float(r["low"]) for r in those], [float(r["high"].replace("Inf", "inf")) for r in those])
            self.assertAlmostEqual(estimate.mass.sum(), 1, 6)
            theirs = [(float(row["time"]), float(row["share"])) for row in reference("turnbull.csv") if row["case"] == case]
            for high in estimate.high[numpy.isfinite(estimate.high)]:
                share = [s for t, s in theirs if t <= high]
                self.assertAlmostEqual(estimate.share_after(high), share[-1] if share else 1.0, delta=2e-3)

    def test_wrong_arguments(self):
        for wrong in (lambda: statistics.kaplan_meier([1, 2], [True]), lambda: statistics.kaplan_meier([[1.0]]), lambda: statistics.kaplan_meier([1], entry=[2]),
                      lambda: statistics.kaplan_meier([1], confidence=2), lambda: statistics.turnbull([2], [1]), lambda: statistics.log_rank([[1], [2]], [[True]])):
            with self.assertRaises(ValueError):
                wrong()


class Rates(unittest.TestCase):
    def test_intervals_as_in_r(self):
        for row in reference("rates.csv"):
            rate = statistics.poisson_rate(int(row["events"]), float(row["time"]))
            numpy.testing.assert_allclose((rate.low, rate.high), (float(row["low"]), float(row["high"])), rtol=1e-9)
            self.assertEqual(rate.value, int(row["events"]) / float(row["time"]))
        self.assertAlmostEqual(statistics.poisson_rate(0, 2).high, -math.log(0.025) / 2, 12)

    def test_two_rates_as_in_r(self):
        for row in reference("two_rates.csv"):
            p = statistics.same_rate_probability(int(row["events_a"]), float(row["time_a"]), int(row["events_b"]), float(row["time_b"]))
            self.assertTrue(math.isclose(p, float(row["p"]), rel_tol=1e-6), row)

    def test_bursts_and_regular_events(self):
        self.assertEqual(statistics.fano_factor(numpy.arange(0.5, 20), 0, 20, 20), 0)
        counts = numpy.histogram([0.1, 0.2, 0.3, 7.5], 4, (0, 8))[0]
        self.assertAlmostEqual(statistics.fano_factor([0.1, 0.2, 0.3, 7.5], 0, 8, 4), counts.var(ddof=1) / counts.mean(), 12)
        random = numpy.random.default_rng(7)
        self.assertGreater(statistics.exponential_distances(numpy.cumsum(random.exponential(1, 200))).p, 0.05)
        self.assertLess(statistics.exponential_distances(numpy.arange(200.0)).p, 1e-3)

    def test_independent_events_that_overlap(self):
        any_there = statistics.overlapping(2.0, 0.5)
        self.assertAlmostEqual(any_there.share, 1 - math.exp(-1), 14)
        self.assertAlmostEqual(any_there.rate, 2 * math.exp(-1), 14)
        self.assertAlmostEqual(any_there.mean_duration, (math.e - 1) / 2, 14)
        with self.assertRaisesRegex(ValueError, "expected numbers >= 0"):
            statistics.overlapping(-1, 1)

    def test_bootstrap(self):
        blocks = numpy.random.default_rng(1).normal(5, 1, 40)
        mean = statistics.bootstrap_mean(blocks)
        self.assertAlmostEqual(mean.value, blocks.mean(), 12)
        width = 2 * 1.96 * blocks.std(ddof=1) / 40**0.5
        self.assertAlmostEqual(mean.high - mean.low, width, delta=0.15 * width)
        again = statistics.bootstrap_mean(blocks)
        self.assertEqual((mean.low, mean.high), (again.low, again.high))

    def test_durations_from_samples(self):
        random = numpy.random.default_rng(3)
        mean, interval = 2e-3, 1e-3
        # n samples of an event of duration d that begins at a random phase.
        samples = numpy.floor(random.exponential(mean, 20000) / interval + random.uniform(0, 1, 20000)).astype(int)
        seen = samples[samples > 0]
        found = statistics.exponential_durations(seen, interval, 1000.0)
        self.assertAlmostEqual(found.mean, mean, delta=0.05 * mean)
        self.assertAlmostEqual(found.unseen, 1 - len(seen) / len(samples), delta=0.02)
        self.assertAlmostEqual(found.rate.value, 20, delta=0.5)


class Laws(unittest.TestCase):
    def durations(self, case):
        tails = [float(r["time"]) for r in reference("tails.csv") if r["case"] == case]
        if tails:
            return tails, [True] * len(tails)
        time, ended, _ = lifetimes(case)[0]
        return time, ended

    def test_fits_as_in_r(self):
        self.assertEqual([law.name for law in statistics.duration_laws()], ["exponential", "stretched", "log_normal", "power", "power_cut_off"])
        for row in reference("fits.csv"):
            shortest = float(row["shortest"])
            time, ended = self.durations(row["case"])
            fit = statistics.fit_durations(row["law"], time, ended, shortest)
            self.assertGreater(fit.log_likelihood, float(row["log_likelihood"]) - (0.01 if row["case"] == "pareto" else 1e-6), row)
            if shortest == 0:
                self.assertTrue(math.isclose(fit.parameters[0], float(row["first"]), rel_tol=1e-4), row)
            self.assertEqual(fit.akaike, 2 * len(fit.parameters) - 2 * fit.log_likelihood)

    def test_which_law_explains_more_as_in_r(self):
        for row in reference("likelihood_ratios.csv"):
            if (row["one"], row["other"]) != ("power", "exponential"):
                continue  # the search of the others ends somewhere on a flat ridge (libjam/statistics)
            time, ended = self.durations(row["case"])
            one, other = (statistics.fit_durations(law, time, ended, float(row["shortest"])) for law in (row["one"], row["other"]))
            ratio = statistics.compare_laws(one, other)
            self.assertTrue(math.isclose(ratio.statistic, float(row["statistic"]), rel_tol=1e-4), row)
            self.assertTrue(math.isclose(ratio.p, float(row["p"]), rel_tol=1e-3), row)

    def test_an_exponential_by_hand(self):
        fit = statistics.fit_durations("exponential", [2, 3, 7], [True, True, False], shortest=2)
        self.assertAlmostEqual(fit.parameters[0], (0 + 1 + 5) / 2, 12)
        self.assertAlmostEqual(fit.share_after(5), math.exp(-3 / 3), 12)
        self.assertEqual(fit.share_after(1), 1)
        self.assertEqual(statistics.fit_durations("exponential", [3, 2, 7]).shortest, 2)

    def test_wrong_arguments(self):
        with self.assertRaisesRegex(UsageError, "did you mean 'exponential'"):
            statistics.fit_durations("exponentiel", [1, 2, 3])
        for wrong in (lambda: statistics.fit_durations("exponential", [1, 2], [False, False]), lambda: statistics.fit_durations("exponential", [1, 2], shortest=5),
                      lambda: statistics.fit_durations("power", [1, 2], shortest=0),
                      lambda: statistics.compare_laws(statistics.fit_durations("power", [1, 2]), statistics.fit_durations("power", [1, 3]))):
            with self.assertRaises(ValueError):
                wrong()


if __name__ == "__main__":
    unittest.main()
