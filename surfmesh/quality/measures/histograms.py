"""How the quality is spread: counts in fixed bins, so that reports can be laid side by side."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import binned_counts
from surfmesh.quality.measures.shape import Shapes

BINS = {"alpha": 20, "min_angle_deg": 20, "max_angle_deg": 20, "length": 25, "deviation": 20}


@dataclass(frozen=True)
class Histogram:
    """counts[i] values from edges[i] to edges[i + 1]; what lies outside is in the end bins."""

    edges: tuple[float, ...]
    counts: tuple[int, ...]


def histograms(
    shape: Shapes, metric: NDArray[np.float64] | None, by_triangle: NDArray[np.float64] | None
) -> dict[str, Histogram]:
    """Of alpha and the angles of the triangles, and where known of ``length`` (edge over
    target size, 0 to 2.5) and ``deviation`` (largest in each triangle, model units).
    """
    found = {
        "alpha": _counted("alpha", shape.alpha, 0.0, 1.0),
        "min_angle_deg": _counted("min_angle_deg", shape.min_angle, 0.0, 60.0),
        "max_angle_deg": _counted("max_angle_deg", shape.max_angle, 60.0, 180.0),
    }
    if metric is not None:
        found["length"] = _counted("length", metric, 0.0, 2.5)
    if by_triangle is not None:
        largest = float(by_triangle.max(initial=0.0))
        if 0.0 < largest < np.inf:
            found["deviation"] = _counted("deviation", by_triangle, 0.0, largest)
    return found


def _counted(name: str, values: NDArray[np.float64], low: float, high: float) -> Histogram:
    bins = BINS[name]
    counts = binned_counts(values, low, high, bins)
    return Histogram(_edges(low, high, bins), tuple(counts.tolist()))


@lru_cache
def _edges(low: float, high: float, bins: int) -> tuple[float, ...]:
    """Of bins that are the same in most reports."""
    return tuple(np.round(np.linspace(low, high, bins + 1), 12).tolist())
