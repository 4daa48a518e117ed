"""The order of the optimiser's steps; what each does is in kernels.optimisation.optimisation.

    swap -> smooth -> degrees -> smooth -> swap -> collapse, split -> ... -> smooth until still

Between any two of them the vertices that moved are put back on the true surface.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from surfmesh.accuracy.deviation import CHORD_MARGIN, interpolated, triangle_deviations
from surfmesh.accuracy.dihedral import (
    SLACK,
    corners_beside,
    dihedral_angles,
    on_crease,
)
from surfmesh.accuracy.folds import cosines_with_surface, sharp_radius
from surfmesh.accuracy.samples import CENTROID
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.differential.sharp_bends import bends_sharply
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.optimisation.dihedral import find_dihedrals_over, lower_sizes
from surfmesh.kernels.optimisation.optimisation import (
    activate_bad,
    collapse_short,
    estimate_deviations,
    find_folded,
    find_stars,
    shrink,
    smooth,
    split_far,
    split_long,
    swap_for_degree,
    swap_for_shape,
    triangles_at,
)
from surfmesh.kernels.optimisation.surface_frames import SurfaceFrames, empty_frames, set_frames
from surfmesh.kernels.triangulation.local_operations import DEAD
from surfmesh.kernels.triangulation.triangulation import Triangulation
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.defaults import FINEST_BY_ANGLE, LEAST_OF_CHORD
from surfmesh.sizing.rules.size_limits import SizeLimits

STIFFNESS = 2.0
"""Weight of unit edges against good shapes: 1 gives better shapes, 4 better lengths."""

SHORTEST, LONGEST = 0.66, 1.45
"""Metric lengths beyond which an edge is collapsed or split."""

FEW = 4
"""An interior vertex with at most this many triangles is removed."""

LEAST_FOR_DEGREE = 0.4
"""Worst alpha that a swap for the sake of degrees may leave to the smoothing that follows."""

ROUNDS = 2
FINAL_PASSES = 2
SWEEPS = 8

GOOD_SHAPE = 0.82
"""Triangles above this alpha keep their edges."""

LEFT_OVER = 0.7
"""Triangles below this alpha are what packing or boundary have left over."""

BAD_SHAPE = 0.72
"""Triangles below this alpha get passes of their own, with a soft wish for unit edges."""

SOFT, SOFTER = 0.3, 0.6
RESCUE_PASSES, SOFT_PASSES = 4, 4

SUSPECT = 0.7
"""Share of ``chord`` from which the estimate of a triangle's deviation is not trusted."""

FEW_TRIANGLES, FLAT = 20_000, 1e-9
"""Up to so many all are measured whose estimate is no round-off, as a share of ``chord``: the
estimate is for triangles small beside the features."""

TURNED, LEAST_AT_CENTRE, LEAST_COSINE = 0.85, 0.55, 0.35
"""Cosines between the normals of a triangle and of the surface: where it is looked at again,
what is folded at the centroid, and at a corner."""

MANY_FAR = 0.02
"""Share of the triangles."""

FINER_UNFOLDS = 0.6
"""Factor on the sizes where triangles are folded."""

CHORD_ROUNDS, STRETCHED_CHORD_ROUNDS, SPLIT_ROUNDS = 10, 4, 6
TOLERATED, SPLIT_MARGIN = 0.995, 0.98
"""What is let pass rather than go all the way round again. Between the
samples of a triangle the deviation may be a little larger than at them."""

ANGLE_ROUNDS, LAST_ANGLE_ROUNDS, TURN_SPLITS = 6, 4, 4
ANGLE_MARGIN, ANGLE_SLACK = 0.97, 1.0 + SLACK
"""What is aimed at, at last no more than what was asked for; and what is rounding."""

NEAR_ANGLE = 0.7
"""Share of ``angle`` from which edges of a seam are made finer when others turn too far: cut
anew, it would be other edges that do."""

LEAST_TURN_SHRINK, LEAST_TURN_SCALE, LAST_TURN_SCALE = 0.85, 0.6, 0.3
"""Least factor on the sizes in one round, in all, and in the last rounds for a few places."""

BESIDE_KINK, _AROUND = 1e-6, ((1, 0.4), (-1, -0.4), (0.4, -1), (-0.4, 1))
"""Of the domain: how far from a kink its two sides are looked at, and in which directions."""

LONGEST_TURNED = 1.25
"""Edges of stretched meshes that turn too far are split from this length: they are not many,
and smoothing alone mends none."""


@dataclass(frozen=True)
class Turned:
    """Edges across which triangles turn by more than ``angle``, though the surface does not."""

    triangles: np.ndarray
    """(k, 2) on both sides."""
    angles: np.ndarray
    """(k,) radians."""

    def __len__(self) -> int:
        return len(self.angles)


@dataclass(frozen=True)
class Changes:
    """What the optimiser did."""

    swaps: int
    collapses: int
    splits: int
    passes: int
    far: np.ndarray
    """Triangles still farther than ``chord`` from the surface."""
    folded: np.ndarray
    """Triangles turned far from the surface's normals."""
    turned: Turned


class Optimiser:
    """A triangulated domain with its embedding; ``run`` changes it in place."""

    before_pass: Callable[[], None] = staticmethod(lambda: None)
    """Called before each pass: may raise to stop the work."""

    def __init__(
        self, t: Triangulation, node: np.ndarray, same: np.ndarray, surface: Surface,
        field: SizeField, creased: np.ndarray | None = None,
    ) -> None:  # fmt: skip
        """``node`` (k,) are boundary vertices, ``same`` (k,) the ones they coincide with.

        creased: (j,) vertices on kinks, where the surface has two normals.
        """
        self.t, self.node, self.surface, self.field = t, node, surface, field
        self.creased = node[:0] if creased is None else creased
        self.same = same
        room = len(t.xy)
        self.is_anisotropic = field.is_anisotropic
        self.embedding: SurfaceFrames = empty_frames(room, self.is_anisotropic)
        self.star = np.empty(room, np.int32)
        self.frozen = np.empty(room, np.uint8)
        self.degree = np.empty(room, np.int32)
        self.active = np.ones(room, np.uint8)
        self.dirty = np.ones(room, np.uint8)
        self.stars_known = False
        self.moved = np.empty(room, np.int32)
        self.shape = np.ones(len(t.tri) // 3)
        self.swaps = self.collapses = self.splits = self.passes = 0
        self._embed(np.arange(int(t.count[0]), dtype=np.int32))
        if len(self.creased):
            self._embed(self.creased.astype(np.int32), creased=True)
        self.embedding.point[node] = self.embedding.point[same]  # equal to the last bit

    def run(self, first: bool = True) -> Changes:
        """Optimise; what is good already is left alone.

        first: the sizes come from no earlier round, and one with finer sizes may follow.
        """
        self._swap()
        for round_number in range(ROUNDS):
            self._smooth()
            self._swap_for_degree()
            self._smooth()
            self._swap()
            if round_number + 1 < ROUNDS:
                self._collapse()
                self._split()
        for _ in range(FINAL_PASSES):
            if self._smooth() == 0:
                break
        self._swap()
        self._rescue()
        if not self.is_anisotropic:  # it leaves all vertices moving, and triangles turning
            self._soften()
        self._straighten()
        far = self._approach(first)
        return Changes(
            self.swaps, self.collapses, self.splits, self.passes, far, self._folded(),
            self._turned(seams=True),
        )  # fmt: skip

    def _folded(self) -> np.ndarray:
        """Triangles turned against the surface's normals at a corner or at the centroid."""
        flag = np.empty(int(self.t.count[1]), np.uint8)
        find_folded(self.t, self.embedding, TURNED, TURNED, flag)
        turned = np.flatnonzero(flag)
        find_folded(self.t, self.embedding, LEAST_COSINE, 0.0, flag)
        if not len(turned):
            return turned
        corners, xy = self._corners(turned)
        _, uv = interpolated(self.field.chart, corners, xy, CENTROID[0])
        away = cosines_with_surface(self.surface, corners, uv) < LEAST_AT_CENTRE
        at_corner = flag[turned] != 0
        if len(self.creased):  # there a corner has the normal of one side, or of neither
            at_corner &= ~np.isin(self.t.tri.reshape(-1, 3)[turned], self.creased).any(axis=1)
        return turned[away | at_corner]

    def settle(self) -> None:
        """Only choose better diagonals for what the packing and the boundary left over."""
        self._swap(LEFT_OVER)

    def unfolding(self, triangles: np.ndarray) -> SizeLimits:
        """Limits under which the folded ``triangles`` (n,) may unfold.

        None where the surface itself turns over, or bends sharply: no size is small enough.
        """
        least = LEAST_OF_CHORD * (self.field.sizing.chord or 0.0)
        radius = sharp_radius(self.field.sizing.chord, self._diagonal())
        smooth = ~bends_sharply(self.surface, self._parameters(triangles), radius)
        return self._limits_at(triangles[smooth], FINER_UNFOLDS, least)

    def approaching(self, triangles: np.ndarray) -> SizeLimits:
        """Limits under which ``triangles`` (n,) would come to lie within ``chord``."""
        chord = self.field.sizing.chord
        factor = np.clip(np.sqrt(CHORD_MARGIN * chord / self._deviations(triangles)), 0.5, 0.8)
        return self._limits_at(triangles, factor, 2.0 * chord)

    def straightening(self, turned: Turned) -> SizeLimits:
        """Limits under which triangles would turn by no more than ``angle``."""
        factor = np.clip(self._angle_limit(ANGLE_MARGIN) / turned.angles, 0.5, 0.85)
        least = FINEST_BY_ANGLE * self._diagonal()
        return self._limits_at(turned.triangles.ravel(), np.repeat(factor, 2), least)

    def _limits_at(
        self, triangles: np.ndarray, factor: np.ndarray | float, least: float
    ) -> SizeLimits:
        """The field's sizes at the corners of ``triangles`` (n,) times ``factor``.

        Only where that is smaller than now: not below ``least``, which no mesh needs, nor
        below ``min_size``.
        """
        least = max(least, self.field.sizing.min_size or 0.0)
        corners = self.t.tri.reshape(-1, 3)[triangles]
        chosen, place = np.unique(corners, return_inverse=True)
        smallest = np.ones(len(chosen))  # factor of all triangles at a corner
        wanted = np.broadcast_to(np.asarray(factor).reshape(-1, 1), corners.shape)
        np.minimum.at(smallest, place.ravel(), wanted.ravel())
        now = self.embedding.size[chosen] / self.embedding.scale[chosen]
        sizes = np.maximum(smallest * now, least)
        finer = sizes < 0.97 * now
        chosen, now, sizes = chosen[finer], now[finer], sizes[finer]
        limits = SizeLimits(self.embedding.point[chosen], sizes, self.field.sizing.gradient)
        if not self.is_anisotropic:
            return limits
        shrunk = self.embedding.scale[chosen] * now / sizes
        return replace(
            limits,
            uv=self.field.chart.to_uv(self.t.xy[chosen]),
            metric_root_3d=self.embedding.metric_root_3d[chosen] * shrunk[:, None],
        )

    def _rescue(self) -> None:
        """Passes for the worst triangles alone."""
        self.active[:] = 0
        for _ in range(RESCUE_PASSES):
            if activate_bad(self.t, self.embedding, BAD_SHAPE, self.active) == 0:
                break
            self._smooth(SOFT)
            self._swap()

    def _soften(self) -> None:
        """Last passes over all vertices, for shapes more than for unit edges."""
        self.active[:] = self.dirty[:] = 1
        for _ in range(SOFT_PASSES):
            if self._smooth(SOFTER) == 0:
                break
        self._swap()
        self._smooth(SOFTER)

    def _angle_limit(self, margin: float) -> float:
        return margin * math.radians(self.field.sizing.angle)

    def _diagonal(self) -> float:
        """Of the box of all vertices, model units."""
        return diagonal(self.embedding.point[: int(self.t.count[0])])

    def _straighten(self) -> None:
        """Lower the sizes where neighbouring triangles turn by more than ``angle``."""
        if self.field.sizing.angle is None:
            return
        limit = self._angle_limit(ANGLE_MARGIN)
        longest = LONGEST_TURNED if self.is_anisotropic else LONGEST
        smoothed = ANGLE_ROUNDS + (0 if self.is_anisotropic else LAST_ANGLE_ROUNDS)
        for round_number in range(smoothed + TURN_SPLITS):
            last = round_number >= ANGLE_ROUNDS
            turned = self._turned(ANGLE_SLACK if last else ANGLE_MARGIN)
            if not (turned.angles > self._angle_limit(ANGLE_SLACK)).any():
                return
            if round_number >= smoothed:  # as they are smoothed others begin to turn too far
                self._split_worst(np.unique(turned.triangles))
                continue
            factor = np.ones(len(self.active))
            corners = self.t.tri.reshape(-1, 3)[turned.triangles].reshape(len(turned), 6)
            wanted = np.maximum(limit / turned.angles, LEAST_TURN_SHRINK)
            np.minimum.at(factor, corners, wanted[:, None])
            some = np.flatnonzero(factor < 1.0).astype(np.int32)
            smallest = LAST_TURN_SCALE if last else LEAST_TURN_SCALE
            lower_sizes(self.embedding, some, factor[some], smallest, self.active)
            self._split(longest)
            for _ in range(2):
                self._smooth()
            self._swap()

    def _turned(self, margin: float = ANGLE_SLACK, seams: bool = False) -> Turned:
        """Edges that turn by more than ``margin`` times ``angle``; across seams too, if asked."""
        if self.field.sizing.angle is None:
            return Turned(np.empty((0, 2), np.int64), np.empty(0))
        limit = self._angle_limit(margin)
        room = 3 * int(self.t.count[1]) // 2 + 1
        edges, angles = np.empty(room, np.int64), np.empty(room)
        count = find_dihedrals_over(self.t, self.embedding.point, limit, edges, angles)
        pairs = np.stack([edges[:count], self.t.adj[edges[:count]]], axis=1)
        angles = angles[:count]
        if seams:
            across, turn = self._across_seams()
            near = turn > NEAR_ANGLE * limit
            pairs, angles = np.concatenate([pairs, across[near]]), np.r_[angles, turn[near]]
        if not len(pairs):
            return Turned(pairs, angles)
        corner = self.t.tri[corners_beside(pairs)]
        uv = self.field.chart.to_uv(self.t.xy[corner.ravel()]).reshape(*corner.shape, 2)
        bent = on_crease(
            self.surface, self._numbers()[corner], uv, self.field.sizing.angle, self._diagonal()
        )
        kept = ~bent
        if not (kept[count:] & (angles[count:] > limit)).any():
            kept[count:] = False  # of seams that are fine as they are
        return Turned(pairs[kept] // 3, angles[kept])

    def _parameters(self, triangles: np.ndarray) -> np.ndarray:
        """(k, 3, 2) of the corners of triangles (k,)."""
        corners = self.t.tri.reshape(-1, 3)[triangles]
        return self.field.chart.to_uv(self.t.xy[corners.ravel()]).reshape(-1, 3, 2)

    def _numbers(self) -> np.ndarray:
        """For each vertex the one that it coincides with, or itself."""
        number = np.arange(int(self.t.count[0]))
        number[self.node] = self.same
        return number

    def _across_seams(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of half-edges (k, 2) that are glued, at poles too, and the angles (k,)."""
        tri, adj = (a[: 3 * self.t.count[1]] for a in (self.t.tri, self.t.adj))
        border = np.flatnonzero((adj < 0) & np.repeat(self.t.region[: self.t.count[1]] != DEAD, 3))
        number = self._numbers()
        corners = number[tri].reshape(-1, 3)
        # beyond a triangle with two corners at a pole, which is an edge, lies the next one
        flat = (corners == np.roll(corners, 1, axis=1)).any(axis=1)
        beyond = adj.reshape(-1, 3)[flat & (self.t.region[: len(flat)] != DEAD)].ravel()
        border = np.concatenate([border, beyond[beyond >= 0]])
        border = border[~flat[border // 3]]
        end = np.where(border % 3 == 2, border - 2, border + 1)
        ends = np.sort(np.stack([number[tri[border]], number[tri[end]]], axis=1), axis=1)
        real = ends[:, 0] != ends[:, 1]  # not a side that is one point
        border, ends = border[real], ends[real]
        order = np.lexsort(ends.T)
        border, ends = border[order], ends[order]
        twice = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
        pairs = np.stack([border[twice], border[twice + 1]], axis=1).reshape(-1, 2)
        triangles = self.t.tri.reshape(-1, 3)
        return pairs, dihedral_angles(self.embedding.point, triangles, pairs.astype(np.int32))

    def _approach(self, first: bool) -> np.ndarray:
        """Bring triangles that are too far from the surface nearer; returns those left.

        An estimate from the tangent planes picks the suspects, samples on the true surface
        decide; afterwards only triangles that have changed are looked at again.
        """
        chord = self.field.sizing.chord
        if chord is None:
            return np.empty(0, np.int64)
        limit = CHORD_MARGIN * chord
        estimate = np.empty(int(self.t.count[1]))
        estimate_deviations(self.t, self.embedding, estimate)
        least = (SUSPECT if len(estimate) > FEW_TRIANGLES else FLAT) * chord
        suspects = np.flatnonzero(estimate > least)
        for _ in range(STRETCHED_CHORD_ROUNDS if self.is_anisotropic else CHORD_ROUNDS):
            if not len(suspects):
                return suspects
            error = self._deviations(suspects)
            if shrink(self.t, self.embedding, suspects, error, limit, self.active) == 0:
                break
            before = self.t.tri[: 3 * self.t.count[1]].copy()
            changed = np.zeros(len(self.active), np.uint8)
            self._split()
            for _ in range(2):
                moved = self._smooth()
                changed[self.moved[:moved]] = 1
            self._swap()
            suspects = np.union1d(self._changed_since(before, changed), suspects[error > limit])
        error = self._deviations(suspects)
        if self.is_anisotropic:
            return self._split_far(suspects[error > SPLIT_MARGIN * chord], first)
        return suspects[error > TOLERATED * chord]

    def _split_far(self, far: np.ndarray, first: bool) -> np.ndarray:
        """Split edges of the triangles ``far`` (n,) where they are too far; returns those left.

        Smoothing and swaps do not know how far a triangle is, and in stretched meshes turn it
        more: the last few are only split. Where many are far in the first round a finer field
        needs fewer triangles than splits: then all are returned. Later it would be asked for
        again and again.
        """
        limit = SPLIT_MARGIN * self.field.sizing.chord
        many = far if first and len(far) > MANY_FAR * int(self.t.count[1]) else None
        for _ in range(SPLIT_ROUNDS):
            before = self.t.tri[: 3 * self.t.count[1]].copy()
            if not self._split_worst(far):
                break
            changed = np.zeros(len(self.active), np.uint8)
            suspects = np.union1d(self._changed_since(before, changed), far)
            far = suspects[self._deviations(suspects) > limit]
        return far if many is None else many

    def _split_worst(self, triangles: np.ndarray) -> int:
        """Split the edge of each of the triangles (n,) that lies farthest away; returns how many.

        All other vertices stay where they are.
        """
        first = split_far(self.t, self.embedding, triangles, self.dirty, self.active)
        new = np.arange(first, int(self.t.count[0]), dtype=np.int32)
        if len(new):
            self._embed(new)
            self.stars_known = False
            self.splits += len(new)
        return len(new)

    def _changed_since(self, before: np.ndarray, changed: np.ndarray) -> np.ndarray:
        """Triangles with a vertex in ``changed``, or whose corners are not as ``before``."""
        now = self.t.tri[: 3 * self.t.count[1]]
        changed[now[: len(before)][now[: len(before)] != before]] = 1
        changed[now[len(before) :]] = 1
        seen = np.empty(int(self.t.count[1]), np.uint8)
        triangles_at(self.t, changed, seen)
        return np.flatnonzero(seen)

    def _deviations(self, triangles: np.ndarray) -> np.ndarray:
        """Largest distance from the surface at samples of each of the triangles (n,)."""
        corners, xy = self._corners(triangles)
        chord = self.field.sizing.chord
        return triangle_deviations(self.surface, self.field.chart, corners, xy, chord)

    def _corners(self, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n, 3, 3) in space and (n, 3, 2) in the scaled plane."""
        corners = self.t.tri.reshape(-1, 3)[triangles]
        return self.embedding.point[corners], self.t.xy[corners]

    def _mean_slopes(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r_u and r_v (n, 3) on kinks at uv (n, 2): the mean of what they are around.

        With the normal of one side, triangles of the other would seem to be turned over.
        """
        low, high = np.array(self.surface.domain).T
        step = BESIDE_KINK * (high - low)
        around = [np.clip(uv + step * np.array(way), low, high) for way in _AROUND]
        slopes = [self.surface.evaluate(place, 1)[1:] for place in around]
        return sum(s[0] for s in slopes) / len(slopes), sum(s[1] for s in slopes) / len(slopes)

    def _embed(self, vertices: np.ndarray, creased: bool = False) -> None:
        """Put vertices (n,) back on the surface, with their exact metric."""
        block = 1 << 15
        chart = self.field.chart
        largest = 1e3 * float(self.field.background.box[4]) / float(chart.extent.max())
        for start in range(0, len(vertices), block):
            some = vertices[start : start + block]
            uv, rates = chart.to_uv_and_rates(self.t.xy[some])
            r, ru, rv = self.surface.evaluate(uv, 1)
            if creased:
                ru, rv = self._mean_slopes(uv)
            ru *= rates[:, :1]
            rv *= rates[:, 1:]
            set_frames(self.t, self.embedding, self.field.background, some, r, ru, rv, largest)

    def _find_stars(self) -> None:
        if not self.stars_known:
            find_stars(self.t, self.star, self.frozen, self.degree)
            self.frozen[self.node] = 1
            self.stars_known = True

    def _smooth(self, stiffness: float = STIFFNESS) -> int:
        self.before_pass()
        self._find_stars()
        moved = smooth(
            self.t, self.embedding, self.field.background,
            self.star, self.frozen, self.active, self.dirty, stiffness, self.moved,
        )  # fmt: skip
        self._embed(self.moved[:moved])
        self.passes += 1
        return moved

    def _swap(self, good: float = GOOD_SHAPE) -> None:
        swaps = swap_for_shape(
            self.t, self.embedding, self.shape, self.dirty, self.active, good, SWEEPS
        )
        self.stars_known = self.stars_known and swaps == 0
        self.swaps += swaps

    def _swap_for_degree(self) -> None:
        self._find_stars()
        swaps = swap_for_degree(
            self.t, self.embedding, self.frozen, self.degree, self.dirty, self.active,
            LEAST_FOR_DEGREE,
        )  # fmt: skip
        self.stars_known = self.stars_known and swaps == 0
        self.swaps += swaps

    def _collapse(self) -> None:
        self._find_stars()
        collapses = collapse_short(
            self.t, self.embedding, self.star, self.frozen, self.degree, self.dirty,
            self.active, SHORTEST, FEW,
        )  # fmt: skip
        self.stars_known = self.stars_known and collapses == 0
        self.collapses += collapses

    def _split(self, longest: float = LONGEST) -> None:
        first = split_long(self.t, self.embedding, longest, self.dirty, self.active)
        new = np.arange(first, int(self.t.count[0]), dtype=np.int32)
        self._embed(new)
        self.stars_known = self.stars_known and len(new) == 0
        self.splits += len(new)
