"""The edges of a CAD model, each cut once for all its faces.

    target sizes at samples of edges -> graded along edges, through vertices -> cut to unit
    (edge_samples), limits of           and across faces (shortest paths         metric length
    earlier rounds                      over all samples of the model)

What two faces share are these nodes, by number: the mesh is watertight because of it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple, overload

import numpy as np

from surfmesh._core.edges import (
    cut_to_metric_length,
    graded_over_faces,
    lowered_to_mates,
    mated_cuts,
    node_numbers,
    rows_of,
)
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import counts_of, model_arrays, offsets
from surfmesh.errors import SizingError
from surfmesh.meshing.edges.edge_gradation import graded_by_direction
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

LARGEST_TURN = np.pi / 3.0
"""No segment of an edge turns farther, so that polygons keep the shape of their loops."""
LARGEST_TURN_TINY = np.pi / 2.0
"""Nor farther than this where it is narrower than the chord: four segments round a needle."""
LEAST_STEP = 1e-12
"""Of the diagonal: steps along edges are not taken to be shorter."""

MATED_TURNS, LEAST_CHANGE = 3, 0.97
"""How often sizes are graded and lowered to those of mates, at most; where that lowers none by this
factor they agree."""

_NONE, _NO_NUMBERS = np.empty(0), np.empty(0, np.int64)

CLOSED_SEGMENTS, TWIN_SEGMENTS = 3, 2
"""Fewest segments of an edge that ends where it starts, and of a curved one beside another edge
between the same two vertices: their chords would be one edge of the mesh."""


class EdgeNodes(NamedTuple):
    """The nodes of one edge, from its start to its end."""

    t: np.ndarray
    """(n,) normalised parameters of the edge, 0 to 1."""
    points: np.ndarray
    """(n, 3) on the edge's curve; the ends are the CAD vertices."""
    numbers: np.ndarray
    """(n,) int64 numbers in the whole mesh."""
    sizes: np.ndarray
    """(n,) wanted edge lengths."""


_NO_NODES = EdgeNodes(_NONE, np.empty((0, 3)), _NO_NUMBERS, _NONE)


@dataclass(frozen=True, eq=False)
class CutEdges(Sequence[EdgeNodes | None]):
    """The nodes of all edges (None: one vertex), in rows, edge after edge."""

    first: np.ndarray = field(default_factory=lambda: np.zeros(1, np.int64))
    """(e + 1,) rows of the edges; none of an edge that is one vertex."""
    rows: EdgeNodes = _NO_NODES
    """Of all edges."""
    made: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    """(e,) the round in which the nodes of each edge were made, 0 for the first."""
    graded: np.ndarray | None = None
    """(n,) graded sizes at the samples, before any were lowered to those of mates."""

    def __len__(self) -> int:
        return len(self.first) - 1

    @overload
    def __getitem__(self, edge: int) -> EdgeNodes | None: ...
    @overload
    def __getitem__(self, edge: slice) -> list[EdgeNodes | None]: ...
    def __getitem__(self, edge: int | slice) -> EdgeNodes | list[EdgeNodes | None] | None:
        if isinstance(edge, slice):
            return [self[k] for k in range(*edge.indices(len(self)))]
        a, b = int(self.first[edge]), int(self.first[edge + 1])
        return EdgeNodes(*(part[a:b] for part in self.rows)) if a < b else None


def cut_edges(
    model: CadModel,
    sizing: Sizing,
    samples: EdgeSamples,
    limits: Mapping[int, SizeLimits],
    before: CutEdges | None = None,
) -> CutEdges:
    """Nodes of every edge (None: one vertex); vertices keep their numbers, others follow.

    sizing: with the model's defaults filled in. limits: by face, from earlier rounds. before:
    the nodes of the last round; edges that have not changed since keep them.
    """
    target_size = samples.target_size
    if limits:
        target_size = target_size.copy()
        for face, limit in limits.items():
            along = samples.along(face)
            if samples.is_anisotropic:
                found = limit.along(samples.points[along], samples.tangent[along][None])[0]
            else:
                found = limit(samples.points[along])
            target_size[along] = np.minimum(target_size[along], found)
    found = graded_with_mates(
        model, samples, target_size, sizing, before.graded if before else None
    )
    size, graded = found.sizes, found.graded
    fewest = _fewest(model, samples)
    mated = _mated(model, samples, size, fewest, sizing.limit)
    cuts = _cut(model, samples, size, fewest, mated, sizing.limit)
    for row in np.flatnonzero(samples.hidden[cuts.edges]).tolist():  # but they hear of them
        own, at = samples.of(cuts.edges[row]), slice(cuts.first[row], cuts.first[row + 1])
        cuts.sizes[at] = np.minimum(
            cuts.sizes[at], np.interp(cuts.t[at], samples.t[own], graded[own])
        )
    return replace(_numbered(model, cuts, before), graded=found.first_graded)


class GradedSizes(NamedTuple):
    """Sizes (n,) at the samples of edges."""

    sizes: np.ndarray
    """That edges are cut by."""
    graded: np.ndarray
    """Those that neighbours hear of: they differ on hidden edges."""
    first_graded: np.ndarray
    """Before any were lowered to those of mates."""


def graded_with_mates(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing,
    before: np.ndarray | None = None,
) -> GradedSizes:  # fmt: skip
    """Sizes at the samples: graded, and lowered to those of mates, by turns.

    Once where sizes depend on the direction: there edges do not hear of each other across faces.
    before: the first graded sizes of an earlier round, in which no target size was smaller.
    """
    if samples.is_anisotropic:
        return _graded_once(model, samples, target_size, sizing)
    target_size = _lowered(samples, target_size)
    first = graded = _graded(model, samples, target_size, sizing, before)
    if not samples.mates and not samples.hidden.any():
        return GradedSizes(graded, graded, first)
    for turns_left in reversed(range(MATED_TURNS)):
        size = _lowered(samples, np.where(samples.is_hidden, target_size, graded))
        if not turns_left or (size >= LEAST_CHANGE * graded).all():
            break
        target_size = np.minimum(target_size, size)
        graded = _graded(model, samples, target_size, sizing, graded)
    return GradedSizes(size, graded, first)


def _graded_once(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing
) -> GradedSizes:
    """The same where sizes depend on the direction."""
    target_size = _lowered(samples, target_size)
    graded = _graded_by_direction(model, samples, target_size, sizing)
    size = _lowered(samples, np.where(samples.is_hidden, target_size, graded))
    return GradedSizes(size, graded, graded)


def _lowered(samples: EdgeSamples, sizes: np.ndarray) -> np.ndarray:
    """Sizes (n,) at the samples, lowered to those of mates."""
    if not samples.mates:
        return sizes
    return np.asarray(lowered_to_mates(samples.mates, samples.t, samples.first, sizes))


def _graded(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing,
    before: np.ndarray | None,
) -> np.ndarray:  # fmt: skip
    """Sizes (n,) at the samples: the target size of any sample plus the slope times the way, along
    edges and straight across faces.

    before: what this has found for target sizes of which none was smaller.
    """
    arrays = model_arrays(model)
    first_of_face, edges_of_face = samples.edges_of_wide_faces
    return graded_over_faces(
        samples.points, target_size, samples.first, arrays.mesh_ends, len(arrays.corners),
        first_of_face, edges_of_face, sizing.gradient, LEAST_STEP * model.diagonal, before,
    )  # fmt: skip


def _graded_by_direction(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing
) -> np.ndarray:
    """Sizes (n,) at the samples, where those along two edges differ at their vertex."""
    there = np.flatnonzero(counts_of(samples.first)).tolist()
    if not there:
        return target_size
    ends = model_arrays(model).mesh_ends[there]
    own = [samples.of(k) for k in there]
    ways = np.array([samples.tangent[k][[0, -1]] for k in own])
    return np.concatenate(
        graded_by_direction(
            [samples.points[k] for k in own], [target_size[k] for k in own], ways, ends,
            sizing.gradient, sizing.anisotropy,
        )
    )  # fmt: skip


def _fewest(model: CadModel, samples: EdgeSamples) -> np.ndarray:
    """Segments (e,) that edges need for their shape and for their topology."""
    most = np.where(samples.tiny, LARGEST_TURN_TINY, LARGEST_TURN)
    of_shape = np.ceil(samples.total_curvature / most - 1e-9)
    of_ends = np.where(samples.has_twin, TWIN_SEGMENTS, 1)
    of_ends[model_arrays(model).is_closed] = CLOSED_SEGMENTS
    return np.maximum(of_shape, of_ends).astype(np.int64)


def _mated(
    model: CadModel, samples: EdgeSamples, sizes: np.ndarray, fewest: np.ndarray, limit: int
) -> dict[int, np.ndarray]:
    """The nodes of edges with mates, found together: fractions (k,) by edge, from 0 to 1."""
    if not samples.mates:
        return {}
    arrays = model_arrays(model)
    edges, first, t = mated_cuts(
        samples.mates, arrays.curves, samples.points, samples.t, samples.first, arrays.mesh_ends,
        arrays.ends, arrays.corners, arrays.length, samples.total_curvature, fewest,
        _chords(samples), samples.shortest, sizes, model.diagonal, limit,
    )  # fmt: skip
    return {edge: t[a:b] for edge, (a, b) in zip(edges.tolist(), pairwise(first.tolist()))}


def _chords(samples: EdgeSamples) -> np.ndarray:
    """What segments of each edge (e,) may sag by, infinite where they are not cut for it."""
    return np.where(samples.tiny, np.inf, samples.chord)


class _Cuts(NamedTuple):
    """The nodes of some edges in one row, as ``EdgeNodes`` has them."""

    edges: np.ndarray  # (k,)
    first: np.ndarray  # (k + 1,)
    t: np.ndarray
    points: np.ndarray
    sizes: np.ndarray


def _cut(
    model: CadModel, samples: EdgeSamples, sizes: np.ndarray, fewest: np.ndarray,
    mated: Mapping[int, np.ndarray], limit: int,
) -> _Cuts:  # fmt: skip
    """Segments of equal metric length near 1, or those between given parameters; of all edges."""
    arrays = model_arrays(model)
    edges = np.flatnonzero(counts_of(samples.first))
    given, count = [_NONE], np.zeros(len(edges), np.int64)
    if mated:
        given = [mated.get(edge, _NONE) for edge in edges.tolist()]
        count = np.array([len(t) for t in given], np.int64)
    first, t, points, found, refused, segments = cut_to_metric_length(
        arrays.curves, samples.points, samples.t, sizes, samples.first, arrays.mesh_ends,
        arrays.corners, edges, fewest[edges], offsets(count), np.concatenate([_NONE, *given]),
        _chords(samples)[edges], samples.shortest[edges], limit,
    )  # fmt: skip
    if refused >= 0:
        number = int(edges[refused])
        edge = model.edges[number]
        raise SizingError(
            f"edge {number} ({edge.name or 'no name'}) of length {edge.length:g} is to be cut in "
            f"{segments:,.0f} segments, the limit is {limit:,} triangles: ask for a larger size "
            "there"
        )
    return _Cuts(edges, first, t, points, found)


def _numbered(model: CadModel, cuts: _Cuts, before: CutEdges | None) -> CutEdges:
    """What has not changed keeps its nodes, others get new numbers."""
    edges, known, following = cuts.edges, _NO_NUMBERS, len(model.vertices)
    every, made = np.zeros((2, len(model.edges)), np.int64)
    every[edges] = counts_of(cuts.first)
    if before:
        kept, numbers = _unchanged(cuts, before), before.rows.numbers
        following = max(following, 1 + int(numbers.max()))
        known = np.full(len(cuts.t), -1)
        known[np.repeat(kept, every[edges])] = numbers[rows_of(before.first, edges[kept])]
        made[:] = before.made
        made[edges[~kept]] = 1 + before.made.max()
    numbers = node_numbers(cuts.first, model_arrays(model).mesh_ends[edges], known, following)
    return CutEdges(offsets(every), EdgeNodes(cuts.t, cuts.points, numbers, cuts.sizes), made)


def _unchanged(cuts: _Cuts, before: CutEdges) -> np.ndarray:
    """Of the cut edges (k,): are their places and sizes those of before to the last bit?"""
    count = counts_of(cuts.first)
    found = counts_of(before.first)[cuts.edges] == count
    if not found.any():
        return found
    old, new = rows_of(before.first, cuts.edges[found]), np.repeat(found, count)
    same = (before.rows.t[old] == cuts.t[new]) & (before.rows.sizes[old] == cuts.sizes[new])
    found[found] = np.logical_and.reduceat(same, offsets(count[found])[:-1])
    return found
