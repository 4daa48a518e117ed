"""The triangles of one face, with their parameters, and which half-edges are opposite."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class FaceTriangles(NamedTuple):
    """The triangles of one face. Half-edge 3 t + k runs from corner k of triangle t to k + 1."""

    corners: NDArray[np.float64]  # (m, 3, 3)
    uv: NDArray[np.float64]  # (m, 3, 2)
    vertices: NDArray[np.int32]  # (m, 3), of the face alone: less than 3 m
    twins: NDArray[np.int32]  # (3 m,) the opposite half-edge within the face, -1 at its rims


def twins_of(
    half_edges: NDArray[np.int32], uses: NDArray[np.int32], count: int
) -> NDArray[np.int32]:
    """(3 count,) the opposite half-edge of each where two triangles share an edge, else -1."""
    twins = np.full(3 * count, -1, np.int32)
    first, second = half_edges.compress(uses == 2, axis=0).T
    twins[first], twins[second] = second, first
    return twins
