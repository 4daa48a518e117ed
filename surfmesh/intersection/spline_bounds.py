"""Bounds of second derivatives of spline surfaces over cells, by control points.

Derivatives of a spline are splines whose control points are differences of its own; over a cell
they lie between those of the spans that it meets. A rational one is S = A / w, and so

    S_uu = (A_uu - 2 w_u S_u - w_uu S) / w        S_u = (A_u - w_u S) / w
    S_uv = (A_uv - w_u S_v - w_v S_u - w_uv S) / w

with A taken about a point of the cell's control points (Piegl and Tiller, The NURBS Book, 4.2).
"""

from __future__ import annotations

import numpy as np

from surfmesh.geometry.cad_surfaces.nurbs import BSplineSurface

ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


class SplineBounds:
    """Of one surface; see ``is_smooth`` for those that have bounds."""

    def __init__(self, surface: BSplineSurface) -> None:
        self.degrees = surface.degrees
        self.knots = surface.knots_u, surface.knots_v
        self.periods = surface.periods
        weights = surface.weights
        if weights is None:
            weights = np.ones(surface.control.shape[:2])
        net = np.concatenate([surface.control * weights[..., None], weights[..., None]], axis=2)
        self.nets = {order: self._derived(net, order) for order in ORDERS}

    def _derived(self, net: np.ndarray, order: tuple[int, int]) -> np.ndarray:
        """Control points of a derivative: (nu - k, nv - l, 4); empty above the degree."""
        for axis, times in enumerate(order):
            net = np.moveaxis(net, axis, 0)
            for done in range(times):
                degree, knots = self.degrees[axis] - done, self.knots[axis]
                if degree < 1:
                    net = net[:0]
                    break
                first = done + 1
                span = knots[first + degree : first + degree + len(net) - 1]
                span = span - knots[first : first + len(net) - 1]
                with np.errstate(divide="ignore", invalid="ignore"):
                    factor = np.where(span > 0.0, degree / np.where(span > 0.0, span, 1.0), 0.0)
                net = factor[:, None, None] * np.diff(net, axis=0)
            net = np.moveaxis(net, 0, axis)
        return net

    def bends(self, lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
        """(n, 3, 3) bounds of |S_uu|, |S_uv|, |S_vv| over cells with the corners lo, hi (n, 2)."""
        spans = [self._spans(axis, lo[:, axis], hi[:, axis]) for axis in (0, 1)]
        return np.array([
            self._of_cell((u0, u1), (v0, v1)) for u0, u1, v0, v1 in zip(*spans[0], *spans[1])
        ]).reshape(-1, 3, 3)  # fmt: skip

    def _spans(self, axis: int, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First and last knot span that cells meet; all of them beyond the knots."""
        degree, knots, period = self.degrees[axis], self.knots[axis], self.periods[axis]
        count = len(knots) - degree - 1
        begin, end = knots[degree], knots[count]
        if period:
            turns = np.floor((0.5 * (low + high) - begin) / period) * period
            low, high = low - turns, high - turns
        first = np.searchsorted(knots, low, side="right") - 1
        last = np.searchsorted(knots, high, side="left") - 1
        slack = 1e-12 * (end - begin)
        beyond = (low < begin - slack) | (high > end + slack)
        first = np.where(beyond, degree, np.clip(first, degree, count - 1))
        last = np.where(beyond, count - 1, np.clip(last, degree, count - 1))
        return first, np.maximum(first, last)

    def _of_cell(self, u: tuple[int, int], v: tuple[int, int]) -> np.ndarray:
        (p, q) = self.degrees
        own = self.nets[(0, 0)][u[0] - p : u[1] + 1, v[0] - q : v[1] + 1].reshape(-1, 4)
        least, points = own[:, 3].min(), own[:, :3] / own[:, 3:]
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        s = np.abs(points - middle).max(axis=0)
        size: dict[tuple[int, int], np.ndarray] = {}
        for (k, l), net in self.nets.items():
            part = net[u[0] - p : u[1] + 1 - k, v[0] - q : v[1] + 1 - l].reshape(-1, 4)
            moved = part[:, :3] - part[:, 3:] * middle
            both = np.concatenate([moved, part[:, 3:]], axis=1)
            size[(k, l)] = np.abs(both).max(axis=0) if len(both) else np.zeros(4)
        a = {order: value[:3] for order, value in size.items()}
        w = {order: float(value[3]) for order, value in size.items()}
        s_u = (a[(1, 0)] + w[(1, 0)] * s) / least
        s_v = (a[(0, 1)] + w[(0, 1)] * s) / least
        s_uu = (a[(2, 0)] + 2.0 * w[(1, 0)] * s_u + w[(2, 0)] * s) / least
        s_vv = (a[(0, 2)] + 2.0 * w[(0, 1)] * s_v + w[(0, 2)] * s) / least
        s_uv = (a[(1, 1)] + w[(1, 0)] * s_v + w[(0, 1)] * s_u + w[(1, 1)] * s) / least
        return np.stack([s_uu, s_uv, s_vv])


def is_smooth(surface: BSplineSurface) -> bool:
    """Has it one tangent plane everywhere: no knot within it as often as its degree?"""
    for knots, degree in zip((surface.knots_u, surface.knots_v), surface.degrees):
        inner = knots[(knots > knots[degree]) & (knots < knots[-1 - degree])]
        if len(inner) and np.unique(inner, return_counts=True)[1].max() >= degree:
            return False
    return True
