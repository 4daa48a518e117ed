"""What users give as loops, lines and points of a domain, as arrays; refused with its label."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from surfmesh.errors import DomainError, shown


def line_arrays(kind: str, given: Any) -> list[np.ndarray]:
    """One array (k, 2), or several, as a list of arrays (k, 2)."""
    if hasattr(given, "geom_type"):
        raise DomainError(
            f"{kind} is a shapely {given.geom_type}; use PlanarDomain.from_shapely for it"
        )
    if isinstance(given, np.ndarray) and given.ndim == 2:
        given = [given]
    if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
        raise DomainError(f"{kind}: an array (k, 2) or several are needed, not {shown(given)}")
    given = list(given)
    if given and all(_is_place(place) for place in given):
        given = [given]
    return [_coordinates(f"{kind} {number}", line) for number, line in enumerate(given)]


def _is_place(given: Any) -> bool:
    """Is it one point, so that what holds it is one line?"""
    return np.ndim(given) == 1 if isinstance(given, np.ndarray) else _is_flat(given)


def _is_flat(given: Any) -> bool:
    return isinstance(given, (tuple, list)) and bool(given) and not any(map(np.ndim, given[:1]))


def _coordinates(label: str, given: Any) -> np.ndarray:
    try:
        array = np.array(given if isinstance(given, np.ndarray) else list(given))
        array = array.astype(float, casting="same_kind") if array.size else np.empty((0, 2))
    except (TypeError, ValueError, OverflowError):
        raise DomainError(f"{label} is not an array (k, 2) of numbers: {shown(given)}") from None
    if array.ndim != 2 or array.shape[1] != 2:
        raise DomainError(f"{label} has shape {array.shape}, not (k, 2)")
    if not len(array):
        raise DomainError(f"{label} holds no points; leave it out")
    broken = ~np.isfinite(array).all(axis=1)
    if broken.any():
        k = int(broken.argmax())
        raise DomainError(f"{label}, point {k} is not finite: {array[k].tolist()}")
    return array


def open_loop(label: str, loop: np.ndarray) -> np.ndarray:
    """The loop without a repeated first point; refused when it cannot have an area."""
    if len(loop) > 1 and (loop[0] == loop[-1]).all():
        loop = loop[:-1]
    distinct = len(np.unique(loop, axis=0))
    if distinct < 3:
        raise DomainError(f"{label} has {distinct} distinct points; a loop needs three or more")
    return loop


def point_array(given: Any) -> np.ndarray:
    """Points as an array (p, 2)."""
    if not isinstance(given, np.ndarray):
        if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
            raise DomainError(f"points are an array (p, 2), not {shown(given)}")
        given = list(given)
        if _is_flat(given):
            given = [given]
    return _coordinates("the array of points", given) if len(given) else np.empty((0, 2))


def shapely_geometries(given: Any) -> list[Any]:
    """The shapely geometries in what was given; none when they are arrays."""
    if hasattr(given, "geom_type"):
        return [given]
    if isinstance(given, (list, tuple)) and given and hasattr(given[0], "geom_type"):
        return list(given)
    return []
