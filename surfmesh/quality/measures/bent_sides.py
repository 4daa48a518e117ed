"""Triangles whose sides are straight in the plane that was meshed, and far from straight in (u, v).

There each stands for the piece between its bent sides: what is straight in (u, v) between the same
corners lies elsewhere on the surface, and may even be turned over. So such triangles are cut, in
the plane, into small ones that are taken as straight in (u, v); two that share a side cut it at the
same places. Where the other one is not cut, what lies between its straight side and the broken one
is counted with the one that is.

        o           n = 2: four triangles; and a whole
       / \\          box, cut likewise, for a triangle
      o---o         beside a pole, where others were
     / \\ / \\        dropped
    o---o---o
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface

PARTS = 8
"""Of a side of a triangle that is cut."""

BENT = 0.1
"""Of the length of a side: farther apart than that the middles of both are not the same."""


class BentPieces(NamedTuple):
    """Triangles of (u, v), each a part of what one triangle of the mesh stands for."""

    uv: NDArray[np.float64]  # (q, 3, 2)
    owner: NDArray[np.int64]  # (q,) row of the triangles that were given


def are_bent(surface: Surface, chart: Chart, uv: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(k, 3) sides of triangles uv (k, 3, 2), side i from corner i, that are bent."""
    ends = uv, np.roll(uv, -1, axis=1)
    first, last = (end.reshape(-1, 2) for end in ends)
    straight = 0.5 * (first + last)
    bent = chart.to_uv(0.5 * (chart.to_plane(first) + chart.to_plane(last)))
    places = np.concatenate([straight, bent, first, last])
    one, other, a, b = np.split(surface.evaluate(places, 0)[0], 4)
    apart = np.linalg.norm(one - other, axis=1)
    return (apart > BENT * np.linalg.norm(b - a, axis=1)).reshape(-1, 3)


def cut_in_plane(
    chart: Chart, uv: NDArray[np.float64], whole: NDArray[np.bool_], alone: NDArray[np.bool_]
) -> BentPieces:
    """Triangles uv (k, 3, 2) cut along sides that are straight in the plane.

    whole: (k,) of which all of the box in the plane counts. alone: (k, 3) sides that the triangle
    beyond has not cut.
    """
    corners = chart.to_plane(uv.reshape(-1, 2)).reshape(-1, 3, 2)
    weights, rows = _cut_triangle()
    square, rows_of_square = _cut_box()
    found, owner = [], []
    for own, own_rows in ((np.flatnonzero(~whole), rows), (np.flatnonzero(whole), rows_of_square)):
        at = corners[own]
        if own_rows is rows:
            places = np.einsum("ij,kjd->kid", weights, at)
        else:
            places = at.min(axis=1)[:, None] + square * np.ptp(at, axis=1)[:, None]
        found.append(_to_uv(chart, places)[:, own_rows].reshape(-1, 3, 2))
        owner.append(np.repeat(own, len(own_rows)))
    for side in range(3):
        own = np.flatnonzero(alone[:, side] & ~whole)
        slivers = _beside_side(chart, corners[own, side], corners[own, (side + 1) % 3])
        found.append(slivers.reshape(-1, 3, 2))
        owner.append(np.repeat(own, slivers.shape[1]))
    return BentPieces(np.concatenate(found), np.concatenate(owner))


def _beside_side(chart: Chart, first: NDArray, last: NDArray) -> NDArray[np.float64]:
    """(k, p, 3, 2) between broken sides and straight ones: a fan from the first corner."""
    t = np.arange(PARTS + 1)[:, None] / PARTS
    uv = _to_uv(chart, first[:, None] + t * (last - first)[:, None])
    steps = [uv[:, [0, i, j]] for i, j in pairwise(range(1, PARTS + 1))]
    return np.stack(steps, axis=1)


def _to_uv(chart: Chart, xy: NDArray) -> NDArray[np.float64]:
    return chart.to_uv(xy.reshape(-1, 2)).reshape(xy.shape)


def _cut_triangle() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Barycentric places (p, 3) and the triangles (PARTS^2, 3) between them."""
    number: dict[tuple[int, int], int] = {}
    for i in range(PARTS + 1):
        for j in range(PARTS + 1 - i):
            number[i, j] = len(number)
    rows = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in number if i + j < PARTS]
    rows += [
        (number[i + 1, j], number[i + 1, j + 1], number[i, j + 1])
        for i, j in number
        if i + j < PARTS - 1
    ]
    ij = np.array(list(number), float) / PARTS
    return np.column_stack([1.0 - ij.sum(axis=1), ij]), np.array(rows)


def _cut_box() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Places (p, 2) of the unit square and the triangles (2 PARTS^2, 3) between them."""
    i, j = np.divmod(np.arange(PARTS * PARTS), PARTS)
    a = i * (PARTS + 1) + j
    b, c, d = a + PARTS + 1, a + PARTS + 2, a + 1
    k, m = np.divmod(np.arange((PARTS + 1) ** 2), PARTS + 1)
    rows = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return np.column_stack([k, m]) / PARTS, rows
