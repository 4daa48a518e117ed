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
        gave = f"shape {sizes.shape}" if sizes is not None else shown(found)
        least = f", smallest {sizes.min():g}" if sizes is not None and sizes.size else ""
        raise SizingError(
            f"{what} law must give positive numbers of shape ({len(points)},) for points "
            f"({len(points)}, 3); it gave {gave}{least}"
        )
    return sizes


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
