"""The edge length that a curvature allows: formulas of the core (src/sizing/curvature_sizes.hpp).

A triangle with its corners on the quadric z = (k1 x^2 + k2 y^2) / 2 misses it by the linear
interpolation error of z, and two that share an edge are bent by the jump of its slope. The field
asks the core, ``explain``, edges and reports ask here: the same formulas.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from surfmesh._core import sizing as core

DEVIATION_RESERVE, ALIKE_RESERVE = core.DEVIATION_RESERVE, core.ALIKE_RESERVE  # 0.74, 0.78
"""Share of ``chord`` that a unit triangle may use: curved one way only, and both ways alike."""

ROUND_RESERVE, BENT_RESERVE = core.ROUND_RESERVE, core.BENT_RESERVE  # 0.78, 0.94
"""Share of ``angle`` that two unit triangles may be bent by: on a sphere; and for what depends on
the direction."""

STRETCHED_RESERVE, STRAIGHT_RESERVE = core.STRETCHED_RESERVE, core.STRAIGHT_RESERVE  # 0.7, 0.75
"""Of ``chord`` for anisotropic sizes: curved both ways, and one way only."""


def deviation_factor(k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """c with deviation = c h^2, for principal curvatures k1, k2, 1 / model unit."""
    return _each(core.deviation_factor, k1, k2)


def chord_size(k1: np.ndarray, k2: np.ndarray, chord: float | np.ndarray) -> np.ndarray:
    """Edge length at which triangles stay within ``chord`` of the surface; never below 2 ``chord``.

    Here and below k1, k2 are of one shape, and so is what is returned.
    """
    if isinstance(chord, np.ndarray) and chord.ndim:
        return _by_chord(lambda *rows: (core.chord_size(*rows),), chord, k1, k2)[0]
    return _each(core.chord_size, k1, k2, float(chord))


def lattice_chord_size(k1: np.ndarray, k2: np.ndarray, chord: float) -> np.ndarray:
    """The same of triangles that form a lattice, laid where it deviates least."""
    return _each(core.lattice_chord_size, k1, k2, chord)


def quadratic_chord_size(k1: np.ndarray, k2: np.ndarray, chord: float) -> np.ndarray:
    """Edge length at which quadratic triangles stay within ``chord`` where the curvature does not
    change; never below 2 ``chord``."""
    return _each(core.quadratic_chord_size, k1, k2, chord)


def share_of_width(k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float) -> np.ndarray:
    """Fraction of a chord that may be used where it is the width of the band around the surface
    that a triangle needs: all of it where the surface bends one way. ratio: of two sizes."""
    first, second = _rows(k1, k2)
    found = core.share_of_width(first.ravel(), second.ravel(), _each_of(ratio, first).ravel())
    return found.reshape(first.shape)


def angle_size(k1: np.ndarray, k2: np.ndarray, angle: float) -> np.ndarray:
    """Edge length at which dihedral angles are at most ``angle`` (degrees)."""
    return _each(core.angle_size, k1, k2, angle)


def normal_deviation_size(k1: np.ndarray, k2: np.ndarray, angle: float) -> np.ndarray:
    """Edge length at which the normals of neighbours differ by at most ``angle`` (degrees)."""
    return _each(core.normal_deviation_size, k1, k2, angle)


def principal_chord_sizes(
    k1: np.ndarray, k2: np.ndarray, chord: float | np.ndarray, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Edge lengths along the directions of k1 and k2 at which triangles stay within ``chord``, for
    a ``ratio`` of the two at most."""
    if isinstance(chord, np.ndarray) and chord.ndim:
        first, second = _by_chord(core.principal_chord_sizes, chord, k1, k2, _each_of(ratio, k1))
        return first, second
    return core.principal_chord_sizes(*_rows(k1, k2), float(chord), _each_of(ratio, k1))


def evened_chord_sizes(
    k1: np.ndarray, k2: np.ndarray, chord: float | np.ndarray, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """The same of triangles whose corners move until they lie nearer: ``Sizing(fewest=True)``."""
    if isinstance(chord, np.ndarray) and chord.ndim:
        first, second = _by_chord(core.evened_chord_sizes, chord, k1, k2, _each_of(ratio, k1))
        return first, second
    return core.evened_chord_sizes(*_rows(k1, k2), float(chord), _each_of(ratio, k1))


def saddle_lattice_sizes(
    k1: np.ndarray, k2: np.ndarray, chord: float, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """The same of triangles that form a lattice on a saddle, laid where it deviates least."""
    return core.saddle_lattice_sizes(*_rows(k1, k2), chord, _each_of(ratio, k1))


def principal_angle_sizes(
    k1: np.ndarray, k2: np.ndarray, angle: float, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Edge lengths along k1 and k2 at which dihedral angles are at most ``angle`` (degrees)."""
    return core.principal_angle_sizes(*_rows(k1, k2), angle, _each_of(ratio, k1))


def _each(formula: Callable[..., np.ndarray], k1: Any, k2: Any, *number: float) -> np.ndarray:
    first, second = _rows(k1, k2)
    return formula(first.ravel(), second.ravel(), *number).reshape(first.shape)


def _by_chord(
    formula: Callable[..., tuple[np.ndarray, ...]], chord: np.ndarray, k1: np.ndarray,
    k2: np.ndarray, *others: np.ndarray,
) -> list[np.ndarray]:  # fmt: skip
    """What a formula says of places (n,) that have a chord each."""
    parts = []
    order = np.argsort(chord, kind="stable")
    for here in np.split(order, np.flatnonzero(np.diff(chord[order])) + 1):
        if len(here):
            given = k1[here], k2[here], float(chord[here[0]]), *(row[here] for row in others)
            parts.append(formula(*given))
    found = [np.empty(len(chord)) for _ in zip(*parts)]
    for column, values in zip(found, zip(*parts)):
        column[order] = np.concatenate(values)
    return found


def _rows(k1: Any, k2: Any) -> tuple[np.ndarray, np.ndarray]:
    return np.ascontiguousarray(k1, float), np.ascontiguousarray(k2, float)


def _each_of(ratio: np.ndarray | float, k1: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(ratio, np.shape(k1)), float)
