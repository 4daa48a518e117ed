"""Areas of faces and volumes under them, by integrals over their regions in (u, v).

   integral of f du dv over the inside of loops  =  integral of F dv along the loops,
   F(u, v) = integral of f(x, v) dx from a fixed u to u                     (Green's theorem)

Gauss-Legendre rules both ways, on more and more pieces until two results agree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.surface import Surface

Loops = Sequence[Sequence[CadCoedge]]
Density = Callable[[np.ndarray], np.ndarray]
"""(n, 2) -> (n,): what is integrated over u and v."""

RULES = {count: np.polynomial.legendre.leggauss(count) for count in (3, 8)}

MANY = 24
"""Spans of a spline: with more of them each needs three places only."""

PIECES = (1, 2, 4, 8, 16, 32)
"""Of each coedge, and of the way from the fixed u; the finest is taken as it is."""

AGREE = 1e-9
"""Relative to the integral of the absolute value: results that differ by less are the same."""


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
    before = np.inf
    for pieces in PIECES:
        total, size = _integral(density, surface, loops, pieces)
        if abs(total - before) <= AGREE * size:
            break
        before = total
    return total


def _integral(density: Density, surface: Surface, loops: Loops, pieces: int) -> tuple[float, float]:
    """The integral, and the sum of the absolute values along the loops."""
    inner, weight = _rule(np.linspace(0.0, 1.0, pieces + 1), 8)
    fixed = 0.5 * sum(surface.domain[0])
    total = size = 0.0
    for coedge in (coedge for loop in loops for coedge in loop):
        stops = _stops(coedge, pieces)
        fraction, along = _rule(stops, 3 if len(stops) > MANY + 2 * pieces else 8)
        parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
        uv, rate = coedge.pcurve.evaluate(parameters, 1)
        dv = rate[:, 1] * (coedge.p1 - coedge.p0) * along
        if coedge.reversed:
            dv = -dv
        if not np.abs(dv).max() > 0.0:
            continue
        way = uv[:, :1] - fixed  # (n, 1)
        u = fixed + way * inner  # (n, m)
        places = np.stack([u, np.broadcast_to(uv[:, 1:], u.shape)], axis=-1).reshape(-1, 2)
        strips = (density(places).reshape(u.shape) @ weight) * way[:, 0]
        total += float(strips @ dv)
        size += float(np.abs(strips) @ np.abs(dv))
    return total, size


def _rule(stops: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of a Gauss-Legendre rule between each two stops, all in one row."""
    nodes, weights = RULES[count]
    width = 0.5 * np.diff(stops)[:, None]
    return (stops[:-1, None] + width * (nodes + 1.0)).ravel(), (width * weights).ravel()


def _stops(coedge: CadCoedge, pieces: int) -> np.ndarray:
    """Fractions of a coedge between which it is smooth; more of them for one that is smooth."""
    if not isinstance(coedge.pcurve, BSplineCurve):
        return np.linspace(0.0, 1.0, pieces + 1)
    knots = (np.unique(coedge.pcurve.knots) - coedge.p0) / (coedge.p1 - coedge.p0)
    knots = np.sort(knots[(knots > 0.0) & (knots < 1.0)])
    if len(knots) < pieces:
        knots = np.union1d(knots, np.linspace(0.0, 1.0, pieces + 1)[1:-1])
    return np.concatenate([[0.0], knots, [1.0]])
