"""Quadratic triangles as flat ones: what is drawn, and what is looked at for self-intersection.

    2                 every side in four, its points computed once for all its triangles: they are
   8-7                the same to the last bit
  9-*-6     *, *, *: three points within
 10-*-*-5
0-11-3-4-1
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.curved_triangles import points_on
from surfmesh.geometry.small_matrices import product
from surfmesh.result.surface_mesh import SurfaceMesh

PARTS = 4  # of a side


class Facets(NamedTuple):
    """Flat triangles, ``PARTS**2`` of each curved one, one after the other."""

    points: NDArray[np.float64]  # (n, 3): those of the mesh, along its edges, within its triangles
    triangles: NDArray[np.int32]  # (k, 3)
    parent: NDArray[np.int32]  # (k,) the triangle of the mesh

    def interpolated(self, mesh: SurfaceMesh, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) at the points, linear in the triangles of the mesh; values: at its points."""
        first, second = values[mesh.edges].T
        parts = np.arange(1, PARTS) / PARTS
        along = first[:, None] * (1.0 - parts) + second[:, None] * parts
        within = product(values[mesh.triangles], _inner_weights().T)
        return np.concatenate([values, along.ravel(), within.ravel()])


def facets(mesh: SurfaceMesh) -> Facets:
    """Of a mesh of second order, on its curved triangles."""
    assert mesh.mid_points is not None  # noqa: S101  for mypy: the caller has looked
    count, edges = len(mesh.points), mesh.edges
    ends, middle = mesh.points[edges], mesh.mid_points
    along = []
    for part in range(1, PARTS):
        s = part / PARTS
        here = (1 - s) * (1 - 2 * s) * ends[:, 0] + s * (2 * s - 1) * ends[:, 1]
        along.append(here + 4 * s * (1 - s) * middle)
    grid = [(i, j) for j in range(PARTS + 1) for i in range(PARTS + 1 - j)]
    within = points_on(mesh.nodes[mesh.elements], _inner_weights())
    points = np.concatenate([mesh.points, np.stack(along, axis=1).reshape(-1, 3),
                             within.reshape(-1, 3)])  # fmt: skip
    numbers = _numbers(mesh, grid, count)
    rows = {place: k for k, place in enumerate(grid)}
    pattern = [[rows[place] for place in corners] for corners in _pattern(PARTS)]
    triangles = numbers[:, np.array(pattern)].reshape(-1, 3)
    parent = np.repeat(np.arange(len(mesh.triangles), dtype=np.int32), len(pattern))
    return Facets(points, triangles.astype(np.int32), parent)


def corner_weights(parts: int) -> NDArray[np.float64]:
    """(parts**2, 3, 3) weights of the corners of a triangle at those of its flat ones."""
    return np.array([[(parts - i - j, i, j) for i, j in one] for one in _pattern(parts)]) / parts


def _pattern(parts: int) -> list[list[tuple[int, int]]]:
    """The flat triangles of one, by steps of their corners towards its corners 1 and 2."""
    places = [(i, j) for j in range(parts) for i in range(parts - j)]
    up = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in places]
    down = [
        [(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in places if i + j < parts - 1
    ]  # fmt: skip
    return up + down


def _inner() -> list[tuple[int, int]]:
    """Steps towards corners 1 and 2 of the points within a triangle."""
    steps = range(1, PARTS)
    return [(i, j) for j in steps for i in steps if i + j < PARTS]


def _inner_weights() -> NDArray[np.float64]:
    return np.array([(PARTS - i - j, i, j) for i, j in _inner()]) / PARTS


def _numbers(mesh: SurfaceMesh, grid: list[tuple[int, int]], count: int) -> NDArray[np.int64]:
    """(m, g) points at the places of the grid over each triangle: i steps towards corner 1, j
    towards corner 2."""
    corners = mesh.triangles.astype(np.int64)
    edge = mesh.elements[:, 3:].astype(np.int64) - count
    forward = corners == mesh.edges[edge][:, :, 0]  # does its side run as the edge does?
    first_inner = count + (PARTS - 1) * len(mesh.edges)
    inner, found = _inner(), np.empty((len(corners), len(grid)), np.int64)
    for k, (i, j) in enumerate(grid):
        weights = (PARTS - i - j, i, j)
        if PARTS in weights:
            found[:, k] = corners[:, weights.index(PARTS)]
        elif 0 in weights:
            side = (weights.index(0) + 1) % 3  # the side opposite to that corner
            step = weights[(side + 1) % 3]
            place = np.where(forward[:, side], step, PARTS - step)
            found[:, k] = count + (PARTS - 1) * edge[:, side] + place - 1
        else:
            row = inner.index((i, j)) + len(inner) * np.arange(len(corners))
            found[:, k] = first_inner + row
    return found
