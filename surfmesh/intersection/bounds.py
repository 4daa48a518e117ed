"""How far surfaces and curves bend over cells: boxes that hold them, cones that hold normals.

Over a cell of the sides du, dv the surface differs from the bilinear patch through its corners by
at most (du^2 |r_uu| + dv^2 |r_vv|) / 8, coordinate by coordinate (the error of linear
interpolation, once a parameter); so the box of the corners, wider by that, holds it. |r_uu|,
|r_uv|, |r_vv| are bounded by interval arithmetic for formulas, by control points for splines, in
closed form for planes, cylinders, cones, spheres and tori. Others are sampled: see ``are_known``.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineSurface
from surfmesh.intersection.spline_bounds import SplineBounds, is_smooth

SAMPLED = 2.0
"""Times the largest second derivative of the samples in a cell, where there are no bounds."""

GRID = 4
"""Samples each way of a cell."""

ROUNDING = 1e-13
"""Of the coordinates: boxes are so much wider."""

CORNERS = (False, False), (True, False), (True, True), (False, True)
"""Of a cell: is it the upper end in u, in v?"""

CURVE_GRID = 5
"""Samples of a piece of a curve."""

Bends = np.ndarray
"""(n, 3, 3): bounds of the absolute values of r_uu, r_uv, r_vv over cells, by coordinate."""


class Boxes(NamedTuple):
    """Of cells or pieces: low, high (n, 3); each lies within ``sag`` (n, 3) of the hull of its
    ``corners`` (n, k, 3)."""

    low: np.ndarray
    high: np.ndarray
    corners: np.ndarray
    sag: np.ndarray


class Cones(NamedTuple):
    """Unit normals (n, 3), and angles (n,) from them, pi/2 where they may point anywhere."""

    axis: np.ndarray
    angle: np.ndarray


def are_known(surface: FaceSurface) -> bool:
    """Are there bounds, or only samples?"""
    if isinstance(surface, BSplineSurface):
        return is_smooth(surface)
    return isinstance(surface, (Plane, Cylinder, Cone, Sphere, Torus)) or surface.kind == "formula"


def bends(surface: FaceSurface, lo: np.ndarray, hi: np.ndarray) -> Bends:
    """Of a surface over cells with the corners lo, hi (n, 2)."""
    closed = _closed_form(surface, lo, hi)
    if closed is not None:
        return closed
    if isinstance(surface, BSplineSurface) and is_smooth(surface):
        return _splines(surface).bends(lo, hi)
    known = surface.derivative_bounds(lo, hi)
    if known is not None:
        lower, upper = known
        return np.maximum(np.abs(lower), np.abs(upper))[:, 2:]
    return _sampled(surface, lo, hi)


@lru_cache(maxsize=64)
def _splines(surface: BSplineSurface) -> SplineBounds:
    return SplineBounds(surface)


def _closed_form(surface: FaceSurface, lo: np.ndarray, hi: np.ndarray) -> Bends | None:
    if not isinstance(surface, (Plane, Cylinder, Cone, Sphere, Torus)):
        return None
    found = np.zeros((len(lo), 3, 3))
    if isinstance(surface, Plane):
        return found
    across = np.hypot(surface.x, surface.y)  # |cos u x + sin u y| by coordinate, at most
    if isinstance(surface, Cylinder):
        found[:, 0] = surface.radius * across
        return found
    v = np.maximum(np.abs(lo[:, 1]), np.abs(hi[:, 1]))[:, None]
    if isinstance(surface, Cone):
        slope = abs(np.sin(surface.angle))
        found[:, 0] = (abs(surface.radius) + v * slope) * across
        found[:, 1] = slope * across
        return found
    cos, sin = (
        _largest_cosine(lo[:, 1], hi[:, 1]),
        _largest_cosine(lo[:, 1] - 0.5 * pi, hi[:, 1] - 0.5 * pi),
    )
    if isinstance(surface, Sphere):
        around, tube = 0.0, surface.radius
    else:
        around, tube = surface.radius, surface.tube
    found[:, 0] = (around + tube * cos)[:, None] * across
    found[:, 1] = (tube * sin)[:, None] * across
    found[:, 2] = tube * np.hypot(across, surface.z)
    return found


def _largest_cosine(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """The largest |cos| between two angles (n,)."""
    ends = np.maximum(np.abs(np.cos(low)), np.abs(np.cos(high)))
    return np.where(np.floor(high / pi) >= np.ceil(low / pi), 1.0, ends)


def _sampled(surface: FaceSurface, lo: np.ndarray, hi: np.ndarray) -> Bends:
    line = np.linspace(0.0, 1.0, GRID)
    places = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    uv = lo[:, None] + places * (hi - lo)[:, None]
    second = surface.evaluate(uv.reshape(-1, 2), 2)[3:]
    each = [np.abs(d).reshape(len(lo), -1, 3).max(axis=1) for d in second]
    return SAMPLED * np.stack(each, axis=1)


def boxes_and_cones(surface: FaceSurface, lo: np.ndarray, hi: np.ndarray) -> tuple[Boxes, Cones]:
    """Boxes around a surface over cells with the corners lo, hi (n, 2), cones of its normals."""
    bent = bends(surface, lo, hi)
    width = hi - lo
    du, dv = width[:, :1], width[:, 1:]
    corners = np.stack([np.where(side, hi, lo) for side in CORNERS])
    (points,) = surface.evaluate(corners.reshape(-1, 2), 0)
    points = points.reshape(4, len(lo), 3)
    sag = (du**2 * bent[:, 0] + dv**2 * bent[:, 2]) / 8.0
    sag = (
        np.where(np.isfinite(sag), sag, np.inf)
        + ROUNDING * np.abs(points).max(axis=(0, 2))[:, None]
    )
    boxes = Boxes(points.min(axis=0) - sag, points.max(axis=0) + sag, points.swapaxes(0, 1), sag)
    return boxes, _cones(surface, 0.5 * (lo + hi), du, dv, bent)


def _cones(
    surface: FaceSurface, middle: np.ndarray, du: np.ndarray, dv: np.ndarray, bent: Bends
) -> Cones:
    """|N - N_0| is at most |d_u||r_v| + |r_u||d_v| + |d_u||d_v|, d: how much r_u, r_v change."""
    _, r_u, r_v = surface.evaluate(middle, 1)
    normal = np.cross(r_u, r_v)
    size = np.linalg.norm(normal, axis=1)
    with np.errstate(invalid="ignore", over="ignore"):
        change_u = np.linalg.norm(0.5 * (du * bent[:, 0] + dv * bent[:, 1]), axis=1)
        change_v = np.linalg.norm(0.5 * (du * bent[:, 1] + dv * bent[:, 2]), axis=1)
        along_u, along_v = np.linalg.norm(r_u, axis=1), np.linalg.norm(r_v, axis=1)
        change = change_u * along_v + along_u * change_v + change_u * change_v
        part = np.where(size > 0.0, change / np.maximum(size, 1e-300), np.inf)
        angle = np.where(part < 1.0, np.arcsin(np.minimum(part, 1.0)), 0.5 * pi)
    return Cones(normal / np.maximum(size, 1e-300)[:, None], np.where(np.isnan(part), pi, angle))


def curve_boxes(edge: CadEdge, lo: np.ndarray, hi: np.ndarray) -> tuple[Boxes, Cones]:
    """Boxes around an edge over the fractions lo to hi (n,), and cones of its directions.

    Of lines and conics exactly; others are sampled.
    """
    line = np.linspace(0.0, 1.0, CURVE_GRID)
    fraction = (lo[:, None] + line * (hi - lo)[:, None]).ravel()
    points, first, second = edge.evaluate(fraction, 2)
    shape = (len(lo), CURVE_GRID, 3)
    points, first, second = points.reshape(shape), first.reshape(shape), second.reshape(shape)
    factor = 1.0 if edge.curve is not None and edge.curve.kind in ("line", "circle") else SAMPLED
    bound = factor * np.linalg.norm(second, axis=2).max(axis=1)
    step = (hi - lo) * (edge.t1 - edge.t0)
    sag = (step**2 * bound / 8.0)[:, None] + ROUNDING * np.abs(points).max(axis=(1, 2))[:, None]
    ends = points[:, [0, -1]]
    boxes = Boxes(ends.min(axis=1) - sag, ends.max(axis=1) + sag, ends, sag)
    axis = first[:, CURVE_GRID // 2]
    speed = np.linalg.norm(axis, axis=1)
    part = np.minimum(0.5 * step * bound / np.maximum(speed, 1e-300), 1.0)
    return boxes, Cones(axis / np.maximum(speed, 1e-300)[:, None], np.arcsin(part))


def overlap(one: Boxes, i: np.ndarray, other: Boxes, j: np.ndarray, normals: Cones) -> np.ndarray:
    """May cell i of the one and cell j of the other meet? (n,) bool.

    normals: of the other, along which slabs are compared too: cells that hardly bend are thin.
    """
    meet = (one.low[i] <= other.high[j]).all(axis=1) & (other.low[j] <= one.high[i]).all(axis=1)
    rows = np.flatnonzero(meet)
    i, j = i[rows], j[rows]
    axis = normals.axis[j]
    low, high = _slabs(one, i, axis)
    low_2, high_2 = _slabs(other, j, axis)
    meet[rows[(low > high_2) | (low_2 > high)]] = False  # not so where a sag is infinite
    return meet


def _slabs(boxes: Boxes, i: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Between which distances along axes (n, 3) the cells i lie."""
    along = np.einsum("nkj,nj->nk", boxes.corners[i], axis)
    with np.errstate(invalid="ignore"):
        room = np.einsum("nj,nj->n", boxes.sag[i], np.abs(axis))
    return along.min(axis=1) - room, along.max(axis=1) + room


def cross_surely(one: Cones, i: np.ndarray, other: Cones, j: np.ndarray) -> np.ndarray:
    """Is no normal of cell i parallel to one of cell j? (n,) bool."""
    cosine = np.abs(np.einsum("ij,ij->i", one.axis[i], other.axis[j]))
    return np.arccos(np.minimum(cosine, 1.0)) > one.angle[i] + other.angle[j]


def pierces_surely(curve: Cones, i: np.ndarray, normal: Cones, j: np.ndarray) -> np.ndarray:
    """Is no direction of piece i at right angles to a normal of cell j? (n,) bool."""
    cosine = np.abs(np.einsum("ij,ij->i", curve.axis[i], normal.axis[j]))
    return np.arccos(np.minimum(cosine, 1.0)) + curve.angle[i] + normal.angle[j] < 0.5 * pi
