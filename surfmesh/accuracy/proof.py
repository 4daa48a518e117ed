"""Proved bounds of the distance between triangles and their surface, both ways: one face at a time.

bounds over boxes -> of each triangle -> with its neighbours -> a closer look where that is too much
(by the surface)     height, shift        both ways              cells, and all triangles around

The work is done in the core (src/proof), with round-off in the bounds; docs/proof.md says what is
proved, and why. Here it is seen which sides are rims, and where a pole leaves a gap in (u, v).
Spheres, cylinders and cones have shorter bounds (``projected_pieces``).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import proof, surfaces
from surfmesh.accuracy.projected_pieces import projected
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

DEPTH = 3
"""How often a triangle is cut in four where its bounds are not good enough."""

LEVELS = 4
"""A closer look has up to 4^levels cells."""

SAME = 1e-9
"""Of a side: the curves over it of two neighbours are the same, as at a seam."""

WHOLE, CORNER, SLOPE = 8, 9, 26
"""Columns of the bounds: the distance point by point, how far corners are off, and how fast the
distance changes."""


class FaceTriangles(NamedTuple):
    """The triangles of one face. Half-edge 3 t + k runs from corner k of triangle t to k + 1."""

    corners: NDArray[np.float64]  # (m, 3, 3)
    uv: NDArray[np.float64]  # (m, 3, 2)
    vertices: NDArray[np.int32]  # (m, 3), of the face alone: less than 3 m
    twins: NDArray[np.int32]  # (3 m,) the opposite half-edge within the face, -1 at its rims


class FaceProof(NamedTuple):
    """What is proved of m triangles. Lengths in model units; infinite where nothing is."""

    bound: NDArray[np.float64]  # (m,) triangle and surface are within it, both ways
    away: NDArray[np.float64]  # (m,) |r - L|, point by point
    slope: NDArray[np.float64]  # (m,) the largest |(r' - L')(w)| for unit w
    is_joined: bool  # pieces of neighbours have the same curve over their side, everywhere


class Gaps(NamedTuple):
    """Triangles of (u, v) that are none in space, between neighbours at a pole."""

    uv: NDArray[np.float64]  # (g, 3, 2)
    owners: NDArray[np.int32]  # (g,) ascending
    beside: NDArray[np.int32]  # (k,) triangles on either side of one
    unknown: NDArray[np.intp]  # triangles whose neighbours do not go on where they end


def proved_distances(
    surface: Surface, face: FaceTriangles, limits: NDArray[np.float64], slope: float = np.inf
) -> FaceProof | None:
    """How far triangles and surface are from each other at most; None without bounds.

    limits: (m,) how near it is worth to look; slope: likewise, of how fast |r - L| changes.
    """
    moved = projected(surface, face.corners, face.uv, limits)
    if moved is not None:
        return FaceProof(moved.away, moved.away, moved.slope, True)
    core = as_core_surface(surface)
    rims = np.packbits(face.twins.reshape(-1, 3) < 0, axis=1, bitorder="little")[:, 0]
    bends, bounds = _bounds(core, face, limits, rims, slope)
    if bounds is None:
        return None
    gaps = _gaps(surface, face)
    away = bounds[:, WHOLE] + bounds[:, CORNER]
    changes = bounds[:, SLOPE].copy()
    is_joined = not len(gaps.owners) and not len(gaps.unknown)
    if len(gaps.unknown):
        bounds[gaps.unknown] = np.inf
    bound, _ = proof.ring_bounds(face.corners, face.vertices, face.twins, bounds)
    # a gap is none of the neighbours: with it point by point alone, or a closer look
    bound[gaps.beside] = away[gaps.beside]
    bound[gaps.owners] = np.inf
    which = np.flatnonzero(~(bound <= limits)).astype(np.int32)
    if not len(which):
        return FaceProof(bound, away, changes, is_joined)
    beside = proof.triangle_bounds(
        core, face.corners[gaps.owners], gaps.uv, np.zeros_like(gaps.uv), limits[gaps.owners],
        np.zeros(len(gaps.owners), np.uint8), DEPTH, False,
    )  # fmt: skip
    if beside is None:
        nothing = np.full(len(bound), np.inf)
        return FaceProof(nothing, nothing, nothing, is_joined)
    bound = proof.look_closer(
        core, face.corners, face.uv, bends, face.vertices, face.twins, bounds, which, limits,
        LEVELS, bound, gaps.uv, gaps.owners, beside,
    )  # fmt: skip
    return FaceProof(bound, away, changes, is_joined)


def proved_curved(
    surface: Surface, face: FaceTriangles, middles: NDArray[np.float64], limits: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """(m,) how far quadratic triangles and surface are from each other at most, point by point.

    middles: (m, 3, 3) nodes of sides 0, 1, 2. None without bounds; infinite where there is none.
    """
    core = as_core_surface(surface)
    corners, uv, vertices, twins = face
    bends = proof.curved_pieces(core, corners, uv, vertices, twins, middles)
    curved = middles - 0.5 * (corners + corners[:, (1, 2, 0)])
    rims = np.zeros(len(corners), np.uint8)
    bounds = proof.triangle_bounds(
        core, corners, uv, bends, limits, rims, DEPTH, curved=np.ascontiguousarray(curved)
    )
    if bounds is None:
        return None
    bound = bounds[:, WHOLE] + bounds[:, CORNER]
    gaps = _gaps(surface, face)
    bound[gaps.owners] = bound[gaps.unknown] = np.inf
    return bound


def _bounds(
    core: surfaces.Surface,
    face: FaceTriangles,
    limits: NDArray[np.float64],
    rims: NDArray[np.uint8],
    slope: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Bends of the pieces' sides (m, 3, 2), and what is proved of triangles with them.

    Where nothing is, as across a kink, pieces are straight: these are bounded by cells.
    """
    corners, uv, vertices, twins = face
    bends = proof.curved_pieces(core, corners, uv, vertices, twins)
    bounds = proof.triangle_bounds(core, corners, uv, bends, limits, rims, DEPTH, slope=slope)
    if bounds is None:
        return bends, None
    is_unknown = ~np.isfinite(bounds[:, WHOLE])
    while bends[is_unknown].any():
        bad = is_unknown.view(np.uint8)
        straight = proof.straightened(bends, corners, uv, vertices, twins, bad)
        rows = np.flatnonzero((straight != bends).any(axis=(1, 2)))
        bends = straight
        bounds[rows] = proof.triangle_bounds(
            core, corners[rows], uv[rows], bends[rows], limits[rows], rims[rows], DEPTH,
            slope=slope,
        )  # fmt: skip
        is_unknown = ~np.isfinite(bounds[:, WHOLE])
    return bends, bounds


def twins_of(
    half_edges: NDArray[np.int32], uses: NDArray[np.int32], count: int
) -> NDArray[np.int32]:
    """(3 count,) the opposite half-edge of each where two triangles share an edge, else -1."""
    twins = np.full(3 * count, -1, np.int32)
    first, second = half_edges[uses == 2].T
    twins[first], twins[second] = second, first
    return twins


def _gaps(surface: Surface, face: FaceTriangles) -> Gaps:
    """Where the parameters of neighbours differ along their side, and not only by a seam."""
    first = proof.parted_half_edges(face.uv, face.twins)
    a, b = _sides(face, first), _sides(face, face.twins[first])
    vertex = face.vertices.reshape(-1)
    against = vertex[first] != vertex[face.twins[first]]
    b[against] = b[against, ::-1]
    odd = np.flatnonzero((a != b).any(axis=(1, 2)))
    if len(odd):
        odd = odd[~_are_one_curve(surface, a[odd], b[odd])]
    if not len(odd):
        none = np.empty(0, np.int32)
        return Gaps(np.empty((0, 3, 2)), none, none, np.empty(0, np.intp))
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
        np.unique(beside), unknown,
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


def _are_one_curve(
    surface: Surface, a: NDArray[np.float64], b: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(k,) do two straight lines of (u, v), ends a and b (k, 2, 2), lie on each other in space?"""
    lines = [(1.0 - t) * x[:, 0] + t * x[:, 1] for x in (a, b) for t in (0.25, 0.5, 0.75)]
    start, end, *rest = _points(surface, a[:, 0], a[:, 1], *lines)
    apart = _distances(np.stack(rest[:3]), np.stack(rest[3:])).max(axis=0)
    return apart <= SAME * _distances(end, start)
