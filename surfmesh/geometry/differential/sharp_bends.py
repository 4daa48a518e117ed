"""Where a surface itself turns over: at a cusp, a crease, a swallowtail, a tube of no width.

There r_u x r_v vanishes or changes its sense, and any triangles about it are turned against
the normals at one of their corners, however small they are.

    n  n  n              Between two samples whose normals differ most the search goes on by
    |  |  |   _ n        halves, until the turn is spread out, or the radius it is made with,
    o--o--o--o _         |pq| / angle, is known to be less than the one that is asked about.
             p`o-- n
"""

import math

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface

INSIDE = 1e-3
"""Samples are taken so far inside a triangle, as a fraction of the way to the centroid: at a pole
there is no normal, and at a crease one for each side."""

SIDES = 4
HALVES = 14
TURN = math.radians(20.0)
"""Between neighbouring samples; what turns by less is followed by triangles."""

_STEPS = [(i, j) for i in range(SIDES + 1) for j in range(SIDES + 1 - i)]
_GRID = np.array([(i, j, SIDES - i - j) for i, j in _STEPS]) / SIDES
_NEIGHBOURS = np.array(
    [
        (_STEPS.index((i, j)), _STEPS.index((i + di, j + dj)))
        for i, j in _STEPS
        for di, dj in ((1, 0), (0, 1), (1, -1))
        if (i + di, j + dj) in _STEPS
    ]
)


def bends_sharply(surface: Surface, triangles: np.ndarray, radius: float) -> np.ndarray:
    """Does the surface bend with less than ``radius`` within triangles (k, 3, 2) of (u, v)? (k,).

    radius: model units. Bends are found where the curvature of a sample shows them, or where
    the normals of two samples differ.
    """
    if not len(triangles):
        return np.zeros(0, bool)
    weights = _GRID + INSIDE * (1.0 / 3.0 - _GRID)
    uv = np.einsum("pk,nkj->npj", weights, triangles)
    point, normal, sharp = _looked_at(surface, uv, radius)
    found = sharp.any(axis=1)
    a, b = _NEIGHBOURS.T
    turn = _angles(normal[:, a], normal[:, b])
    row, worst = np.arange(len(turn)), turn.argmax(axis=1)
    ends = [(array[row, a[worst]], array[row, b[worst]]) for array in (uv, point, normal)]
    (p, q), (rp, rq), (n, m) = (np.array(pair) for pair in ends)
    found |= _made_within(radius, rp, rq, turn[row, worst])
    for _ in range(HALVES):
        left = np.flatnonzero(~found & (_angles(n, m) > TURN))
        if not len(left):
            break
        middle = 0.5 * (p[left] + q[left])
        r, between, sharp = _looked_at(surface, middle[:, None], radius)
        r, between = r[:, 0], between[:, 0]
        first, second = _angles(n[left], between), _angles(between, m[left])
        nearer = (first >= second)[:, None]
        q[left] = np.where(nearer, middle, q[left])
        rq[left], m[left] = np.where(nearer, r, rq[left]), np.where(nearer, between, m[left])
        p[left] = np.where(nearer, p[left], middle)
        rp[left], n[left] = np.where(nearer, rp[left], r), np.where(nearer, n[left], between)
        turned = np.maximum(first, second)
        found[left] = sharp[:, 0] | _made_within(radius, rp[left], rq[left], turned)
    return found


def _looked_at(
    surface: Surface, uv: np.ndarray, radius: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n, p, 3) and unit normals (n, p, 3) at uv (n, p, 2); is it bent sharply? (n, p)."""
    r, *rates = surface.evaluate(uv.reshape(-1, 2), 2)
    forms = forms_from_derivatives(*rates)
    k = curvatures(forms)
    sharp = forms.degenerate | (np.maximum(np.abs(k.k1), np.abs(k.k2)) * radius > 1.0)
    shape = (*uv.shape[:2], 3)
    return r.reshape(shape), forms.normal.reshape(shape), sharp.reshape(uv.shape[:2])


def _angles(n: np.ndarray, m: np.ndarray) -> np.ndarray:
    return np.arccos(np.clip((n * m).sum(axis=-1), -1.0, 1.0))


def _made_within(radius: float, p: np.ndarray, q: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Is ``turn`` (k,) made between points (k, 3) on a circle of less than ``radius``?"""
    return (turn > TURN) & (np.linalg.norm(q - p, axis=-1) < radius * turn)
