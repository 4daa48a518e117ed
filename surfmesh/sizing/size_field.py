"""The size field of one surface: from its curvature and the user's wishes to a background.

The background is built level by level. Every cell carries nine nodes (see kernels.gradation);
at each level the sizes of all nodes are graded together, each cell is compared with its test
nodes, and the cells that miss are split into four. The test nodes of a leaf are kept: they
make the final field twice as fine as the one that was tested.

Samples alone cannot see a feature that lies between them. Where the surface can bound its
derivatives over a cell (formulas can, by interval arithmetic), a cell is split as well while
the bound admits a curvature that would at least halve the size.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfmesh.errors import SizingError
from surfmesh.geometry.fundamental_forms import (
    FundamentalForms,
    curvatures,
    forms_from_derivatives,
)
from surfmesh.geometry.scaling import Scaling
from surfmesh.geometry.sides import SideTopology
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.background import Background, sizes_at
from surfmesh.kernels.coverage import STACK, inverse_area
from surfmesh.kernels.gradation import grade, patch_errors
from surfmesh.sizing.curvature_size import angle_size, chord_size
from surfmesh.sizing.size_limits import SizeLimits
from surfmesh.sizing.sizing import Sizing
from surfmesh.sizing.small_sizes import small_sizes

ROOT_CELLS = 2304
"""About how many cells the search starts with: a smooth surface needs no more."""

DEPTH = 13
"""Most splits of a root cell for accuracy: a leaf may be a 400,000th of the domain."""

GRID_DEPTH = 20
"""Most splits around small sources; also the depth of the finest grid that nodes lie on."""

HIDDEN_DEPTH = 6
"""Splits of a root cell within which features between the samples are looked for."""

TEST_ERROR, GRADED_ERROR = 0.03, 0.1
"""Error at the test nodes that a cell may have; the leaf, twice as fine, has a quarter of it,
or half at a kink. Where gradation decides, the field is a cone and all slopes are small."""

FINEST_EXTENT = 0.2
"""A cell narrower than this many edges is not split: no circle would notice."""

FINEST_GRADED = 1.0
"""The same where sizes are graded from sources, which have cells of their own size already."""

POLE_DISTANCE = 0.9
"""In edges: the first ring of triangles around a pole lies about there."""

DEFAULT_CHORD = 1e-3
DEFAULT_MAX_SIZE = 0.1
"""Wishes that are not stated, relative to the diagonal of the bounding box."""

FINEST_SIZE = 1e-5
"""No size is smaller, relative to the diagonal, unless ``min_size`` says so: at an apex the
curvature is infinite."""

DEFAULT_ANGLE = 45.0
"""Degrees; kept wherever the size follows the curvature at all."""

LEAST_OF_CHORD = 0.5
"""The default angle asks for nothing smaller than this share of ``chord``: an apex is no fold."""

MAX_CELLS = 800_000
MAX_ROUNDS = 60
SWEEPS, MAX_CHUNKS = 16, 400
"""Sweeps of the gradation before the cells are sorted anew, and how often that is done."""


@dataclass(frozen=True)
class SizeField:
    """Wanted sizes on one surface, ready for the kernels.

    ``background`` gives size tensors in the scaled plane of ``scaling``.
    """

    scaling: Scaling
    background: Background
    sizing: Sizing
    """The wishes it was made from, defaults filled in."""

    def expected_vertices(self) -> int:
        """About how many circles cover the domain: its metric area over that of a circle's
        share, sqrt(3) / 2."""
        width, height = self.scaling.extent
        area = inverse_area(self.background, float(width), float(height), np.empty((STACK, 5)))
        return int(area * 2.0 / np.sqrt(3.0)) + 100

    def tensors(self, xy: np.ndarray) -> np.ndarray:
        """Size tensors (n, 3) at points xy (n, 2) of the scaled plane."""
        out = np.empty((len(xy), 3))
        sizes_at(self.background, np.ascontiguousarray(xy), out)
        return out


def size_field(
    surface: Surface,
    sizing: Sizing,
    sides: SideTopology | None = None,
    limits: SizeLimits | None = None,
) -> SizeField:
    """Build the background for ``surface``; ``sides`` tells which sides are joined.

    ``limits``: upper bounds of the size near points, from an earlier round.

    Raises ``SizingError`` when a size law gives something else than positive numbers, or when
    the wanted sizes need an unreasonable number of cells.
    """
    return _Builder(surface, sizing, sides, _SizeLaw(surface, sizing, limits)).build()


def plane_field(
    surface: Surface, tensors: Callable[[np.ndarray], np.ndarray], growth: float
) -> SizeField:
    """The background of size tensors over the box of a plane: ``tensors`` (n, 2) -> (n, 3).

    Raises ``SizingError`` when they need an unreasonable number of cells.
    """
    sizing = Sizing(size=1.0, growth=growth)
    return _Builder(surface, sizing, None, _TensorLaw(surface, sizing, tensors)).build()


class _Builder:
    def __init__(
        self,
        surface: Surface,
        sizing: Sizing,
        sides: SideTopology | None,
        law: "_SizeLaw | _TensorLaw",
    ) -> None:
        self.surface = surface
        self.sides = sides
        self.scaling = law.scaling
        width, height = self.scaling.extent
        self.nx = int(np.clip(round(np.sqrt(ROOT_CELLS * width / height)), 4, ROOT_CELLS // 4))
        self.ny = int(np.clip(round(ROOT_CELLS / self.nx), 4, ROOT_CELLS // 4))
        self.root_step = np.array([width / self.nx, height / self.ny])
        self.law = law
        self.slope = sizing.gradient
        # nodes, in order of creation; their keys also in sorted order
        self.keys = np.empty(0, np.int64)
        self.order = np.empty(0, np.int64)
        self.size = np.empty(0)
        self.wish = np.empty(0)  # the size before gradation
        self.root = np.empty((0, 3))
        self.normal = np.empty((0, 3))
        self.point = np.empty((0, 3))
        self.joined = np.empty((0, 2), np.int64)
        self.changed = np.empty(0, np.int32)  # last sweep of the gradation that lowered a node
        self.sweep = 1  # number of the next one

    def build(self) -> SizeField:
        cells = _Cells.roots(self.nx, self.ny)
        patch = self._patches(cells)
        fresh = np.ones(len(cells), bool)
        total = len(cells)
        seeds = small_sizes(self.surface, self.law.sizing, self.law.limits)
        sources = _SourceCells(*seeds, self.scaling, self.root_step, self.nx)
        tree: list[np.ndarray] = []  # the cells that were split, in the order of their children
        for round_number in range(MAX_ROUNDS + GRID_DEPTH):
            seen = self.sweep
            self._grade(patch)
            touched = fresh | (self.changed[patch].max(axis=1) >= seen)
            split = np.zeros(len(cells), bool)
            split[touched] = self._inaccurate(cells.chosen(touched), patch[touched])
            unseen = fresh & ~split
            split[unseen] = self._may_hide(cells.chosen(unseen), patch[unseen])
            split &= cells.depth < DEPTH
            demanded = sources.split(cells)
            split |= demanded
            # after so many rounds all features are found; a few cells creep along fronts
            few = 0 if round_number <= DEPTH else len(cells) // 1000
            if split.sum() <= few and not demanded.any():
                break
            self._balance(cells, split)
            parents = cells.chosen(split)
            children = parents.split(total)
            tree.append(parents.index)
            total += len(children)
            sources.follow(split)
            if total > MAX_CELLS:
                raise SizingError(
                    f"the sizes asked for on {self.surface.name!r} need more than {MAX_CELLS:,} "
                    "cells to describe: raise min_size or growth"
                )
            fresh = np.concatenate([np.zeros((~split).sum(), bool), np.ones(len(children), bool)])
            patch = np.concatenate([patch[~split], self._patches(children)])
            cells = cells.chosen(~split).joined_with(children)
        self._blunt_poles()
        tree.append(cells.index)  # every leaf is split once more, onto its test nodes
        return SizeField(self.scaling, self._background(tree, patch), self.law.sizing)

    # nodes

    def _patches(self, cells: "_Cells") -> np.ndarray:
        """The nine nodes of each cell (n, 9), creating those that do not exist yet."""
        half = (1 << (GRID_DEPTH - cells.depth)).astype(np.int64)  # in units of the finest grid
        i = np.arange(9)
        x = cells.x[:, None] + half[:, None] * (i % 3)
        y = cells.y[:, None] + half[:, None] * (i // 3)
        wanted = x * self._stride + y
        unique, inverse = np.unique(wanted, return_inverse=True)
        place = np.searchsorted(self.keys, unique)
        known = np.zeros(len(unique), bool)
        inside = place < len(self.keys)
        known[inside] = self.keys[place[inside]] == unique[inside]
        node = np.empty(len(unique), np.int64)
        node[known] = self.order[place[known]]
        new = unique[~known]
        node[~known] = len(self.size) + np.arange(len(new))
        self._create(new)
        return node[inverse].reshape(-1, 9).astype(np.int32)

    @property
    def _stride(self) -> int:
        return (self.ny << (GRID_DEPTH + 1)) + 1

    def _plane(self, keys: np.ndarray) -> np.ndarray:
        """xy (n, 2) of nodes; the far sides of the domain are met exactly."""
        count = np.array([self.nx << (GRID_DEPTH + 1), self.ny << (GRID_DEPTH + 1)])
        index = np.stack([keys // self._stride, keys % self._stride], axis=1)
        return index / count * self.scaling.extent

    def _create(self, keys: np.ndarray) -> None:
        size, wish, root, normal, point = self.law(self._plane(keys))
        self.order = np.concatenate([self.order, len(self.size) + np.arange(len(keys))])
        self.keys = np.concatenate([self.keys, keys])
        sort = np.argsort(self.keys, kind="stable")
        self.keys, self.order = self.keys[sort], self.order[sort]
        self.size = np.concatenate([self.size, size])
        self.wish = np.concatenate([self.wish, wish])
        self.root = np.concatenate([self.root, root])
        self.normal = np.concatenate([self.normal, normal])
        self.point = np.concatenate([self.point, point])
        self.joined = self._joined_nodes()

    def _joined_nodes(self) -> np.ndarray:
        """Pairs of nodes next to each other, or one point in 3D, across joined sides."""
        pairs = [np.empty((0, 2), np.int64)]
        if self.sides is None or max(self.sides.partner) < 0:
            return pairs[0]
        ends = (self.nx << (GRID_DEPTH + 1), self.ny << (GRID_DEPTH + 1))
        x, y = self.keys // self._stride, self.keys % self._stride
        on_side = [y == 0, x == ends[0], y == ends[1], x == 0]
        along = [x / ends[0], y / ends[1], x / ends[0], y / ends[1]]
        for a, b in enumerate(self.sides.partner):
            if b < a:  # none, or seen from the other side
                continue
            ta, tb = along[a][on_side[a]], along[b][on_side[b]]
            tb = 1.0 - tb if self.sides.reversed[a] else tb
            node_a, node_b = self.order[on_side[a]], self.order[on_side[b]]
            for t, node, other_t, other in ((ta, node_a, tb, node_b), (tb, node_b, ta, node_a)):
                sort = np.argsort(other_t)
                after = np.searchsorted(other_t[sort], t - 1e-9)
                for k in (after - 1, after):  # the two nodes across, or the same point
                    k = np.clip(k, 0, len(sort) - 1)
                    pairs.append(np.stack([node, other[sort[k]]], axis=1))
        return np.concatenate(pairs)

    # cells

    def _grade(self, patch: np.ndarray) -> None:
        new = np.full(len(self.size) - len(self.changed), self.sweep, np.int32)
        self.changed = np.concatenate([self.changed, new])
        for _ in range(MAX_CHUNKS):
            order = np.argsort(self.size[patch].min(axis=1))
            following = grade(
                patch[order], self.joined, self.point, self.slope, self.size,
                self.changed, self.sweep + 1, SWEEPS,
            )  # fmt: skip
            self.sweep = abs(following)
            if following > 0:
                return
        raise SizingError(f"the sizes on {self.surface.name!r} could not be graded")

    def _balance(self, cells: "_Cells", split: np.ndarray) -> None:
        """Add to ``split`` what would be left more than one level coarser than a neighbour."""
        fresh = split
        while fresh.any():
            fresh = _coarse_beside_fine(cells, fresh, split, self.ny, self.nx) & ~split
            split |= fresh

    def _inaccurate(self, cells: "_Cells", patch: np.ndarray) -> np.ndarray:
        step = self.root_step / (1 << cells.depth)[:, None]
        error, extent = np.empty(len(patch)), np.empty(len(patch))
        largest = self._largest
        patch_errors(patch, self.root, self.size, step, largest, error, extent)
        graded = (self.size < 0.98 * self.wish)[patch].any(axis=1)
        allowed = np.where(graded, GRADED_ERROR, TEST_ERROR)
        by_sources = self.law.limits is not None and self.law.limits.uv is not None
        finest = np.where(graded & by_sources, FINEST_GRADED, FINEST_EXTENT)
        return (error > allowed) & (extent > finest)

    def _may_hide(self, cells: "_Cells", patch: np.ndarray) -> np.ndarray:
        """Cells whose bounds admit curvature that would at least halve the sizes seen."""
        hide = np.zeros(len(patch), bool)
        if not self.law.follows_curvature:
            return hide
        shallow = np.flatnonzero(cells.depth < HIDDEN_DEPTH)
        corners = patch[shallow][:, [0, 8]]
        xy = np.stack([self._xy_of(corners[:, 0]), self._xy_of(corners[:, 1])])
        bounds = self.surface.derivative_bounds(
            self.scaling.to_uv(xy[0]), self.scaling.to_uv(xy[1])
        )
        if bounds is None:
            return hide
        nodes = patch[shallow]
        normal = np.abs(self.normal[nodes[:, 4]])
        du, dv = self.scaling.rates(0.5 * (xy[0] + xy[1])).T
        second = np.maximum(np.abs(bounds[0]), np.abs(bounds[1]))[:, 2:]
        second *= np.stack([du * du, du * dv, dv * dv], axis=1)[:, :, None]
        with np.errstate(over="ignore", invalid="ignore"):
            form = np.einsum("nki,ni->nk", second, normal)  # |L|, |M|, |N| at most
        root = self.root[nodes]
        e = (root[..., 0] ** 2 + root[..., 1] ** 2).max(axis=1)
        g = (root[..., 1] ** 2 + root[..., 2] ** 2).max(axis=1)
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            bound = np.sqrt(
                (form[:, 0] / e) ** 2 + 2.0 * form[:, 1] ** 2 / (e * g) + (form[:, 2] / g) ** 2
            )
        possible = self.law.from_curvature(np.where(np.isnan(bound), np.inf, bound), 0.0)
        hide[shallow] = possible < 0.5 * self.size[nodes].min(axis=1)
        return hide

    def _blunt_poles(self) -> None:
        """Cap the stretch near sides that are one point in space.

        There the wanted length along the side is infinite in (u, v): whoever comes nearer to
        the pole than ``POLE_DISTANCE`` edges is given the metric at that distance, so that the
        side is cut as the ring of triangles around the pole is.
        """
        if self.sides is None or not any(self.sides.collapsed):
            return
        xy = self._xy_of(np.arange(len(self.size)))
        width, height = self.scaling.extent
        for side in np.flatnonzero(self.sides.collapsed):
            across = 1 if side in (0, 2) else 0
            far = (0.0, width, height, 0.0)[side]
            away = np.abs(xy[:, across] - far)
            # metric speed across the side, of the nodes themselves: finite at the pole
            first, last = (self.root[:, 1], self.root[:, 2]) if across else self.root[:, :2].T
            speed = np.hypot(first, last)
            depth = np.minimum(
                POLE_DISTANCE * self.size / np.maximum(speed, 1e-300),
                0.25 * self.scaling.extent[across],
            )
            near = np.flatnonzero(away < depth)
            moved = xy[near]
            moved[:, across] = np.abs(far - depth[near])
            forms = forms_from_derivatives(*self.surface.evaluate(self.scaling.to_uv(moved), 2)[1:])
            self.root[near] = _root(forms, self.scaling.rates(moved))

    def _xy_of(self, nodes: np.ndarray) -> np.ndarray:
        keys = np.empty(len(self.order), np.int64)
        keys[self.order] = self.keys
        return self._plane(keys[nodes])

    @property
    def _largest(self) -> float:
        """Cap on a circle's size in the scaled plane, for degenerate points."""
        return 16.0 * float(self.scaling.extent.max())

    def _background(self, tree: list[np.ndarray], patch: np.ndarray) -> Background:
        parents = np.concatenate(tree)
        roots = self.nx * self.ny
        child = np.full(roots + 4 * len(parents), -1, np.int32)
        child[parents] = roots + 4 * np.arange(len(parents))
        corner = np.zeros((len(child), 4), np.int32)
        quarters = patch[:, [[0, 1, 3, 4], [1, 2, 4, 5], [3, 4, 6, 7], [4, 5, 7, 8]]]
        corner[len(child) - 4 * len(patch) :] = quarters.reshape(-1, 4)
        inverse = np.empty((len(self.size), 4))
        inverse[:, :3] = self.root / self.size[:, None]
        inverse[:, 3] = 1.0 / self.size
        box = np.array([0.0, 0.0, *(1.0 / self.root_step), self._largest])
        return Background(box, np.array([self.nx, self.ny]), child, corner, inverse)


def _coarse_beside_fine(
    cells: "_Cells", fresh: np.ndarray, split: np.ndarray, ny: int, nx: int
) -> np.ndarray:
    """Leaves that would be two levels coarser than a neighbour of ``fresh`` that is split.

    With them a fine node in the middle of a coarse side would bind nobody across it.
    """
    unit = GRID_DEPTH + 1
    stride = (ny << unit) + 1
    found = np.zeros(len(cells), bool)
    fine = cells.chosen(fresh)
    half = (1 << (unit - fine.depth)) // 2
    levels = np.unique(fine.depth)
    for level in levels[levels > 0] - 1:  # neighbours that are one level coarser already
        here = np.flatnonzero((cells.depth == level) & ~split)
        if not len(here):
            continue
        key = cells.x[here] * stride + cells.y[here]
        order = np.argsort(key)
        key, here = key[order], here[order]
        of = fine.depth == level + 1
        for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):  # a point just outside each side
            x = fine.x[of] + half[of] + dx * half[of] - (dx < 0)
            y = fine.y[of] + half[of] + dy * half[of] - (dy < 0)
            inside = (x >= 0) & (x < nx << unit) & (y >= 0) & (y < ny << unit)
            shift = unit - level
            x, y = (x[inside] >> shift) << shift, (y[inside] >> shift) << shift
            wanted = x * stride + y
            place = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
            found[here[place[key[place] == wanted]]] = True
    return found


def _root(forms: FundamentalForms, rates: np.ndarray) -> np.ndarray:
    """I^(1/2) (n, 3) in the scaled plane, whose axes run at ``rates`` (n, 2)."""
    du, dv = rates.T
    e, f, g = forms.E * du * du, forms.F * du * dv, forms.G * dv * dv
    # square root of a symmetric 2 x 2 matrix: (I + s Id) / t, s^2 = det I, t^2 = tr I + 2 s
    s = np.sqrt(np.maximum(e * g - f * f, 0.0))
    t = np.sqrt(np.maximum(e + g + 2.0 * s, np.finfo(float).tiny))
    return np.stack([(e + s) / t, f / t, (g + s) / t], axis=1)


@dataclass(frozen=True)
class SizeBounds:
    """What the wishes say at a given curvature, on a surface of known extent."""

    sizing: Sizing
    """With the default chord where nothing else was wished."""

    clamp: tuple[float, float]
    """The smallest and the largest size, model units; the largest may be infinite."""

    @classmethod
    def of(cls, sizing: Sizing, diagonal: float) -> "SizeBounds":
        """``diagonal``: of the surface's bounding box, model units."""
        if sizing.chord is None and sizing.angle is None and sizing.size is None:
            sizing = sizing.replaced(chord=DEFAULT_CHORD * diagonal)
        coarsest = sizing.max_size or DEFAULT_MAX_SIZE * diagonal
        if callable(sizing.size) and not sizing.max_size:
            coarsest = np.inf  # the law alone decides
        if isinstance(sizing.size, float):
            coarsest = min(coarsest, sizing.size) if sizing.max_size else sizing.size
        finest = sizing.min_size or min(FINEST_SIZE * diagonal, coarsest)
        return cls(sizing, (finest, max(coarsest, finest)))

    @property
    def follows_curvature(self) -> bool:
        return self.sizing.chord is not None or self.sizing.angle is not None

    def from_curvature(self, k1: np.ndarray, k2: np.ndarray | float) -> np.ndarray:
        """Clamped size (n,) for principal curvatures, before ``size`` and gradation."""
        size = np.full(len(k1), np.inf)
        if self.sizing.chord is not None:
            size = np.minimum(size, chord_size(k1, k2, self.sizing.chord))
        if self.sizing.angle is not None:
            size = np.minimum(size, angle_size(k1, k2, self.sizing.angle))
        else:  # a triangle within chord of an apex need not follow it
            unfolded = angle_size(k1, k2, DEFAULT_ANGLE)
            size = np.minimum(size, np.maximum(unfolded, LEAST_OF_CHORD * self.sizing.chord))
        return np.clip(size, *self.clamp)


class _SizeLaw:
    """The ungraded wish at points of one surface, with what the background stores there."""

    def __init__(self, surface: Surface, sizing: Sizing, limits: SizeLimits | None) -> None:
        self.surface, self.scaling = surface, Scaling.of(surface)
        (u0, u1), (v0, v1) = surface.domain
        grid = np.linspace(0.0, 1.0, 17)
        t = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
        (points,) = surface.evaluate(np.array([u0, v0]) + t * np.array([u1 - u0, v1 - v0]), 0)
        self.diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
        self.bounds = SizeBounds.of(sizing, self.diagonal)
        self.sizing, self.clamp = self.bounds.sizing, self.bounds.clamp
        self.follows_curvature = self.bounds.follows_curvature
        self.from_curvature = self.bounds.from_curvature
        self.limits = limits

    def __call__(self, xy: np.ndarray) -> tuple[np.ndarray, ...]:
        """size (n,), the wish (n,) that sources have not lowered, I^(1/2) in the scaled plane
        (n, 3), unit normal (n, 3), point (n, 3)."""
        uv, rates = self.scaling.to_uv_and_rates(xy)
        derivatives = self.surface.evaluate(uv, 2)
        forms = forms_from_derivatives(*derivatives[1:])
        root = _root(forms, rates)
        size = np.full(len(uv), self.clamp[1])
        if self.follows_curvature:
            k = curvatures(forms)
            size = self.from_curvature(k.k1, k.k2)
            # nothing is known at a pole or a cusp: gradation brings the neighbours' size
            size[forms.degenerate] = self.clamp[1]
        if self.sizing.has_law:
            wish = self.sizing.law_sizes(derivatives[0])
            size = np.clip(np.minimum(size, wish), *self.clamp)
        wish = size
        if self.limits is not None:
            least = self.clamp[0] if self.limits.uv is None else self.sizing.min_size or 0.0
            least = 0.0 if self.limits.settled else least
            size = np.minimum(size, np.maximum(self.limits(derivatives[0]), least))
            if self.limits.uv is None:
                wish = size
        return size, wish, root, forms.normal, derivatives[0]


class _TensorLaw:
    """Size tensors given over a plane, in the place of sizes that follow from a surface."""

    follows_curvature = False
    limits = None

    def __init__(
        self, surface: Surface, sizing: Sizing, tensors: Callable[[np.ndarray], np.ndarray]
    ) -> None:
        self.surface, self.scaling = surface, Scaling.of(surface)
        self.sizing, self.tensors = sizing, tensors

    def __call__(self, xy: np.ndarray) -> tuple[np.ndarray, ...]:
        """As for ``_SizeLaw``: sizes of one, and H^-1 for the root of the first form."""
        uv = self.scaling.to_uv(xy)
        h = self.tensors(uv)
        det = h[:, 0] * h[:, 2] - h[:, 1] ** 2
        inverse = np.stack([h[:, 2], -h[:, 1], h[:, 0]], axis=1) / det[:, None]
        normal = np.tile([0.0, 0.0, 1.0], (len(uv), 1))
        size = np.ones(len(uv))
        return size, size, inverse, normal, self.surface.evaluate(uv, 0)[0]


class _SourceCells:
    """The leaf that each source of a small size lies in, and how deep it shall be.

    What is smaller than a cell would be missed by its nodes.
    """

    def __init__(
        self, uv: np.ndarray, sizes: np.ndarray, scaling: Scaling, root_step: np.ndarray, nx: int
    ) -> None:
        last = np.round(scaling.extent / root_step * (1 << GRID_DEPTH)).astype(np.int64) - 1
        grid = scaling.to_plane(uv) / root_step * (1 << GRID_DEPTH)
        self.grid = np.clip(grid, 0, last).astype(np.int64)
        root = self.grid >> GRID_DEPTH
        self.leaf = root[:, 1] * nx + root[:, 0]
        # the leaves are split once more at the end
        depth = np.ceil(np.log2(0.5 * float(root_step.max()) / sizes))
        self.depth = np.clip(depth, 0, GRID_DEPTH).astype(np.int64)
        self._before = np.zeros(len(uv), np.int64)

    def split(self, cells: "_Cells") -> np.ndarray:
        """Leaves (n,) bool that are too shallow for a source within."""
        wanted = np.zeros(len(cells), bool)
        self._before = cells.depth[self.leaf]
        wanted[self.leaf[self._before < self.depth]] = True
        return wanted

    def follow(self, split: np.ndarray) -> None:
        """The cells in ``split`` (n,) bool were replaced by children at the end of the list."""
        gone = split[self.leaf]
        kept_rank, split_rank = np.cumsum(~split) - 1, np.cumsum(split) - 1
        quarter = (self.grid >> (GRID_DEPTH - 1 - self._before)[:, None]) & 1
        child = len(split) - split.sum() + 4 * split_rank[self.leaf]
        child += quarter[:, 0] + 2 * quarter[:, 1]
        self.leaf = np.where(gone, child, kept_rank[self.leaf])


@dataclass(frozen=True)
class _Cells:
    """The leaves so far: lower left corner in units of the finest node grid, place in the tree."""

    x: np.ndarray
    y: np.ndarray
    depth: np.ndarray
    index: np.ndarray

    @classmethod
    def roots(cls, nx: int, ny: int) -> "_Cells":
        index = np.arange(nx * ny, dtype=np.int64)
        j, i = np.divmod(index, nx)
        unit = 1 << (GRID_DEPTH + 1)
        return cls(i * unit, j * unit, np.zeros(nx * ny, np.int64), index)

    def __len__(self) -> int:
        return len(self.index)

    def chosen(self, mask: np.ndarray) -> "_Cells":
        return _Cells(self.x[mask], self.y[mask], self.depth[mask], self.index[mask])

    def joined_with(self, other: "_Cells") -> "_Cells":
        return _Cells(
            np.concatenate([self.x, other.x]),
            np.concatenate([self.y, other.y]),
            np.concatenate([self.depth, other.depth]),
            np.concatenate([self.index, other.index]),
        )

    def split(self, first: int) -> "_Cells":
        """The four children of every cell, numbered from ``first`` on."""
        half = 1 << (GRID_DEPTH - self.depth)
        i = np.arange(4)
        return _Cells(
            (self.x[:, None] + half[:, None] * (i % 2)).ravel(),
            (self.y[:, None] + half[:, None] * (i // 2)).ravel(),
            np.repeat(self.depth + 1, 4),
            first + np.arange(4 * len(self)),
        )
