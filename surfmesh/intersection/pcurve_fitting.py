"""Curves in the (u, v) of a face that follow an edge which lies on it, at the edge's own pace.

The nearest point of the surface is followed from the middle of the edge to both ends, then a
spline goes through more and more of them; a line where they lie on one at an even pace.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge
from surfmesh.geometry.cad_surfaces.curves import CoreCurve, Line
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.interpolating_spline import interpolating_spline
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.newton import BEYOND

GRID = 33
"""Samples each way of a surface, of which the nearest to a point is looked for first."""

STEPS = 12
"""Towards the nearest point."""

FOLLOWED = 16
"""Steps along an edge, of which each starts from the one before."""

COUNTS = (16, 32, 64, 128, 256, 512, 1024)
"""Spans of the spline, the first that are enough."""

DEGREE = 5
BETWEEN = np.array([0.113, 0.31, 0.5, 0.69, 0.887])
"""Of a span: where it is compared with the edge."""

STRAIGHT = 1e-12
"""Of the (u, v) box: places so near to a line at an even pace are on it."""


def nearest_on_surface(surface: FaceSurface, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2) of a surface over its box that are nearest to points (n, 3); distances (n,)."""
    box = np.array(surface.domain)
    line = (np.arange(GRID) + 0.5) / GRID  # no poles among them
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    uv = box[:, 0] + grid * (box[:, 1] - box[:, 0])
    samples = np.nan_to_num(surface.evaluate(uv, 0)[0], nan=np.inf)
    away = np.linalg.norm(points[:, None] - samples, axis=2)
    found, distance, _ = closest_point(
        surface, points, uv[np.argmin(away, axis=1)], STEPS, margin=BEYOND
    )
    return found, distance


def followed(edge: CadEdge, surface: FaceSurface, middle: np.ndarray) -> np.ndarray:
    """Places (FOLLOWED + 1, 2) beside an edge at even fractions, from that of its middle (2,)."""
    points = edge.evaluate(np.linspace(0.0, 1.0, FOLLOWED + 1), 0)[0]
    found = np.empty((len(points), 2))
    half = FOLLOWED // 2
    found[half] = middle
    for order in (range(half + 1, FOLLOWED + 1), range(half - 1, -1, -1)):
        step = np.zeros(2)
        for k in order:
            before = found[k - 1 if k > half else k + 1]
            guess = (before + step)[None]
            found[k] = closest_point(surface, points[k][None], guess, STEPS, margin=BEYOND)[0][0]
            step = found[k] - before
    # at a pole any place is as near as another: go on straight
    width = np.ptp(np.array(surface.domain), axis=1)
    for end, one, two in ((0, 1, 2), (-1, -2, -3)):
        ahead = 2.0 * found[one] - found[two]
        if np.abs((found[end] - ahead) / width).max() > 0.1:
            found[end] = np.where(np.abs(found[end] - ahead) / width > 0.1, ahead, found[end])
    return found


def pcurve_along(
    edge: CadEdge, surface: FaceSurface, places: np.ndarray, reach: float
) -> tuple[CoreCurve, float, float]:
    """A curve over 0 to its second value, for the fractions 0 to 1 of an edge; how far it is off
    the edge in space.

    places: (n + 1, 2) at even fractions; its ends are kept. reach: the first that is as near is
    taken, else the nearest.
    """
    width = np.ptp(np.array(surface.domain), axis=1)
    fraction = np.linspace(0.0, 1.0, len(places))
    even = places[0] + fraction[:, None] * (places[-1] - places[0])
    if np.abs((places - even) / width).max() <= STRAIGHT:
        step = places[-1] - places[0]
        length = norm(step)
        line = Line(places[0], step / length)
        return line, length, _deviation(edge, surface, line, length, 16)
    spline: Callable[[np.ndarray], np.ndarray] = interpolating_spline(fraction, places, 3)
    best: CoreCurve | None = None
    nearest = np.inf
    for count in COUNTS:
        fraction = np.linspace(0.0, 1.0, count + 1)
        points = edge.evaluate(fraction, 0)[0]
        uv = closest_point(surface, points, spline(fraction), STEPS, margin=BEYOND)[0]
        uv[[0, -1]] = places[[0, -1]]
        made = interpolating_spline(fraction, uv, DEGREE)
        curve = BSplineCurve(made.t, made.c)
        off = _deviation(edge, surface, curve, 1.0, count)
        if off < nearest:
            best, nearest = curve, off
        if nearest <= reach:
            break
        spline = made
    assert best is not None  # noqa: S101
    return best, 1.0, nearest


def _deviation(
    edge: CadEdge, surface: FaceSurface, curve: CoreCurve, length: float, count: int
) -> float:
    fraction = ((np.arange(count)[:, None] + BETWEEN) / count).ravel()
    on_face = surface.evaluate(curve.evaluate(length * fraction, 0)[0], 0)[0]
    return float(np.linalg.norm(on_face - edge.evaluate(fraction, 0)[0], axis=1).max())


def as_edge_runs(
    coedge: CadCoedge, edge: CadEdge, turned: bool, surface: FaceSurface, reach: float
) -> tuple[CadCoedge, float]:
    """A use of one edge as the use of another in the same place, which may run the other way.

    The p-curve is kept where its pace is that of the new edge within ``reach``, else made anew.
    edge: the new one; its number is the caller's. Returns how far it is off the edge, too.
    """
    fraction = np.linspace(0.0, 1.0, FOLLOWED + 1)
    places = coedge.uv(fraction)
    if turned:
        places = places[::-1]
    on_face = surface.evaluate(places, 0)[0]
    off = float(np.linalg.norm(on_face - edge.evaluate(fraction, 0)[0], axis=1).max())
    reversed_ = coedge.reversed != turned
    if off <= reach and not turned:
        return CadCoedge(-1, reversed_, coedge.pcurve, coedge.p0, coedge.p1, coedge.seam), off
    curve, length, off = pcurve_along(edge, surface, places, reach)
    return CadCoedge(-1, reversed_, curve, 0.0, length, coedge.seam), off
