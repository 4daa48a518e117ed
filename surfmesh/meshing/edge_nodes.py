"""The edges of a CAD model, each cut once for all its faces.

    wishes at samples of every edge -> graded along edges and through vertices -> cut to unit
    own curvature, faces, gaps,         (Dijkstra over all samples of the        metric length
    limits of earlier rounds             model; it is a shortest path)

What two faces share are these nodes, by number: the mesh is watertight because of it.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.cad.model import CadEdge, CadModel
from surfmesh.geometry.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.meshing.edge_gradation import graded_by_direction
from surfmesh.sizing.curvature_size import (
    DEVIATION_RESERVE,
    STRAIGHT_RESERVE,
    angle_size,
    chord_size,
)
from surfmesh.sizing.direction_size import size_along
from surfmesh.sizing.size_bounds import DEFAULT_ANGLE, FINEST_SIZE, LEAST_OF_CHORD, SizeBounds
from surfmesh.sizing.size_limits import SizeLimits
from surfmesh.sizing.sizing import Sizing

STRAIGHT_SAMPLES, CURVED_SAMPLES = 33, 129
NEIGHBOURS = 24
"""Samples of a face's edges looked at for gaps; those of the own edge are among them."""
NARROWEST = 5e-4
"""Gaps narrower than this share of the diagonal do not ask for smaller sizes by themselves."""
LARGEST_TURN = np.pi / 3.0
"""No segment of an edge turns farther, so that polygons keep the shape of their loops."""
CLOSED_SEGMENTS = 3
COLLAPSED = 2e-6
"""Edges shorter than this share of the diagonal are one point: their faces meet in it."""


@dataclass(frozen=True)
class EdgeNodes:
    """The nodes of one edge, from its start to its end."""

    share: np.ndarray
    """(n,) shares of the edge's parameter range, 0 to 1."""
    points: np.ndarray
    """(n, 3) on the edge's curve; the ends are the CAD vertices."""
    numbers: np.ndarray
    """(n,) int64 numbers in the whole mesh."""
    sizes: np.ndarray
    """(n,) wanted edge lengths."""


@dataclass(frozen=True)
class _Samples:
    share: np.ndarray
    points: np.ndarray
    wish: np.ndarray
    metric: np.ndarray
    """What the curvature allows, before anything else lowers it."""
    turn: float


def cut_edges(
    model: CadModel, sizing: Sizing, limits: dict[int, SizeLimits]
) -> list[EdgeNodes | None]:
    """Nodes of every edge (None: degenerate); vertices keep their numbers, others follow.

    sizing: with the model's defaults filled in. limits: by face, from earlier rounds.
    """
    uses: list[list] = [[] for _ in model.edges]
    for number, face in enumerate(model.faces):
        for coedge in face.coedges:
            uses[coedge.edge].append((number, coedge))
    vertex = vertex_numbers(model)
    samples = [
        None if collapses(model, edge) else _sampled(model, edge, uses[number], sizing, limits)
        for number, edge in enumerate(model.edges)
    ]
    _heed_gaps(model, samples, sizing.anisotropy if sizing.is_anisotropic else 1.0)
    sizes = _graded(model, samples, vertex, sizing)
    nodes: list[EdgeNodes | None] = []
    following = len(model.vertices)
    for edge, sampled, size in zip(model.edges, samples, sizes):
        if sampled is None:
            nodes.append(None)
            continue
        nodes.append(_cut(model, edge, sampled, size, vertex, following))
        following += len(nodes[-1].share) - 2
    return nodes


def collapses(model: CadModel, edge: CadEdge) -> bool:
    """Is the edge so short that it is one vertex of the mesh?"""
    return edge.degenerate or edge.length <= COLLAPSED * model.diagonal


def vertex_numbers(model: CadModel) -> np.ndarray:
    """For each CAD vertex the first one that tiny edges join it to, mostly itself."""
    number = np.arange(len(model.vertices))
    for edge in model.edges:
        if collapses(model, edge) and number[edge.start] != number[edge.end]:
            ends = number[edge.start], number[edge.end]
            number[number == max(ends)] = min(ends)
    return number


def _sampled(
    model: CadModel, edge: CadEdge, uses: list, sizing: Sizing, limits: dict[int, SizeLimits]
) -> _Samples:
    straight = getattr(edge.curve, "kind", "") == "line"
    share = np.linspace(0.0, 1.0, STRAIGHT_SAMPLES if straight else CURVED_SAMPLES)
    points, first, second = edge.curve.evaluate(edge.parameters(share), 2)
    finest = sizing.min_size or FINEST_SIZE * model.diagonal
    coarsest = sizing.max_size or np.inf
    if isinstance(sizing.size, float):
        coarsest = min(coarsest, sizing.size)
    wish = np.full(len(share), coarsest)
    speed = np.linalg.norm(first, axis=1)
    tangent = first / np.maximum(speed, np.finfo(float).tiny)[:, None]
    reserve = STRAIGHT_RESERVE if sizing.is_anisotropic else DEVIATION_RESERVE
    bend = np.linalg.norm(np.cross(first, second), axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        curvature = np.nan_to_num(bend / speed**3, nan=0.0, posinf=0.0)
        if sizing.chord is not None:
            own = np.sqrt(8.0 * reserve * sizing.chord / curvature)
            wish = np.minimum(wish, np.maximum(own, 2.0 * sizing.chord))
        if sizing.chord is not None or sizing.angle is not None:
            least = 0.0 if sizing.angle is not None else LEAST_OF_CHORD * sizing.chord
            own = angle_size(curvature, curvature, sizing.angle or DEFAULT_ANGLE)
            wish = np.minimum(wish, np.maximum(own, least))
    for number, coedge in uses:
        surface = model.faces[number].surface
        if surface.kind != "plane" and (sizing.chord is not None or sizing.angle is not None):
            if sizing.is_anisotropic:
                bounds = SizeBounds.of(sizing, model.diagonal)
                found = size_along(surface, coedge.uv(share), tangent, bounds)
            else:
                found = _face_wish(surface, coedge.uv(share), sizing, coarsest)
            wish = np.minimum(wish, found)
    metric = np.clip(wish, finest, model.diagonal)
    for number, _ in uses:
        if number in limits:
            wish = np.minimum(wish, limits[number].along(points, tangent))
    if callable(sizing.size):
        wish = np.minimum(wish, np.asarray(sizing.size(points), float))
    wish = np.minimum(wish, edge.length if edge.length > 0.0 else np.inf)
    cosine = np.einsum("ij,ij->i", tangent[1:], tangent[:-1])
    turn = float(np.arccos(np.clip(cosine, -1.0, 1.0)).sum())
    return _Samples(share, points, np.maximum(wish, finest), metric, 0.0 if straight else turn)


def _face_wish(surface, uv: np.ndarray, sizing: Sizing, coarsest: float) -> np.ndarray:
    """What the face's curvature asks for along one of its edges (n,)."""
    forms = forms_from_derivatives(*surface.evaluate(uv, 2)[1:])
    k = curvatures(forms)
    wish = np.full(len(uv), np.inf)
    if sizing.chord is not None:
        wish = chord_size(k.k1, k.k2, sizing.chord)
    least = 0.0 if sizing.angle is not None else LEAST_OF_CHORD * sizing.chord
    unfolded = angle_size(k.k1, k.k2, sizing.angle or DEFAULT_ANGLE)
    wish = np.minimum(wish, np.maximum(unfolded, least))
    wish[forms.degenerate | ~np.isfinite(wish)] = np.inf
    return np.minimum(wish, coarsest)


def _heed_gaps(model: CadModel, samples: list[_Samples | None], ratio: float) -> None:
    """Lower wishes, in place, to the distance of edges of the same face that do not meet.

    Where triangles may be ``ratio`` times longer than wide, to so many times the distance.
    """
    from scipy.spatial import cKDTree

    narrowest = NARROWEST * model.diagonal
    for face in model.faces:
        edges = sorted({c.edge for c in face.coedges if samples[c.edge] is not None})
        if len(edges) < 2:
            continue
        points = np.concatenate([samples[e].points for e in edges])
        of = np.repeat(edges, [len(samples[e].points) for e in edges])
        ends = np.array([[edge.start, edge.end] for edge in model.edges])
        count = min(NEIGHBOURS, len(points))
        distance, near = cKDTree(points).query(points, k=count)
        other = of[near]
        mine, theirs = ends[of][:, None, :], ends[other]
        meets = (mine[..., :, None] == theirs[..., None, :]).any(axis=(2, 3))
        meets |= other == of[:, None]
        gap = ratio * np.where(meets, np.inf, distance).min(axis=1)
        for edge in edges:
            wish = samples[edge].wish
            np.minimum(wish, np.maximum(gap[of == edge], np.minimum(narrowest, wish)), out=wish)


def _graded(
    model: CadModel, samples: list, vertex: np.ndarray, sizing: Sizing
) -> list[np.ndarray | None]:
    """Sizes (n,) at the samples: the wish w_j of any sample j plus the slope times the way."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    if sizing.is_anisotropic:
        return _graded_by_direction(model, samples, vertex, sizing)
    vertices = len(model.vertices)
    first, rows, columns, lengths, wishes = vertices, [], [], [], [np.full(vertices, np.inf)]
    numbers: list[np.ndarray | None] = []
    shortest = 1e-12 * model.diagonal  # the sparse graph takes zero for no edge
    for edge, sampled in zip(model.edges, samples):
        if sampled is None:
            numbers.append(None)
            continue
        inner = len(sampled.share) - 2
        ends = vertex[[edge.start, edge.end]]
        number = np.concatenate([ends[:1], first + np.arange(inner), ends[1:]])
        first += inner
        numbers.append(number)
        rows.append(number[:-1])
        columns.append(number[1:])
        step = np.linalg.norm(np.diff(sampled.points, axis=0), axis=1)
        lengths.append(np.maximum(step, shortest))
        wishes.append(sampled.wish[1:-1])
        for corner, end in zip(ends, (0, -1)):
            wishes[0][corner] = min(wishes[0][corner], sampled.wish[end])
    if not rows:
        return numbers
    wish = np.concatenate(wishes)
    wanted = np.flatnonzero(np.isfinite(wish))
    root = np.full(len(wanted), first)  # one more node, from which all wishes start
    graph = coo_matrix(
        (
            np.concatenate([*lengths, wish[wanted] / sizing.gradient]),
            (np.concatenate([*rows, root]), np.concatenate([*columns, wanted])),
        ),
        shape=(first + 1, first + 1),
    )
    # parallel edges would be summed: keep the shorter one
    order = np.lexsort((graph.data, graph.col, graph.row))
    row, column, data = graph.row[order], graph.col[order], graph.data[order]
    kept = np.r_[True, (np.diff(row) != 0) | (np.diff(column) != 0)]
    graph = coo_matrix((data[kept], (row[kept], column[kept])), graph.shape).tocsr()
    size = sizing.gradient * dijkstra(graph, directed=False, indices=first)
    return [None if number is None else size[number] for number in numbers]


def _graded_by_direction(
    model: CadModel, samples: list, vertex: np.ndarray, sizing: Sizing
) -> list[np.ndarray | None]:
    there = [k for k, sampled in enumerate(samples) if sampled is not None]
    ends = np.array([vertex[[model.edges[k].start, model.edges[k].end]] for k in there])
    found = graded_by_direction(
        [samples[k].points for k in there], [samples[k].wish for k in there],
        [samples[k].metric for k in there], ends, sizing.gradient, sizing.anisotropy,
    )  # fmt: skip
    sizes: list[np.ndarray | None] = [None] * len(samples)
    for k, size in zip(there, found):
        sizes[k] = size
    return sizes


def _cut(
    model: CadModel, edge: CadEdge, sampled: _Samples, size: np.ndarray, vertex: np.ndarray,
    following: int,
) -> EdgeNodes:  # fmt: skip
    """Pieces of equal metric length near 1."""
    step = np.linalg.norm(np.diff(sampled.points, axis=0), axis=1)
    metric = np.concatenate([[0.0], np.cumsum(2.0 * step / (size[1:] + size[:-1]))])
    start, end = vertex[[edge.start, edge.end]]
    least = max(1, int(np.ceil(sampled.turn / LARGEST_TURN - 1e-9)))
    pieces = max(CLOSED_SEGMENTS if start == end else 1, least, round(float(metric[-1])))
    even = np.linspace(0.0, 1.0, pieces + 1)
    share = np.interp(even * metric[-1], metric, sampled.share) if metric[-1] > 0.0 else even
    share[0], share[-1] = 0.0, 1.0
    points = edge.curve.evaluate(edge.parameters(share), 0)[0].copy()
    points[0], points[-1] = model.vertices[start].point, model.vertices[end].point
    inner = following + np.arange(pieces - 1)
    numbers = np.concatenate([[start], inner, [end]]).astype(np.int64)
    sizes = np.interp(share, sampled.share, size)
    return EdgeNodes(share, points, numbers, sizes)
