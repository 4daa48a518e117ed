"""A face with some of its triangles cut, in (u, v) and onto the surface: a step on the way to it.

Where pieces change too fast for their triangles, as round a pole with few of them, mesh and surface
are compared by way of a finer mesh: from the mesh, cut in its own planes, to the finer one points
move linearly, and from there pieces change less.

          c                    c
        .' `.                .'|`.        m: amid a b
       a-----b     ->       a--m--b       m': the nearest point of the surface

Sides that end in a pole stay whole, and those at rims of the mesh; what is amid a side of two
faces is said by both (``joined_faces``).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.triangulation import first_not_ccw
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.accuracy.gaps import gaps_of
from surfmesh.accuracy.joined_faces import FaceMoves, SharedMiddles
from surfmesh.accuracy.polar_pieces import Pole, poles
from surfmesh.accuracy.projected_pieces import nearest
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.surface import Surface

ROUNDING = 1e-9
"""More than lengths and directions of triangles of any use are off."""


STEPS = 20
"""Of Newton's method towards the nearest point."""


class FinerFace(NamedTuple):
    """A face cut further: its new vertices in the planes of triangles, and moved."""

    surface: Surface
    face: FaceTriangles  # with vertices moved
    numbers: NDArray[np.int64]  # of its vertices, among those of the whole mesh
    flat: NDArray[np.float64]  # (k, 3) new vertices, amid sides
    moved: NDArray[np.float64]  # (k, 3) the same on the surface


def unmoved(moves: FaceMoves) -> FinerFace:
    """A face that stays as it is."""
    none = np.empty((0, 3))
    return FinerFace(moves.surface, moves.face, moves.numbers, none, none)


def cut_around(
    moves: FaceMoves, points: NDArray[np.float64], is_bent: NDArray[np.bool_],
    shared: SharedMiddles, count: int,
) -> FinerFace | None:  # fmt: skip
    """With all sides of triangles at vertices that are bent cut, that can be; None without any.

    points: of all vertices, those of ``shared`` with them, on the surface; is_bent: of the first of
    them; count: how many there are with those of other faces.
    """
    surface, face, numbers, _ = moves
    own = is_bent[numbers]
    ends = poles(face, gaps_of(surface, face)) if own.any() else []
    sides = _sides_to_cut(face, ends, own)
    if not len(sides) and not len(shared.numbers):
        return None
    a, b = (numbers[face.vertices[sides // 3, (sides % 3 + k) % 3]] for k in (0, 1))
    flat = 0.5 * (points[a] + points[b])
    middle, moved = _middles(moves, sides, flat)
    middle.reshape(-1, 2)[shared.half_edges] = shared.uv
    number = np.full(face.twins.shape, -1, np.int32)
    first = len(numbers) + len(shared.numbers)
    number[shared.half_edges] = len(numbers) + np.arange(len(shared.numbers))
    number[sides] = number[face.twins[sides]] = first + np.arange(len(sides))
    rows, cut = _cut(number.reshape(-1, 3) >= 0)
    six = np.concatenate([face.vertices, number.reshape(-1, 3)], axis=1)
    triangles = np.ascontiguousarray(six[rows[:, None], cut], np.int32)
    uv = np.ascontiguousarray(np.concatenate([face.uv, middle], axis=1)[rows[:, None], cut])
    for pole in ends:
        _place_amid(uv, triangles, pole)
    if not _run_alike(uv):
        return None
    known = np.concatenate([numbers, shared.numbers])
    corners = np.concatenate([points[known], moved])[triangles]
    finer = FaceTriangles(np.ascontiguousarray(corners), uv, triangles, _twins(triangles))
    numbers = np.concatenate([known, count + np.arange(len(sides))])
    return FinerFace(surface, finer, numbers, flat, moved)


def _middles(
    moves: FaceMoves, sides: NDArray[np.intp], flat: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(m, 3, 2) parameters amid sides, and (k, 3) the points there; nearest to ``flat`` (k, 3).

    Sides whose parameters differ on their two sides, as at a seam, keep their middle in (u, v).
    """
    surface, face, _, found = moves
    middle = (0.5 * (face.uv + face.uv[:, (1, 2, 0)])).reshape(-1, 2)
    own, twin = middle[sides], middle[face.twins[sides]]
    is_one = (own == twin).all(axis=1)
    own[is_one] = closest_point(surface, flat[is_one], own[is_one], STEPS, 0.0)[0]
    middle[sides[is_one]] = middle[face.twins[sides[is_one]]] = own[is_one]
    points = nearest(surface, flat) if found.bends is None else None
    if points is None:
        (points,) = surface.evaluate(np.ascontiguousarray(own), 0)
    return middle.reshape(-1, 3, 2), points


def _place_amid(uv: NDArray[np.float64], triangles: NDArray[np.int32], pole: Pole) -> None:
    """Corners there lie amid the opposite side, along the side of the domain that is the pole."""
    rows, corner = np.nonzero(triangles == pole.vertex)
    around = 0 if pole.is_v else 1
    a, b = uv[rows, (corner + 1) % 3, around], uv[rows, (corner + 2) % 3, around]
    uv[rows, corner, around] = 0.5 * (a + b)


def _run_alike(uv: NDArray[np.float64]) -> bool:
    """Do triangles (m, 3, 2) all run counter-clockwise, as those of a face do? Exactly."""
    corners = np.arange(3 * len(uv)).reshape(-1, 3)
    return first_not_ccw(uv.reshape(-1, 2), corners) < 0


def _sides_to_cut(
    face: FaceTriangles, ends: list[Pole], is_bent: NDArray[np.bool_]
) -> NDArray[np.intp]:
    """Half-edges, one a side."""
    is_pole = np.zeros(len(is_bent), bool)
    is_pole[[pole.vertex for pole in ends]] = True
    wanted = np.repeat(is_bent[face.vertices].any(axis=1), 3)
    ends_in_pole = (is_pole[face.vertices] | is_pole[face.vertices[:, (1, 2, 0)]]).ravel()
    inner = np.flatnonzero((face.twins >= 0) & ~ends_in_pole)
    inner = inner[wanted[inner] | wanted[face.twins[inner]]]
    return inner[inner < face.twins[inner]]


def _patterns() -> list[list[tuple[int, int, int]]]:
    """By the bits of sides with a middle, 3, 4, 5: triangles, the way round of the old one."""
    found = []
    for bits in range(8):
        marked = [k for k in range(3) if bits >> k & 1]
        if not marked:
            found.append([(0, 1, 2)])
        elif len(marked) == 1:
            (k,) = marked
            a, b, c = k, (k + 1) % 3, (k + 2) % 3
            found.append([(a, 3 + k, c), (3 + k, b, c)])
        elif len(marked) == 2:
            (whole,) = {0, 1, 2} - {*marked}
            c, a, b = whole, (whole + 1) % 3, (whole + 2) % 3
            found.append([(3 + a, b, 3 + b), (a, 3 + a, 3 + b), (a, 3 + b, c)])
        else:
            found.append([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])
    return found


PATTERNS = _patterns()


def _cut(is_marked: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """(k,) rows, (k, 3) which of their corners 0, 1, 2 and middles 3, 4, 5 new triangles have."""
    bits = is_marked @ np.array([1, 2, 4])
    rows, corners = [], []
    for pattern, triangles in enumerate(PATTERNS):
        some = np.flatnonzero(bits == pattern)
        rows.append(np.repeat(some, len(triangles)))
        corners.append(np.tile(np.array(triangles), (len(some), 1)))
    return np.concatenate(rows), np.concatenate(corners)


def _twins(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """(3 m,) the opposite half-edge of each, -1 where an edge has not two."""
    ends = np.stack([triangles, triangles[:, (1, 2, 0)]], axis=2).reshape(-1, 2).astype(np.int64)
    key = ends.min(axis=1) * (int(triangles.max()) + 1) + ends.max(axis=1)
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    pairs = starts[np.diff(starts, append=len(key)) == 2]
    twins = np.full(len(key), -1, np.int32)
    twins[order[pairs]], twins[order[pairs + 1]] = order[pairs + 1], order[pairs]
    return twins


def linear_moves(
    corners: NDArray[np.float64], move: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(m,) how far, and how fast, points of triangles (m, 3, 3) move whose corners do by ``move``.

    The derivative is the sum of move x n / height, n across the opposite side within the plane.
    """
    side = corners[:, (2, 0, 1)] - corners[:, (1, 2, 0)]  # opposite to each corner
    normal = np.cross(side[:, 0], side[:, 1])
    area = np.linalg.norm(normal, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        inwards = np.cross(normal[:, None], side) / (area * area)[:, None, None]
        gradient = np.einsum("mkd,mke->mde", move, inwards)
    slope = np.sqrt(np.einsum("mde,mde->m", gradient, gradient))
    away = np.sqrt((move * move).sum(axis=2)).max(axis=1)
    known = np.isfinite(slope)
    return away * (1.0 + ROUNDING), np.where(known, slope * (1.0 + ROUNDING) + ROUNDING, np.inf)
