"""Edges that run side by side are cut with nodes that face each other.

    a  o-------o-------o------o       the nodes of one edge have feet on its mate, which is cut
       :       :       :      :       there and nowhere else; where that would leave a node of its
    b  o-------o-------o------o       own (a vertex of a third edge) the other edge gets its foot

Two polygons whose nodes face each other do not cross, however near to each other their curves
are: cut one by one they would where the distance is less than the sag of a segment.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfmesh.cad.model import CadModel
from surfmesh.meshing.narrow_faces import Chain, chain_of, feet, foot_on_edge

SWEEPS = 6
"""How often feet of new nodes are looked for, at most."""

SAME_SIZE, SAME_GAP = 0.3, 0.5
"""A node that lies off the foot by less than this share of the size there is the mate itself;
on bent edges by less than this share of the gap over the turn of a segment: chords would cross."""

LEAST_TURN = 1e-3
"""Radians: edges that turn less from node to node are straight."""


@dataclass(frozen=True)
class MateRun:
    """A part of an edge and its feet on another one, at samples.

    share (n,) rising, foot (n,): shares of both edges; gap (n,): distance.
    """

    edge: int
    mate: int
    share: np.ndarray
    foot: np.ndarray
    gap: np.ndarray


def mate_runs(model: CadModel, samples) -> list[MateRun]:
    """Of the two sides of every narrow face, both ways. samples: ``EdgeSamples``."""
    found = []
    for number, narrow in samples.narrow.items():
        coedges = list(model.faces[number].coedges)
        sides = [chain_of(coedges, samples, side) for side in narrow.sides]
        for own, other in (sides, sides[::-1]):
            found += _runs(model, own, other, float(samples.narrow_width[number]))
    return found


def _runs(model: CadModel, own: Chain, other: Chain, width: float) -> list[MateRun]:
    """The runs of one side along the other."""
    found = []
    for coedge in dict.fromkeys(own.coedge.tolist()):
        at = np.flatnonzero(own.coedge == coedge)
        share = np.r_[own.share[at], own.share_end[at[-1]]]
        points = own.points[np.r_[at, at[-1] + 1]]
        edge = int(own.edge[at[0]])
        place, foot, gap = feet(model, points, other)
        mate = other.edge[place]
        near = (gap <= width) & (mate != edge)
        starts = np.flatnonzero(np.r_[True, (np.diff(mate) != 0) | (near[1:] != near[:-1])])
        for rows in np.split(np.arange(len(share)), starts[1:]):
            if not near[rows[0]]:
                continue
            order = rows[np.argsort(share[rows], kind="stable")]
            found.append(MateRun(edge, int(mate[rows[0]]), share[order], foot[order], gap[order]))
    return found


def share_sizes(samples, mates: list[MateRun], sizes: np.ndarray) -> None:
    """Lower the sizes (n,) at samples, in place, to those of their mates."""
    for run in mates:
        own, other = samples.of(run.edge), samples.of(run.mate)
        found = np.interp(run.foot, samples.share[other], sizes[other])
        rows = own.start + np.searchsorted(samples.share[own], run.share)
        rows = np.minimum(rows, own.stop - 1)
        sizes[rows] = np.minimum(sizes[rows], found)


class MatedCuts:
    """Shares of the nodes of all edges with mates, found together."""

    def __init__(
        self, model: CadModel, samples, sizes: np.ndarray, fewest: Callable[[int], int]
    ) -> None:
        """sizes (n,): at the samples, graded. fewest: segments of an edge, by number."""
        self.model, self.samples, self.sizes, self.fewest = model, samples, sizes, fewest
        self.runs: dict[int, list[MateRun]] = {}
        for run in samples.mates:
            self.runs.setdefault(run.edge, []).append(run)
            self.runs.setdefault(run.mate, [])
        self.shares = {edge: np.array([0.0, 1.0]) for edge in self.runs}

    def cut(self) -> dict[int, np.ndarray]:
        """Shares (k,) by edge, rising from 0 to 1."""
        if not self.runs:
            return {}
        self._spread()  # the feet of vertices
        done: set[int] = set()
        for edge in sorted(self.runs, key=lambda e: (-self.model.edges[e].length, e)):
            queue = deque([edge])
            while queue:
                own = queue.popleft()
                if own in done:
                    continue
                done.add(own)
                self.shares[own] = self._subdivided(own)
                for run in self.runs[own]:
                    if run.mate not in done:
                        self._add_feet(run)
                        queue.append(run.mate)
        self._spread()
        return self.shares

    def _spread(self) -> None:
        for _ in range(SWEEPS):
            if not sum(self._add_feet(run) for own in self.runs.values() for run in own):
                break

    def _add_feet(self, run: MateRun) -> int:
        """Cut the mate where nodes of the edge have their feet; how many are new."""
        own = self.shares[run.edge]
        reach = 0.5 * np.diff(run.share).max() if len(run.share) > 1 else 1e-3
        own = own[(own >= run.share[0] - reach) & (own <= run.share[-1] + reach)]
        if not len(own):
            return 0
        edge = self.model.edges[run.edge]
        points = edge.curve.evaluate(edge.parameters(own), 0)[0]
        for k in np.flatnonzero((own == 0.0) | (own == 1.0)):
            points[k] = self.model.vertices[edge.start if own[k] == 0.0 else edge.end].point
        guess = np.interp(own, run.share, run.foot)
        foot, away = foot_on_edge(self.model, run.mate, points, guess)
        gap = np.interp(own, run.share, run.gap)
        there = away <= 2.0 * gap + 1e-9 * self.model.diagonal
        nodes, added = self.shares[run.mate], []
        for t, width in zip(foot[there].tolist(), away[there].tolist()):
            every = np.concatenate([nodes, added])
            near = float(every[np.abs(every - t).argmin()])
            if abs(self._way(run.mate, near, t)) > self._same(run.mate, t, width):
                added.append(t)
        if added:
            self.shares[run.mate] = np.unique(np.concatenate([nodes, added]))
        return len(added)

    def _way(self, edge: int, a: float, b: float) -> float:
        """Length along an edge between two shares."""
        at = self.samples.of(edge)
        points, share = self.samples.points[at], self.samples.share[at]
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
        return float(np.diff(np.interp([a, b], share, length))[0])

    def _same(self, edge: int, t: float, gap: float) -> float:
        """How near to the foot t a node is the mate itself."""
        at = self.samples.of(edge)
        size = float(np.interp(t, self.samples.share[at], self.sizes[at]))
        length = max(self.model.edges[edge].length, np.finfo(float).tiny)
        turn = max(self.samples.turn[edge] * min(size / length, 1.0), LEAST_TURN)
        return max(min(SAME_SIZE * size, SAME_GAP * gap / turn), 1e-9 * length)

    def _subdivided(self, edge: int) -> np.ndarray:
        """The shares with more between them, in pieces of metric length near 1."""
        at = self.samples.of(edge)
        points, share, size = (a[at] for a in (self.samples.points, self.samples.share, self.sizes))
        step = np.linalg.norm(np.diff(points, axis=0), axis=1)
        metric = np.r_[0.0, np.cumsum(2.0 * step / (size[1:] + size[:-1]))]
        ends = np.interp(self.shares[edge], share, metric)
        pieces = np.maximum(1, np.round(np.diff(ends))).astype(int)
        fewest = self.fewest(edge)
        while pieces.sum() < fewest:
            pieces[(np.diff(ends) / pieces).argmax()] += 1
        cut = [
            np.interp(a + (b - a) * np.arange(1, n) / n, metric, share)
            for a, b, n in zip(ends[:-1], ends[1:], pieces.tolist())
        ]
        return np.unique(np.concatenate([self.shares[edge], *cut]))
