"""Samples along the edges of a CAD model, and the edge lengths that they ask for by themselves.

    own curvature, curvature of the faces, size law, sources, length, gaps to other edges of a
    face; each as the wishes of the edge, of its faces and of its vertices have it

Made once for a model. What earlier rounds of meshing have found out, and the growth of sizes
along edges and through vertices, comes later: see ``edge_nodes``.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadModel
from surfmesh.cad.model.collapsed_edges import collapses, vertex_numbers
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.kernels.space.edge_distances import edge_gaps
from surfmesh.meshing.edges.edge_mates import MateRun, mate_runs
from surfmesh.meshing.edges.narrow_faces import ROUND, NarrowFace, narrow_face, narrow_width
from surfmesh.sizing.options.defaults import FINEST_SIZE
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.across_gaps import size_across
from surfmesh.sizing.rules.curvature_size import (
    DEVIATION_RESERVE,
    STRAIGHT_RESERVE,
    normal_deviation_size,
)
from surfmesh.sizing.rules.direction_rates import has_even_curvature
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.size_bounds import SizeBounds, curvature_sizes, default_angle_size

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

MOST_LONGER = 1e8
"""Segments beside a narrow face are at most so many times longer than it is wide: triangles
longer than that count as having no area."""

HIDDEN, MOST_HALVINGS, MOST_SAMPLES = 0.7, 30, 20_000
"""Between samples, laws may ask for this share of the sizes at them; how hard that is pursued."""


@dataclass(frozen=True)
class EdgeSamples:
    """Of all edges in one row; edge k has those from first[k] to first[k + 1], ends included."""

    first: np.ndarray
    """(e + 1,) int64. Edges that are one vertex of the mesh have no samples."""
    share: np.ndarray
    """(n,) shares of the edge's parameter range, 0 to 1."""
    points: np.ndarray
    """(n, 3)"""
    target_size: np.ndarray
    """(n,) wanted edge lengths, not graded."""
    tangent: np.ndarray
    """(n, 3) unit; empty where sizes do not depend on the direction."""
    total_curvature: np.ndarray
    """(e,) integral of the curvature along each edge, radians."""
    has_twin: np.ndarray
    """(e,) bool: the edge is curved, and another one joins the same two vertices."""
    vertex: np.ndarray
    """(v,) for each CAD vertex the number that it has in the mesh."""
    edges_of_face: tuple[np.ndarray, ...]
    """For each face the edges with samples, each once."""
    narrow_width: np.ndarray
    """(f,) up to where a face is narrow, model units."""
    narrow: dict[int, NarrowFace]
    """By number the faces that are so all along."""
    hidden: np.ndarray
    """(e,) bool: only narrow faces use the edge: its sizes are nobody else's."""
    tiny: np.ndarray
    """(e,) bool: the edge is no longer than the way round a narrow tube."""
    mates: list[MateRun]
    """Parts of edges that lie within a narrow width of another edge of the same face."""

    @property
    def is_anisotropic(self) -> bool:
        """Do sizes depend on the direction?"""
        return len(self.tangent) > 0

    def of(self, edge: int) -> slice:
        """The samples of one edge."""
        return slice(self.first[edge], self.first[edge + 1])

    def along(self, face: int) -> np.ndarray:
        """The samples of all edges of a face."""
        edges = self.edges_of_face[face]
        parts = [np.arange(self.first[e], self.first[e + 1]) for e in edges]
        return np.concatenate(parts) if parts else np.empty(0, np.int64)


def sample_edges(model: CadModel, sizing: ModelSizing) -> EdgeSamples:
    """Samples of all edges. Raises ``SizingError`` for laws that give no sizes."""
    uses: list[list[tuple[int, CadCoedge]]] = [[] for _ in model.edges]
    for number, face in enumerate(model.faces):
        for coedge in face.coedges:
            uses[coedge.edge].append((number, coedge))
    shares, points, wishes, tangents = [], [], [], []
    count = np.zeros(len(model.edges) + 1, np.int64)
    turn = np.zeros(len(model.edges))
    for number, edge in enumerate(model.edges):
        if collapses(model, edge):
            continue
        share, place, wish, tangent, turn[number] = _sampled(model, number, uses[number], sizing)
        shares.append(share)
        points.append(place)
        wishes.append(wish)
        tangents.append(tangent)
        count[number + 1] = len(share)
    first = np.cumsum(count)
    edges_of_face = tuple(
        np.array(sorted({c.edge for c in face.coedges if count[c.edge + 1]}), np.int64)
        for face in model.faces
    )
    vertex = vertex_numbers(model)
    samples = EdgeSamples(
        first,
        np.concatenate(shares) if shares else np.empty(0),
        np.concatenate(points) if points else np.empty((0, 3)),
        np.concatenate(wishes) if wishes else np.empty(0),
        np.concatenate(tangents) if tangents else np.empty((0, 3)),
        turn,
        _has_twin(model, first, turn, vertex),
        vertex,
        edges_of_face,
        np.zeros(len(model.faces)),
        {},
        np.zeros(len(model.edges), bool),
        np.zeros(len(model.edges), bool),
        [],
    )
    _find_narrow(model, samples, uses, sizing)
    _heed_vertices(model, samples, sizing)
    _heed_gaps(model, samples, sizing)
    return samples


def _find_narrow(
    model: CadModel, samples: EdgeSamples, uses: list[list[tuple[int, CadCoedge]]],
    sizing: ModelSizing,
) -> None:  # fmt: skip
    """Fill in what is narrow; edges of narrow faces do not hear the curvature across these."""
    for number, face in enumerate(model.faces):
        points = samples.points[samples.along(number)]
        width = narrow_width(sizing.of_face(number), model.diagonal, points)
        samples.narrow_width[number] = width
        found = narrow_face(model, face, samples, width)
        if found is not None:
            samples.narrow[number] = found
    for number, own in enumerate(uses):
        at = samples.of(number)
        ways = [samples.narrow[face].width for face, _ in own if face in samples.narrow]
        if not ways or at.start == at.stop:
            continue
        width = max(samples.narrow_width[face] for face, _ in own)
        samples.tiny[number] = model.edges[number].length <= ROUND * width
        samples.hidden[number] = len(ways) == len(own)
        wish = _sampled(model, number, own, sizing, samples.narrow)[2]
        if samples.tiny[number] and (samples.hidden[number] or not model.edges[number].closed):
            wish[:] = sizing.base.max_size or model.diagonal  # it is cut as its shape needs
        samples.target_size[at] = np.minimum(wish, MOST_LONGER * min(ways))
    samples.mates.extend(mate_runs(model, samples))


def _has_twin(
    model: CadModel, first: np.ndarray, turn: np.ndarray, vertex: np.ndarray
) -> np.ndarray:
    """(e,) bool; see ``EdgeSamples``."""
    ends = np.array([[edge.start, edge.end] for edge in model.edges]).reshape(-1, 2)
    ends = np.sort(vertex[ends], axis=1)
    there = np.diff(first) > 0
    _, group, count = np.unique(ends[there], axis=0, return_inverse=True, return_counts=True)
    found = np.zeros(len(model.edges), bool)
    found[there] = count[group.reshape(-1)] > 1
    return found & (turn > 0.0)


def _sampled(
    model: CadModel, number: int, uses: list[tuple[int, CadCoedge]], sizing: ModelSizing,
    narrow: Collection[int] = (),
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:  # fmt: skip
    """share (n,), points (n, 3), wish (n,), tangent (n, 3), turn.

    narrow: faces whose curvature is not asked for.
    Faces that differ in their wishes are heard one after the other, then the edge itself.
    """
    edge = model.edges[number]
    straight = edge.is_straight
    by_wishes: dict[int, tuple[Sizing, list]] = {}
    for face, coedge in uses:
        own = sizing.of_face(face)
        by_wishes.setdefault(id(own), (own, []))[1].append((face, coedge))
    if not by_wishes:  # an edge of no face
        by_wishes[0] = (sizing.base, [])
    if number in sizing.edges:
        by_wishes[-1] = (sizing.edges[number], uses)
    share = _seen(edge, _STRAIGHT if straight else _CURVED, [own for own, _ in by_wishes.values()])
    turn = 0.0
    if straight:
        (points,) = edge.evaluate(share, 0)
        derivatives = None
        way = points[-1] - points[0]
        tangent = np.tile(way / max(np.linalg.norm(way), np.finfo(float).tiny), (len(share), 1))
    else:
        points, *derivatives = edge.evaluate(share, 2)
        speed = np.linalg.norm(derivatives[0], axis=1)
        tangent = derivatives[0] / np.maximum(speed, np.finfo(float).tiny)[:, None]
        cosine = np.einsum("ij,ij->i", tangent[1:], tangent[:-1])
        turn = float(np.arccos(np.clip(cosine, -1.0, 1.0)).sum())
    wish = np.full(len(share), max(edge.length, NARROWEST * model.diagonal))
    for own, users in by_wishes.values():
        coedges = [(face, coedge) for face, coedge in users if face not in narrow]
        found = _wish(model, own, share, points, derivatives, coedges)
        if own.is_anisotropic:
            along = _metric_wish(model, own, share, tangent, coedges)
            np.minimum(found, along, out=found)
        np.minimum(wish, np.maximum(found, _finest(model, own)), out=wish)
    if not sizing.is_anisotropic:
        tangent = np.empty((0, 3))
    finest = min(_finest(model, own) for own, _ in by_wishes.values())
    return share, points, np.maximum(wish, finest, out=wish), tangent, turn


def _finest(model: CadModel, sizing: Sizing) -> float:
    return sizing.min_size or FINEST_SIZE * model.diagonal


def _wish(
    model: CadModel, sizing: Sizing, share: np.ndarray, points: np.ndarray,
    derivatives: list[np.ndarray] | None, uses: list[tuple[int, CadCoedge]],
) -> np.ndarray:  # fmt: skip
    """What one set of wishes asks for (n,) at samples of an edge, whatever its direction."""
    coarsest = sizing.max_size or np.inf
    if isinstance(sizing.size, float):
        coarsest = min(coarsest, sizing.size)
    wish = np.full(len(share), coarsest)
    follows_curvature = sizing.chord is not None or sizing.angle is not None
    if derivatives is not None and follows_curvature:
        first, second = derivatives
        speed = np.linalg.norm(first, axis=1)
        np.minimum(wish, _own_wish(points, first, second, speed, sizing), out=wish)
    for face, coedge in uses if follows_curvature and not sizing.is_anisotropic else ():
        surface = model.faces[face].surface
        if surface.kind != "plane":
            some = share[:1] if has_even_curvature(surface) else share
            np.minimum(wish, _face_wish(surface, coedge.uv(some), sizing), out=wish)
    if sizing.has_law:
        np.minimum(wish, sizing.law_sizes(points), out=wish)
    return wish


def _metric_wish(
    model: CadModel, sizing: Sizing, share: np.ndarray, tangent: np.ndarray,
    uses: list[tuple[int, CadCoedge]],
) -> np.ndarray:  # fmt: skip
    """What the faces' curvature allows in the direction of the edge (n,)."""
    bounds = SizeBounds.of(sizing, model.diagonal)
    wish = np.full(len(share), bounds.longest)
    for face, coedge in uses if bounds.sizing.is_anisotropic else ():
        surface = model.faces[face].surface
        if surface.kind != "plane":
            found = size_along(surface, coedge.uv(share), tangent, bounds)
            np.minimum(wish, found, out=wish)
    return wish


def _seen(edge: CadEdge, share: np.ndarray, wishes: list[Sizing]) -> np.ndarray:
    """More shares where laws may ask for much smaller sizes between two samples.

    A law of slope s that gives a and b at the ends of a piece of length l gives at least
    (a + b - s l) / 2 in between.
    """
    for sizing in {id(own): own for own in wishes if own.has_law}.values():
        slope = sizing.law_slope
        coarsest = min(sizing.max_size or np.inf, edge.length)
        if isinstance(sizing.size, float):
            coarsest = min(coarsest, sizing.size)
        finest = sizing.min_size or 0.0
        for _ in range(MOST_HALVINGS):
            (points,) = edge.evaluate(share, 0)
            size = np.minimum(sizing.law_sizes(points), coarsest)
            length = np.linalg.norm(np.diff(points, axis=0), axis=1)
            least = np.maximum(0.5 * (size[1:] + size[:-1] - slope * length), finest)
            smaller = np.minimum(size[1:], size[:-1])
            hiding = (least < HIDDEN * smaller) & (length > 0.5 * np.maximum(least, 0.1 * smaller))
            if not hiding.any() or len(share) > MOST_SAMPLES:
                break
            middle = 0.5 * (share[1:] + share[:-1])[hiding]
            share = np.sort(np.concatenate([share, middle]))
    return share


def _heed_vertices(model: CadModel, samples: EdgeSamples, sizing: ModelSizing) -> None:
    """Lower the wishes, in place, at the ends of edges to what their vertices ask for."""
    if not sizing.vertices:
        return
    wanted = {}
    for number, own in sizing.vertices.items():
        size = own.size if isinstance(own.size, float) else own.max_size or np.inf
        if own.has_law:
            size = min(size, float(own.law_sizes(model.vertices[number].point[None])[0]))
        wanted[number] = max(size, own.min_size or 0.0)
    for number, edge in enumerate(model.edges):
        start, end = samples.first[number], samples.first[number + 1]
        if start < end:
            for vertex, place in ((edge.start, start), (edge.end, end - 1)):
                samples.target_size[place] = min(
                    samples.target_size[place], wanted.get(vertex, np.inf)
                )


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
    if sizing.angle is not None:
        return np.minimum(wish, normal_deviation_size(curvature, curvature, sizing.angle))
    return np.minimum(wish, default_angle_size(curvature, curvature, sizing.chord))


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
    wish = np.minimum.reduce([*curvature_sizes(sizing, k.k1, k.k2).values()])
    wish[forms.degenerate | ~np.isfinite(wish)] = np.inf
    return wish


def _heed_gaps(model: CadModel, samples: EdgeSamples, sizing: ModelSizing) -> None:
    """Lower the wishes, in place, for the distance of edges of the same face that do not meet.

    To that distance, or as small as ``gap`` says. Where triangles may be longer than wide and no
    number of them is asked for, to so many times the distance.
    """
    if not len(samples.points):
        return
    ends = samples.vertex[np.array([[edge.start, edge.end] for edge in model.edges])]
    by_wishes: dict[tuple[float | None, float, float], list[int]] = {}
    for face in range(len(model.faces)):
        if face in samples.narrow:
            continue  # across it is nothing to be meshed, beside the end of one side neither
        own, narrow = sizing.of_face(face), float(samples.narrow_width[face])
        by_wishes.setdefault((own.gap, own.min_size or 0.0, narrow), []).append(face)
    slope = sizing.base.gradient
    ratio = sizing.base.anisotropy if sizing.is_anisotropic else 1.0
    room = np.empty((len(samples.points), 6)), np.empty((len(model.edges), 6))
    narrowest = NARROWEST * model.diagonal
    asked = samples.target_size.copy()
    for (count, least, narrow), faces in by_wishes.items():
        edges = [samples.edges_of_face[face] for face in faces]
        first = np.zeros(len(faces) + 1, np.int64)
        np.cumsum([len(own) for own in edges], out=first[1:])
        if not first[-1]:
            continue
        gap = np.full(len(samples.points), np.inf)
        share = 1.0 if count is None else size_across(1.0, count, slope)
        edge_gaps(
            samples.points, asked / share, samples.first, ends, np.concatenate(edges),
            first, *room, gap,
        )  # fmt: skip
        ignored = np.maximum(max(SLIVER * model.diagonal, narrow), MUCH_SMALLER * asked)
        heeded = (gap >= ignored) & np.isfinite(gap)
        sliver = np.minimum(LONGER * gap[heeded], narrowest)
        sliver[sliver < HOPELESS * narrowest] = narrowest
        along = ratio if count is None else share
        wish = np.maximum(along * gap[heeded], np.maximum(sliver, least))
        samples.target_size[heeded] = np.minimum(samples.target_size[heeded], wish)
