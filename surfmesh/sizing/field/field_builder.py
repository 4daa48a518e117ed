"""The background of a size field: the sizes of one surface, graded, on a balanced quadtree.

The background is built level by level. Every cell carries nine nodes (see
src/fields/gradation.hpp); at each level the sizes of all nodes are graded together, each cell is
compared with its test nodes, and the cells that miss are split into four. The test nodes of a leaf
are kept: they make the final field twice as fine as the one that was tested.

Samples alone cannot see a feature that lies between them. Where the surface can bound its
derivatives over a cell (formulas can, by interval arithmetic), a cell is split as well while
the bound admits a curvature that would at least halve the size.
"""

from typing import NoReturn

import numpy as np

from surfmesh._core.fields import Background, grade, grade_stretched, patch_errors
from surfmesh.errors import SizingError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.sizing.field.field_cells import GRID_DEPTH, Cells, SourceCells, coarse_beside_fine
from surfmesh.sizing.field.hidden_features import SeenCells, may_bend, may_rise
from surfmesh.sizing.field.size_law import FieldNodes, SizeLaw, TensorLaw
from surfmesh.sizing.field.small_sizes import small_sizes
from surfmesh.sizing.rules.direction_rates import has_even_curvature

ROOT_CELLS = 2304
"""About how many cells the search starts with: a smooth surface needs no more."""

CELLS_OF_PIECE, CELLS_OF_FACE = 16, (64, 2304)
"""The same for the faces of a CAD model, which are smooth between the knots of their splines."""

LONGEST_ROW = 2048
"""Root cells along the longer side of a narrow face, at most."""

DEPTH = 13
"""Most splits of a root cell for accuracy: a leaf may be a 400,000th of the domain."""

HIDDEN_DEPTH, DEEPEST_HIDDEN = 6, 19
"""Splits of a root cell within which features between the samples are looked for: all of them,
and where they would rise by more than a share of ``chord``."""

MOST_HIDDEN = 60_000
"""Cells looked into beyond ``HIDDEN_DEPTH``, at most; the report finds what is left."""

TEST_ERROR, GRADED_ERROR = 0.03, 0.1
"""Error at the test nodes that a cell may have; the leaf, twice as fine, has a quarter of it,
or half at a kink. Where gradation decides, the field is a cone and all slopes are small."""

FINEST_EXTENT = 0.2
"""A cell narrower than this many edges is not split: no circle would notice."""

FINEST_GRADED, FINEST_STRETCHED = 1.0, 2.0
"""The same where sizes are graded from sources, which have cells of their own size already; and
where they depend on the direction too, so that gradation brings kinks of its own."""

POLE_DISTANCE = 0.9
"""In edges: the first ring of triangles around a pole lies about there."""

REACHED = 1.1
"""How much more than the reached ratio of the two sizes the shorter one leaves room for."""

MAX_CELLS, FREE_CELLS, CELLS_OF_TRIANGLE = 800_000, 200_000, 4
"""A field may have so many cells; and beyond the second number no more than the third for each
triangle that it asks for so far: what needs more is no size, but a place where r is singular."""
MAX_ROUNDS = 60
NODES_AT_ONCE = 250_000
"""Nodes whose sizes are taken at a time."""
SWEEPS, MAX_CHUNKS = 16, 400
"""Sweeps of the gradation before the cells are sorted anew, and how often that is done."""

PATIENT_CHUNKS, MOST_SLOW = 4, 40_000_000
"""So often sorted anew a field is graded, as a rule; cells times sweeps that may come after it, in
all rounds: where the surface is a wall sizes creep up it, a cell a sweep."""

FAR_BEYOND, MANY_CELLS = 2.0, 100_000
"""Times the limit of triangles: so many are not asked for by mistake of a coarse sampling; and
cells that are made before that is looked at."""


def _root_grid(width: float, height: float, cells: int) -> tuple[int, int]:
    """How many cells along x and y: about ``cells`` of them, as near to squares as they can be.

    A cell keeps its shape when it is split: long ones would have to become far too narrow.
    """
    ratio = max(width, height) / min(width, height)
    most = max(cells // 4, min(round(2.0 * ratio), LONGEST_ROW))
    longer = int(np.clip(round(np.sqrt(cells * ratio)), 4, most))
    shorter = int(np.clip(round(cells / longer), 2 if longer > cells // 4 else 4, cells // 4))
    return (longer, shorter) if width > height else (shorter, longer)


class FieldBuilder:
    """Makes one background."""

    def __init__(self, law: SizeLaw | TensorLaw, sides: SideTopology | None = None) -> None:
        """sides: which of the domain are joined."""
        self.surface = surface = law.surface
        self.sides = sides
        self.chart = law.chart
        width, height = self.chart.extent
        roots = ROOT_CELLS
        if isinstance(surface, FaceSurface):
            roots = int(np.clip(CELLS_OF_PIECE * surface.pieces, *CELLS_OF_FACE))
        self.nx, self.ny = _root_grid(width, height, roots)
        self.root_step = np.array([width / self.nx, height / self.ny])
        self.law = law
        self.slope = law.sizing.gradient
        # nodes, in order of creation; their keys also in sorted order
        self.keys = np.empty(0, np.int64)
        self.order = np.empty(0, np.int64)
        self.nodes = FieldNodes.none()
        self.joined = np.empty((0, 2), np.int64)
        self.changed = np.empty(0, np.int32)  # last sweep of the gradation that lowered a node
        self.sweep = 1  # number of the next one
        self.looked_into = 0  # cells beyond HIDDEN_DEPTH, for what hides in them
        self.slow = 0  # cells times sweeps of slow gradation

    def background(self) -> Background:
        """Raises ``SizingError`` when the sizes need an unreasonable number of cells."""
        cells = Cells.roots(self.nx, self.ny)
        patch = self._patches(cells)
        fresh = np.ones(len(cells), bool)
        total = len(cells)
        seeds = small_sizes(self.surface, self.law.sizing, self.law.limits, self.law.loop_limits)
        sources = SourceCells(*seeds, self.chart, self.root_step, self.nx)
        tree: list[np.ndarray] = []  # the cells that were split, in the order of their children
        deep = np.zeros(len(cells), bool)  # in search of what hides: they may be split further
        for round_number in range(MAX_ROUNDS + GRID_DEPTH):
            seen = self.sweep
            self._grade(patch)
            self._refuse_far_beyond(cells, patch)
            touched = fresh | (self.changed[patch].max(axis=1) >= seen)
            split = np.zeros(len(cells), bool)
            split[touched] = self._inaccurate(cells.chosen(touched), patch[touched])
            unseen = fresh & ~split
            hidden = np.zeros(len(cells), bool)
            hidden[unseen] = self._may_hide(cells.chosen(unseen), patch[unseen])
            deep |= hidden & (cells.depth >= HIDDEN_DEPTH)
            split |= hidden
            split &= cells.depth < np.where(deep, DEEPEST_HIDDEN, DEPTH)
            demanded = sources.split(cells) | (split & deep)
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
            if total > FREE_CELLS and total > self._most_cells(cells, patch):
                self._refuse(total, parents)
            fresh = np.concatenate([np.zeros((~split).sum(), bool), np.ones(len(children), bool)])
            deep = np.concatenate([deep[~split], np.repeat(deep[split], 4)])
            patch = np.concatenate([patch[~split], self._patches(children)])
            cells = cells.chosen(~split).joined_with(children)
        if isinstance(self.law, SizeLaw) and self.nodes.is_anisotropic:
            if not has_even_curvature(self.surface):
                self._limit_longer_sizes(self.law, patch)
        self._blunt_poles()
        self.nodes = self.nodes.in_order()
        tree.append(cells.index)  # every leaf is split once more, onto its test nodes
        return self._background(tree, patch)

    @property
    def _is_of_formulas(self) -> bool:
        return isinstance(self.law, SizeLaw) and not isinstance(self.surface, FaceSurface)

    def _most_cells(self, cells: Cells, patch: np.ndarray) -> float:
        """How many cells are allowed for what the leaves ask for."""
        if not self._is_of_formulas:
            return MAX_CELLS
        triangles = float(self._triangles(cells, patch[:, 4:5]).sum())
        free = FREE_CELLS + 4 * self.looked_into
        return min(MAX_CELLS, max(free, CELLS_OF_TRIANGLE * triangles))

    def _triangles(self, cells: Cells, patch: np.ndarray) -> np.ndarray:
        """Triangles that cells ask for (n,), by the median of some of their nodes (n, k)."""
        a11, a12, a22 = self.nodes.inverse_sizes().T
        density = np.median((a11 * a22 - a12 * a12)[patch], axis=1)
        return (
            self.root_step.prod() / np.ldexp(1.0, 2 * cells.depth) * density * (4.0 / np.sqrt(3.0))
        )

    def _refuse_far_beyond(self, cells: Cells, patch: np.ndarray) -> None:
        """Raise SizingError before a field is made for far more triangles than there may be."""
        if len(cells) < MANY_CELLS or not isinstance(self.law, SizeLaw):
            return
        if not (self._is_of_formulas or self.law.sizing.has_law):
            return  # the triangles of a CAD model are counted together, elsewhere
        asked = self._triangles(cells, patch)
        limit = self.law.sizing.limit
        if float(asked.sum()) <= FAR_BEYOND * limit:
            return
        place = self.chart.to_uv(self._xy_of(patch[[int(np.argmax(asked))], 4]))[0]
        raise SizingError(
            f"about {float(asked.sum()):.2g} triangles are asked for on {self.surface.name!r}, "
            f"most near (u, v) = ({place[0]:.6g}, {place[1]:.6g}), far more than the limit of "
            f"{limit:,}: ask for a larger chord, size or min_size, or a smaller part of the domain"
        )

    def _refuse(self, total: int, parents: Cells) -> NoReturn:
        """The place is in the midst of the smallest cells."""
        deepest = np.flatnonzero(parents.depth == parents.depth.max())
        one = deepest[len(deepest) // 2]
        corner = np.array([[parents.x[one], parents.y[one]]]) / (1 << (GRID_DEPTH + 1))
        u, v = self.chart.to_uv(corner * self.root_step)[0]
        raise SizingError(
            f"the sizes asked for on {self.surface.name!r} need more than {total:,} cells to "
            f"describe, most near (u, v) = ({u:.6g}, {v:.6g}), where the surface may be singular: "
            "raise min_size or growth, or leave that place out of the domain"
        )

    # nodes

    def _patches(self, cells: Cells) -> np.ndarray:
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
        node[~known] = len(self.nodes.size) + np.arange(len(new))
        self._create(new)
        return node[inverse].reshape(-1, 9).astype(np.int32)

    @property
    def _stride(self) -> int:
        return (self.ny << (GRID_DEPTH + 1)) + 1

    def _plane(self, keys: np.ndarray) -> np.ndarray:
        """xy (n, 2) of nodes; the far sides of the domain are met exactly."""
        count = np.array([self.nx << (GRID_DEPTH + 1), self.ny << (GRID_DEPTH + 1)])
        index = np.stack([keys // self._stride, keys % self._stride], axis=1)
        return index / count * self.chart.extent

    def _create(self, keys: np.ndarray) -> None:
        xy = self._plane(keys)
        fresh = self.law(xy[:NODES_AT_ONCE])
        for first in range(NODES_AT_ONCE, len(xy), NODES_AT_ONCE):
            fresh = fresh.joined_with(self.law(xy[first : first + NODES_AT_ONCE]))
        self.order = np.concatenate([self.order, len(self.nodes.size) + np.arange(len(keys))])
        self.keys = np.concatenate([self.keys, keys])
        sort = np.argsort(self.keys, kind="stable")
        self.keys, self.order = self.keys[sort], self.order[sort]
        self.nodes = self.nodes.joined_with(fresh)
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
        new = np.full(len(self.nodes.size) - len(self.changed), self.sweep, np.int32)
        self.changed = np.concatenate([self.changed, new])
        nodes = self.nodes
        self._spread(patch, nodes.size, nodes if nodes.is_anisotropic else None)

    def _grade_anew(self, patch: np.ndarray, size: np.ndarray, long: np.ndarray) -> None:
        """Gradation of other sizes, as if all nodes were new."""
        self.nodes.size[:], self.nodes.long[:] = size, long
        self.changed[:] = self.sweep
        self._grade(patch)

    def _limit_longer_sizes(self, law: SizeLaw, patch: np.ndarray) -> None:
        """Lower long sizes where directions change, raise short ones where long are not reached.

        The width of a triangle is then known: it is at most what growth allows in any metric.
        """
        nodes = self.nodes
        size, long = nodes.asked.T.copy()
        width = size.copy()
        self.changed[:] = self.sweep
        self._spread(patch, width)
        long = np.minimum(long, law.longest_along(nodes, width))
        self._grade_anew(patch, size, long)
        ratio = REACHED * nodes.long / nodes.size
        size = law.regained(nodes, ratio)
        self._grade_anew(patch, size, np.minimum(long, ratio * size))

    def _spread(
        self, patch: np.ndarray, size: np.ndarray, stretched: FieldNodes | None = None
    ) -> None:
        point, first = self.nodes.point, self.sweep + 1
        joined = self.joined.astype(np.int32)
        for chunk in range(MAX_CHUNKS):
            if chunk >= PATIENT_CHUNKS:
                self.slow += SWEEPS * len(patch)
            if self.slow > MOST_SLOW:
                break
            order = np.argsort(size[patch].min(axis=1))
            cells = patch[order], joined, point, self.slope, size
            sweeps = self.changed, first, SWEEPS
            if stretched is None:
                first, finished = grade(*cells, *sweeps)
            else:
                s = stretched
                first, finished = grade_stretched(
                    *cells, s.long, s.along, s.normal, s.is_round, *sweeps
                )
            self.sweep = first  # the last sweep's changes are still to be spread
            if finished:
                return
        creeping = np.flatnonzero(self.changed >= first - SWEEPS)
        u, v = self.chart.to_uv(self._xy_of(creeping[[len(creeping) // 2]]))[0]
        raise SizingError(
            f"the sizes on {self.surface.name!r} cannot be graded from one place to the next, near "
            f"(u, v) = ({u:.6g}, {v:.6g}), where the surface is as steep as a wall: "
            "raise min_size or growth, or leave that place out of the domain"
        )

    def _balance(self, cells: Cells, split: np.ndarray) -> None:
        """Add to ``split`` what would be left more than one level coarser than a neighbour."""
        fresh = split
        while fresh.any():
            fresh = coarse_beside_fine(cells, fresh, split, self.ny, self.nx) & ~split
            split |= fresh

    def _inaccurate(self, cells: Cells, patch: np.ndarray) -> np.ndarray:
        step = self.root_step / (1 << cells.depth)[:, None]
        nodes = self.nodes
        error, extent = patch_errors(patch, nodes.inverse_sizes(), step, self._largest)
        graded = (nodes.size < 0.98 * nodes.target_size)[patch].any(axis=1)
        if nodes.is_anisotropic:
            graded |= (nodes.long < 0.98 * nodes.long_target_size)[patch].any(axis=1)
        allowed = np.where(graded, GRADED_ERROR, TEST_ERROR)
        by_sources = self.law.limits is not None and self.law.limits.uv is not None
        coarse = FINEST_STRETCHED if nodes.is_anisotropic else FINEST_GRADED
        finest = np.where(graded & by_sources, coarse, FINEST_EXTENT)
        return (error > allowed) & (extent > finest)

    def _may_hide(self, cells: Cells, patch: np.ndarray) -> np.ndarray:
        """Cells whose bounds admit curvature that would at least halve the sizes seen."""
        law, hide = self.law, np.zeros(len(patch), bool)
        if not isinstance(law, SizeLaw) or not law.follows_curvature or not len(patch):
            return hide
        shallow = np.flatnonzero(cells.depth < HIDDEN_DEPTH)
        hide[shallow] = may_bend(law, self._seen(patch[shallow]))
        deep = np.flatnonzero(cells.depth >= HIDDEN_DEPTH)
        chord = law.sizing.chord
        if len(deep) and chord is not None and self.looked_into < MOST_HIDDEN:
            self.looked_into += len(deep)
            seen = self._seen(patch[deep])
            hide[deep] = may_bend(law, seen) & may_rise(law, chord, seen)
        return hide

    def _seen(self, patch: np.ndarray) -> SeenCells:
        return SeenCells(self._xy_of(patch[:, 0]), self._xy_of(patch[:, 8]), patch, self.nodes)

    def _blunt_poles(self) -> None:
        """Cap the stretch near sides that are one point in space.

        There the wanted length along the side is infinite in (u, v): whoever comes nearer to
        the pole than ``POLE_DISTANCE`` edges is given the metric at that distance, so that the
        side is cut as the ring of triangles around the pole is.
        """
        if self.sides is None or not any(self.sides.collapsed):
            return
        xy = self._xy_of(np.arange(len(self.nodes.size)))
        width, height = self.chart.extent
        for side in np.flatnonzero(self.sides.collapsed):
            across = 1 if side in (0, 2) else 0
            far = (0.0, width, height, 0.0)[side]
            away = np.abs(xy[:, across] - far)
            # metric speed across the side, of the nodes themselves: finite at the pole
            speed = np.hypot(*self.nodes.root[:, across : across + 2].T)
            depth = np.minimum(
                POLE_DISTANCE * self.nodes.size / np.maximum(speed, 1e-300),
                0.25 * self.chart.extent[across],
            )
            near = np.flatnonzero(away < depth)
            moved = xy[near]
            moved[:, across] = np.abs(far - depth[near])
            elsewhere = self.law(moved)
            self.nodes.root[near] = elsewhere.root
            if self.nodes.is_anisotropic:
                self.nodes.along[near] = elsewhere.along
                self.nodes.jacobian[near] = elsewhere.jacobian

    def _xy_of(self, nodes: np.ndarray) -> np.ndarray:
        keys = np.empty(len(self.order), np.int64)
        keys[self.order] = self.keys
        return self._plane(keys[nodes])

    @property
    def _largest(self) -> float:
        """Cap on a circle's size in the scaled plane, for degenerate points."""
        return 16.0 * float(self.chart.extent.max())

    def _background(self, tree: list[np.ndarray], patch: np.ndarray) -> Background:
        parents = np.concatenate(tree)
        roots = self.nx * self.ny
        child = np.full(roots + 4 * len(parents), -1, np.int32)
        child[parents] = roots + 4 * np.arange(len(parents))
        corner = np.zeros((len(child), 4), np.int32)
        quarters = patch[:, [[0, 1, 3, 4], [1, 2, 4, 5], [3, 4, 6, 7], [4, 5, 7, 8]]]
        corner[len(child) - 4 * len(patch) :] = quarters.reshape(-1, 4)
        inverse = np.empty((len(self.nodes.size), 4))
        inverse[:, :3] = self.nodes.inverse_sizes()
        inverse[:, 3] = 1.0 / self.nodes.size
        metric_root_3d = self.nodes.metric_roots_3d() if self.nodes.is_anisotropic else None
        box = np.array([0.0, 0.0, *(1.0 / self.root_step), self._largest])
        return Background(box, np.array([self.nx, self.ny]), child, corner, inverse, metric_root_3d)
