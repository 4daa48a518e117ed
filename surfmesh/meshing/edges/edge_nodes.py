"""The edges of a CAD model, each cut once for all its faces.

    target sizes at samples of edges -> graded along edges and through vertices -> cut to unit
    (edge_samples), limits of           (Dijkstra over all samples of the        metric length
    earlier rounds                       model; it is a shortest path)

What two faces share are these nodes, by number: the mesh is watertight because of it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadModel
from surfmesh.errors import SizingError
from surfmesh.meshing.edges.edge_gradation import graded_by_direction
from surfmesh.meshing.edges.edge_mates import MatedCuts, lower_to_mates
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

LARGEST_TURN = np.pi / 3.0
"""No segment of an edge turns farther, so that polygons keep the shape of their loops."""
LARGEST_TURN_TINY = np.pi / 2.0
"""Nor farther than this where it is narrower than the chord: four segments round a needle."""
CLOSED_SEGMENTS, TWIN_SEGMENTS = 3, 2
"""Fewest segments of an edge that ends where it starts, and of a curved one beside another edge
between the same two vertices: their chords would be one edge of the mesh."""


@dataclass(frozen=True)
class EdgeNodes:
    """The nodes of one edge, from its start to its end."""

    t: np.ndarray
    """(n,) normalised parameters of the edge, 0 to 1."""
    points: np.ndarray
    """(n, 3) on the edge's curve; the ends are the CAD vertices."""
    numbers: np.ndarray
    """(n,) int64 numbers in the whole mesh."""
    sizes: np.ndarray
    """(n,) wanted edge lengths."""

    def same_as(self, other: "EdgeNodes | None") -> bool:
        """Are the places and the sizes equal to the last bit?"""
        return (
            other is not None
            and np.array_equal(self.t, other.t)
            and np.array_equal(self.sizes, other.sizes)
        )


def cut_edges(
    model: CadModel,
    sizing: Sizing,
    samples: EdgeSamples,
    limits: Mapping[int, SizeLimits],
    before: list[EdgeNodes | None] | None = None,
) -> list[EdgeNodes | None]:
    """Nodes of every edge (None: one vertex); vertices keep their numbers, others follow.

    sizing: with the model's defaults filled in. limits: by face, from earlier rounds. before:
    the nodes of the last round; edges that have not changed since stay the same objects.
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
    grade = _graded_by_direction if samples.is_anisotropic else _graded
    if samples.mates:
        target_size = target_size.copy() if target_size is samples.target_size else target_size
        lower_to_mates(samples, samples.mates, target_size)
    size = grade(model, samples, target_size, sizing)
    for number in np.flatnonzero(samples.hidden).tolist():  # no neighbour hears of them
        size[samples.of(number)] = target_size[samples.of(number)]
    if samples.mates:
        lower_to_mates(samples, samples.mates, size)
    fewest = partial(_fewest, model, samples)
    mated = MatedCuts(model, samples, size, fewest).cut()
    nodes = before or [None] * len(model.edges)
    following = 1 + max([len(model.vertices) - 1, *(int(n.numbers.max()) for n in nodes if n)])
    nodes = list(nodes)
    for number, edge in enumerate(model.edges):
        if samples.first[number] == samples.first[number + 1]:
            continue
        cut = _cut(model, edge, number, samples, size, following, sizing.limit, mated.get(number))
        if not cut.same_as(nodes[number]):
            nodes[number] = cut
            following += len(cut.t) - 2
    return nodes


def _graded(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing
) -> np.ndarray:
    """Sizes (n,) at the samples: the target size of any sample plus the slope times the way."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    total = len(target_size)
    if not total:
        return target_size
    starts, ends = samples.first[:-1], samples.first[1:] - 1
    there = starts <= ends
    starts, ends = starts[there], ends[there]
    node = len(model.vertices) + np.arange(total)  # of the graph: vertices, samples, the root
    corners = samples.vertex[np.array([[edge.start, edge.end] for edge in model.edges])[there]]
    node[starts], node[ends] = corners.T
    root = len(model.vertices) + total  # from which all sizes grow
    step = np.linalg.norm(samples.points[1:] - samples.points[:-1], axis=1)
    step = np.maximum(step, 1e-12 * model.diagonal)  # the sparse graph takes zero for no edge
    inside = np.ones(total - 1, bool)
    inside[ends[:-1]] = False
    graph = coo_matrix(
        (
            np.concatenate([step[inside], target_size / sizing.gradient]),
            (
                np.concatenate([node[:-1][inside], np.full(total, root)]),
                np.concatenate([node[1:][inside], node]),
            ),
        ),
        shape=(root + 1, root + 1),
    )
    # parallel edges would be summed: keep the shorter one
    order = np.lexsort((graph.data, graph.col, graph.row))
    row, column, data = graph.row[order], graph.col[order], graph.data[order]
    kept = np.r_[True, (np.diff(row) != 0) | (np.diff(column) != 0)]
    graph = coo_matrix((data[kept], (row[kept], column[kept])), graph.shape).tocsr()
    return (sizing.gradient * dijkstra(graph, directed=False, indices=root))[node]


def _graded_by_direction(
    model: CadModel, samples: EdgeSamples, target_size: np.ndarray, sizing: Sizing
) -> np.ndarray:
    """Sizes (n,) at the samples, where those along two edges differ at their vertex."""
    there = [k for k in range(len(model.edges)) if samples.first[k] < samples.first[k + 1]]
    if not there:
        return target_size
    ends = np.array([samples.vertex[[model.edges[k].start, model.edges[k].end]] for k in there])
    own = [samples.of(k) for k in there]
    ways = np.array([samples.tangent[k][[0, -1]] for k in own])
    return np.concatenate(
        graded_by_direction(
            [samples.points[k] for k in own], [target_size[k] for k in own], ways, ends,
            sizing.gradient, sizing.anisotropy,
        )
    )  # fmt: skip


def _fewest(model: CadModel, samples: EdgeSamples, number: int) -> int:
    """Segments that an edge needs for its shape and for its topology."""
    edge = model.edges[number]
    most = LARGEST_TURN_TINY if samples.tiny[number] else LARGEST_TURN
    fewest = max(1, int(np.ceil(samples.total_curvature[number] / most - 1e-9)))
    if samples.has_twin[number]:
        fewest = max(fewest, TWIN_SEGMENTS)
    start, end = samples.vertex[[edge.start, edge.end]]
    return max(CLOSED_SEGMENTS if start == end else 1, fewest)


def _cut(
    model: CadModel, edge: CadEdge, number: int, samples: EdgeSamples, sizes: np.ndarray,
    following: int, limit: int, t: np.ndarray | None = None,
) -> EdgeNodes:  # fmt: skip
    """Pieces of equal metric length near 1, or those between given parameters t."""
    own = samples.of(number)
    points, known, size = samples.points[own], samples.t[own], sizes[own]
    dx, dy, dz = (points[1:] - points[:-1]).T
    step = np.sqrt(dx * dx + dy * dy + dz * dz)
    metric = np.zeros(len(points))
    np.cumsum(2.0 * step / (size[1:] + size[:-1]), out=metric[1:])
    start, end = samples.vertex[[edge.start, edge.end]]
    pieces = max(_fewest(model, samples, number), round(float(metric[-1])))
    if t is not None:
        pieces = len(t) - 1
    if pieces > limit:
        raise SizingError(
            f"edge {number} ({edge.name or 'no name'}) of length {edge.length:g} is to be cut in "
            f"{pieces:,} pieces, the limit is {limit:,} triangles: ask for a larger size there"
        )
    if t is None:
        t = np.arange(pieces + 1) / pieces
        if metric[-1] > 0.0:
            t = np.interp(t * metric[-1], metric, known)
            t[0], t[-1] = 0.0, 1.0
    place = np.empty((pieces + 1, 3))
    if pieces > 1:
        place[1:-1] = edge.evaluate(t[1:-1], 0)[0]
    place[0], place[-1] = model.vertices[start].point, model.vertices[end].point
    numbers = np.arange(following - 1, following + pieces, dtype=np.int64)
    numbers[0], numbers[-1] = start, end
    return EdgeNodes(t, place, numbers, np.interp(t, known, size))
