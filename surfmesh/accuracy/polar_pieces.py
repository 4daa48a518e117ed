"""How triangles at a pole move to the surface: along rays, which neighbours have in common.

The pieces of ``proof`` are triangles of (u, v), whose sides to the pole differ from those of their
neighbours. Rays do not: the piece of a triangle lies between the pole and the curve over the side
opposite to it (src/proof/polar_pieces.hpp). All triangles at a pole have such pieces, or none.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.proof import polar_moves
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.accuracy.gaps import Gaps, gaps_of
from surfmesh.accuracy.proof import FaceProof
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

ALL_ROUND = 1e-9
"""Of the domain: what the triangles at a pole may leave of the side that is the pole."""


class Pole(NamedTuple):
    """A vertex, and the side of the domain that is there: where u, or v, has a value."""

    vertex: int
    is_v: bool
    value: float


def joined_at_poles(surface: Surface, face: FaceTriangles, found: FaceProof) -> FaceProof:
    """Slopes and distances with triangles at poles moved along rays, where they all can be."""
    gaps = gaps_of(surface, face)
    if found.bends is None or len(gaps.unknown) or len(gaps.loose):
        return found
    away, slope = found.away.copy(), found.slope.copy()
    for pole in poles(face, gaps):
        rows, corner = np.nonzero(face.vertices == pole.vertex)
        base = _bases(face, found.bends, rows, corner)
        if not _is_all_round(surface, face, pole, rows, corner):
            return found
        order = (corner[:, None] + np.arange(3)) % 3
        corners = np.ascontiguousarray(face.corners[rows[:, None], order])
        moves = polar_moves(as_core_surface(surface), corners, base, pole.is_v, pole.value)
        if moves is None:
            return found
        slope[rows], away[rows] = moves.T
    return found._replace(away=away, slope=slope, is_joined=True)


def poles(face: FaceTriangles, gaps: Gaps) -> list[Pole]:
    """Of all gaps, each once."""
    at_pole = (face.uv[gaps.owners] == gaps.uv[:, None, 1]).all(axis=2)
    vertex = face.vertices[gaps.owners, at_pole.argmax(axis=1)].tolist()
    is_v = gaps.uv[:, 1, 1] == gaps.uv[:, 2, 1]
    value = np.where(is_v, gaps.uv[:, 1, 1], gaps.uv[:, 1, 0])
    return sorted(set(map(Pole, vertex, is_v.tolist(), value.tolist())))


def _bases(
    face: FaceTriangles, bends: NDArray[np.float64], rows: NDArray[np.intp],
    corner: NDArray[np.intp],
) -> NDArray[np.float64]:  # fmt: skip
    """(k, 3, 2) Bezier points of the curves over the sides opposite to ``corner``."""
    first, last = (corner + 1) % 3, (corner + 2) % 3
    start, end = face.uv[rows, first], face.uv[rows, last]
    control = 0.5 * (start + end) + 2.0 * bends[rows, first]
    return np.ascontiguousarray(np.stack([start, control, end], axis=1))


def _is_all_round(
    surface: Surface, face: FaceTriangles, pole: Pole, rows: NDArray[np.intp],
    corner: NDArray[np.intp],
) -> bool:  # fmt: skip
    """Do the pieces of the triangles lie over all of the side that is the pole, once?

    They have to run round it as all triangles of the face do in (u, v).
    """
    around, across = (0, 1) if pole.is_v else (1, 0)
    low, high = surface.domain[around]
    if pole.value not in surface.domain[across] or len(np.unique(rows)) < len(rows):
        return False
    if (face.uv[rows, corner, across] != pole.value).any():
        return False
    start, end = face.uv[rows, (corner + 1) % 3], face.uv[rows, (corner + 2) % 3]
    step = end[:, around] - start[:, around]
    turn = step * (start[:, across] - pole.value) * (-1.0 if pole.is_v else 1.0)
    is_whole = abs(np.abs(step).sum() - (high - low)) <= ALL_ROUND * (high - low)
    return bool(is_whole and (turn * _turn(face.uv[0]) > 0.0).all())


def _turn(uv: NDArray[np.float64]) -> float:
    """Of a triangle (3, 2): twice its area, less than 0 clockwise."""
    (a, b), (c, d) = uv[1] - uv[0], uv[2] - uv[0]
    return float(a * d - b * c)
