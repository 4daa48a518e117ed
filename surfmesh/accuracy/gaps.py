"""Gaps of (u, v) between triangles at a pole: neighbours have other parameters of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import proof
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.geometry.surface import Surface

SAME = 1e-9
"""Of a side: the curves over it of two neighbours are the same, as at a seam."""


NEARLY = 1e-3
"""Of a side: these curves differ by a sliver, as those of two faces of a model do."""


class Gaps(NamedTuple):
    """Triangles of (u, v) that are none in space, between neighbours at a pole."""

    uv: NDArray[np.float64]  # (g, 3, 2)
    owners: NDArray[np.int32]  # (g,) ascending
    beside: NDArray[np.int32]  # (k,) triangles on either side of one
    unknown: NDArray[np.intp]  # triangles whose neighbours do not go on where they end
    loose: NDArray[np.int32]  # half-edges over which those of two neighbours nearly agree


def gaps_of(surface: Surface, face: FaceTriangles) -> Gaps:
    """Where the parameters of neighbours differ along their side, and not only by a seam."""
    first = proof.parted_half_edges(face.uv, face.twins)
    a, b = _sides(face, first), _sides(face, face.twins[first])
    vertex = face.vertices.reshape(-1)
    against = vertex[first] != vertex[face.twins[first]]
    b[against] = b[against, ::-1]
    odd = np.flatnonzero((a != b).any(axis=(1, 2)))
    none = np.empty(0, np.int32)
    loose = none
    if len(odd):
        apart = _apart(surface, a[odd], b[odd])
        is_loose = (apart > SAME) & (apart <= NEARLY)
        loose = np.concatenate([first[odd[is_loose]], face.twins[first[odd[is_loose]]]])
        odd = odd[~(apart <= NEARLY)]
    if not len(odd):
        return Gaps(np.empty((0, 3, 2)), none, none, np.empty(0, np.intp), loose)
    first, a, b = first[odd], a[odd], b[odd]
    fixed = np.where(_is_pole(surface, a, b, 0), 1, 0)
    row = np.arange(len(odd))
    shift = a[row, fixed] - b[row, fixed]  # a seam that ends at the pole
    uv = np.stack([a[row, fixed], a[row, 1 - fixed], b[row, 1 - fixed] + shift], axis=1)
    good = _is_pole(surface, a, b, 1 - fixed) & _goes_on(surface, uv, shift)
    beside = np.stack([first, face.twins[first]])[:, good] // 3
    owners = beside.min(axis=0)
    order = np.argsort(owners, kind="stable")
    unknown = np.unique(np.concatenate([first[~good], face.twins[first[~good]]]) // 3)
    return Gaps(
        np.ascontiguousarray(uv[good][order]), owners[order].astype(np.int32),
        np.unique(beside), unknown, loose,
    )  # fmt: skip


def _sides(face: FaceTriangles, half_edges: NDArray[np.int32]) -> NDArray[np.float64]:
    """(k, 2, 2) parameters of the ends of half-edges."""
    triangle, side = half_edges // 3, half_edges % 3
    return np.stack([face.uv[triangle, side], face.uv[triangle, (side + 1) % 3]], axis=1)


def _points(surface: Surface, *uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, k, 3) points of the surface at n times (k, 2) places."""
    (points,) = surface.evaluate(np.concatenate(uv), 0)
    return points.reshape(len(uv), -1, 3)


def _distances(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(a - b, axis=-1))


def _is_pole(
    surface: Surface, a: NDArray[np.float64], b: NDArray[np.float64], end: NDArray[np.intp] | int
) -> NDArray[np.bool_]:
    """(k,) are ends a and b (k, 2, 2) there one point, as is what lies between them?"""
    rows = np.arange(len(a))
    one, other = a[rows, end], b[rows, end]
    between = [(1.0 - t) * one + t * other for t in (0.25, 0.5, 0.75, 1.0)]
    start, finish, first, *rest = _points(surface, a[:, 0], a[:, 1], one, *between)
    apart = _distances(np.stack(rest), first).max(axis=0)
    return (apart <= SAME * _distances(finish, start)) & (one != other).any(axis=1)


def _goes_on(
    surface: Surface, uv: NDArray[np.float64], shift: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(k,) is the surface the same over triangles uv (k, 3, 2) and ``shift`` (k, 2) away?"""
    middle = uv.mean(axis=1)
    here, there, start, end = _points(surface, middle, middle - shift, uv[:, 0], uv[:, 1])
    return _distances(here, there) <= SAME * _distances(end, start)


def _apart(surface: Surface, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) how far two straight lines of (u, v), ends a and b (k, 2, 2), are apart, of a side."""
    lines = [(1.0 - t) * x[:, 0] + t * x[:, 1] for x in (a, b) for t in (0.25, 0.5, 0.75)]
    start, end, *rest = _points(surface, a[:, 0], a[:, 1], *lines)
    apart = _distances(np.stack(rest[:3]), np.stack(rest[3:])).max(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(apart > 0.0, apart / _distances(end, start), 0.0)
