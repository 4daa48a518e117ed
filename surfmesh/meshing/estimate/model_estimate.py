"""The triangles of a CAD model before it is meshed, and a bound that costs nothing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from surfmesh._core.edges import curvatures_at
from surfmesh._core.faces import metric_areas_inward
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import cell_centres, inner_samples
from surfmesh.cad.model.model_arrays import model_arrays, offsets
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.estimate.estimation import Estimate, combined, require_within
from surfmesh.meshing.estimate.face_counts import counts_of_faces
from surfmesh.meshing.estimate.trial_mesh import LARGEST_TURN, is_one_round
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import face_field
from surfmesh.meshing.faces.inward_faces import InwardFaces
from surfmesh.meshing.faces.strip_triangulation import strip_mesh
from surfmesh.sizing.field.metric_area import TRIANGLES, metric_area
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import has_even_curvature
from surfmesh.sizing.rules.size_rules import SizeRules

FEW = 9
"""Points each way of a grid on a face."""


FEW_UNKNOWN = 0.25
"""Share of the triangles: what becomes of those changes the whole by little."""

THIN = 1.02, 1.3
"""Triangles of a thin face for each that it has at least."""


class FaceFields:
    """Size fields of faces, each made once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[FaceJob, tuple[FaceSurface, SizeField]]] = {}

    def __call__(self, job: FaceJob) -> tuple[FaceSurface, SizeField]:
        if id(job) not in self._known:
            self._known[id(job)] = job, face_field(job)
        return self._known[id(job)][1]


def model_counts(model: CadModel, jobs: list[FaceJob], fields: FaceFields) -> np.ndarray:
    """Triangles on each face (f,) in the first round. Raises ``SizingError`` where a size field
    cannot be made."""
    return counts_of_faces(jobs, model_arrays(model).area, partial(counts_by_area, fields=fields))


def counts_by_area(jobs: list[FaceJob], fields: FaceFields) -> np.ndarray:
    """Triangles (f,) by the metric area within the loops of each face; on a narrow face those
    between its sides, which cost nothing to make."""
    strips = [strip_mesh(job) for job in jobs]
    makes = InwardFaces()
    inward = [None if strip else makes.face(job) for strip, job in zip(strips, jobs)]
    areas = iter(metric_areas_inward([face for face in inward if face is not None]).tolist())
    counts = np.empty(len(jobs))
    for number, (job, strip, face) in enumerate(zip(jobs, strips, inward)):
        if strip is not None:
            counts[number] = len(strip.triangles)
            continue
        area = np.nan if face is None else next(areas)
        if np.isnan(area):
            area = metric_area(fields(job)[1], job.rings)
        boundary = job.boundary
        nodes = len(boundary) - len(boundary.piece_end)
        counts[number] = combined(TRIANGLES * area, nodes, len(boundary.loop_end))
    return counts


def bounds(
    model: CadModel, nodes: CutEdges, sizings: list[Sizing]
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (f,) that each face has at least and at most, of its size requests at a few points.

    At least: the largest size holds everywhere. At most: the smallest, also of sources.
    """
    least, most = np.zeros(len(model.faces)), np.zeros(len(model.faces))
    for number, (face, sizing) in enumerate(zip(model.faces, sizings)):
        cuts = (nodes[coedge.edge] for coedge in face.coedges)
        edges = [float(cut.sizes.min()) for cut in cuts if cut is not None]
        allowed = SizeRules.of(sizing, model.diagonal)
        plain = face.surface.kind == "plane" and not sizing.has_law
        uv = np.empty((0, 2)) if plain else inner_samples(face, FEW)
        if not plain and not len(uv):
            smallest = min([*edges, allowed.clamp[1]])
            most[number] = TRIANGLES * face.area / max(smallest, allowed.clamp[0]) ** 2
            continue
        points, *derivatives = face.surface.evaluate(uv, 2)
        sizes = np.full(1 if plain else len(uv), allowed.clamp[1])
        if allowed.follows_curvature and not plain:
            forms = forms_from_derivatives(*derivatives)
            k = curvatures(forms)
            sizes = np.where(forms.degenerate, sizes, allowed.shorter(k.k1, k.k2))
        largest = float(sizes.max())
        if largest < np.inf:
            longest = min(largest * sizing.anisotropy, max(allowed.longest, largest))
            least[number] = TRIANGLES * face.area / (largest * longest)
        if sizing.has_law:
            sizes = np.clip(np.minimum(sizes, sizing.law_sizes(points)), *allowed.clamp)
        smallest = min([sizes.min(), *edges, *(getattr(s, "size", np.inf) for s in sizing.sources)])
        most[number] = TRIANGLES * face.area / max(float(smallest), allowed.clamp[0]) ** 2
    return least, most


def quick_bound(model: CadModel, nodes: CutEdges, sizings: list[Sizing]) -> float:
    """Triangles of the whole model at most, of size requests at a few points of the faces' boxes,
    all faces at once; infinite where sizes depend on the place by a law."""
    arrays = model_arrays(model)
    edges = np.full(len(nodes), np.inf)
    cut = np.flatnonzero(np.diff(nodes.first))
    if len(cut):
        edges[cut] = np.minimum.reduceat(nodes.rows.sizes, nodes.first[cut])
    smallest = np.full(len(sizings), np.inf)
    np.minimum.at(smallest, arrays.coedge_face, edges[arrays.coedge_edge])
    by_sizing: dict[int, list[int]] = {}
    for number, sizing in enumerate(sizings):
        by_sizing.setdefault(id(sizing), []).append(number)
    for faces in by_sizing.values():
        sizing = sizings[faces[0]]
        if sizing.has_law:
            return np.inf
        allowed = SizeRules.of(sizing, model.diagonal)
        sizes = [allowed.clamp[1], *(getattr(s, "size", np.inf) for s in sizing.sources)]
        smallest[faces] = np.minimum(smallest[faces], min(sizes))
        curved = [face for face in faces if model.faces[face].surface.kind != "plane"]
        if curved and allowed.follows_curvature:
            found = _least_by_curvature([model.faces[face].surface for face in curved], allowed)
            smallest[curved] = np.minimum(smallest[curved], found)
        smallest[faces] = np.maximum(smallest[faces], allowed.clamp[0])
    return float((TRIANGLES * arrays.area / smallest**2).sum())


def _least_by_curvature(surfaces: list[FaceSurface], allowed: SizeRules) -> np.ndarray:
    """The smallest size (k,) that the curvature of each surface asks for within its box."""
    sizes, _, first = _by_curvature(surfaces, allowed)
    return np.minimum.reduceat(sizes, first[:-1])


def _by_curvature(
    surfaces: list[FaceSurface], allowed: SizeRules
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sizes and largest curvatures (n,) at points of the boxes of surfaces, and where those of each
    begin (k + 1,)."""
    every = [1 if has_even_curvature(surface) else FEW for surface in surfaces]
    grids = {count: cell_centres(count) for count in set(every)}
    low, high = np.array([surface.domain for surface in surfaces]).transpose(2, 0, 1)
    uv = [a + grids[count] * (b - a) for count, a, b in zip(every, low, high)]
    first = offsets(np.square(every))
    k1, k2, degenerate = curvatures_at(
        np.concatenate(uv), first, [surface.core for surface in surfaces]
    )
    regular = ~degenerate.astype(bool)
    sizes = np.full(len(k1), allowed.clamp[1])
    if allowed.follows_curvature:
        sizes = np.where(regular, allowed.shorter(k1, k2), sizes)
    return sizes, np.where(regular, np.maximum(np.abs(k1), np.abs(k2)), 0.0), first


def is_foreseen(jobs: list[FaceJob], diagonal: float, counts: np.ndarray) -> bool:
    """Is the mesh of the first round the last one, and are ``counts`` (f,) its triangles?

    diagonal: of the model.
    """
    every = {id(job.sizing): job.sizing for job in jobs}.values()
    if not all(map(is_one_round, every)):
        return False
    unknown = np.maximum(bent_counts(jobs, diagonal, counts), thin_counts(jobs, counts))
    return float(unknown.sum()) <= FEW_UNKNOWN * float(counts.sum())


def thin_counts(jobs: list[FaceJob], counts: np.ndarray) -> np.ndarray:
    """Those of the triangles ``counts`` (f,): on faces that are about as wide as
    these, where neither the boundary nor the area tells how many there are."""
    boundaries = [job.boundary for job in jobs]
    fewest = np.array([
        len(b) - len(b.piece_end) + 2 * len(b.loop_end) - 4 for b in boundaries
    ], float)  # fmt: skip
    thin = (counts > THIN[0] * fewest) & (counts < THIN[1] * fewest)
    return np.where(thin, counts, 0.0)


def bent_counts(jobs: list[FaceJob], diagonal: float, counts: np.ndarray) -> np.ndarray:
    """Those of the triangles ``counts`` (f,): on faces where sizes are large for the
    curvature, as many as they may become."""
    turns = np.zeros(len(counts))
    by_sizing: dict[int, list[int]] = {}
    for number, job in enumerate(jobs):
        if job.surface.kind != "plane":
            by_sizing.setdefault(id(job.sizing), []).append(number)
    for faces in by_sizing.values():
        allowed = SizeRules.of(jobs[faces[0]].sizing, diagonal)
        surfaces = [jobs[face].surface for face in faces]
        sizes, curvature, first = _by_curvature(surfaces, allowed)
        turns[faces] = np.maximum.reduceat(sizes * curvature, first[:-1])
    return np.where(turns > LARGEST_TURN, counts * (turns / LARGEST_TURN) ** 2, 0.0)


def require_model_within(
    model: CadModel, jobs: Callable[[], list[FaceJob]], nodes: CutEdges,
    sizings: list[Sizing], sizing: Sizing,
) -> None:  # fmt: skip
    """Raise ``SizingError`` with advice when a model would have more than ``sizing.limit``
    triangles. ``jobs``: makes them; asked only where the bounds leave it open."""
    if quick_bound(model, nodes, sizings) <= sizing.limit:
        return
    least, most = bounds(model, nodes, sizings)
    if most.sum() <= sizing.limit:
        return
    names = [face.label(number) for number, face in enumerate(model.faces)]
    require_within(sizing.limit, Estimate.of(least), names)
    counts = model_counts(model, jobs(), FaceFields())
    require_within(sizing.limit, Estimate.of(counts, model=True), names)
