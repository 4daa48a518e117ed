r"""Triangles that are not proved to keep to the chord are cut in (u, v) until they are.

     c               c          The side that lies farthest from the surface is cut amid its (u, v),
   / T \           / | \        in the two triangles at it. Everything else stays as it is, so that
  a-----b   -->   a--p--b       what is proved of triangles farther off goes on to hold: a mesh that
   \ N /           \ | /        is made anew has others that are not, somewhere else.
     d               d

Rims and seams are not cut, as other faces know their nodes: smaller sizes are asked for there, and
where so many triangles are left that sizes say it better.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.accuracy.proof import proved_distances
from surfmesh.geometry.surface import Surface
from surfmesh.result.connectivity import connect
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

FINER = 0.9
"""Times the size at which a bound that falls with its square would keep to the chord."""

FINEST, COARSEST = 0.5, 0.8
"""Of the sizes, in one round."""

PASSES, MOST_PASSES = 6, 24
"""How often triangles are cut: bounds fall to a half or less each time; and where hardly any are
left, whose cuts come to an end sooner than another mesh that has others."""

HARDLY_ANY = 2e-3
"""Part of all triangles."""

FEW, SMALL_FRACTION = 4, 0.02
"""Triangles, and their part of all, up to which they are cut: that gives two more for each."""

MUCH = 0.5
"""Of the distance of the farthest side: where all that may be cut lie nearer, cuts are no help."""

LEAST_COSINE = 0.5
"""Between the normals of a triangle and of its halves: no fold is made."""

LEAST_PART = 0.25
"""Of the area in (u, v) that a half has at least: one has a half of it but for rounding."""


class Patch(NamedTuple):
    """Triangles over (u, v), of n points and k places."""

    points: NDArray[np.float64]  # (n, 3)
    triangles: NDArray[np.int32]  # (m, 3) of the points
    uv: NDArray[np.float64]  # (k, 2)
    uv_triangles: NDArray[np.int32]  # (m, 3) of the places
    sizes: NDArray[np.float64]  # (n,) wanted at the points
    roots: NDArray[np.float64] | None  # (k, 6) of the metric, where sizes depend on the direction


class _Sides(NamedTuple):
    """Sides to be cut: side k of triangle t, side j of triangle s, and the place amid."""

    t: NDArray[np.intp]
    k: NDArray[np.intp]
    s: NDArray[np.intp]
    j: NDArray[np.intp]
    uv: NDArray[np.float64]  # (c, 2)
    points: NDArray[np.float64]  # (c, 3)


def cut_until_proved(
    surface: Surface, sizing: Sizing, patch: Patch
) -> tuple[Patch, SizeLimits | None]:
    """The patch with cuts where few triangles are not proved; what it asks for where some are left.

    Points are added after those that are there.
    """
    if not sizing.proof or sizing.chord is None or not len(patch.triangles):
        return patch, None
    for passes in range(MOST_PASSES + 1):
        face = _face(patch)
        found = proved_distances(surface, face, np.full(len(face.corners), sizing.chord))
        if found is None:
            return patch, None
        most = max(FEW, SMALL_FRACTION * len(found.bound))
        is_bounded = np.isfinite(found.bound)
        left = np.flatnonzero(found.bound > sizing.chord)
        # where much is not bounded, as at poles of offsets, smaller triangles would be no better
        left = left if np.count_nonzero(~is_bounded) <= most else left[is_bounded[left]]
        cut = None
        hardly_any = max(FEW, HARDLY_ANY * len(found.bound))
        may_cut = passes < PASSES or (passes < MOST_PASSES and len(left) <= hardly_any)
        if 0 < len(left) <= most and may_cut:
            worst_first = left[np.argsort(-found.bound[left], kind="stable")]
            cut = _farthest_sides(surface, patch, face, worst_first, sizing.min_size or 0.0)
        if cut is None:
            return patch, _requests(sizing, patch, left, found.bound[left])
        patch = _cut(patch, cut)
    raise AssertionError("the last pass cuts nothing")


def _requests(
    sizing: Sizing, patch: Patch, left: NDArray[np.intp], bound: NDArray[np.float64]
) -> SizeLimits | None:
    """Upper bounds of the size, for another round, at triangles ``left`` with these bounds."""
    if not len(left) or sizing.chord is None:
        return None
    factor = np.clip(FINER * np.sqrt(sizing.chord / bound), FINEST, COARSEST)
    corners, places, roots = patch.triangles[left], patch.uv_triangles[left], patch.roots
    return SizeLimits(
        patch.points[corners].mean(axis=1),
        factor * patch.sizes[corners].mean(axis=1),
        sizing.gradient,
        uv=patch.uv[places].mean(axis=1),
        metric_root_3d=None if roots is None else roots[places[:, 0]] / factor[:, None],
    )


def _face(patch: Patch) -> FaceTriangles:
    vertices = np.ascontiguousarray(patch.triangles, np.int32)
    table = connect(vertices)
    return FaceTriangles(
        np.ascontiguousarray(patch.points[vertices]),
        np.ascontiguousarray(patch.uv[patch.uv_triangles]),
        vertices,
        twins_of(table.half_edges, table.uses, len(vertices)),
    )


def _farthest_sides(
    surface: Surface, patch: Patch, face: FaceTriangles, left: NDArray[np.intp], least: float
) -> _Sides | None:
    """Of the triangles ``left``, no two in one triangle; None where there are none.

    least: length of the halves of a side.
    """
    after = (1, 2, 0)
    uv = 0.5 * (face.uv[left] + face.uv[left][:, after])  # (l, 3, 2) amid the sides
    (points,) = surface.evaluate(uv.reshape(-1, 2), 0)
    points = points.reshape(-1, 3, 3)
    corners = face.corners[left]
    sag = _norm(points - 0.5 * (corners + corners[:, after]))
    may_be_cut = _inner_sides(patch, face)[left]
    may_be_cut &= 0.5 * _norm(corners[:, after] - corners) >= least
    far = np.where(may_be_cut, sag, -1.0)
    side = far.argmax(axis=1)
    good = far.max(axis=1) >= MUCH * sag.max(axis=1)
    is_used, rows = np.zeros(len(patch.triangles), bool), []
    for row in np.flatnonzero(good).tolist():
        t, s = left[row], face.twins[3 * left[row] + side[row]] // 3
        ends = uv[row, side[row]], points[row, side[row]]
        if not (is_used[t] or is_used[s]) and _keeps_shape(face, (t, s), side[row], *ends):
            is_used[[t, s]] = True
            rows.append(row)
    if not rows:
        return None
    t, k = left[rows], side[rows]
    twin = face.twins[3 * t + k]
    return _Sides(t, k, twin // 3, twin % 3, uv[rows, k], points[rows, k])


def _inner_sides(patch: Patch, face: FaceTriangles) -> NDArray[np.bool_]:
    """(m, 3) has the triangle across the side the same two places in (u, v)?"""
    start = patch.uv_triangles.reshape(-1)
    end = np.roll(patch.uv_triangles, -1, axis=1).reshape(-1)
    twins = face.twins
    return np.asarray(((twins >= 0) & (start[twins] == end) & (end[twins] == start)).reshape(-1, 3))


def _keeps_shape(
    face: FaceTriangles, two: tuple[int, int], k: int, uv: NDArray[np.float64],
    point: NDArray[np.float64],
) -> bool:  # fmt: skip
    """Do halves of both triangles at side k of the first run as these do, in (u, v) and space?"""
    j = face.twins[3 * two[0] + k] % 3
    for triangle, side in zip(two, (k, j)):
        flat, normal = _area(face.uv[triangle]), _normal(face.corners[triangle])
        for end in (side, (side + 1) % 3):
            places, corners = face.uv[triangle].copy(), face.corners[triangle].copy()
            places[end], corners[end] = uv, point
            half = _normal(corners)
            if not _area(places) * flat > LEAST_PART * flat * flat:
                return False
            if not (half * normal).sum() > LEAST_COSINE * float(_norm(half) * _norm(normal)):
                return False
    return True


def _cut(patch: Patch, cut: _Sides) -> Patch:
    """Each triangle keeps the half at the end of its side; the others come after all."""
    count = len(cut.t)
    new, place = (len(old) + np.arange(count) for old in (patch.points, patch.uv))
    ends = patch.triangles[cut.t, cut.k], patch.triangles[cut.t, (cut.k + 1) % 3]
    places = patch.uv_triangles[cut.t, cut.k], patch.uv_triangles[cut.t, (cut.k + 1) % 3]
    roots = patch.roots
    if roots is not None:
        roots = np.concatenate([roots, 0.5 * (roots[places[0]] + roots[places[1]])])
    sizes = 0.5 * (patch.sizes[ends[0]] + patch.sizes[ends[1]])
    return Patch(
        np.concatenate([patch.points, cut.points]),
        _halves(patch.triangles, cut, new),
        np.concatenate([patch.uv, cut.uv]),
        _halves(patch.uv_triangles, cut, place),
        np.concatenate([patch.sizes, sizes]),
        roots,
    )


def _halves(triangles: NDArray[np.int32], cut: _Sides, new: NDArray[np.intp]) -> NDArray[np.int32]:
    """new: (c,) the row amid each side."""
    kept, more = triangles.copy(), []
    for t, k in ((cut.t, cut.k), (cut.s, cut.j)):
        half = triangles[t]
        half[np.arange(len(t)), (k + 1) % 3] = new
        more.append(half)
        kept[t, k] = new
    return np.concatenate([kept, *more])


def _norm(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _area(uv: NDArray[np.float64]) -> float:
    (au, av), (bu, bv) = uv[1] - uv[0], uv[2] - uv[0]
    return float(0.5 * (au * bv - av * bu))


def _normal(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.cross(corners[1] - corners[0], corners[2] - corners[0])
