"""Sizes as functions of the place, whoever wrote them: asked for at points, and looked at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from surfmesh.errors import SizingError, shown


def checked_sizes(law: Callable, points: np.ndarray, what: str) -> np.ndarray:
    """``law(points)``, (n, 3) -> (n,), all at once; raises ``SizingError`` for what is no size.

    The law gets points of its own, and what it warns of is told as that error alone.
    """
    with np.errstate(all="ignore"):
        found = law(points.copy())
    sizes = as_numbers(found)
    if sizes is None or sizes.shape != (len(points),) or not (sizes > 0.0).all():
        raise SizingError(
            f"{what} law must give positive numbers of shape ({len(points)},) for points "
            f"({len(points)}, 3); it gave {_what_is_wrong(found, sizes, points)}"
        )
    return sizes


def _what_is_wrong(found: Any, sizes: np.ndarray | None, points: np.ndarray) -> str:
    """What a law gave instead of sizes; of numbers one that is no size, with its place."""
    if sizes is None:
        return shown(found)
    if sizes.shape != (len(points),):
        least = f", smallest {sizes.min():g}" if sizes.size else ""
        return f"shape {sizes.shape}{least}"
    bad = int((~(sizes > 0.0)).argmax())
    place = ", ".join(f"{x:.6g}" for x in points[bad])
    return f"{sizes[bad]:g} at ({place})"


def as_numbers(found: Any) -> np.ndarray | None:
    """What a caller's function gave as an array of its own; None if those are no real numbers.

    Masked entries are nan.
    """
    try:
        if np.iscomplexobj(found):
            return None
        if np.ma.isMaskedArray(found):
            return np.ma.filled(found.astype(float), np.nan)
        return np.array(found, float)
    except (TypeError, ValueError, OverflowError):
        return None
