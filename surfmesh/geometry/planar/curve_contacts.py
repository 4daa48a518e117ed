"""Where curves of the plane come together, decided on the curves and not on polygons of them.

a ---.___         Pieces of curves are halved for as long as the fat line around one meets
         `--x     that around another: what is left is where the curves meet. Curves that
b ------'  /      lie on each other would be halved for ever; where many pieces of them are
          /       left, points of one next to the other tell.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

MOST_LEVELS = 48
"""Halvings: after so many a piece is shorter than the last place of its parameter."""

MANY = 96
"""Pieces of one curve near another, from which on they may lie on each other."""

MOST_PAIRS = 100_000
"""Pairs of pieces at a time; beyond, what is undecided is given up."""

FAT, LOOKED_AT, STEPS = 2.0, 7, 8
"""Width of a piece, of its measured bulge; places that are looked at along a stretch; steps
to the foot of a point."""

RECENT = 16
"""Contacts that a further pair of pieces may belong to, in their order along a curve."""

LONG = 1e4
"""Times the reach: straight pieces that are near each other for so long lie on each other."""


@dataclass(frozen=True)
class PlaneCurve:
    """evaluate: fractions (n,) from 0 to 1 -> points (n, 2). pieces: in which it hardly bends, 1
    for a straight line."""

    evaluate: Callable[[np.ndarray], np.ndarray]
    pieces: int


@dataclass(frozen=True)
class Contact:
    """Two curves (numbers, the smaller first) that meet; the fractions of both, from and to."""

    curves: tuple[int, int]
    fractions: tuple[tuple[float, float], tuple[float, float]]
    stretch: bool
    """They lie on each other there, rather than meet in a point."""


@dataclass
class _Pieces:
    """Pieces of curves: whose, from and to which fraction, ends and how far they bulge."""

    curve: np.ndarray  # (s,)
    t: np.ndarray  # (s, 2)
    ends: np.ndarray  # (s, 2 ends, 2)
    middle: np.ndarray  # (s, 2)

    @property
    def bulge(self) -> np.ndarray:
        return FAT * np.linalg.norm(self.middle - self.ends.mean(axis=1), axis=1)

    def halves(self, rows: np.ndarray, curves: Sequence[PlaneCurve]) -> _Pieces:
        """Of these pieces: first halves, then second halves."""
        t0, t1 = self.t[rows].T
        middle = 0.5 * (t0 + t1)
        t = np.concatenate([np.stack([t0, middle], 1), np.stack([middle, t1], 1)])
        start, end = self.ends[rows].transpose(1, 0, 2)
        at = self.middle[rows]
        ends = np.concatenate([np.stack([start, at], 1), np.stack([at, end], 1)])
        curve = np.tile(self.curve[rows], 2)
        return _Pieces(curve, t, ends, _evaluated(curves, curve, t.mean(axis=1)))


def contacts(curves: Sequence[PlaneCurve], reach: np.ndarray) -> list[Contact]:
    """All places where two curves, or parts of one, come within reach (c,) of each other.

    Neighbouring pieces of one curve are not compared.
    """
    pieces, found = _cut(curves), []
    pairs = _neighbours(pieces, reach, curves)
    for _ in range(MOST_LEVELS):
        near = reach[pieces.curve[pairs]].max(axis=1)
        bulge = pieces.bulge
        distance = _distance(pieces.ends[pairs[:, 0]], pieces.ends[pairs[:, 1]])
        kept = distance <= bulge[pairs].sum(axis=1) + near
        pairs, near = pairs[kept], near[kept]
        done = bulge[pairs].sum(axis=1) <= 0.25 * near
        found.append(_rows(pieces, pairs[done], near[done]))
        pairs = pairs[~done]
        if not len(pairs) or len(pairs) > MOST_PAIRS:
            break
        stretches, pairs = _stretches(pieces, pairs, curves, reach)
        found.append(stretches)
        pieces, pairs = _halved(pieces, pairs, curves, reach)
    return _clustered(np.concatenate(found))


def closest(curve: PlaneCurve, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fractions (n,) of the nearest places of a curve to points (n, 2), and the distances (n,)."""
    t = np.linspace(0.0, 1.0, 8 * curve.pieces + 1)
    line = curve.evaluate(t)
    step = line[1:] - line[:-1]
    square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-300)
    along = np.einsum("nij,ij->ni", points[:, None] - line[None, :-1], step) / square
    along = np.clip(along, 0.0, 1.0)
    foot = line[None, :-1] + along[..., None] * step
    best = np.linalg.norm(points[:, None] - foot, axis=2).argmin(axis=1)
    fraction = t[best] + along[np.arange(len(points)), best] * (t[1] - t[0])
    width = np.full(len(points), t[1] - t[0])
    for _ in range(STEPS):  # secants of the curve on both sides of the foot
        low, high = np.clip(fraction - width, 0.0, 1.0), np.clip(fraction + width, 0.0, 1.0)
        way = curve.evaluate(high) - curve.evaluate(low)
        speed = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
        to_curve = points - curve.evaluate(fraction)
        ahead = np.einsum("ij,ij->i", to_curve, way) / speed * (high - low)
        fraction = np.clip(fraction + np.clip(ahead, -width, width), 0.0, 1.0)
        width *= 0.25
    return fraction, np.linalg.norm(points - curve.evaluate(fraction), axis=1)


def _cut(curves: Sequence[PlaneCurve]) -> _Pieces:
    count = np.array([curve.pieces for curve in curves])
    lines = [curve.evaluate(np.linspace(0.0, 1.0, n + 1)) for curve, n in zip(curves, count)]
    t = [np.linspace(0.0, 1.0, n + 1) for n in count]
    curve = np.repeat(np.arange(len(curves)), count)
    spans = np.concatenate([np.stack([s[:-1], s[1:]], axis=1) for s in t])
    ends = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    return _Pieces(curve, spans, ends, _evaluated(curves, curve, spans.mean(axis=1)))


def _evaluated(curves: Sequence[PlaneCurve], which: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Points (n, 2) of the curves (n,) at fractions (n,)."""
    points = np.empty((len(t), 2))
    order = np.argsort(which, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(which[order])) + 1):
        if len(rows):
            points[rows] = curves[which[rows[0]]].evaluate(t[rows])
    return points


def _neighbours(pieces: _Pieces, reach: np.ndarray, curves: Sequence[PlaneCurve]) -> np.ndarray:
    """Pairs (n, 2) of pieces whose boxes meet, without neighbours on one curve."""
    room = (pieces.bulge + reach[pieces.curve])[:, None]
    low, high = pieces.ends.min(axis=1) - room, pieces.ends.max(axis=1) + room
    boxes = shapely.box(*low.T, *high.T)
    pairs = shapely.STRtree(boxes).query(boxes).T
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    first, second = pieces.curve[pairs].T
    beside = (first == second) & (
        (pairs[:, 1] - pairs[:, 0] == 1)
        | ((pieces.t[pairs[:, 0], 0] == 0.0) & (pieces.t[pairs[:, 1], 1] == 1.0))
    )
    return pairs[~beside]


def _distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Between segments (n, 2 ends, 2), zero where they cross."""
    a, b, c, d = one[:, 0], one[:, 1], other[:, 0], other[:, 1]

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return (q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0])

    def to_curve(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        way = r - q
        square = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
        t = np.clip(np.einsum("ij,ij->i", p - q, way) / square, 0.0, 1.0)
        return np.linalg.norm(p - q - t[:, None] * way, axis=1)

    crosses = (side(a, b, c) * side(a, b, d) < 0.0) & (side(c, d, a) * side(c, d, b) < 0.0)
    distance = np.minimum.reduce(
        [to_curve(a, c, d), to_curve(b, c, d), to_curve(c, a, b), to_curve(d, a, b)]
    )
    return np.where(crosses, 0.0, distance)


def _halved(
    pieces: _Pieces, pairs: np.ndarray, curves: Sequence[PlaneCurve], reach: np.ndarray
) -> tuple[_Pieces, np.ndarray]:
    """The pieces of the pairs, those that bulge in halves, and the pairs of them."""
    rows, place = np.unique(pairs, return_inverse=True)
    place = place.reshape(-1, 2)
    split = pieces.bulge[rows] > 0.1 * reach[pieces.curve[rows]]
    halves = pieces.halves(rows[split], curves)
    whole = rows[~split]
    n, many = len(whole), int(split.sum())
    child = np.empty((len(rows), 2), np.int64)
    child[~split] = np.arange(n)[:, None]
    child[split] = n + np.arange(many)[:, None] + np.array([0, many])
    fresh = _Pieces(
        np.concatenate([pieces.curve[whole], halves.curve]),
        np.concatenate([pieces.t[whole], halves.t]),
        np.concatenate([pieces.ends[whole], halves.ends]),
        np.concatenate([pieces.middle[whole], halves.middle]),
    )
    first, second = child[place[:, 0]], child[place[:, 1]]
    count = len(fresh.curve)
    both = np.unique(first[:, [0, 0, 1, 1]] * count + second[:, [0, 1, 0, 1]])
    return fresh, np.stack(np.divmod(both, count), axis=1)


def _rows(pieces: _Pieces, pairs: np.ndarray, near: np.ndarray) -> np.ndarray:
    """(n, 7): two curves, the fractions of both from and to, whether they lie on each other.

    Pieces are taken for straight; near: (n,) how near is a contact.
    """
    pairs = _ordered(pieces, pairs)
    one, other = pieces.ends[pairs[:, 0]], pieces.ends[pairs[:, 1]]
    first, second = _overlap(one, other, near), _overlap(other, one, near)
    length = np.minimum(
        np.ptp(first, axis=1) * np.linalg.norm(one[:, 1] - one[:, 0], axis=1),
        np.ptp(second, axis=1) * np.linalg.norm(other[:, 1] - other[:, 0], axis=1),
    )
    straight = pieces.bulge[pairs].max(axis=1, initial=0.0) <= 1e-3 * near
    t = pieces.t[pairs]
    first = t[:, 0, :1] + first * np.diff(t[:, 0], axis=1)
    second = t[:, 1, :1] + second * np.diff(t[:, 1], axis=1)
    stretch = straight & (length > LONG * near)
    return np.column_stack([pieces.curve[pairs], first, second, stretch])


def _ordered(pieces: _Pieces, pairs: np.ndarray) -> np.ndarray:
    """The pairs with the piece of the smaller curve first."""
    swap = pieces.curve[pairs[:, 0]] > pieces.curve[pairs[:, 1]]
    return np.where(swap[:, None], pairs[:, ::-1], pairs)


def _overlap(one: np.ndarray, other: np.ndarray, near: np.ndarray) -> np.ndarray:
    """(n, 2) from which to which fraction of segments ``one`` others are near, both (n, 2, 2)."""
    a, way = one[:, 0], one[:, 1] - one[:, 0]
    square = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.sqrt(square)[:, None]
    along = np.einsum("nkj,nj->nk", other - a[:, None], way) / square[:, None]
    height = np.einsum("nkj,nj->nk", other - a[:, None], across)
    rise = height[:, 1] - height[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):  # where the other is as high as +-near
        steps = (np.stack([-near, near], axis=1) - height[:, :1]) / rise[:, None]
    steps = np.where(np.abs(rise)[:, None] > 1e-3 * near[:, None], steps, [0.0, 1.0])
    found = along[:, :1] + np.clip(steps, 0.0, 1.0) * (along[:, 1:] - along[:, :1])
    return np.sort(np.clip(found, 0.0, 1.0), axis=1)


def _stretches(
    pieces: _Pieces, pairs: np.ndarray, curves: Sequence[PlaneCurve], reach: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (see ``_rows``) of curves that lie on each other, and the pairs of all others."""
    curve = np.sort(pieces.curve[pairs], axis=1)
    key = curve[:, 0] * len(curves) + curve[:, 1]
    found, kept = [np.empty((0, 7))], np.ones(len(pairs), bool)
    for one, count in zip(*np.unique(key, return_counts=True)):
        first, second = divmod(int(one), len(curves))
        if count < MANY or first == second:
            continue
        here = np.flatnonzero(key == one)
        t = pieces.t[_ordered(pieces, pairs[here])[:, 0]]
        order = np.argsort(t[:, 0], kind="stable")
        t, here = t[order], here[order]
        gap = t[1:, 0] > np.maximum.accumulate(t[:, 1])[:-1] + 1e-12
        for group in np.split(np.arange(len(t)), np.flatnonzero(gap) + 1):
            low, high = t[group, 0].min(), t[group, 1].max()
            looked = low + (high - low) * np.linspace(0.2, 0.8, LOOKED_AT)
            fraction, distance = closest(curves[second], curves[first].evaluate(looked))
            near = max(reach[first], reach[second])
            if len(group) >= MANY and (distance <= near).all() and np.ptp(fraction) > 0.0:
                ends = closest(curves[second], curves[first].evaluate(np.array([low, high])))[0]
                found.append(np.array([[first, second, low, high, ends.min(), ends.max(), 1.0]]))
                kept[here[group]] = False
    return np.concatenate(found), pairs[kept]


def _clustered(rows: np.ndarray) -> list[Contact]:
    """Rows (see ``_rows``) that go on from each other are one contact."""
    rows = rows[np.lexsort((rows[:, 4], rows[:, 2], rows[:, 1], rows[:, 0]))]
    groups: list[list[float]] = []
    for row in rows.tolist():
        for group in reversed(groups[-RECENT:]):
            if _goes_on(group, row):
                for k, choice in ((2, min), (3, max), (4, min), (5, max), (6, max)):
                    group[k] = choice(group[k], row[k])
                break
        else:
            groups.append(row)
    return [
        Contact((int(g[0]), int(g[1])), ((g[2], g[3]), (g[4], g[5])), bool(g[6])) for g in groups
    ]


def _goes_on(group: list[float], row: list[float]) -> bool:
    """Are both of the same curves, and next to each other on both?"""
    one, other, a0, a1, b0, b1, _ = group
    return (
        (one == row[0] and other == row[1])
        and (row[2] <= a1 + 1e-12 and row[3] >= a0 - 1e-12)
        and (row[4] <= b1 + 1e-12 and row[5] >= b0 - 1e-12)
    )
