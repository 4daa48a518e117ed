"""Areas of faces and volumes under them, by integrals over their regions in (u, v).

   integral of f du dv over the inside of loops  =  integral of F dv along the loops,
   F(u, v) = integral of f(x, v) dx from a fixed u to u                     (Green's theorem)

Gauss-Legendre rules both ways, on more and more pieces until two results agree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface
from surfmesh.geometry.surface import Surface, surface_kind

Loops = Sequence[Sequence[CadCoedge]]
Density = Callable[[np.ndarray], np.ndarray]
"""(n, 2) -> (n,): what is integrated over u and v."""

RULES = {count: np.polynomial.legendre.leggauss(count) for count in (3, 8)}

MANY = 24
"""Spans of a spline: with more of them each needs three places only."""

SMOOTH = ("formula", "plane", "cylinder", "cone", "sphere", "torus")
"""Kinds of surfaces."""

PIECES = (1, 2, 4, 8, 16, 32)
"""Of each coedge, and of the way from the fixed u; the finest is taken as it is."""

AGREE, AGREE_FREE_FORM = 1e-9, 1e-7
"""Results that differ by less are the same, relative to the integral of the absolute value; the
second of surfaces that are smooth in pieces only."""

FEWER = 3
"""So many of the last PIECES are not tried on these."""


def region_area(surface: Surface, loops: Loops) -> float:
    """The area within loops of a surface, model units squared."""

    def density(uv: np.ndarray) -> np.ndarray:
        _, r_u, r_v = surface.evaluate(uv, 1)
        return np.linalg.norm(np.cross(r_u, r_v), axis=1)

    return region_integral(density, surface, loops)


def region_cone(surface: Surface, loops: Loops, origin: np.ndarray) -> float:
    """The signed volume between the inside of loops and a point: (r - o) . (r_u x r_v) / 3."""

    def density(uv: np.ndarray) -> np.ndarray:
        r, r_u, r_v = surface.evaluate(uv, 1)
        return np.einsum("ij,ij->i", r - origin, np.cross(r_u, r_v)) / 3.0

    return region_integral(density, surface, loops)


def region_integral(density: Density, surface: Surface, loops: Loops) -> float:
    """Of a density over the inside of loops."""
    is_smooth = surface_kind(surface) in SMOOTH
    agree = AGREE if is_smooth else AGREE_FREE_FORM
    before = np.inf
    for pieces in PIECES if is_smooth else PIECES[:-FEWER]:
        total, size = _integral(density, surface, loops, pieces)
        if abs(total - before) <= agree * size:
            break
        before = total
    return total


def _integral(density: Density, surface: Surface, loops: Loops, pieces: int) -> tuple[float, float]:
    """The integral, and the sum of the absolute values along the loops."""
    knots = _knots(surface)
    fixed = 0.5 * sum(surface.domain[0])
    total = size = 0.0
    for coedge in (coedge for loop in loops for coedge in loop):
        stops = _stops(coedge, pieces, knots)
        fraction, along = _rule(stops, 3 if len(stops) > MANY + 2 * pieces else 8)
        parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
        uv, rate = coedge.pcurve.evaluate(parameters, 1)
        dv = rate[:, 1] * (coedge.p1 - coedge.p0) * along
        if coedge.reversed:
            dv = -dv
        if not np.abs(dv).max() > 0.0:
            continue
        u, weight = _strips(fixed, uv[:, 0], knots[0], pieces)  # (n, m)
        places = np.stack([u, np.broadcast_to(uv[:, 1:], u.shape)], axis=-1).reshape(-1, 2)
        strips = (density(places).reshape(u.shape) * weight).sum(axis=1)
        total += float(strips @ dv)
        size += float(np.abs(strips) @ np.abs(dv))
    return total, size


def _knots(surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Values of u and of v within the domain at which a surface is less smooth."""
    if not isinstance(surface, BSplineSurface):
        return np.empty(0), np.empty(0)
    own = []
    for knots, (low, high) in zip((surface.knots_u, surface.knots_v), surface.domain):
        distinct = np.unique(knots)
        own.append(distinct[(distinct > low) & (distinct < high)])
    return own[0], own[1]


def _strips(
    fixed: float, end: np.ndarray, knots: np.ndarray, pieces: int
) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, m) between a fixed u and ends (n,), with weights: a rule between all knots."""
    low, high = np.minimum(fixed, end)[:, None], np.maximum(fixed, end)[:, None]
    stops = np.hstack([low, np.clip(knots[None], low, high), high])
    inner, weight = _rule(np.linspace(0.0, 1.0, pieces + 1), 8 if len(knots) < MANY else 3)
    width = np.diff(stops, axis=1)[..., None]
    places = stops[:, :-1, None] + width * inner
    sign = np.where(end < fixed, -1.0, 1.0)[:, None]
    return places.reshape(len(end), -1), (width * weight).reshape(len(end), -1) * sign


def _rule(stops: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of a Gauss-Legendre rule between each two stops, all in one row."""
    nodes, weights = RULES[count]
    width = 0.5 * np.diff(stops)[:, None]
    return (stops[:-1, None] + width * (nodes + 1.0)).ravel(), (width * weights).ravel()


def _stops(coedge: CadCoedge, pieces: int, across: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Fractions of a coedge between which it is smooth, and does not cross knots of the surface
    if it is straight; more of them for one that is smooth."""
    even = np.linspace(0.0, 1.0, pieces + 1)
    if not isinstance(coedge.pcurve, BSplineCurve):
        ends = coedge.uv(np.array([0.0, 1.0]))
        step = ends[1] - ends[0]
        crossed = [
            (knots - ends[0, axis]) / step[axis]
            for axis, knots in enumerate(across)
            if coedge.is_straight and abs(step[axis]) > 0.0
        ]
        inner = np.concatenate([*crossed, np.empty(0)])
        return np.union1d(even, inner[(inner > 0.0) & (inner < 1.0)])
    knots = (np.unique(coedge.pcurve.knots) - coedge.p0) / (coedge.p1 - coedge.p0)
    knots = np.sort(knots[(knots > 0.0) & (knots < 1.0)])
    if len(knots) < pieces:
        knots = np.union1d(knots, even[1:-1])
    return np.concatenate([[0.0], knots, [1.0]])
