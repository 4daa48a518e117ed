"""What no sample of the mesh has seen: features narrower than its triangles, proved absent or not.

Samples alone cannot tell a plane from a plane with a needle. Where a surface has bounds over boxes
of (u, v) (formulas have), every triangle and every segment of a free rim is either shown to hold
nothing more than its samples have seen, or named with its place: a feature was found, or none can
be excluded.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import TriangleStars, corner_places, hidden_bounds
from surfmesh._core.space import PointTree, triangle_planes
from surfmesh.geometry.components import components
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import BoundedSurface
from surfmesh.quality.measures.bent_sides import BentPieces, are_bent, cut_in_plane
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.hidden_search import (
    BOXES,
    BOXES_EACH,
    Pieces,
    climb,
    search_rims,
    search_triangles,
)
from surfmesh.quality.measures.known_surfaces import KnownSurfaces, Rows
from surfmesh.quality.measures.places import Point, as_point, as_uv
from surfmesh.quality.measures.tolerances import Tolerances, chord_forbidden
from surfmesh.result.connectivity import connect
from surfmesh.result.surface_mesh import SurfaceMesh

SLACK = 1.3
"""Of chord, or of what the samples have seen: between them it is smooth, and a little larger."""

PLAINLY, SLIGHT = 1.5, 0.005
"""Without a chord: times ``SLACK`` what the samples have seen, and of a triangle's longest side.
Across a bend that no edge follows the samples see two thirds of the deviation."""

FOLLOWED = 0.5
"""Of the longest side: a triangle whose samples lie farther off does not follow the surface."""

RIM_SLACK = 2.0
"""Of what three samples of a rim's segment have seen."""

AS_FAR = 2.0
"""Times the largest deviation that samples have seen where ``min_size`` forbids the chord."""

NEAREST = 3
"""Vertices whose triangles are looked at, beside a point's own and its neighbours."""

LEVELS = 3
"""A triangle is cut in four so often before boxes are tried."""

NO_AREA = 1e-12
"""Of the square of its longest side: a triangle without a normal."""


@dataclass(frozen=True)
class UnseenPlace:
    """A triangle between whose samples something lies, or may lie; lengths in model units."""

    triangle: int
    face: int
    uv: tuple[float, float]
    point: Point  # of the surface, there
    found: bool  # it was found: else nothing excludes it
    deviation: float  # how far it lies, or may lie, from the mesh; infinite: no bound at all


class UnseenCounts(NamedTuple):
    """What was found, and what cannot be excluded."""

    found: int  # triangles and segments of rims
    open: int
    largest: float  # deviation of what was found
    possible: float  # largest that cannot be excluded
    places: tuple[UnseenPlace, ...]  # what was found first, the largest first


class Unseen(NamedTuple):
    """All of it, and what is left of it where a ``min_size`` of the user's forbids the triangles
    that would show it: that is a limit as any other."""

    total: UnseenCounts
    faults: UnseenCounts
    forbidden: Rows  # (k,) triangles where it does
    heights: NDArray[np.float64]  # (k,) how far the surface lies, or may lie, from them


def unseen(
    known: KnownSurfaces, fit: Deviation, tolerances: Tolerances, listed: int
) -> Unseen | None:
    """Look between the samples of ``fit``; None where no surface has bounds: functions have none,
    and faces of CAD models are smooth between their knots.
    """
    mesh = known.mesh
    bounded = [
        (face, surface)
        for face, surface in enumerate(mesh.surfaces)
        if hasattr(surface, "all_bounds") and isinstance(surface, BoundedSurface)
    ]  # to ask for the whole protocol takes its time, of thousands of faces
    if not bounded or not np.isfinite(fit.largest):
        return None
    found: list[tuple[Rows, Pieces]] = []
    for face, surface in bounded:
        triangles = np.flatnonzero(mesh.face_ids == face).astype(np.int32)
        if len(triangles):
            found.append(_in_triangles(known, surface, face, triangles, fit, tolerances))
            found.append(_along_rims(known, surface, face, fit, tolerances))
    triangle = np.concatenate([t for t, _ in found] or [np.empty(0, np.int64)])
    reached = np.concatenate([p.reached for _, p in found] or [np.empty(0)])
    possible = np.concatenate([p.possible for _, p in found] or [np.empty(0)])
    place = np.concatenate([p.place for _, p in found] or [np.empty((0, 2))])
    possible[reached > 0.0] = 0.0
    bad = np.flatnonzero((reached > 0.0) | (possible > 0.0))
    bad = bad[np.lexsort((-possible[bad], -reached[bad]))]
    triangle, reached, possible, place = (x[bad] for x in (triangle, reached, possible, place))
    height = np.maximum(reached, possible)
    held = np.zeros(len(bad), bool)
    if len(bad) and tolerances.min_size.any():
        held = _held(mesh, fit, tolerances, triangle, height)

    def counts(rows: NDArray[np.intp]) -> UnseenCounts:
        return UnseenCounts(
            int(np.count_nonzero(reached[rows])), int(np.count_nonzero(possible[rows])),
            float(reached[rows].max(initial=0.0)), float(possible[rows].max(initial=0.0)),
            tuple(_place(mesh, int(triangle[k]), place[k], reached[k], possible[k])
                  for k in rows[:listed]),
        )  # fmt: skip

    total = counts(np.arange(len(bad)))
    faults = counts(np.flatnonzero(~held)) if held.any() else total
    return Unseen(total, faults, triangle[held], height[held])


def _held(
    mesh: SurfaceMesh, fit: Deviation, tolerances: Tolerances, triangles: Rows, height: NDArray
) -> NDArray[np.bool_]:
    """(k,) does ``min_size`` explain what hides in triangles? Where it bounds sizes, and others on
    the face are seen to be as far, more or less, because of it: a needle on a plane is none."""
    bound, beyond = chord_forbidden(tolerances, mesh, fit.by_triangle)
    largest = np.zeros(max(int(mesh.face_ids.max(initial=0)) + 1, 1))
    np.maximum.at(largest, mesh.face_ids[beyond], fit.by_triangle[beyond])
    return bound[triangles] & (height <= AS_FAR * largest[mesh.face_ids[triangles]])


def _place(
    mesh: SurfaceMesh, triangle: int, uv: NDArray, reached: float, possible: float
) -> UnseenPlace:
    face = int(mesh.face_ids[triangle])
    (point,) = mesh.surfaces[face].evaluate(uv[None], 0)
    is_found = bool(reached > 0.0)
    return UnseenPlace(
        triangle, face, as_uv(uv), as_point(point[0]), is_found,
        float(reached if is_found else possible),
    )  # fmt: skip


def _in_triangles(
    known: KnownSurfaces, surface: BoundedSurface, face: int, triangles: NDArray[np.int32],
    fit: Deviation, tolerances: Tolerances,
) -> tuple[Rows, Pieces]:  # fmt: skip
    _, points, corners, uv_points, uv_corners, _ = known.arrays
    seen = fit.by_triangle.take(triangles)
    tolerance = SLACK * _expected(
        face, seen, fit, tolerances, lambda: _longest(known.points(triangles))
    )
    whole = _beside_poles(known, triangles)
    bounded = hidden_bounds(
        as_core_surface(surface), points, corners, uv_points, uv_corners, triangles,
        tolerance, seen, whole.view(np.uint8), LEVELS,
    )  # fmt: skip
    return _of_triangles(*_left(known, surface, triangles, tolerance, whole, bounded == 0))


def _of_triangles(triangles: Rows, pieces: Pieces) -> tuple[Rows, Pieces]:
    """What is open, once for each triangle: what was found farthest off, or may hide highest."""
    bad = np.flatnonzero(pieces.is_open)
    order = bad[np.lexsort((-pieces.possible[bad], -pieces.reached[bad]))]
    _, first = np.unique(triangles[order], return_index=True)
    chosen = order[first]
    return triangles[chosen], Pieces(*(getattr(pieces, name)[chosen] for name in vars(pieces)))


def _left(
    known: KnownSurfaces, surface: BoundedSurface, triangles: NDArray[np.int32],
    tolerance: NDArray[np.float64], whole: NDArray[np.bool_], is_left: NDArray[np.bool_],
) -> tuple[Rows, Pieces]:  # fmt: skip
    """What was found in triangles that are left, and in those with bent sides where some are."""
    of, parts = np.flatnonzero(is_left), None
    if len(of):
        parts = _bent_parts(known, surface, triangles, whole, is_left)
    if parts is None:
        corners, wholly = known.uv(triangles[of]), whole[of]
    else:
        uv = known.uv(triangles)
        of = np.concatenate([np.flatnonzero(parts.straight), parts.rows[parts.pieces.owner]])
        corners = np.concatenate([uv[parts.straight], parts.pieces.uv])
        wholly = np.concatenate([whole[parts.straight], np.zeros(len(parts.pieces.uv), bool)])
    _, points, rows, *_ = known.arrays
    own = triangles[of]
    normal, _, _ = triangle_planes(points, rows, own)
    pieces = Pieces.of(corners, points[rows[own, 0]], normal[:, None], tolerance[of])
    if len(of):
        around = _Around(known.mesh, own)
        search_triangles(
            surface, pieces, wholly, around.deviation, BOXES + BOXES_EACH * len(rows)
        )  # fmt: skip
        climb(surface, pieces, around.deviation)
    return own, pieces


class _BentParts(NamedTuple):
    straight: NDArray[np.bool_]  # (k,) triangles that are looked at as they are
    rows: Rows  # those that are cut
    pieces: BentPieces


def _bent_parts(
    known: KnownSurfaces, surface: BoundedSurface, triangles: NDArray[np.int32],
    whole: NDArray[np.bool_], is_left: NDArray[np.bool_],
) -> _BentParts | None:  # fmt: skip
    """None where the sides of those that are left are straight enough in (u, v), or where no axis
    runs to an elongated pole."""
    chart = Chart.of(surface)
    if chart.core.scaling is None:
        return None
    uv = known.uv(triangles)
    if not are_bent(surface, chart, uv[is_left]).any():
        return None
    corners = known.corners.uv_triangles[triangles]
    table = connect(np.ascontiguousarray(corners, np.int32))
    h, g = table.half_edges[table.uses == 2].T
    # two triangles are cut together where the side between them is bent
    over = are_bent(surface, chart, uv).ravel()[h]
    group = components(len(triangles), np.stack([h[over] // 3, g[over] // 3], axis=1))
    is_cut = np.isin(group, group[is_left])
    alone = np.zeros((len(triangles), 3), bool)
    for own, other in ((h, g), (g, h)):
        alone[own // 3, own % 3] = is_cut[own // 3] & ~is_cut[other // 3]
    rows = np.flatnonzero(is_cut)
    pieces = cut_in_plane(chart, uv[rows], whole[rows], alone[rows])
    return _BentParts(is_left & ~is_cut, rows, pieces)


def _along_rims(
    known: KnownSurfaces, surface: BoundedSurface, face: int, fit: Deviation,
    tolerances: Tolerances,
) -> tuple[Rows, Pieces]:  # fmt: skip
    """Segments of the free rims: in its own plane a triangle's rim may swing out unseen."""
    mesh = known.mesh
    triangle, side = np.divmod(mesh.connectivity.half_edges[mesh.connectivity.uses == 1, 0], 3)
    here = mesh.face_ids[triangle] == face
    triangle, side = triangle[here], side[here]
    corners, uv = known.points(triangle), known.uv(triangle)
    row = np.arange(len(side))
    ends = corners[row, side], corners[row, (side + 1) % 3]
    uv = np.stack([uv[row, side], uv[row, (side + 1) % 3]], axis=1)
    along = ends[1] - ends[0]
    length = np.linalg.norm(along, axis=1)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    some = (length > 0.0) & (size > NO_AREA * _longest(corners) ** 2)
    across = across[some] / size[some, None]
    beside = np.cross(along[some] / length[some, None], across)
    triangle, uv, start = triangle[some], uv[some], ends[0][some]
    normal = np.stack([across, beside], axis=1)
    seen = np.zeros(len(uv))
    for t in (0.25, 0.5, 0.75):
        (point,) = surface.evaluate(uv[:, 0] + t * (uv[:, 1] - uv[:, 0]), 0)
        from_chord = np.einsum("idj,ij->id", normal, point - start)
        seen = np.maximum(seen, np.linalg.norm(from_chord, axis=1))
    expected = _expected(
        face, fit.by_triangle[triangle], fit, tolerances, lambda: length[some]
    )  # fmt: skip
    pieces = Pieces.of(uv, start, normal, np.maximum(SLACK * expected, RIM_SLACK * seen))
    if len(uv):
        search_rims(surface, pieces, BOXES + BOXES_EACH * len(uv))
    bad = pieces.is_open
    return triangle[bad], Pieces(*(getattr(pieces, name)[bad] for name in vars(pieces)))


def _expected(
    face: int, seen: NDArray[np.float64], fit: Deviation, tolerances: Tolerances,
    longest: Callable[[], NDArray[np.float64]],
) -> NDArray[np.float64]:  # fmt: skip
    """(k,) the distance that is asked for, or that the samples have ``seen`` (k,) if it is more."""
    chord = tolerances.at(tolerances.chord, np.array([face]))
    asked = np.maximum(chord, seen)
    if np.isfinite(asked).all():
        return asked
    length = longest()
    without = PLAINLY * np.clip(fit.largest, SLIGHT * length, FOLLOWED * length)
    return np.where(np.isfinite(chord), asked, without)


def _longest(corners: NDArray) -> NDArray[np.float64]:
    return np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)


def _beside_poles(known: KnownSurfaces, triangles: Rows) -> NDArray[np.bool_]:
    """(k,) triangles with a corner at a side that is one point: there others were dropped."""
    mesh, corners = known.mesh, known.corners
    if np.array_equal(mesh.triangles, corners.uv_triangles):  # one place each
        return np.zeros(len(triangles), bool)
    images = corner_places(
        mesh.triangles, corners.uv_triangles, len(mesh.points), len(corners.uv_points)
    )
    if images.max(initial=0) <= 4:  # a corner of two seams has four
        return np.zeros(len(triangles), bool)
    many = images[mesh.triangles[triangles]] > 4
    return np.any(many, axis=1)


class _Around:
    """The triangles near points of the surface: those that share a corner with a point's own, and
    those at the vertices nearest to it. Sides of triangles are straight in the plane that was
    meshed, whose axes are bent: in (u, v) a point may lie over a triangle farther away."""

    def __init__(self, mesh: SurfaceMesh, triangles: NDArray) -> None:
        self.mesh, self.triangles = mesh, triangles
        self.stars = TriangleStars(mesh.points, mesh.triangles)
        self.used = np.unique(mesh.triangles)

    @cached_property
    def _tree(self) -> PointTree:
        return PointTree(self.mesh.points[self.used])

    def deviation(self, piece: NDArray, point: NDArray) -> NDArray[np.float64]:
        """Distance (n,) of points (n, 3) from the triangles around those of ``piece`` (n,)."""
        count = min(NEAREST, len(self.used))
        _, nearest = self._tree.nearest(point, count)
        own = self.mesh.triangles[self.triangles[piece]]
        return self.stars.distances_from_stars(
            point, np.concatenate([own, self.used[nearest]], axis=1)
        )
