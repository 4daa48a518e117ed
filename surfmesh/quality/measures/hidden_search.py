"""What may hide between the samples of a triangle or of a rim, by interval arithmetic.

Over a triangle T with normal n and corner p the surface lies e = n.(r - p) from the plane of T,
and e is 0 at the corners. Over a box of (u, v) with centre c and half widths a, b there are bounds

    value          |e| <= max |n.(r - p)|                            also across a jump
    mean value     |e| <= |e(c)| + a |e_u| + b |e_v|                 across a kink
    Taylor         |e| <= |e(c)| + a |e_u(c)| + b |e_v(c)|
                          + (a^2 |e_uu| + 2 a b |e_uv| + b^2 |e_vv|) / 2

Boxes are halved until the least of them is within the tolerance, or a point is found that is not.
Before that, where the surface is smooth, nearly all triangles are bounded as they are or cut in
four a few times: ``src/quality/hidden_bounds.hpp``.

Source: Moore, Kearfott, Cloud, "Introduction to Interval Analysis", SIAM 2009, chapter 6.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.formulas.interval import largest_along
from surfmesh.geometry.surface import BoundedSurface

BLOCK = 1 << 13  # boxes looked at together
ROUNDS = 60  # halvings of a triangle's box at most
BOXES, BOXES_EACH = 500_000, 4  # most boxes in all: so many, and so many for each triangle
NEARLY = 1.02  # of the tolerance: a box counts as within, so that halving comes to an end
AHEAD = 16.0  # a box is at most so many times narrower across a place without bounds than along it
NO_BOUND = 1e300  # what is more is infinite
INSIDE = 1e-9  # barycentric: a centre so far outside is inside
CLIMBED = 50  # found points, the farthest first, that are moved to where the distance is largest
CLIMB_STEPS, SHORTER = 80, 0.7  # of the pattern search: down to 1e-12 of the triangle
EIGHT_WAYS = np.array([(a, b) for a in (-1.0, 0.0, 1.0) for b in (-1.0, 0.0, 1.0) if a or b])

Deviations: TypeAlias = Callable[[NDArray[np.int64], NDArray[np.float64]], NDArray[np.float64]]


@dataclass
class Pieces:
    """Triangles of one surface, or segments of its rim, and what was found of each.

    Of a segment only ``corner`` 0 and 1 count, and there are two normals.
    """

    uv: NDArray[np.float64]  # (k, 3, 2), or (k, 2, 2) of segments
    corner: NDArray[np.float64]  # (k, 3) one of its points in space
    normal: NDArray[np.float64]  # (k, d, 3) unit; d = 1 or 2
    tolerance: NDArray[np.float64]  # (k,) what may hide there
    possible: NDArray[np.float64]  # (k,) what may hide, where that is more; 0 elsewhere
    reached: NDArray[np.float64]  # (k,) the distance of a point that was found; 0: none
    place: NDArray[np.float64]  # (k, 2) its parameters, or those where nothing is known

    @classmethod
    def of(cls, uv: NDArray, corner: NDArray, normal: NDArray, tolerance: NDArray) -> Pieces:
        """Nothing is known of them yet."""
        none = np.zeros(len(uv))
        return cls(uv, corner, normal, tolerance, none, none.copy(), uv.mean(axis=1))

    @property
    def is_open(self) -> NDArray[np.bool_]:
        """(k,) where something was found, or may hide."""
        return (self.reached > 0.0) | (self.possible > 0.0)


@dataclass
class _Boxes:
    piece: NDArray[np.int64]  # (n,)
    lo: NDArray[np.float64]  # (n, 2), of segments (n, 1): t along them
    hi: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.piece)

    def chosen(self, which: NDArray) -> _Boxes:
        return _Boxes(self.piece[which], self.lo[which], self.hi[which])

    def halved(self, axis: NDArray[np.int64]) -> _Boxes:
        """Both halves of each along its ``axis`` (n,)."""
        row = np.arange(len(self))
        middle = 0.5 * (self.lo[row, axis] + self.hi[row, axis])
        first_hi, second_lo = self.hi.copy(), self.lo.copy()
        first_hi[row, axis] = middle
        second_lo[row, axis] = middle
        return _Boxes(
            np.concatenate([self.piece, self.piece]),
            np.concatenate([self.lo, second_lo]),
            np.concatenate([first_hi, self.hi]),
        )


def search_triangles(
    surface: BoundedSurface,
    pieces: Pieces,
    whole: NDArray[np.bool_],
    deviation: Deviations,
    budget: int,
) -> int:
    """Look into the triangles; fills in what was found. Returns the number of boxes.

    whole: (k,) where all of the box counts, not the triangle alone (beside a pole, where others
    were dropped). deviation(piece (n,), point (n, 3)) -> (n,) of points from the mesh nearby.
    """
    boxes = _Boxes(np.arange(len(pieces.uv)), pieces.uv.min(axis=1), pieces.uv.max(axis=1))
    looked = 0
    for _ in range(ROUNDS):
        if not len(boxes):
            return looked
        looked += len(boxes)
        bound, axis = np.empty(len(boxes)), np.empty(len(boxes), np.int64)
        for start in range(0, len(boxes), BLOCK):
            part = np.arange(start, min(start + BLOCK, len(boxes)))
            bound[part], axis[part] = _looked_into(
                surface, pieces, boxes.chosen(part), whole, deviation
            )
        going = bound > NEARLY * pieces.tolerance[boxes.piece]
        going &= pieces.reached[boxes.piece] == 0.0
        if looked + 2 * going.sum() > budget:
            _leave(pieces, boxes.chosen(going), bound[going])
            return looked
        boxes = boxes.chosen(going).halved(axis[going])
        boxes = boxes.chosen(whole[boxes.piece] | _meet(boxes, pieces.uv))
    _leave(pieces, boxes, np.full(len(boxes), np.inf))  # not bounded yet
    return looked


def _looked_into(
    surface: BoundedSurface,
    pieces: Pieces,
    boxes: _Boxes,
    whole: NDArray[np.bool_],
    deviation: Deviations,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A bound (n,) of the distance over each box, and the axis (n,) to halve it along."""
    piece, normal = boxes.piece, pieces.normal[boxes.piece]
    middle, half = 0.5 * (boxes.lo + boxes.hi), 0.5 * (boxes.hi - boxes.lo)
    lower, upper = surface.all_bounds(boxes.lo, boxes.hi)
    r, r_u, r_v = surface.evaluate(middle, 1)
    plane = normal[:, 0]
    height = np.abs(np.einsum("ij,ij->i", plane, r - pieces.corner[piece]))
    with np.errstate(invalid="ignore", over="ignore"):
        corner = pieces.corner[piece]
        value = largest_along(lower[:, 0] - corner, upper[:, 0] - corner, normal)[:, 0]
        u, v, uu, uvs, vv = (
            largest_along(lower[:, k], upper[:, k], normal)[:, 0] for k in range(1, 6)
        )
        a, b = half.T
        slope_u, slope_v = (np.abs(np.einsum("ij,ij->i", plane, x)) for x in (r_u, r_v))
        # each axis: by the mean value or by Taylor's formula, whichever is less
        bent_u = a * slope_u + 0.5 * a * (a * uu + b * uvs)
        bent_v = b * slope_v + 0.5 * b * (b * vv + a * uvs)
        part_u, part_v = np.fmin(a * u, bent_u), np.fmin(b * v, bent_v)
        bound = np.fmin(value, height + np.fmin(a * u + b * v, bent_u + bent_v))
    bound[np.isnan(bound)] = np.inf
    part = np.nan_to_num(np.stack([part_u, part_v], axis=1), nan=np.inf)
    widths = half / np.maximum(np.ptp(pieces.uv[piece], axis=1), 1e-300)
    axis = np.where(part[:, 0] == part[:, 1], widths.argmax(axis=1), part.argmax(axis=1))
    # at a rim of infinite speed no halving across it makes that bound finite: the other one's turn
    row = np.arange(len(boxes))
    endless = (part[row, axis] > NO_BOUND) & (AHEAD * widths[row, axis] < widths[row, 1 - axis])
    axis = np.where(endless, 1 - axis, axis)
    far = np.flatnonzero(height > pieces.tolerance[piece])
    if len(far):
        distance = deviation(piece[far], r[far])  # from the triangles around it too
        truly = distance > pieces.tolerance[piece[far]]
        truly &= whole[piece[far]] | _holds(pieces.uv[piece[far]], middle[far])
        _remember(pieces, piece[far], middle[far], distance, truly)
        with np.errstate(invalid="ignore", over="ignore"):
            fastest = np.maximum(np.abs(lower[far, 1:3]), np.abs(upper[far, 1:3]))
            around = distance + (np.linalg.norm(fastest, axis=2) * half[far]).sum(axis=1)
        bound[far] = np.fmin(bound[far], around)
    return bound, axis


def _remember(
    pieces: Pieces, piece: NDArray, uv: NDArray, distance: NDArray, truly: NDArray[np.bool_]
) -> None:
    """Points (n,) of the surface that are ``truly`` farther from the mesh than they may be."""
    order = np.argsort(distance[truly], kind="stable")  # the farthest is written last
    chosen = piece[truly][order]
    worst = distance[truly][order] > pieces.reached[chosen]
    pieces.reached[chosen[worst]] = distance[truly][order][worst]
    pieces.place[chosen[worst]] = uv[truly][order][worst]


def climb(surface: BoundedSurface, pieces: Pieces, deviation: Deviations) -> None:
    """From the points that were found uphill: the search ends at the first, on a feature's slope.

    Eight ways round a point are tried within its triangle, step by step shorter (pattern search).
    """
    found = np.flatnonzero(pieces.reached > 0.0)
    found = found[np.argsort(-pieces.reached[found], kind="stable")][:CLIMBED]
    step = np.ptp(pieces.uv[found], axis=1)
    for _ in range(CLIMB_STEPS if len(found) else 0):
        trial = pieces.place[found, None] + step[:, None] * EIGHT_WAYS
        piece, uv = np.repeat(found, len(EIGHT_WAYS)), trial.reshape(-1, 2)
        held = _holds(pieces.uv[piece], uv)
        piece, uv = piece[held], uv[held]
        if len(piece):
            distance = deviation(piece, surface.evaluate(uv, 0)[0])
            _remember(pieces, piece, uv, distance, np.isfinite(distance))
        step *= SHORTER


def _leave(pieces: Pieces, boxes: _Boxes, bound: NDArray[np.float64]) -> None:
    """Boxes that nobody has the time for: what may hide there is said of their pieces."""
    order = np.argsort(bound, kind="stable")
    chosen = boxes.piece[order]
    if boxes.lo.shape[1] == 2:
        middle = 0.5 * (boxes.lo + boxes.hi)
    else:
        t, ends = 0.5 * (boxes.lo + boxes.hi), pieces.uv[boxes.piece]
        middle = ends[:, 0] + t * (ends[:, 1] - ends[:, 0])
    pieces.possible[chosen] = bound[order]
    pieces.place[chosen] = middle[order]


def _holds(uv: NDArray, point: NDArray) -> NDArray[np.bool_]:
    """Do triangles (n, 3, 2) hold points (n, 2)?"""
    a, b, c = uv.transpose(1, 0, 2)
    area = _cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = [_cross(q - p, point - p) / area for p, q in ((a, b), (b, c), (c, a))]
        return np.min(weights, axis=0) >= -INSIDE


def _meet(boxes: _Boxes, uv: NDArray) -> NDArray[np.bool_]:
    """(n,) boxes that are not wholly on the outer side of an edge of their triangle."""
    corners = uv[boxes.piece]
    middle, half = 0.5 * (boxes.lo + boxes.hi), 0.5 * (boxes.hi - boxes.lo)
    sign = np.sign(_cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    meet = np.ones(len(boxes), bool)
    for first, second in ((0, 1), (1, 2), (2, 0)):
        edge = corners[:, second] - corners[:, first]
        height = sign * _cross(edge, middle - corners[:, first])
        reach = np.abs(edge[:, 1]) * half[:, 0] + np.abs(edge[:, 0]) * half[:, 1]
        meet &= height + reach > 0.0
    return meet


def _cross(a: NDArray, b: NDArray) -> NDArray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def search_rims(surface: BoundedSurface, pieces: Pieces, budget: int) -> int:
    """The same along segments of the rim, one variable s from 0 to 1, distances from the chord."""
    boxes = _Boxes(
        np.arange(len(pieces.uv)), np.zeros((len(pieces.uv), 1)), np.ones((len(pieces.uv), 1))
    )
    looked = 0
    for _ in range(ROUNDS):
        if not len(boxes):
            return looked
        looked += len(boxes)
        bound = np.empty(len(boxes))
        for start in range(0, len(boxes), BLOCK):
            part = np.arange(start, min(start + BLOCK, len(boxes)))
            bound[part] = _along_rim(surface, pieces, boxes.chosen(part))
        going = bound > NEARLY * pieces.tolerance[boxes.piece]
        going &= pieces.reached[boxes.piece] == 0.0
        if looked + 2 * going.sum() > budget:
            _leave(pieces, boxes.chosen(going), bound[going])
            return looked
        boxes = boxes.chosen(going)
        boxes = boxes.halved(np.zeros(len(boxes), np.int64))
    _leave(pieces, boxes, np.full(len(boxes), np.inf))  # not bounded yet
    return looked


def _along_rim(surface: BoundedSurface, pieces: Pieces, boxes: _Boxes) -> NDArray[np.float64]:
    """A bound (n,) of the distance from the line through the segment's ends."""
    piece, normal = boxes.piece, pieces.normal[boxes.piece]
    start, step = pieces.uv[piece, 0], pieces.uv[piece, 1] - pieces.uv[piece, 0]
    ends = start + boxes.lo * step, start + boxes.hi * step
    lower, upper = surface.all_bounds(np.minimum(*ends), np.maximum(*ends))
    middle = start + 0.5 * (boxes.lo + boxes.hi) * step
    half = 0.5 * (boxes.hi - boxes.lo)[:, 0]
    r, r_u, r_v = surface.evaluate(middle, 1)
    corner = pieces.corner[piece]
    height = np.abs(np.einsum("idj,ij->id", normal, r - corner))
    along = np.abs(np.einsum("idj,ij->id", normal, step[:, :1] * r_u + step[:, 1:] * r_v))
    a, b = np.abs(step).T[:, :, None]
    with np.errstate(invalid="ignore", over="ignore"):
        value = largest_along(lower[:, 0] - corner, upper[:, 0] - corner, normal)
        u, v, uu, uvs, vv = (
            _times_bound(largest_along(lower[:, k], upper[:, k], normal), times)
            for k, times in zip(range(1, 6), (a, b, a * a, a * b, b * b))
        )
        bent = half[:, None] * along + 0.5 * half[:, None] ** 2 * (uu + 2.0 * uvs + vv)
        bound = np.fmin(value, height + np.fmin(half[:, None] * (u + v), bent))
    bound[np.isnan(bound)] = np.inf
    distance = np.linalg.norm(height, axis=1)
    far = np.flatnonzero(distance > pieces.tolerance[piece])
    order = far[np.argsort(distance[far], kind="stable")]
    pieces.reached[piece[order]], pieces.place[piece[order]] = distance[order], middle[order]
    return np.linalg.norm(bound, axis=1)


def _times_bound(bound: NDArray, times: NDArray) -> NDArray:
    """Along a side of the domain one of the variables stands still: infinity times 0 is 0."""
    return np.where(times == 0.0, 0.0, bound * times)
