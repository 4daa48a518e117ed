"""Which tetrahedra lie in which solid: a flood that the triangles of the surface stop.

The side of a tetrahedron is number 4 t + s; a triangle of the surface that is such a side, seen
counter-clockwise from outside the tetrahedron, has it behind; seen clockwise, before.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfmesh.errors import MeshingError

CORNERS = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
"""Corners of the sides S1 .. S4, counter-clockwise from outside a positive tetrahedron."""


def positive(points: NDArray, tetrahedra: NDArray) -> NDArray:
    """Tetrahedra with two corners exchanged where they are turned."""
    a, b, c, d = (points[corner] for corner in tetrahedra.T)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0.0
    return np.where(turned[:, None], tetrahedra[:, [0, 2, 1, 3]], tetrahedra)


def sides_of_triangles(
    tetrahedra: NDArray, triangles: NDArray
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(m,) the sides behind and before each triangle, -1 where there is none."""
    sides = tetrahedra[:, CORNERS].reshape(-1, 3)
    of_side, turned = _keys(sides)
    wanted, wanted_turned = _keys(triangles)
    order = np.lexsort((turned, *of_side.T[::-1]))
    table = np.column_stack((of_side, turned))[order]
    return tuple(
        _found(table, np.column_stack((wanted, wanted_turned ^ other)), order) for other in (0, 1)
    )  # type: ignore[return-value]


def _keys(rows: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The numbers of each row, ascending, and 1 where that reverses the sense of rotation."""
    order = np.argsort(rows, axis=1, kind="stable")
    first = order[:, 0]
    turned = (order[:, 1] != (first + 1) % 3).astype(np.int64)
    return np.take_along_axis(rows, order, axis=1).astype(np.int64), turned


def _found(table: NDArray[np.int64], wanted: NDArray[np.int64], order: NDArray) -> NDArray:
    """Where the rows ``wanted`` stand in the sorted ``table``, by ``order``; -1: nowhere."""
    width = int(max(table.max(initial=0), wanted.max(initial=0))) + 1
    both = np.concatenate((table, wanted))
    _, inverse = np.unique(both[:, 0] * width + both[:, 1], return_inverse=True)
    keys = (inverse.reshape(-1) * width + both[:, 2]) * 2 + both[:, 3]
    known, asked = keys[: len(table)], keys[len(table) :]
    at = np.minimum(np.searchsorted(known, asked), max(len(known) - 1, 0))
    hit = known[at] == asked if len(known) else np.zeros(len(asked), bool)
    return np.where(hit, order[at] if len(known) else -1, -1)


def solids_of_tetrahedra(
    tetrahedra: NDArray, triangles: NDArray, solid_ids: NDArray
) -> NDArray[np.int32]:
    """(k,) the solid in which each tetrahedron lies, -1: in none.

    solid_ids: (m, 2) the solids behind and before each triangle. Raises ``MeshingError`` where a
    triangle is no side of a tetrahedron, and where two solids claim one region.
    """
    behind, before = sides_of_triangles(tetrahedra, triangles)
    lost = int(((solid_ids[:, 0] >= 0) & (behind < 0)).sum())
    lost += int(((solid_ids[:, 1] >= 0) & (before < 0)).sum())
    if lost:
        raise MeshingError(f"{lost} triangles of the surface are no sides of tetrahedra")
    region = _regions(tetrahedra, np.concatenate((behind, before)))
    found = np.full(int(region.max(initial=-1)) + 1, -2, np.int64)
    for sides, solids in ((behind, solid_ids[:, 0]), (before, solid_ids[:, 1])):
        there = sides >= 0
        of = region[sides[there] // 4]
        seen = found[of]
        if ((seen != -2) & (seen != solids[there])).any():
            raise MeshingError("two solids lie in one region: the surface has a gap")
        found[of] = solids[there]
        if (found[of] != solids[there]).any():
            raise MeshingError("two solids lie in one region: the surface has a gap")
    return np.where(found < 0, -1, found)[region].astype(np.int32)


def _regions(tetrahedra: NDArray, stops: NDArray[np.int64]) -> NDArray[np.int32]:
    """(k,) numbers of the parts that the sides ``stops`` leave connected."""
    keys, _ = _keys(tetrahedra[:, CORNERS].reshape(-1, 3))
    order = np.lexsort(keys.T[::-1])
    same = (keys[order][1:] == keys[order][:-1]).all(axis=1)
    stopped = np.zeros(len(keys), bool)
    stopped[stops[stops >= 0]] = True
    a, b = order[:-1][same], order[1:][same]
    open_ = ~(stopped[a] | stopped[b])
    a, b = a[open_] // 4, b[open_] // 4
    k = len(tetrahedra)
    graph = coo_array((np.ones(len(a), np.int8), (a, b)), shape=(k, k))
    return connected_components(graph, directed=False)[1]
