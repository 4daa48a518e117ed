"""The (u, v) box of a face in cells, halved both ways level after level; an edge likewise.

level 0   n_u x n_v cells about as wide as high in space
level k   each in 2^k x 2^k;  the cell (i, j) holds (2i, 2j) ... (2i + 1, 2j + 1) of the next one
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace
from surfmesh.intersection.bounds import Boxes, Cones, boxes_and_cones, curve_boxes

FIRST = 8
"""Cells of level 0 along the longer side."""

MOST = 64
"""Cells of level 0 along one side."""

QUARTERS = np.array([(0, 0), (1, 0), (0, 1), (1, 1)])


class FaceCells:
    """The cells of one face."""

    def __init__(self, face: CadFace) -> None:
        self.surface = face.surface
        (u0, u1), (v0, v1) = face.surface.domain
        self.low, self.width = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
        line = np.linspace(0.0, 1.0, 9)
        uv = self.low + np.stack(np.meshgrid(line, line), -1).reshape(-1, 2) * self.width
        _, r_u, r_v = self.surface.evaluate(uv, 1)
        speed = [np.nan_to_num(np.linalg.norm(d, axis=1)).mean() for d in (r_u, r_v)]
        length = np.maximum(np.array(speed) * self.width, 1e-300)
        self.first = np.clip(np.ceil(FIRST * length / length.max()), 1, MOST).astype(np.int64)

    def start(self) -> np.ndarray:
        """(n, 2) the cells of level 0."""
        nu, nv = self.first
        return np.stack(np.meshgrid(np.arange(nu), np.arange(nv)), axis=-1).reshape(-1, 2)

    @staticmethod
    def children(cells: np.ndarray) -> np.ndarray:
        """(n, 2) -> (n, 4, 2) of the next level."""
        return 2 * cells[:, None] + QUARTERS

    def corners(self, cells: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corners (n, 2) in (u, v)."""
        count = self.first * 2.0**level
        return self.low + cells / count * self.width, self.low + (cells + 1) / count * self.width

    def bounds(self, cells: np.ndarray, level: int) -> tuple[Boxes, Cones]:
        """Boxes of cells, and cones of their normals."""
        return boxes_and_cones(self.surface, *self.corners(cells, level))


class EdgeCells:
    """The cells of one edge: 2^k times FIRST equal fractions at level k."""

    def __init__(self, edge: CadEdge) -> None:
        self.edge = edge

    def start(self) -> np.ndarray:
        """(n, 1) the cells of level 0."""
        return np.arange(FIRST)[:, None]

    @staticmethod
    def children(cells: np.ndarray) -> np.ndarray:
        """(n, 1) -> (n, 2, 1) of the next level."""
        return 2 * cells[:, None] + np.arange(2)[:, None]

    def corners(self, cells: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        """First and last fractions (n, 1)."""
        count = FIRST * 2.0**level
        return cells / count, (cells + 1) / count

    def bounds(self, cells: np.ndarray, level: int) -> tuple[Boxes, Cones]:
        """Boxes of cells, and cones of their directions."""
        low, high = self.corners(cells, level)
        return curve_boxes(self.edge, low[:, 0], high[:, 0])


class Numbered:
    """Cells that pairs name, each once, with its bounds: cell ``of[k]`` is that of pair k."""

    def __init__(self, owner: FaceCells | EdgeCells, named: np.ndarray, level: int) -> None:
        order = np.lexsort(named.T[::-1])
        rows = named[order]
        first = np.ones(len(rows), bool)
        first[1:] = (rows[1:] != rows[:-1]).any(axis=1)
        self.cells, self.of = rows[first], np.empty(len(rows), np.int64)
        self.of[order] = np.cumsum(first) - 1
        self.boxes, self.cones = owner.bounds(self.cells, level)

    def size(self, rows: np.ndarray) -> float:
        """The diagonal of the largest box of some pairs."""
        of = self.of[rows]
        return float(np.linalg.norm(self.boxes.high[of] - self.boxes.low[of], axis=1).max())


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of a cell of the one and a cell of the other: row k of ``a`` and of ``b``."""

    one: FaceCells | EdgeCells
    other: FaceCells
    a: np.ndarray
    b: np.ndarray
    level_a: int = 0
    level_b: int = 0

    @staticmethod
    def of(one: FaceCells | EdgeCells, other: FaceCells) -> Pairs:
        """All pairs of level 0."""
        first, second = one.start(), other.start()
        i, j = (k.ravel() for k in np.meshgrid(np.arange(len(first)), np.arange(len(second))))
        return Pairs(one, other, first[i], second[j])

    def __len__(self) -> int:
        return len(self.a)

    def kept(self, rows: np.ndarray) -> Pairs:
        """Some of them."""
        return replace(self, a=self.a[rows], b=self.b[rows])

    def halved(self, size_a: float, size_b: float) -> Pairs:
        """With the cells of both halved, or only the larger ones."""
        a, b, level_a, level_b = self.a, self.b, self.level_a, self.level_b
        if size_a >= 0.5 * size_b:
            parts = self.one.children(a)
            b = np.repeat(b, parts.shape[1], axis=0)
            a, level_a = parts.reshape(-1, parts.shape[2]), level_a + 1
        if size_b >= 0.5 * size_a:
            parts = self.other.children(b)
            a = np.repeat(a, parts.shape[1], axis=0)
            b, level_b = parts.reshape(-1, parts.shape[2]), level_b + 1
        return replace(self, a=a, b=b, level_a=level_a, level_b=level_b)

    @property
    def corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corners (n, p + q) in the parameters of both."""
        low_a, high_a = self.one.corners(self.a, self.level_a)
        low_b, high_b = self.other.corners(self.b, self.level_b)
        return np.hstack([low_a, low_b]), np.hstack([high_a, high_b])

    @property
    def middles(self) -> np.ndarray:
        """(n, p + q)."""
        low, high = self.corners
        return 0.5 * (low + high)
