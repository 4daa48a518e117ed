"""Which points of the (u, v) plane lie within the loops of a face."""

from __future__ import annotations

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve

SAMPLES, MOST = 64, 1024
"""Segments of a curved coedge, at least and at most; two for each span of a spline."""

WIDER = 2.0
"""Times the sag of a segment: nearer to it nothing is sure."""

ROUNDING = 1e-9
"""Of the (u, v) box."""


class Region:
    """The inside of a face's loops, as polygons that know how far they are off their curves."""

    def __init__(self, face: CadFace) -> None:
        box = np.array(face.surface.domain)
        self.scale = box[:, 1] - box[:, 0]
        self.coedges = list(face.coedges)
        starts, ends, sags = [], [], []
        for coedge in face.coedges:
            polygon, sag = polygon_of(coedge, self.scale)
            starts.append(polygon[:-1])
            ends.append(polygon[1:])
            sags.append(sag)
        self.start, self.end = np.concatenate(starts), np.concatenate(ends)
        self.sag = WIDER * np.concatenate(sags) + ROUNDING

    def inside(self, uv: np.ndarray) -> np.ndarray:
        """(n,) bool: on the left of the nearest loops, by crossings; edges run twice cancel."""
        u, v = (np.asarray(uv, float) / self.scale).reshape(-1, 2).T[..., None]
        (u0, v0), (u1, v1) = self.start.T, self.end.T
        rise = np.where(v1 == v0, 1.0, v1 - v0)
        spans = (v0 > v) != (v1 > v)
        return (spans & (u0 + (v - v0) / rise * (u1 - u0) < u)).sum(axis=1) % 2 == 1

    def distance(self, uv: np.ndarray) -> np.ndarray:
        """(n,) to the polygons, in parts of the box, less what these are off their curves."""
        point = (np.asarray(uv, float) / self.scale).reshape(-1, 1, 2)
        step = self.end - self.start
        square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-300)
        t = np.clip(np.einsum("nij,ij->ni", point - self.start, step) / square, 0.0, 1.0)
        foot = self.start + t[..., None] * step
        return (np.linalg.norm(point - foot, axis=2) - self.sag).min(axis=1)

    def beside_curve(self, uv: np.ndarray) -> bool:
        """Of one point (2,) near a curve: is it on the left of the nearest coedge's own curve?"""
        best, left = np.inf, False
        for coedge in self.coedges:
            fraction = np.linspace(0.0, 1.0, 2 * SAMPLES + 1)
            for _ in range(5):
                points = coedge.walk(fraction) / self.scale
                distance = np.linalg.norm(points - uv / self.scale, axis=1)
                k = int(np.argmin(distance))
                around = fraction[max(k - 1, 0)], fraction[min(k + 1, len(fraction) - 1)]
                fraction = np.linspace(*around, 33)
            if distance[k] < best:
                best = distance[k]
                a, b = coedge.walk(np.array(around)) / self.scale
                ahead, step = b - a, uv / self.scale - a
                left = bool(ahead[0] * step[1] - ahead[1] * step[0] > 0.0)
        return left

    def surely_inside(self, uv: np.ndarray) -> np.ndarray:
        """(n,) bool."""
        return self.inside(uv) & (self.distance(uv) > 0.0)

    def surely_outside(self, uv: np.ndarray) -> np.ndarray:
        """(n,) bool."""
        return ~self.inside(uv) & (self.distance(uv) > 0.0)

    def interior_point(self) -> np.ndarray:
        """(2,) a point well within: of a few on lines across, the one farthest from the loops."""
        points = self.interior_points()
        # not the very middle: symmetric parts have other surfaces through it
        return points[int(np.argmax(self.distance(points)))]

    def interior_points(self) -> np.ndarray:
        """(n, 2) some points inside, on lines across."""
        low = np.minimum(self.start.min(axis=0), self.end.min(axis=0))
        high = np.maximum(self.start.max(axis=0), self.end.max(axis=0))
        candidates = []
        for cut in (0.5, 0.382, 0.618, 0.213, 0.787, 0.09, 0.91):
            for axis in (0, 1):
                candidates.append(self._spans(axis, low[axis] + cut * (high - low)[axis]))
        return np.concatenate(candidates) * self.scale

    def _spans(self, axis: int, value: float) -> np.ndarray:
        """Points off the middle of the spans of a line that lie inside: (n, 2), scaled."""
        a, b = self.start, self.end
        crosses = (a[:, axis] > value) != (b[:, axis] > value)
        a, b = a[crosses], b[crosses]
        t = (value - a[:, axis]) / (b[:, axis] - a[:, axis])
        other = np.sort(a[:, 1 - axis] + t * (b[:, 1 - axis] - a[:, 1 - axis]))
        middle = 0.47 * other[:-1] + 0.53 * other[1:]
        points = np.empty((len(middle), 2))
        points[:, axis], points[:, 1 - axis] = value, middle
        return points[self.inside(points * self.scale)] if len(points) else points


def polygon_of(coedge: CadCoedge, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A coedge as it is walked: points (n + 1, 2) over ``scale``, and how far segments (n,) sag."""
    if coedge.is_straight:
        return coedge.walk(np.array([0.0, 1.0])) / scale, np.zeros(1)
    count = SAMPLES
    if isinstance(coedge.pcurve, BSplineCurve):
        knots = np.unique(coedge.pcurve.knots)
        low, high = sorted((coedge.p0, coedge.p1))
        count = int(np.clip(2 * ((knots > low) & (knots < high)).sum(), SAMPLES, MOST))
    points = coedge.walk(np.linspace(0.0, 1.0, 2 * count + 1)) / scale
    ends, middles = points[::2], points[1::2]
    return ends, np.linalg.norm(middles - 0.5 * (ends[1:] + ends[:-1]), axis=1)
