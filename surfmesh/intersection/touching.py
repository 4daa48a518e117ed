"""Points where a curve touches a surface, or two surfaces each other, and how curves leave them.

Where the difference of both surfaces over the common tangent plane, D = S_A - S_B in second order,
has two signs, two curves cross in the point: a branch point, as of two equal tubes. Their
directions x are x^T D x = 0. One sign: the surfaces touch in that point alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import (
    least_squares,
    norm,
    product,
    pseudo_inverse,
    symmetric_axes,
)
from surfmesh.intersection.newton import Curve, limits_of

STEPS = 20
FLAT = 1e-5
"""Of the larger curvature of D: a smaller one is none, and the surfaces touch along a curve."""


class Touch(NamedTuple):
    """A place on both: the distance there, and whether it was found to rounding."""

    place: np.ndarray
    point: np.ndarray
    gap: float
    found: bool


def touch_of_curve(curve: Curve, surface: FaceSurface, place: np.ndarray) -> Touch:
    """The place (t, u, v) near a guess (3,) where the curve is nearest to the surface:

    (c - r) . r_u = (c - r) . r_v = 0,  c' . (r_u x r_v) = 0.
    """

    def equations(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        c, c1, c2 = (value[0] for value in curve(at[:1], 2))
        r, ru, rv, ruu, ruv, rvv = (value[0] for value in surface.evaluate(at[None, 1:], 2))
        away, normal = c - r, np.cross(ru, rv)
        normal_u = np.cross(ruu, rv) + np.cross(ru, ruv)
        normal_v = np.cross(ruv, rv) + np.cross(ru, rvv)
        value = np.array([product(away, ru), product(away, rv), product(c1, normal)])
        mixed = product(away, ruv) - product(ru, rv)
        slope = np.array([
            [product(c1, ru), product(away, ruu) - product(ru, ru), mixed],
            [product(c1, rv), mixed, product(away, rvv) - product(rv, rv)],
            [product(c2, normal), product(c1, normal_u), product(c1, normal_v)],
        ])  # fmt: skip
        return value, slope

    low, high = limits_of(surface)
    limits = np.array([0.0, *low]), np.array([1.0, *high])
    at, found = _solved(equations, place, limits)
    c, r = curve(at[:1], 0)[0][0], surface.evaluate(at[None, 1:], 0)[0][0]
    return Touch(at, c, norm(c - r), found)


def _solved(
    equations: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], place: np.ndarray,
    limits: tuple[np.ndarray, np.ndarray],
) -> tuple[np.ndarray, bool]:  # fmt: skip
    """Newton from a guess; and whether the last step was nothing."""
    at = np.array(place, float)
    width = np.maximum(limits[1] - limits[0], 1e-300)
    for _ in range(STEPS):
        value, slope = equations(at)
        if not (np.isfinite(value).all() and np.isfinite(slope).all()):
            return at, False
        step = least_squares(slope * width, value, 1e-12)
        step /= max(1.0, 5.0 * float(np.abs(step).max()))
        at = np.clip(at - step * width, *limits)
        if np.abs(step).max() < 1e-13:
            return at, True
    return at, bool(np.abs(step).max() < 1e-9)


def branch_ways(
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray
) -> tuple[str, list[np.ndarray]]:
    """What two surfaces do where they have one tangent plane: "cross" with the four unit
    directions (3,) in which their curves leave, "touch" in a point, "along" a curve with its two
    directions, or "flat", where they do not bend apart: they may be one surface."""
    _, ru, rv = (value[0] for value in a.evaluate(uv_a[None], 1))
    normal = np.cross(ru, rv)
    normal /= norm(normal)
    first = ru / norm(ru)
    frame = np.stack([first, np.cross(normal, first)])
    bent = _second(a, uv_a, normal, frame) - _second(b, uv_b, normal, frame)
    values, axes = symmetric_axes(bent)
    size = np.abs(values).max()
    curved = max(np.abs(_second(a, uv_a, normal, frame)).max(), size)
    if size <= FLAT * curved:
        return "flat", []
    if np.abs(values).min() <= FLAT * size:
        way = product(axes[:, int(np.argmin(np.abs(values)))], frame)
        return "along", [way, -way]
    if values[0] * values[1] > 0.0:
        return "touch", []
    slope = np.sqrt(-values[0] / values[1])
    ways = []
    for sign in (1.0, -1.0):
        way = axes[:, 0] + sign * slope * axes[:, 1]
        way = product(way, frame)
        way /= norm(way)
        ways += [way, -way]
    return "cross", ways


def _second(
    surface: FaceSurface, uv: np.ndarray, normal: np.ndarray, frame: np.ndarray
) -> np.ndarray:
    """Second derivatives (2, 2) of the height over the tangent plane, in its frame (2, 3)."""
    _, ru, rv, ruu, ruv, rvv = (value[0] for value in surface.evaluate(uv[None], 2))
    form = np.array(
        [[product(ruu, normal), product(ruv, normal)], [product(ruv, normal), product(rvv, normal)]]
    )
    inverse = pseudo_inverse(np.stack([product(frame, ru), product(frame, rv)], axis=1), 0.0)
    return product(product(inverse.T, form), inverse)
