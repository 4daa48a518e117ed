"""Lines u = c or v = c of a face's surface that are one point in space.

v |               A torus whose tube reaches its axis has one at the angle pi, or two; a cone at
  |_______c_____  its apex; a surface of revolution where its profile meets the axis; a spline
  |             | where a row of control points is one point. There r_u x r_v is zero, and
  |_____________| no triangle can cross the line.
  +------------- u
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, pi, sin

import numpy as np

from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.surface import Surface

POINT = 1e-9  # of the surface's size: the extent of a line that is a point
ACROSS, ALONG = 9, 65  # samples on a line, and lines tried
STEEP = 0.5  # a line that may become a point is so much shorter than one of its neighbours
NESTED, SAME = 2, 1e-7  # searches within a dip; of the domain: values so near are one
ROUNDING = 1e-14  # of the surface's size
BESIDE = 1e-3, 1e-4  # of the domain: where lines on both sides are compared
NARROWED = 60  # steps of the golden section
GOLDEN = 0.5 * (5.0**0.5 - 1.0)


@dataclass(frozen=True)
class SingularLine:
    """The line on which the parameter ``axis`` (0: u, 1: v) has the ``value``.

    point: (3,) what it is in space.
    """

    axis: int
    value: float
    point: np.ndarray

    def at(self, other: float) -> np.ndarray:
        """(u, v) where the other parameter has this value."""
        return np.array([self.value, other] if self.axis == 0 else [other, self.value])


def singular_lines(surface: FaceSurface) -> list[SingularLine]:
    """All such lines in the surface's domain, its sides among them, in rising order of values."""
    known = _known(surface)
    if known is not None:
        values = [(1, value) for value in known]
    elif surface.kind == "extrusion":
        values = []
    else:
        axes = (1,) if surface.kind == "revolution" else (0, 1)
        values = [(axis, value) for axis in axes for value in _found(surface, axis)]
    lines = []
    for axis, value in values:
        low, high = surface.domain[axis]
        slack = POINT * (high - low)
        if low - slack <= value <= high + slack:
            middle = 0.5 * sum(surface.domain[1 - axis])
            place = np.array([[value, middle] if axis == 0 else [middle, value]])
            lines.append(SingularLine(axis, float(value), surface.evaluate(place, 0)[0][0]))
    return lines


def _known(surface: FaceSurface) -> list[float] | None:
    """The values of v, of surfaces that say them."""
    if isinstance(surface, (Plane, Cylinder)):
        return []
    if isinstance(surface, Sphere):
        return [-0.5 * pi, 0.5 * pi]
    if isinstance(surface, Cone):
        return [-surface.radius / sin(surface.angle)]
    return _of_torus(surface) if isinstance(surface, Torus) else None


def _of_torus(surface: Torus) -> list[float]:
    """R + r cos v = 0, in all turns of v that the domain has a part of."""
    radius, tube = surface.radius, surface.tube
    if radius - tube > POINT * tube:
        return []
    half = pi - acos(min(radius / tube, 1.0))
    low, high = surface.domain[1]
    turns = range(int(low // (2.0 * pi)) - 1, int(high // (2.0 * pi)) + 2)
    found = {2.0 * pi * turn + side for turn in turns for side in (half, 2.0 * pi - half)}
    return sorted(found)


def _found(surface: Surface, axis: int) -> list[float]:
    """By search: where the extent of a line, seen over the domain, falls to nothing."""
    low, high = surface.domain[axis]
    values = np.linspace(low, high, ALONG)
    extent, size = _extents(surface, axis, values)
    tolerance = POINT * size
    found = [float(values[k]) for k in (0, ALONG - 1) if extent[k] <= tolerance]
    for value in _dips(surface, axis, low, high, NESTED):
        apart = all(abs(value - other) > SAME * (high - low) for other in found)
        # the search is off by the root of what is lost in rounding
        if apart and _extents(surface, axis, np.array([value]))[0][0] <= tolerance:
            found.append(value)
    return sorted(found)


def _dips(surface: Surface, axis: int, low: float, high: float, nested: int) -> list[float]:
    """Where the extent is steeply least between two values; two dips may lie near each other."""
    values = np.linspace(low, high, ALONG)
    extent = _extents(surface, axis, values)[0]
    inner = np.arange(1, ALONG - 1)
    before, here, after = extent[inner - 1], extent[inner], extent[inner + 1]
    steep = here < STEEP * np.maximum(before, after)
    dips = inner[(here <= before) & (here <= after) & steep]
    if not nested:
        return [_lowest(surface, axis, values[k - 1], values[k + 1]) for k in dips]
    spans = [(values[k - 1], values[k + 1]) for k in dips]
    return [value for span in spans for value in _dips(surface, axis, *span, nested - 1)]


def _lowest(surface: Surface, axis: int, low: float, high: float) -> float:
    """Where the extent is least between two values: golden section."""
    a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    fa, fb = _extents(surface, axis, np.array([a, b]))[0]
    for _ in range(NARROWED):
        if fa <= fb:
            high, b, fb = b, a, fa
            a = high - GOLDEN * (high - low)
            fa = _extents(surface, axis, np.array([a]))[0][0]
        else:
            low, a, fa = a, b, fb
            b = low + GOLDEN * (high - low)
            fb = _extents(surface, axis, np.array([b]))[0][0]
    return _between_alike(surface, axis, float(a if fa <= fb else b))


def _between_alike(surface: Surface, axis: int, value: float) -> float:
    """The value again, where lines on both sides are alike: a flat least is lost in rounding.

    Kept only where the line there is as short as rounding lets it be.
    """
    low, high = surface.domain[axis]
    better = value
    for fraction in BESIDE:
        step = min(fraction * (high - low), better - low, high - better)
        if not step > 0.0:
            return value
        places = np.array([better - step, better + 0.5 * step, better + step])
        before, steeper, after = _extents(surface, axis, places)[0]
        if not min(before, after, steeper) > 0.0:
            return value
        # extent |s|^p: a shift by d changes the ratio of both sides by 2 p d / step
        power = max(np.log2(after / steeper), 1.0)
        better += float(np.clip(0.5 * step * np.log(before / after) / power, -step, step))
    _, size = _extents(surface, axis, np.linspace(low, high, ACROSS))
    here = _extents(surface, axis, np.array([better]))[0][0]
    return better if here <= ROUNDING * size else value


def _extents(surface: Surface, axis: int, values: np.ndarray) -> tuple[np.ndarray, float]:
    """Diagonals (n,) of the boxes around the lines, and of that around all of them."""
    across = np.linspace(*surface.domain[1 - axis], ACROSS)
    uv = np.empty((len(values), ACROSS, 2))
    uv[..., axis] = values[:, None]
    uv[..., 1 - axis] = across
    (points,) = surface.evaluate(uv.reshape(-1, 2), 0)
    boxes = np.ptp(points.reshape(len(values), ACROSS, 3), axis=1)
    return np.linalg.norm(boxes, axis=1), diagonal(points)
