"""The (u, v) box of a face in cells, halved both ways level after level; an edge in pieces.

level 0   n_u x n_v cells about as wide as high in space
level k   each in 2^k x 2^k;  the cell (i, j) holds (2i, 2j) ... (2i + 1, 2j + 1) of the next one
"""

from __future__ import annotations

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

    def middles(self, cells: np.ndarray, level: int) -> np.ndarray:
        """(n, 2) in (u, v)."""
        low, high = self.corners(cells, level)
        return 0.5 * (low + high)

    def bounds(self, cells: np.ndarray, level: int) -> tuple[Boxes, Cones]:
        """Boxes of cells, and cones of their normals."""
        return boxes_and_cones(self.surface, *self.corners(cells, level))


class EdgePieces:
    """The pieces of one edge: 2^k times FIRST equal fractions at level k."""

    def __init__(self, edge: CadEdge) -> None:
        self.edge = edge

    def start(self) -> np.ndarray:
        """(n,) the pieces of level 0."""
        return np.arange(FIRST)

    @staticmethod
    def children(pieces: np.ndarray) -> np.ndarray:
        """(n,) -> (n, 2) of the next level."""
        return 2 * pieces[:, None] + np.arange(2)

    def corners(self, pieces: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        """First and last fractions (n,)."""
        count = FIRST * 2.0**level
        return pieces / count, (pieces + 1) / count

    def bounds(self, pieces: np.ndarray, level: int) -> tuple[Boxes, Cones]:
        """Boxes of pieces, and cones of their directions."""
        return curve_boxes(self.edge, *self.corners(pieces, level))


class Numbered:
    """Cells that pairs name, each once, with its bounds."""

    def __init__(self, owner: FaceCells | EdgePieces, named: np.ndarray, level: int) -> None:
        self.cells, self.of = np.unique(named, axis=0, return_inverse=True)
        self.of = self.of.reshape(-1)
        self.boxes, self.cones = owner.bounds(self.cells, level)
