"""Statistics of lifetimes and rates, for numbers from anywhere: what the analysis of jams uses."""
from __future__ import annotations

from ._core import (
    BlockMean, DurationLaw, ExponentialDurations, FittedLaw, IndependenceTest, LawFit, LikelihoodRatio, Overlapping, Quantile, Rate, SurvivalCurve, TestResult, TurnbullEstimate,
    bootstrap_mean, compare_laws, duration_laws, exponential_distances, exponential_durations, fano_factor, fit_durations, kaplan_meier, log_rank, overlapping, poisson_rate,
    same_rate_probability, turnbull,
)

__all__ = [
    "BlockMean", "DurationLaw", "ExponentialDurations", "FittedLaw", "IndependenceTest", "LawFit", "LikelihoodRatio", "Overlapping", "Quantile", "Rate", "SurvivalCurve",
    "TestResult", "TurnbullEstimate", "bootstrap_mean", "compare_laws", "duration_laws", "exponential_distances", "exponential_durations", "fano_factor",
    "fit_durations", "kaplan_meier", "log_rank", "overlapping", "poisson_rate", "same_rate_probability", "turnbull",
]
