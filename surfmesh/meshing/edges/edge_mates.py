"""Edges that run side by side are cut with nodes that face each other.

    a  o-------o-------o------o       the nodes of one edge have feet on its mate, which is cut
       :       :       :      :       there and nowhere else; where that would leave a node of its
    b  o-------o-------o------o       own (a vertex of a third edge) the other edge gets its foot

Two polygons whose nodes face each other do not cross, however near to each other their curves
are: cut one by one they would where the distance is less than the sag of a segment.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from surfmesh._core.space import edge_gaps, edge_sags
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import model_arrays, offsets, rows_of
from surfmesh.meshing.edges.edge_samples import EdgeSamples, MateRun
from surfmesh.meshing.edges.narrow_faces import Chain, chain_of, feet, foot_on_edge
from surfmesh.meshing.edges.polygon_lengths import lengths_along

SWEEPS = 6
"""How often feet of new nodes are looked for, at most."""

SAME_SIZE, SAME_GAP = 0.3, 0.5
"""A node that lies off the foot by less than this fraction of the size there is the mate itself;
on bent edges by less than this part of the gap over the turn of a segment: chords would cross."""

ACUTE = 0.85
"""Cosine of the angle between edges that meet: wider wedges have no narrow part to speak of."""

LEAST_TURN = 1e-3
"""Radians: edges that turn less from node to node are straight."""

COINCIDENT = 1e-12
"""Of the diagonal: edges nearer than this all along lie on each other and have no mates."""


def mate_runs(model: CadModel, samples: EdgeSamples) -> list[MateRun]:
    """Of the two sides of every narrow face, both ways, and of other edges of a face that are as
    near to each other, inside or outside of it."""
    found = []
    for number, narrow in samples.narrow.items():
        coedges = list(model.faces[number].coedges)
        first, second = (chain_of(coedges, samples, side) for side in narrow.sides)
        if first is None or second is None:
            continue
        for own, other in ((first, second), (second, first)):
            found += _runs(model, own, other, float(samples.narrow_width[number]))
    pairs = dict.fromkeys([*_meeting_pairs(model, samples), *_near_pairs(model, samples)])
    widths: dict[tuple[int, int], float] = {}
    known = {(run.edge, run.mate) for run in found}
    for face, a, b in pairs:
        if (a, b) not in known:
            widths[a, b] = max(widths.get((a, b), 0.0), float(samples.narrow_width[face]))
    for (a, b), width in widths.items():
        own, other = (_edge_chain(samples, edge) for edge in (a, b))
        found += [run for run in _runs(model, own, other, width) if len(run.t) > 1]
    return found


def _meeting_pairs(model: CadModel, samples: EdgeSamples) -> list[tuple[int, int, int]]:
    """(face, edge, edge) of coedges that follow each other and turn back, both ways."""
    arrays, points, first = model_arrays(model), samples.points, samples.first
    looked_at = samples.narrow_width > 0.0
    looked_at[list(samples.narrow)] = False
    one, other = arrays.successions
    if not looked_at.all():
        of_them = looked_at[arrays.coedge_face[one]]
        one, other = one[of_them], other[of_them]
    edge, back = arrays.coedge_edge, arrays.coedge_reversed
    a, b = edge[one], edge[other]
    end = np.where(back[one], first[a], first[a + 1] - 1)  # of walking
    start = np.where(back[other], first[b + 1] - 1, first[b])
    into = points[np.where(back[one], end + 1, end - 1)] - points[end]
    out = points[np.where(back[other], start - 1, start + 1)] - points[start]
    lengths = np.linalg.norm(into, axis=1) * np.linalg.norm(out, axis=1)
    found = []
    for row in np.flatnonzero((into * out).sum(axis=1) > ACUTE * lengths).tolist():
        face, own, mate = int(arrays.coedge_face[one[row]]), int(a[row]), int(b[row])
        found += [(face, own, mate), (face, mate, own)]
    return found


def _near_pairs(model: CadModel, samples: EdgeSamples) -> list[tuple[int, int, int]]:
    """(face, edge, edge) of edges that do not meet and are somewhere narrowly apart, both ways."""
    points, first = samples.points, samples.first
    if len(points) < 3:
        return []
    arrays, sag = model_arrays(model), edge_sags(points, first)
    ends, (first_edge, edges) = arrays.mesh_ends, arrays.edges_of_faces
    several = np.diff(first_edge) > 1
    looked_at = np.flatnonzero(samples.is_wide & several & (samples.narrow_width > 0.0))
    widths, seen = np.unique(samples.narrow_width[looked_at], return_index=True)
    count = np.diff(first)
    found = []
    for width in widths[np.argsort(seen)].tolist():  # in the order of their first faces
        faces = looked_at[samples.narrow_width[looked_at] == width]
        in_a_row = edges[rows_of(first_edge, faces)]
        start = offsets(np.diff(first_edge)[faces])
        reach = np.repeat(width + sag + sag.max(), count)
        gap, boxes = edge_gaps(points, reach, first, ends, in_a_row, start)
        near = np.zeros(len(model.edges), bool)
        near[np.searchsorted(first, np.flatnonzero(np.isfinite(gap)), side="right") - 1] = True
        low, high = boxes[:, :3], boxes[:, 3:]
        some = np.add.reduceat(near[in_a_row], start[:-1], dtype=np.int64) > 1
        for k in np.flatnonzero(some).tolist():
            face, own = int(faces[k]), in_a_row[start[k] : start[k + 1]]
            own = own[near[own]]
            for a in own.tolist():
                apart = np.maximum(np.maximum(low[own] - high[a], low[a] - high[own]), 0.0)
                close = np.linalg.norm(apart, axis=1) <= width + sag[a] + sag[own]
                meets = (ends[own, :, None] == ends[a]).any(axis=(1, 2))
                found += [(face, a, b) for b in own[close & ~meets].tolist()]
    return found


def _edge_chain(samples: EdgeSamples, edge: int) -> Chain:
    """One edge as a chain."""
    own = samples.of(edge)
    points, t = samples.points[own], samples.t[own]
    count = len(points) - 1
    return Chain(points, np.zeros(count, int), np.full(count, edge), t[:-1], t[1:])


def _runs(model: CadModel, own: Chain, other: Chain, width: float) -> list[MateRun]:
    """The runs of one side along the other."""
    found = []
    for coedge in dict.fromkeys(own.coedge.tolist()):
        at = np.flatnonzero(own.coedge == coedge)
        t = np.r_[own.t[at], own.t_end[at[-1]]]
        points = own.points[np.r_[at, at[-1] + 1]]
        edge = int(own.edge[at[0]])
        place, foot, gap = feet(model, points, other)
        mate = other.edge[place]
        near = (gap <= width) & (mate != edge)
        starts = np.flatnonzero(np.r_[True, (np.diff(mate) != 0) | (near[1:] != near[:-1])])
        for rows in np.split(np.arange(len(t)), starts[1:]):
            if not near[rows[0]]:
                continue
            order = rows[np.argsort(t[rows], kind="stable")]
            found.append(MateRun(edge, int(mate[rows[0]]), t[order], foot[order], gap[order]))
    return found


def lower_to_mates(samples: EdgeSamples, mates: list[MateRun], sizes: np.ndarray) -> None:
    """Lower the sizes (n,) at samples, in place, to those of their mates."""
    for run in mates:
        own, other = samples.of(run.edge), samples.of(run.mate)
        found = np.interp(run.foot, samples.t[other], sizes[other])
        rows = own.start + np.searchsorted(samples.t[own], run.t)
        rows = np.minimum(rows, own.stop - 1)
        sizes[rows] = np.minimum(sizes[rows], found)


class MatedCuts:
    """Parameters of the nodes of all edges with mates, found together."""

    def __init__(
        self, model: CadModel, samples: EdgeSamples, sizes: np.ndarray, fewest: np.ndarray
    ) -> None:
        """sizes (n,): at the samples, graded. fewest: (e,) segments of the edges."""
        self.model, self.samples, self.sizes, self.fewest = model, samples, sizes, fewest
        self.runs: dict[int, list[MateRun]] = {}
        for run in samples.mates:
            if run.gap.max() <= COINCIDENT * model.diagonal:
                continue  # feet would be told apart by rounding alone, without end
            self.runs.setdefault(run.edge, []).append(run)
            self.runs.setdefault(run.mate, [])
        self.t = {edge: np.array([0.0, 1.0]) for edge in self.runs}
        self._seen: dict[int, int] = {}  # nodes of the edge when feet of a run were looked for
        self._length = {edge: self._lengths(edge) for edge in self.runs}

    def cut(self) -> dict[int, np.ndarray]:
        """Parameters (k,) by edge, rising from 0 to 1."""
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
                self.t[own] = self._subdivided(own)
                for run in self.runs[own]:
                    if run.mate not in done:
                        self._add_feet(run)
                        queue.append(run.mate)
        self._spread()
        return self.t

    def _spread(self) -> None:
        for _ in range(SWEEPS):
            if not sum(self._add_feet(run) for own in self.runs.values() for run in own):
                break

    def _add_feet(self, run: MateRun) -> int:
        """Cut the mate where nodes of the edge have their feet; how many are new."""
        own = self.t[run.edge]
        if self._seen.get(id(run)) == len(own):
            return 0
        self._seen[id(run)] = len(own)
        reach = 0.5 * np.diff(run.t).max() if len(run.t) > 1 else 0.0
        own = own[(own >= run.t[0] - reach) & (own <= run.t[-1] + reach)]
        own = own[~self._is_node_of(run.mate, run.edge, own)]
        if not len(own):
            return 0
        edge = self.model.edges[run.edge]
        points = edge.evaluate(own, 0)[0]
        for k in np.flatnonzero((own == 0.0) | (own == 1.0)):
            points[k] = self.model.vertices[edge.start if own[k] == 0.0 else edge.end].point
        guess = np.interp(own, run.t, run.foot)
        foot, away = foot_on_edge(self.model, run.mate, points, guess)
        gap = np.interp(own, run.t, run.gap)
        there = away <= 2.0 * gap + 1e-9 * self.model.diagonal
        foot, away = foot[there], away[there]
        nodes = self.t[run.mate]
        right = np.clip(np.searchsorted(nodes, foot), 1, len(nodes) - 1)
        along, ends = self._along(run.mate, foot), self._along(run.mate, nodes)
        near = np.minimum(np.abs(along - ends[right - 1]), np.abs(along - ends[right]))
        same = self._same(run.mate, foot, away)
        added: list[float] = []
        for new in np.flatnonzero(near > same).tolist():
            if all(abs(along[new] - place) > same[new] for place in added):
                added.append(float(along[new]))
                nodes = np.append(nodes, foot[new])
        if added:
            self.t[run.mate] = np.unique(nodes)
        return len(added)

    def _is_node_of(self, mate: int, edge: int, t: np.ndarray) -> np.ndarray:
        """Which parameters (n,) of an edge are vertices that the mate has too: these are their own
        feet, however far from the vertex its curves end."""
        ends = model_arrays(self.model).mesh_ends
        start, end = np.isin(ends[edge], ends[mate]).tolist()
        return np.asarray(((t == 0.0) & start) | ((t == 1.0) & end))

    def _lengths(self, edge: int) -> np.ndarray:
        return lengths_along(self.samples.points[self.samples.of(edge)])

    def _along(self, edge: int, t: np.ndarray) -> np.ndarray:
        """Lengths (n,) from the start of an edge to parameters (n,)."""
        return np.interp(t, self.samples.t[self.samples.of(edge)], self._length[edge])

    def _same(self, edge: int, foot: np.ndarray, gap: np.ndarray) -> np.ndarray:
        """How near (n,) to its foot (n,) a node is the mate itself, where the gap is (n,)."""
        at = self.samples.of(edge)
        size = np.interp(foot, self.samples.t[at], self.sizes[at])
        length = max(self.model.edges[edge].length, np.finfo(float).tiny)
        turn = np.maximum(
            self.samples.total_curvature[edge] * np.minimum(size / length, 1.0), LEAST_TURN
        )
        same = np.minimum(SAME_SIZE * size, SAME_GAP * gap / turn)
        return np.maximum(same, 1e-9 * length)

    def _subdivided(self, edge: int) -> np.ndarray:
        """The parameters with more between them, in pieces of metric length near 1."""
        at = self.samples.of(edge)
        points, t, size = (a[at] for a in (self.samples.points, self.samples.t, self.sizes))
        step = np.linalg.norm(np.diff(points, axis=0), axis=1)
        metric = np.r_[0.0, np.cumsum(2.0 * step / (size[1:] + size[:-1]))]
        ends = np.interp(self.t[edge], t, metric)
        pieces = np.maximum(1, np.round(np.diff(ends))).astype(int)
        fewest = self.fewest[edge]
        while pieces.sum() < fewest:
            pieces[(np.diff(ends) / pieces).argmax()] += 1
        cut = [
            np.interp(a + (b - a) * np.arange(1, n) / n, metric, t)
            for a, b, n in zip(ends[:-1], ends[1:], pieces.tolist())
        ]
        return self._within_chord(edge, np.unique(np.concatenate([self.t[edge], *cut])))

    def _within_chord(self, edge: int, t: np.ndarray) -> np.ndarray:
        """The parameters with one more in the middle of each segment that sags by more than the
        chord: feet divide an edge at will, so that some are half as long again as wanted."""
        if self.samples.tiny[edge] or not np.isfinite(self.samples.chord[edge]):
            return t
        for _ in range(SWEEPS):
            sag, length = model_arrays(self.model).curves.sags(edge, t)
            far = (sag > self.samples.chord[edge]) & (length > self.samples.shortest[edge])
            if not far.any():
                break
            t = np.sort(np.concatenate([t, 0.5 * (t[:-1] + t[1:])[far]]))
        return t
