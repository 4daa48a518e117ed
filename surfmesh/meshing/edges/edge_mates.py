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
    for face, a, b in _beside(model, samples):
        if (a, b) not in known:
            widths[a, b] = max(widths.get((a, b), 0.0), float(samples.narrow_width[face]))
    row = {edge: k for k, edge in enumerate(dict.fromkeys(chain(*widths)))}
    chains = [[(edge, False)] for edge in row]
    between = [(row[a], row[b], width) for (a, b), width in widths.items()]
    others = _runs(model, samples, chains, between, FEWEST)
    return _joined(of_narrow, others) if len(of_narrow) else others


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


def _beside(model: CadModel, samples: EdgeSamples) -> list[list[int]]:
    """[face, edge, edge] of edges that meet and turn back, and of those that do not meet and are
    somewhere narrowly apart, both ways."""
    arrays = model_arrays(model)
    width = samples.narrow_width
    if samples.narrow:
        width = np.where(samples.is_wide, width, 0.0)
    return edges.edges_beside(
        samples.points, samples.first, arrays.mesh_ends, samples.first_of_face,
        samples.face_edges, arrays.coedge_edge, arrays.coedge_face,
        arrays.coedge_reversed.view(np.uint8), *arrays.successions, width, ACUTE,
    ).tolist()  # fmt: skip
