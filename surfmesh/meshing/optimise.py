"""The order of the optimiser's steps; what each does is in kernels.optimisation.

    swap -> smooth -> degrees -> smooth -> swap -> collapse, split -> ... -> smooth until still

Between any two of them the vertices that moved are put back on the true surface.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.kernels.embedding import Embedding, embed, empty_embedding
from surfmesh.kernels.optimisation import (
    collapse_short,
    find_stars,
    smooth,
    split_long,
    swap_for_degree,
    swap_for_shape,
)
from surfmesh.kernels.triangulation import Triangulation
from surfmesh.sizing.size_field import SizeField

STIFFNESS = 2.0
"""Weight of unit edges against good shapes: 1 gives better shapes, 4 better lengths."""

SHORTEST, LONGEST = 0.66, 1.45
"""Metric lengths beyond which an edge is collapsed or split."""

FEW = 4
"""An interior vertex with at most this many triangles is removed."""

LEAST_FOR_DEGREE = 0.4
"""Worst alpha that a swap for the sake of degrees may leave to the smoothing that follows."""

ROUNDS = 3
FINAL_PASSES = 3
SWEEPS = 8


@dataclass(frozen=True)
class Changes:
    """What the optimiser did."""

    swaps: int
    collapses: int
    splits: int
    passes: int


class Optimiser:
    """A triangulated domain with its embedding; ``run`` changes it in place."""

    def __init__(self, t: Triangulation, surface: Surface, field: SizeField) -> None:
        self.t, self.surface, self.field = t, surface, field
        room = len(t.xy)
        self.embedding: Embedding = empty_embedding(room)
        self.star = np.empty(room, np.int32)
        self.frozen = np.empty(room, np.uint8)
        self.degree = np.empty(room, np.int32)
        self.active = np.ones(room, np.uint8)
        self.shape = np.empty(len(t.tri) // 3)
        self._embed(0)

    def run(self) -> Changes:
        """Optimise; what is good already is left alone."""
        swaps = self._swap()
        collapses = splits = passes = 0
        for round_number in range(ROUNDS):
            self._smooth()
            swaps += swap_for_degree(
                self.t, self.embedding, self.frozen, self.degree, self.active, LEAST_FOR_DEGREE
            )
            self._smooth()
            swaps += self._swap()
            passes += 2
            if round_number + 1 < ROUNDS:
                collapses += self._collapse()
                splits += self._split()
                if round_number == 0:
                    swaps += self._swap()
        for _ in range(FINAL_PASSES):
            passes += 1
            if self._smooth() == 0:
                break
        swaps += self._swap()
        return Changes(swaps, collapses, splits, passes)

    def _find_stars(self) -> None:
        find_stars(self.t, self.star, self.frozen, self.degree)

    def _embed(self, first: int) -> None:
        """Put the vertices from ``first`` on back on the surface, with their exact metric."""
        block = 1 << 15
        scaling = self.field.scaling
        largest = float(self.field.background.box[4]) / float(scaling.extent.max())
        for start in range(first, int(self.t.count[0]), block):
            xy = self.t.xy[start : min(start + block, int(self.t.count[0]))]
            r, ru, rv = self.surface.evaluate(scaling.to_uv(xy), 1)
            ru /= scaling.factor[0]
            rv /= scaling.factor[1]
            embed(
                self.t, self.embedding, self.field.background, start, r, ru, rv, 1e3 * largest
            )

    def _smooth(self) -> int:
        self._find_stars()
        moved = smooth(
            self.t, self.embedding, self.field.background,
            self.star, self.frozen, self.active, STIFFNESS,
        )  # fmt: skip
        if moved:
            self._embed(0)
        return moved

    def _swap(self) -> int:
        return swap_for_shape(self.t, self.embedding, self.shape, self.active, SWEEPS)

    def _collapse(self) -> int:
        self._find_stars()
        return collapse_short(
            self.t, self.embedding, self.star, self.frozen, self.degree, self.active,
            SHORTEST, FEW,
        )  # fmt: skip

    def _split(self) -> int:
        first = split_long(self.t, self.embedding, LONGEST, self.active)
        self._embed(first)
        return int(self.t.count[0]) - first
