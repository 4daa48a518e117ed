"""How triangles of several faces move to their surfaces together: what is shared is moved alike.

Pieces of two faces need not run alike over a side, though they have one curve there. Each slides
along the side until f(s) is over s, and a triangle of a plane follows within it:

         c            x = c + t (p(s) - c)  moves to  f(c + t (p(sigma(s)) - c)) + t q(s)
        .'.
       / t `.         f: the piece, its corners brought to the vertices
      /   |   `.      sigma: f(p(sigma)) is over p(s)
     a----p(s)--b     q: of a plane, from the side to the other face's curve

That both have one curve is looked at in places. docs/proof.md has what is proved with that.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.proof import side_rates
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.accuracy.projected_pieces import nearest, slide_along
from surfmesh.accuracy.proof import FaceProof
from surfmesh.geometry.cad_surfaces.elementary import Plane
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import Surface

Array = NDArray[np.float64]

PLACES = np.array([0.25, 0.5, 0.75])
"""Of a side: where pieces of two faces are compared."""

SECANTS = 6
"""Steps to the place of a piece that is over one of the side."""

OVER = 1e-12
"""Of the side: what is over a place of it is no farther from there."""

ROUNDING = 1e-9
"""More than lengths and directions of triangles of any use are off."""


class FaceMoves(NamedTuple):
    """The triangles of one face, and what is known of how they move to their pieces."""

    surface: Surface
    face: FaceTriangles
    numbers: NDArray[np.int64]  # of its vertices, among those of the whole mesh
    found: FaceProof

    @property
    def triangles(self) -> NDArray[np.int64]:
        """(m, 3) by vertices of the whole mesh."""
        return self.numbers[self.face.vertices]


class AllMoves(NamedTuple):
    """Of all faces, one after the other."""

    triangles: NDArray[np.int32]  # (m, 3)
    away: Array  # (m,) how far points move at most
    slope: Array  # (m,) how fast that changes at most


class _Rims(NamedTuple):
    """Sides at rims of one face, from the lower end on."""

    triangle: NDArray[np.intp]  # (k,) of all faces
    side: NDArray[np.intp]  # (k,) of that
    ends: NDArray[np.int64]  # (k, 2)
    corners: Array  # (k, 2, 3)
    uv: Array  # (k, 2, 2)


class RimSides(NamedTuple):
    """Sides of triangles at rims of several faces, one after the other; from the lower end on."""

    triangle: NDArray[np.intp]  # (k,) of all
    side: NDArray[np.intp]  # (k,) of that
    ends: NDArray[np.int64]  # (k, 2)
    length: Array  # (k,)
    piece: Array  # (k, 3, 3) over PLACES, less these
    part: Array  # (k, 3) where that is, from end to end in (u, v)
    off: Array  # (k, 2) how far these are from the vertices
    normal: Array  # (k, 3) of a plane, else 0
    by_face: list[_Rims]


_Pairs = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Rows of sides that two faces share."""


def joined(faces: list[FaceMoves], sides: RimSides, count: int) -> AllMoves:
    """Of a mesh with so many vertices."""
    triangles = np.concatenate([face.triangles for face in faces])
    away = np.concatenate([face.found.away for face in faces])
    slope = np.concatenate([face.found.slope for face in faces])
    if len(faces) > 1:
        corners = np.concatenate([face.face.corners for face in faces])
        pairs = _pairs(sides)
        with np.errstate(divide="ignore", invalid="ignore"):
            more_away, more_slope = _at_corners(sides, triangles, corners, count)
            rates = _rates(faces, sides)
            away, slope = _spread(
                sides, rates, pairs, corners, away + more_away, slope + more_slope
            )
        known = np.isfinite(away) & np.isfinite(slope)
        away, slope = np.where(known, away, np.inf), np.where(known, slope, np.inf)
    return AllMoves(np.ascontiguousarray(triangles, np.int32), away, slope)


def _at_corners(
    sides: RimSides, triangles: NDArray[np.int64], corners: Array, count: int
) -> tuple[Array, Array]:
    """(m,) distances and slopes by which pieces are brought back to vertices of several faces."""
    off = np.zeros(count)
    np.maximum.at(off, sides.ends.ravel(), sides.off.ravel())
    all_off = off[triangles].sum(axis=1)
    slope = np.where(all_off > 0.0, all_off / _heights(corners).min(axis=1), 0.0)
    return all_off * (1.0 + ROUNDING), slope * (1.0 + ROUNDING)


def _spread(
    sides: RimSides, rates: Array, pairs: _Pairs, corners: Array, away: Array, slope: Array
) -> tuple[Array, Array]:
    """(m,) distances and slopes with what is spread over triangles from sides of two faces.

    f(s) runs along the side with 1 but for at most a: sigma with 1 but for a / (1 - a).
    """
    along, across = rates
    room = np.maximum(1.0 - along, 0.0)
    slides = np.where(room > 0.0, along / room, np.inf)
    leaves = np.where(room > 0.0, across / room, np.inf)
    is_plane = (sides.normal != 0.0).any(axis=1)
    slid, followed, far = np.ones_like(slope), np.zeros_like(slope), np.zeros_like(away)
    heights, longest = _heights(corners), _lengths(corners).max(axis=1)
    for own, beside in (pairs, pairs[::-1]):
        t, half = sides.triangle[own], 0.5 * sides.length[own]
        of_own = np.where(is_plane[own], 0.0, slides[own])
        of_other = np.where(is_plane[own] & ~is_plane[beside], leaves[beside], 0.0)
        steep = (longest[t] + half) / heights[t, sides.side[own]]
        np.multiply.at(slid, t, 1.0 + of_own * steep)  # one after the other
        np.add.at(followed, t, of_other * steep)
        np.add.at(far, t, half * (of_own + of_other))
    all_slope = (1.0 + slope) * slid - 1.0 + followed
    return (away + far) * (1.0 + ROUNDING), all_slope * (1.0 + ROUNDING)


def gaps_between(faces: list[FaceMoves], sides: RimSides) -> Array:
    """(f,) how far pieces are at most from those of other faces, over places of their sides.

    Beside a plane, from that.
    """
    gaps = np.zeros(len(faces))
    one, other = _pairs(sides)
    is_plane = (sides.normal != 0.0).any(axis=1)
    apart = sides.piece[one] - sides.piece[other]
    far = np.linalg.norm(apart, axis=2)
    for own in (one, other):
        from_plane = np.abs(np.einsum("kqc,kc->kq", apart, sides.normal[own]))
        far = np.where(is_plane[own, None], from_plane, far)
    far[is_plane[one] & is_plane[other]] = 0.0
    number = np.repeat(np.arange(len(faces)), [len(face.face.vertices) for face in faces])
    for own in (one, other):
        np.maximum.at(gaps, number[sides.triangle[own]], far.max(axis=1, initial=0.0))
    return gaps


def _pairs(sides: RimSides) -> _Pairs:
    """Rows of sides that two faces share."""
    key = sides.ends[:, 0] * (int(sides.ends.max(initial=0)) + 1) + sides.ends[:, 1]
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    pairs = starts[np.diff(starts, append=len(key)) == 2]
    return order[pairs], order[pairs + 1]


def rim_sides(faces: list[FaceMoves]) -> RimSides:
    """Of all faces; none of one that is alone."""
    starts = np.cumsum([0, *(len(face.face.vertices) for face in faces)])
    wanted = len(faces) > 1
    rims = [_rims_of(face, start, wanted) for face, start in zip(faces, starts.tolist())]
    triangle, side, ends, corners, _ = map(np.concatenate, zip(*rims, strict=True))
    count = [len(own.side) for own in rims]
    length = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    ends_of_piece = _pieces(faces, rims, np.tile([0.0, 1.0], (len(side), 1)))
    off = np.linalg.norm(ends_of_piece - corners, axis=2)
    normal = np.repeat([_normal_of_plane(face.surface) for face in faces], count, axis=0)
    piece, part = np.zeros((len(side), len(PLACES), 3)), np.tile(PLACES, (len(side), 1))
    # that of a plane is the side itself, once it is brought to the vertices
    bent = [k for k, face in enumerate(faces) if not isinstance(face.surface, Plane)]
    if bent:
        rows = np.flatnonzero(np.repeat(np.isin(np.arange(len(faces)), bent), count))
        piece[rows], part[rows] = _over_places(
            [faces[k] for k in bent], [rims[k] for k in bent], corners[rows], ends_of_piece[rows]
        )
    return RimSides(triangle, side, ends, length, piece, part, off, normal, rims)


def _rims_of(face: FaceMoves, start: int, wanted: bool) -> _Rims:
    """Of one face, whose triangles are numbered from ``start`` on; none if they are not wanted."""
    half_edges = np.flatnonzero((face.face.twins < 0) & wanted)
    triangle, side = half_edges // 3, half_edges % 3
    at = np.stack([side, (side + 1) % 3], axis=1)
    ends = face.triangles[triangle[:, None], at]
    turned = ends[:, 0] > ends[:, 1]
    at[turned], ends[turned] = at[turned, ::-1], ends[turned, ::-1]
    corners, uv = face.face.corners[triangle[:, None], at], face.face.uv[triangle[:, None], at]
    return _Rims(triangle + start, side, ends, corners, uv)


def _normal_of_plane(surface: Surface) -> Array:
    """(3,) 0 of another surface."""
    return np.asarray(surface.z) if isinstance(surface, Plane) else np.zeros(3)


def _rates(faces: list[FaceMoves], sides: RimSides) -> Array:
    """(2, k) how fast pieces leave their sides at most, along these and across."""
    starts = np.cumsum([0, *(len(face.face.vertices) for face in faces)])
    rates = [
        _rates_of(face, rims, start)
        for face, rims, start in zip(faces, sides.by_face, starts[:-1], strict=True)
    ]
    return np.concatenate(rates, axis=1) + sides.off.sum(axis=1) / sides.length


def _rates_of(face: FaceMoves, rims: _Rims, start: int) -> Array:
    """Of one face, whose ends are where they are."""
    if isinstance(face.surface, Plane):
        return np.zeros((2, len(rims.side)))
    if face.found.bends is None:
        own = rims.triangle - start
        away = face.found.away[own]
        return np.stack([slide_along(face.surface, rims.corners, away), face.found.slope[own]])
    rates = side_rates(
        as_core_surface(face.surface),
        np.ascontiguousarray(rims.corners), np.ascontiguousarray(rims.uv),
    )  # fmt: skip
    return np.asarray(rates.T)


def _over_places(
    faces: list[FaceMoves], rims: list[_Rims], corners: Array, ends: Array
) -> tuple[Array, Array]:
    """(k, 3, 3) pieces, their ends (k, 2, 3) brought to the corners, over PLACES, less these.

    And (k, 3) the part of the way between their ends. Of all faces at once.
    """
    along = corners[:, 1] - corners[:, 0]
    square = np.einsum("kc,kc->k", along, along)[:, None]
    first = np.tile(PLACES, (len(corners), 1))
    wanted = _along(corners, first)

    def off(t: Array) -> tuple[Array, Array]:
        places = _pieces(faces, rims, t) - _along(ends - corners, t) - wanted
        return places, np.einsum("kqc,kc->kq", places, along) / square

    with np.errstate(divide="ignore", invalid="ignore"):
        last = first
        places, value = off(last)
        t, before = last - value, value
        for _ in range(SECANTS):
            places, value = off(t)
            if not (np.abs(value) > OVER).any():
                return places, t
            step = np.where(value == before, 0.0, value * (t - last) / (value - before))
            last, before, t = t, value, t - step
        places, _ = off(t)
    return places, t


def _pieces(faces: list[FaceMoves], rims: list[_Rims], t: Array) -> Array:
    """(k, q, 3) at parts t (k, q) of the sides of all faces."""
    parts = np.split(t, np.cumsum([len(own.side) for own in rims])[:-1])
    return np.concatenate(
        [
            _piece(face, own.corners, own.uv, part)
            for face, own, part in zip(faces, rims, parts, strict=True)
        ]
    )


def _piece(face: FaceMoves, corners: Array, uv: Array, t: Array) -> Array:
    """(k, q, 3) at parts t (k, q) of sides with ends (k, 2, ...)."""
    if face.found.bends is None:
        piece = nearest(face.surface, _along(corners, t))
        if piece is not None:
            return piece
    (points,) = face.surface.evaluate(np.ascontiguousarray(_along(uv, t).reshape(-1, 2)), 0)
    return points.reshape(*t.shape, 3)


class SharedMiddles(NamedTuple):
    """New vertices amid sides of two faces, as one of these has them."""

    half_edges: NDArray[np.intp]  # (k,) of the face
    uv: Array  # (k, 2)
    numbers: NDArray[np.int64]  # (k,) of the vertices


def shared_middles(
    faces: list[FaceMoves], sides: RimSides, points: Array, is_bent: NDArray[np.bool_]
) -> tuple[Array, Array, list[SharedMiddles]]:
    """(n, 3) amid sides that end in a vertex that is bent, (n, 3) on both faces; and of each face.

    Sides between planes need none.
    """
    one, other = _pairs(sides)
    is_plane = (sides.normal != 0.0).any(axis=1)
    wanted = is_bent[sides.ends[one]].any(axis=1) & ~(is_plane[one] & is_plane[other])
    one, other = one[wanted], other[wanted]
    flat = points[sides.ends[one]].mean(axis=1)
    weight = np.where(is_plane[one], 0.0, np.where(is_plane[other], 1.0, 0.5))[:, None]
    moved = flat + weight * sides.piece[one, 1] + (1.0 - weight) * sides.piece[other, 1]
    rows, number = np.concatenate([one, other]), np.tile(np.arange(len(one)), 2)
    starts = np.cumsum([0, *(len(face.face.vertices) for face in faces)])
    found = []
    for face, first, end in zip(faces, starts[:-1], starts[1:], strict=True):
        own = np.flatnonzero((sides.triangle[rows] >= first) & (sides.triangle[rows] < end))
        row, k = rows[own], number[own]
        half_edges = 3 * (sides.triangle[row] - first) + sides.side[row]
        uv = _middle_uv(face, half_edges, sides.part[row, 1], moved[k])
        found.append(SharedMiddles(half_edges, uv, len(points) + k))
    return flat, moved, found


def _middle_uv(face: FaceMoves, half_edges: NDArray[np.intp], part: Array, points: Array) -> Array:
    """(k, 2) parameters of points on sides."""
    surface = face.surface
    if isinstance(surface, Plane):
        away = points - surface.origin
        return np.stack([(away * axis).sum(axis=1) for axis in (surface.x, surface.y)], axis=1)
    triangle, side = half_edges // 3, half_edges % 3
    at = np.stack([side, (side + 1) % 3], axis=1)
    ends = face.triangles[triangle[:, None], at]
    turned = ends[:, 0] > ends[:, 1]
    at[turned] = at[turned, ::-1]
    return _along(face.face.uv[triangle[:, None], at], part[:, None])[:, 0]


def _along(ends: Array, t: Array) -> Array:
    """(k, q, d) at parts t (k, q) between ends (k, 2, d)."""
    t = t[:, :, None]
    return np.asarray((1.0 - t) * ends[:, None, 0] + t * ends[:, None, 1])


def _lengths(corners: Array) -> Array:
    """(m, 3) of sides k, from corner k on."""
    return np.asarray(np.linalg.norm(corners[:, (1, 2, 0)] - corners, axis=2))


def _heights(corners: Array) -> Array:
    """(m, 3) over sides k, from corner k on."""
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return np.asarray(area[:, None] / _lengths(corners))
