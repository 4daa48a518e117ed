"""Edges that run side by side, so that they are cut with nodes that face each other.

    a  o-------o-------o------o       a run: a part of one edge, at its samples, with their feet on
       :       :       :      :       its mate
    b  o-------o-------o------o

Looked for beside each other are the sides of narrow faces, edges of a face that meet and turn
back, and edges of a face that come near to each other. What follows from it is in the core
(``mated_cuts``).
"""

from __future__ import annotations

from itertools import chain

import numpy as np

from surfmesh._core import edges
from surfmesh._core.edges import MateRuns
from surfmesh._core.space import edge_gaps, edge_sags
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import model_arrays, offsets
from surfmesh.meshing.edges.edge_samples import EdgeSamples

ACUTE = 0.85
"""Cosine of the angle between edges that meet: wider wedges have no narrow part to speak of."""

FEWEST = 2
"""Samples of a run of edges that are no sides of a narrow face."""

_NONE, _NO_NUMBERS = np.empty(0), np.empty(0, np.int64)

NO_RUNS = MateRuns(_NO_NUMBERS, _NO_NUMBERS, np.zeros(1, np.int64), _NONE, _NONE, _NONE)
"""Before any are looked for."""


def mate_runs(model: CadModel, samples: EdgeSamples) -> MateRuns:
    """Of the two sides of every narrow face, both ways, and of other edges of a face that are as
    near to each other, inside or outside of it."""
    of_narrow = _runs_of_narrow(model, samples)
    known = set(zip(of_narrow.edge.tolist(), of_narrow.mate.tolist()))
    widths: dict[tuple[int, int], float] = {}
    pairs = dict.fromkeys([*_meeting_pairs(model, samples), *_near_pairs(model, samples)])
    for face, a, b in pairs:
        if (a, b) not in known:
            widths[a, b] = max(widths.get((a, b), 0.0), float(samples.narrow_width[face]))
    row = {edge: k for k, edge in enumerate(dict.fromkeys(chain(*widths)))}
    chains = [[(edge, False)] for edge in row]
    between = [(row[a], row[b], width) for (a, b), width in widths.items()]
    return _joined(of_narrow, _runs(model, samples, chains, between, FEWEST))


def _runs_of_narrow(model: CadModel, samples: EdgeSamples) -> MateRuns:
    """Of the sides of narrow faces, both ways."""
    chains: list[list[tuple[int, bool]]] = []
    pairs = []
    for number, narrow in samples.narrow.items():
        coedges = list(model.faces[number].coedges)
        width, first = float(samples.narrow_width[number]), len(chains)
        pairs += [(first, first + 1, width), (first + 1, first, width)]
        for side in narrow.sides:
            chains.append([(coedges[k].edge, coedges[k].reversed) for k in side])
    return _runs(model, samples, chains, pairs, 1)


def _runs(
    model: CadModel, samples: EdgeSamples, chains: list[list[tuple[int, bool]]],
    pairs: list[tuple[int, int, float]], fewest: int,
) -> MateRuns:  # fmt: skip
    """The runs of chains in pairs: of so many samples, within a width of each other.

    chains: edges, and whether they are walked backwards.
    """
    if not pairs:
        return NO_RUNS
    uses = list(chain(*chains))
    own, other, width = zip(*pairs)
    return edges.mate_runs(
        model_arrays(model).curves, samples.points, samples.t, samples.first,
        np.array([edge for edge, _ in uses], np.int64),
        np.array([is_reversed for _, is_reversed in uses], np.uint8),
        offsets(np.array([len(part) for part in chains], np.int64)),
        np.array(own, np.int64), np.array(other, np.int64), np.array(width), fewest,
    )  # fmt: skip


def _joined(one: MateRuns, other: MateRuns) -> MateRuns:
    """The runs of both."""
    return MateRuns(
        np.concatenate([one.edge, other.edge]),
        np.concatenate([one.mate, other.mate]),
        np.concatenate([one.first, one.first[-1] + other.first[1:]]),
        np.concatenate([one.t, other.t]),
        np.concatenate([one.foot, other.foot]),
        np.concatenate([one.gap, other.gap]),
    )


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
    ends, sag = model_arrays(model).mesh_ends, edge_sags(points, first)
    several = np.diff(samples.first_of_face) > 1
    looked_at = np.flatnonzero(samples.is_wide & several & (samples.narrow_width > 0.0))
    widths, seen = np.unique(samples.narrow_width[looked_at], return_index=True)
    count = np.diff(first)
    found = []
    for width in widths[np.argsort(seen)].tolist():  # in the order of their first faces
        faces = looked_at[samples.narrow_width[looked_at] == width]
        start, in_a_row = samples.edges_of_faces(faces)
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
