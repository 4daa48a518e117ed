"""The cells of a size field under construction: the leaves of a forest of quadtrees."""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.differential.chart import Chart

GRID_DEPTH = 20
"""Most splits around small sources; also the depth of the finest grid that nodes lie on."""


@dataclass(frozen=True)
class Cells:
    """The leaves so far: lower left corner in units of the finest node grid, place in the tree."""

    x: np.ndarray
    y: np.ndarray
    depth: np.ndarray
    index: np.ndarray

    @classmethod
    def roots(cls, nx: int, ny: int) -> "Cells":
        index = np.arange(nx * ny, dtype=np.int64)
        j, i = np.divmod(index, nx)
        unit = 1 << (GRID_DEPTH + 1)
        return cls(i * unit, j * unit, np.zeros(nx * ny, np.int64), index)

    def __len__(self) -> int:
        return len(self.index)

    def chosen(self, mask: np.ndarray) -> "Cells":
        return Cells(self.x[mask], self.y[mask], self.depth[mask], self.index[mask])

    def joined_with(self, other: "Cells") -> "Cells":
        return Cells(
            np.concatenate([self.x, other.x]),
            np.concatenate([self.y, other.y]),
            np.concatenate([self.depth, other.depth]),
            np.concatenate([self.index, other.index]),
        )

    def split(self, first: int) -> "Cells":
        """The four children of every cell, numbered from ``first`` on."""
        half = 1 << (GRID_DEPTH - self.depth)
        i = np.arange(4)
        return Cells(
            (self.x[:, None] + half[:, None] * (i % 2)).ravel(),
            (self.y[:, None] + half[:, None] * (i // 2)).ravel(),
            np.repeat(self.depth + 1, 4),
            first + np.arange(4 * len(self)),
        )


def coarse_beside_fine(
    cells: Cells, fresh: np.ndarray, split: np.ndarray, ny: int, nx: int
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


class SourceCells:
    """The leaf that each source of a small size lies in, and how deep it shall be.

    What is smaller than a cell would be missed by its nodes.
    """

    def __init__(
        self, uv: np.ndarray, sizes: np.ndarray, chart: Chart, root_step: np.ndarray, nx: int
    ) -> None:
        last = np.round(chart.extent / root_step * (1 << GRID_DEPTH)).astype(np.int64) - 1
        grid = chart.to_plane(uv) / root_step * (1 << GRID_DEPTH)
        self.grid = np.clip(grid, 0, last).astype(np.int64)
        root = self.grid >> GRID_DEPTH
        self.leaf = root[:, 1] * nx + root[:, 0]
        # the leaves are split once more at the end
        depth = np.ceil(np.log2(0.5 * float(root_step.max()) / sizes))
        self.depth = np.clip(depth, 0, GRID_DEPTH).astype(np.int64)
        self._before = np.zeros(len(uv), np.int64)

    def split(self, cells: Cells) -> np.ndarray:
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
