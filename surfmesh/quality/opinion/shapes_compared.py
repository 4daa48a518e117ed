"""Shapes of triangles by Verdict beside ours: of every triangle, and as the report has them."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.figures.figures import Figures
from surfmesh.quality.measures.shape import Shapes
from surfmesh.quality.opinion.libraries_asked import QUALITIES, Failed
from surfmesh.quality.opinion.rounding_bounds import ALPHA, EPS, angle_bounds
from surfmesh.quality.opinion.witness import Witness

_OF_REPORT = (  # field, what it is of, how
    ("alpha_min", "alpha", "min"),
    ("alpha_mean", "alpha", "mean"),
    ("min_angle_deg", "smallest angle", "min"),
    ("max_angle_deg", "largest angle", "max"),
)
_NEEDLE = "two corners of a triangle lie in one place, to rounding: no angles there"


class Measure(NamedTuple):
    """(m,) arrays, a value a triangle; angles in degrees."""

    ours: NDArray[np.float64]
    theirs: NDArray[np.float64] | Failed | None
    bound: NDArray[np.float64]  # how far the two may be apart
    reason: str  # why it is not compared, if it is not


def compare_shapes(
    library: Witness,
    report: Figures,
    shape: Shapes,
    qualities: Any,
    cosine: NDArray[np.float64],
    reason: str,
) -> None:
    """Rows of ``library`` about ``shape``, which is ours, and about the report.

    qualities: those of Verdict by name, or ``Failed``; cosine: (m,) how far cosines of angles
    may be off; reason: why nothing is compared, if nothing is.
    """
    measures = _measures(shape, qualities, cosine, reason)
    for name, measure in measures.items():
        _each_triangle(library, name, measure)
    for field, name, how in _OF_REPORT:
        ours, theirs, bound, why = measures[name]
        one = float(getattr(np, how)(theirs)) if isinstance(theirs, np.ndarray) else theirs
        most = _of_mean(bound) if how == "mean" else _of_extreme(ours, bound, how)
        library.near(field, getattr(report, field), one, most, 0, "", why)


def _measures(
    shape: Shapes, qualities: Any, cosine: NDArray[np.float64], reason: str
) -> dict[str, Measure]:
    theirs = qualities
    if not isinstance(qualities, dict):
        theirs = dict.fromkeys(QUALITIES, qualities)
    needles = reason or _NEEDLE * bool((cosine >= 2.0).any())
    within = np.full(len(cosine), ALPHA)
    return {
        "alpha": Measure(shape.alpha, theirs["shape"], within, reason),
        "smallest angle": Measure(
            shape.min_angle, theirs["min_angle"], angle_bounds(shape.min_angle, cosine), needles
        ),
        "largest angle": Measure(
            shape.max_angle, theirs["max_angle"], angle_bounds(shape.max_angle, cosine), needles
        ),
    }


def _each_triangle(library: Witness, name: str, measure: Measure) -> None:
    """The triangle on which they differ most, beyond what rounding can do."""
    ours, theirs, bound, reason = measure
    if reason or not isinstance(theirs, np.ndarray):
        answer = theirs if isinstance(theirs, Failed) else None
        library.near(f"{name} by triangles", None, answer, 0.0, 0, "", reason)
        return
    beyond = np.abs(theirs - ours) - bound
    t = int(np.argmax(np.where(np.isnan(beyond), np.inf, beyond)))
    library.near(
        f"{name} by triangles", float(ours[t]), float(theirs[t]), float(bound[t]), 0,
        f"triangle {t}",
    )  # fmt: skip


def _of_mean(bound: NDArray[np.float64]) -> float:
    """How far means of values up to 1 may be apart."""
    return float(bound.max()) + len(bound) * EPS


def _of_extreme(ours: NDArray[np.float64], bound: NDArray[np.float64], how: str) -> float:
    """How far the extremes may be apart: another triangle may be that of theirs."""
    if how == "max":
        ours = -ours
    first = int(np.argmin(ours))
    return max(float(bound[first]), float(ours[first] - (ours - bound).min()))
