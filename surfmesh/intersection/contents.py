"""Areas of faces and volumes under them, by integrals over their regions in (u, v).

   integral of f du dv over the inside of loops  =  integral of F dv along the loops,
   F(u, v) = integral of f(x, v) dx from a fixed u to u                     (Green's theorem)

Gauss-Legendre rules both ways, on more and more pieces until two results agree.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh._core import intersection
from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.quadrature import unit_rule
from surfmesh.geometry.small_matrices import product
from surfmesh.geometry.surface import Surface, surface_kind

Loops = Sequence[Sequence[CadCoedge]]
RULES = {count: unit_rule(count) for count in (3, 8)}

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
    return _region_integral(surface, loops, None)


def region_cone(surface: Surface, loops: Loops, origin: np.ndarray) -> float:
    """The signed volume between the inside of loops and a point: (r - o) . (r_u x r_v) / 3."""
    return _region_integral(surface, loops, origin)


def _region_integral(surface: Surface, loops: Loops, origin: np.ndarray | None) -> float:
    """Of the element of area, or of volume, over the inside of loops."""
    is_smooth = surface_kind(surface) in SMOOTH
    agree = AGREE if is_smooth else AGREE_FREE_FORM
    refined = PIECES[1:] if is_smooth else PIECES[1:-FEWER]
    strips = _Strips(surface, origin, agree, len(refined))
    coedges = [coedge for loop in loops for coedge in loop]
    coarse = [strips.along(coedge, PIECES[0]) for coedge in coedges]
    enough = agree * sum(size for _, size in coarse) / len(coedges)
    total = 0.0
    for coedge, (before, _) in zip(coedges, coarse):
        for pieces in refined:
            found, _ = strips.along(coedge, pieces)
            close = abs(found - before) <= enough
            before = found
            if close:
                break
        total += before
    return total


class _Strips:
    """Integrals over u from a fixed one to a coedge, and over v along it."""

    def __init__(
        self, surface: Surface, origin: np.ndarray | None, agree: float, halvings: int
    ) -> None:
        self.core, self.origin = as_core_surface(surface), origin
        self.knots = _knots(surface)
        self.fixed = 0.5 * sum(surface.domain[0])
        rule = _rule(np.array([0.0, 1.0]), 8 if len(self.knots[0]) < MANY else 3)
        self.settings = (*rule, agree, halvings)

    def along(self, coedge: CadCoedge, pieces: int) -> tuple[float, float]:
        """The integral along a coedge in pieces, and the sum of the absolute values."""
        stops = _stops(coedge, pieces, self.knots)
        fraction, along = _rule(stops, 3 if len(stops) > MANY + 2 * pieces else 8)
        parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
        uv, rate = coedge.pcurve.evaluate(parameters, 1)
        dv = rate[:, 1] * (coedge.p1 - coedge.p0) * along
        if coedge.reversed:
            dv = -dv
        if not np.abs(dv).max() > 0.0:
            return 0.0, 0.0
        strips = intersection.strip_integrals(
            self.core, self.fixed, uv, self.knots[0], *self.settings, self.origin
        )
        return float(product(strips, dv)), float(product(np.abs(strips), np.abs(dv)))


def _knots(surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Values of u and of v within the domain at which a surface is less smooth."""
    if not isinstance(surface, BSplineSurface):
        return np.empty(0), np.empty(0)
    own = []
    for knots, (low, high) in zip((surface.knots_u, surface.knots_v), surface.domain):
        distinct = np.unique(knots)
        own.append(distinct[(distinct > low) & (distinct < high)])
    return own[0], own[1]


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
