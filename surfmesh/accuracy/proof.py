"""Proved bounds of the distance between triangles and their surface, both ways: one face at a time.

bounds over boxes -> of each triangle -> with its neighbours -> a closer look where that is too much
(by the surface)     height, shift        both ways              cells, and all triangles around

The work is done in the core (src/proof), with round-off in the bounds; docs/proof.md says what is
proved, and why. Here it is seen which sides are rims.
Spheres, cylinders and cones have shorter bounds (``projected_pieces``).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import proof, surfaces
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.accuracy.gaps import gaps_of
from surfmesh.accuracy.projected_pieces import projected
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

DEPTH = 3
"""How often a triangle is cut in four where its bounds are not good enough."""

LEVELS = 4
"""A closer look has up to 4^levels cells."""

WHOLE, CORNER, SLOPE = 8, 9, 26
"""Columns of the bounds: the distance point by point, how far corners are off, and how fast the
distance changes."""


class FaceProof(NamedTuple):
    """What is proved of m triangles. Lengths in model units; infinite where nothing is."""

    bound: NDArray[np.float64]  # (m,) triangle and surface are within it, both ways
    away: NDArray[np.float64]  # (m,) |r - L|, point by point
    slope: NDArray[np.float64]  # (m,) the largest |(r' - L')(w)| for unit w
    is_joined: bool  # pieces of neighbours have the same curve over their side, everywhere
    bends: NDArray[np.float64] | None  # (m, 3, 2) of the sides of pieces; None: these are others


def proved_distances(
    surface: Surface, face: FaceTriangles, limits: NDArray[np.float64], slope: float = np.inf,
    by_normals: bool = True,
) -> FaceProof | None:  # fmt: skip
    """How far triangles and surface are from each other at most; None without bounds.

    limits: (m,) how near it is worth to look; slope: likewise, of how fast |r - L| changes.
    by_normals: with the nearest points of surfaces whose pieces can be these.
    """
    moved = projected(surface, face.corners, face.uv, limits) if by_normals else None
    if moved is not None:
        return FaceProof(moved.away, moved.away, moved.slope, True, None)
    core, gaps = as_core_surface(surface), gaps_of(surface, face)
    face = _with_rims(face, gaps.loose)
    is_rim = (face.twins < 0).view(np.uint8)
    rims = (is_rim[0::3] | is_rim[1::3] << 1 | is_rim[2::3] << 2).astype(np.uint8, copy=False)
    bends, bounds = _bounds(core, face, limits, rims, slope)
    if bounds is None:
        return None
    away = bounds[:, WHOLE] + bounds[:, CORNER]
    changes = bounds[:, SLOPE].copy()
    is_joined = not (len(gaps.owners) or len(gaps.unknown) or len(gaps.loose))
    if len(gaps.unknown):
        bounds[gaps.unknown] = np.inf
    bound, _ = proof.ring_bounds(face.corners, face.vertices, face.twins, bounds, limits)
    # a gap is none of the neighbours: with it point by point alone, or a closer look
    bound[gaps.beside] = away[gaps.beside]
    bound[gaps.owners] = np.inf
    which = np.flatnonzero(~(bound <= limits)).astype(np.int32)
    if not len(which):
        return FaceProof(bound, away, changes, is_joined, bends)
    beside = proof.triangle_bounds(
        core, face.corners[gaps.owners], gaps.uv, np.zeros_like(gaps.uv), limits[gaps.owners],
        np.zeros(len(gaps.owners), np.uint8), DEPTH, False,
    )  # fmt: skip
    if beside is None:
        nothing = np.full(len(bound), np.inf)
        return FaceProof(nothing, nothing, nothing, is_joined, bends)
    bound = proof.look_closer(
        core, face.corners, face.uv, bends, face.vertices, face.twins, bounds, which, limits,
        LEVELS, bound, gaps.uv, gaps.owners, beside,
    )  # fmt: skip
    return FaceProof(bound, away, changes, is_joined, bends)


def _with_rims(face: FaceTriangles, half_edges: NDArray[np.int32]) -> FaceTriangles:
    """Cut open along some sides."""
    if not len(half_edges):
        return face
    twins = face.twins.copy()
    twins[half_edges] = -1
    return face._replace(twins=twins)


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
    gaps = gaps_of(surface, face)
    bound[gaps.owners] = bound[gaps.unknown] = bound[gaps.loose // 3] = np.inf
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
