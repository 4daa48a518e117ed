"""Samples along the edges of a CAD model, and the edge lengths that they ask for by themselves.

    own curvature, curvature of the faces, size law, length, gaps to other edges of a face

Made once for a model. What earlier rounds of meshing have found out, and the growth of sizes
along edges and through vertices, comes later: see ``edge_nodes``.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.cad.model import CadCoedge, CadEdge, CadFace, CadModel
from surfmesh.geometry.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.kernels.edge_gaps import edge_gaps
from surfmesh.sizing.curvature_size import (
    DEVIATION_RESERVE,
    STRAIGHT_RESERVE,
    angle_size,
    chord_size,
    fold_size,
)
from surfmesh.sizing.direction_size import size_along
from surfmesh.sizing.size_bounds import DEFAULT_ANGLE, FINEST_SIZE, LEAST_OF_CHORD, SizeBounds
from surfmesh.sizing.sizing import Sizing

STRAIGHT_SAMPLES, CURVED_SAMPLES = 33, 129
_STRAIGHT, _CURVED = (np.linspace(0.0, 1.0, n) for n in (STRAIGHT_SAMPLES, CURVED_SAMPLES))

KINK = 0.02
"""Radians: smaller turns between samples are no corners."""

LONGER, HOPELESS = 3.0, 0.3
"""Edges narrower than NARROWEST apart ask for so many times their distance, not below this
share of NARROWEST: triangles of alpha 0.5."""

NARROWEST = 5e-4
"""Gaps narrower and edges shorter than this share of the diagonal do not ask for still smaller
sizes by themselves: the mesh would be flooded by what is too small to matter."""

SLIVER, MUCH_SMALLER = 5e-5, 1.0 / 150.0
"""Gaps narrower than this share of the diagonal, or of the size asked for there without them,
ask for nothing: a sliver along a whole part would flood it with triangles."""

COLLAPSED = 2e-6
"""Edges shorter than this share of the diagonal are one point: their faces meet in it."""

EVEN = ("cylinder", "sphere")
"""Kinds of surfaces whose curvature is the same everywhere."""


@dataclass(frozen=True)
class EdgeSamples:
    """Of all edges in one row; edge k has those from first[k] to first[k + 1], ends included."""

    first: np.ndarray
    """(e + 1,) int64. Edges that are one vertex of the mesh have no samples."""
    share: np.ndarray
    """(n,) shares of the edge's parameter range, 0 to 1."""
    points: np.ndarray
    """(n, 3)"""
    wish: np.ndarray
    """(n,) wanted edge lengths, not graded."""
    tangent: np.ndarray
    """(n, 3) unit."""
    metric: np.ndarray
    """(n,) what curvature allows along the edge, before anything else lowers it. Both are empty
    where sizes do not depend on the direction."""
    turn: np.ndarray
    """(e,) by how much the tangent turns along each edge, radians."""
    vertex: np.ndarray
    """(v,) for each CAD vertex the number that it has in the mesh."""
    edges_of_face: tuple[np.ndarray, ...]
    """For each face the edges with samples, each once."""

    def of(self, edge: int) -> slice:
        """The samples of one edge."""
        return slice(self.first[edge], self.first[edge + 1])

    def along(self, face: int) -> np.ndarray:
        """The samples of all edges of a face."""
        edges = self.edges_of_face[face]
        parts = [np.arange(self.first[e], self.first[e + 1]) for e in edges]
        return np.concatenate(parts) if parts else np.empty(0, np.int64)


def sample_edges(model: CadModel, sizing: Sizing) -> EdgeSamples:
    """``sizing``: with the model's defaults filled in."""
    uses: list[list[tuple[CadFace, CadCoedge]]] = [[] for _ in model.edges]
    for face in model.faces:
        for coedge in face.coedges:
            uses[coedge.edge].append((face, coedge))
    shares, points, wishes, tangents, metrics = [], [], [], [], []
    count = np.zeros(len(model.edges) + 1, np.int64)
    turn = np.zeros(len(model.edges))
    for number, edge in enumerate(model.edges):
        if collapses(model, edge):
            continue
        share, place, wish, tangent, metric, turn[number] = _sampled(
            model, edge, uses[number], sizing
        )
        shares.append(share)
        points.append(place)
        wishes.append(wish)
        tangents.append(tangent)
        metrics.append(metric)
        count[number + 1] = len(share)
    first = np.cumsum(count)
    edges_of_face = tuple(
        np.array(sorted({c.edge for c in face.coedges if count[c.edge + 1]}), np.int64)
        for face in model.faces
    )
    samples = EdgeSamples(
        first,
        np.concatenate(shares) if shares else np.empty(0),
        np.concatenate(points) if points else np.empty((0, 3)),
        np.concatenate(wishes) if wishes else np.empty(0),
        np.concatenate(tangents) if tangents else np.empty((0, 3)),
        np.concatenate(metrics) if metrics else np.empty(0),
        turn,
        vertex_numbers(model),
        edges_of_face,
    )
    ratio = sizing.anisotropy if sizing.is_anisotropic else 1.0
    _heed_gaps(model, samples, sizing.min_size or 0.0, ratio)
    return samples


def collapses(model: CadModel, edge: CadEdge) -> bool:
    """Is the edge so short that it is one vertex of the mesh?"""
    return edge.degenerate or edge.length <= COLLAPSED * model.diagonal


def vertex_numbers(model: CadModel) -> np.ndarray:
    """For each CAD vertex the first one that tiny edges join it to, mostly itself."""
    number = np.arange(len(model.vertices))
    for edge in model.edges:
        if edge.start != edge.end and collapses(model, edge):
            ends = number[edge.start], number[edge.end]
            if ends[0] != ends[1]:
                number[number == max(ends)] = min(ends)
    return number


def _sampled(
    model: CadModel, edge: CadEdge, uses: list[tuple[CadFace, CadCoedge]], sizing: Sizing
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    """share (n,), points (n, 3), wish (n,), tangent (n, 3), metric (n,), turn."""
    coarsest = min(sizing.max_size or np.inf, max(edge.length, NARROWEST * model.diagonal))
    if isinstance(sizing.size, float):
        coarsest = min(coarsest, sizing.size)
    follows_curvature = sizing.chord is not None or sizing.angle is not None
    straight = getattr(edge.curve, "kind", "") == "line"
    share = _STRAIGHT if straight else _CURVED
    wish = np.full(len(share), coarsest)
    turn = 0.0
    if straight:
        (points,) = edge.curve.evaluate(edge.parameters(share), 0)
        way = points[-1] - points[0]
        tangent = np.tile(way / max(np.linalg.norm(way), np.finfo(float).tiny), (len(share), 1))
    else:
        points, first, second = edge.curve.evaluate(edge.parameters(share), 2)
        speed = np.linalg.norm(first, axis=1)
        tangent = first / np.maximum(speed, np.finfo(float).tiny)[:, None]
        cosine = np.einsum("ij,ij->i", tangent[1:], tangent[:-1])
        turn = float(np.arccos(np.clip(cosine, -1.0, 1.0)).sum())
        if follows_curvature:
            np.minimum(wish, _own_wish(points, first, second, speed, sizing), out=wish)
    metric = np.empty(0)
    if sizing.is_anisotropic:
        metric = _metric_wish(model, uses, share, tangent, sizing)
        np.minimum(wish, metric, out=wish)
    else:
        tangent = np.empty((0, 3))
    for face, coedge in uses if follows_curvature and not sizing.is_anisotropic else ():
        surface = face.surface
        if surface.kind != "plane":
            some = share[:1] if surface.kind in EVEN else share
            np.minimum(wish, _face_wish(surface, coedge.uv(some), sizing), out=wish)
    if callable(sizing.size):
        np.minimum(wish, np.asarray(sizing.size(points), float), out=wish)
    finest = sizing.min_size or FINEST_SIZE * model.diagonal
    return share, points, np.maximum(wish, finest, out=wish), tangent, metric, turn


def _metric_wish(
    model: CadModel, uses: list[tuple[CadFace, CadCoedge]], share: np.ndarray,
    tangent: np.ndarray, sizing: Sizing,
) -> np.ndarray:  # fmt: skip
    """What the faces' curvature allows in the direction of the edge (n,)."""
    bounds = SizeBounds.of(sizing, model.diagonal)
    wish = np.full(len(share), bounds.longest)
    for face, coedge in uses:
        if face.surface.kind != "plane":
            found = size_along(face.surface, coedge.uv(share), tangent, bounds)
            np.minimum(wish, found, out=wish)
    return wish


def _own_wish(
    points: np.ndarray, first: np.ndarray, second: np.ndarray, speed: np.ndarray, sizing: Sizing
) -> np.ndarray:
    """What the curve's points (n, 3) and derivatives (n, 3) ask for (n,)."""
    wish = np.full(len(speed), np.inf)
    bend = np.linalg.norm(np.cross(first, second), axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        curvature = np.nan_to_num(bend / speed**3, nan=0.0, posinf=0.0)
        if sizing.chord is not None:
            reserve = STRAIGHT_RESERVE if sizing.is_anisotropic else DEVIATION_RESERVE
            own = np.sqrt(8.0 * reserve * sizing.chord / curvature)
            wish = np.maximum(own, 2.0 * sizing.chord)
            np.minimum(wish, _kink_wish(points, curvature, sizing.chord), out=wish)
    least = 0.0 if sizing.angle is not None else LEAST_OF_CHORD * sizing.chord
    own = fold_size(curvature, curvature, sizing.angle or DEFAULT_ANGLE)
    return np.minimum(wish, np.maximum(own, least))


def _kink_wish(points: np.ndarray, curvature: np.ndarray, chord: float) -> np.ndarray:
    """Sizes (n,) that cut the corners of polygonal curves by ``chord``; infinite elsewhere.

    A corner is a turn between samples that the curvature (n,) there knows nothing of. A segment
    h across one of angle a passes it at h/2 tan(a/2), about h a / 4.
    """
    step = np.diff(points, axis=0)
    length = np.linalg.norm(step, axis=1)
    step /= np.maximum(length, np.finfo(float).tiny)[:, None]
    turn = np.arccos(np.clip(np.einsum("ij,ij->i", step[1:], step[:-1]), -1.0, 1.0))
    known = np.maximum.reduce([curvature[:-2], curvature[1:-1], curvature[2:]])
    hidden = turn > np.maximum(KINK, known * (length[1:] + length[:-1]))
    wish = np.full(len(points), np.inf)
    wish[1:-1][hidden] = 4.0 * DEVIATION_RESERVE * chord / turn[hidden]
    return wish


def _face_wish(surface, uv: np.ndarray, sizing: Sizing) -> np.ndarray:
    """What the face's curvature asks for along one of its edges (n,)."""
    forms = forms_from_derivatives(*surface.evaluate(uv, 2)[1:])
    k = curvatures(forms)
    wish = np.full(len(uv), np.inf)
    if sizing.chord is not None:
        wish = chord_size(k.k1, k.k2, sizing.chord)
    if sizing.angle is not None:
        wish = np.minimum(wish, angle_size(k.k1, k.k2, sizing.angle))
    else:
        unfolded = fold_size(k.k1, k.k2, DEFAULT_ANGLE)
        wish = np.minimum(wish, np.maximum(unfolded, LEAST_OF_CHORD * sizing.chord))
    wish[forms.degenerate | ~np.isfinite(wish)] = np.inf
    return wish


def _heed_gaps(model: CadModel, samples: EdgeSamples, least: float, ratio: float) -> None:
    """Lower the wishes, in place, to the distance of edges of the same face that do not meet.

    Where triangles may be ``ratio`` times longer than wide, to so many times the distance.
    """
    first = np.zeros(len(model.faces) + 1, np.int64)
    np.cumsum([len(edges) for edges in samples.edges_of_face], out=first[1:])
    if not len(samples.points) or not first[-1]:
        return
    ends = samples.vertex[np.array([[edge.start, edge.end] for edge in model.edges])]
    gap = np.full(len(samples.points), np.inf)
    edge_gaps(
        samples.points, samples.wish, samples.first, ends, np.concatenate(samples.edges_of_face),
        first, np.empty((len(gap), 6)), np.empty((len(model.edges), 6)), gap,
    )  # fmt: skip
    heeded = gap >= np.maximum(SLIVER * model.diagonal, MUCH_SMALLER * samples.wish)
    narrowest = NARROWEST * model.diagonal
    sliver = np.minimum(LONGER * gap[heeded], narrowest)
    sliver[sliver < HOPELESS * narrowest] = narrowest
    wish = np.maximum(ratio * gap[heeded], np.maximum(sliver, least))
    samples.wish[heeded] = np.minimum(samples.wish[heeded], wish)
