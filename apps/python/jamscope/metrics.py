"""What network metrics there are; Frame.metric(), Frame.metrics() and Frame.change() compute them."""
from __future__ import annotations

from ._core import MetricInfo, metric_table as table

__all__ = ["MetricInfo", "doc", "names", "table"]


def names(of: str = "frames") -> list[str]:
    """Names of all metrics of "frames", "changes", "particles" or "contacts"."""
    return [row.name for row in table(of)]


def doc(name: str, of: str = "frames") -> str:
    """Unit and meaning of a metric, and when it is NaN. Raises KeyError where there is none of that name."""
    for row in table(of):
        if row.name == name:
            return f"[{row.unit}] {row.doc}" + (f"; NaN: {row.undefined}" if row.undefined else "")
    raise KeyError(f"no metric of {of} is called {name!r}")
