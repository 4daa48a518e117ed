"""The triangles of a CAD model before it is meshed, and a bound that costs nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Self
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh._core.edges import curvatures_at, rows_of
from surfmesh._core.faces import metric_areas_inward
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import cell_centres, inner_samples
from surfmesh.cad.model.model_arrays import counts_of, model_arrays, offsets
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.estimate.estimation import Estimate, combined, require_within
from surfmesh.meshing.estimate.face_counts import Alike, counts_of_faces, fewest_of
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

JobsOf = Callable[[Sequence[int]], list[FaceJob]]
"""Of faces by their numbers."""

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


def model_counts(
    model: CadModel, jobs: list[FaceJob], most: np.ndarray, alike: Alike, refined: JobsOf,
    fields: FaceFields,
) -> np.ndarray:  # fmt: skip
    """Triangles on each face (f,) before anything is known of a mesh. Raises
    ``SizingError`` where a size field cannot be made.

    jobs: of the first round; most: see ``quick_bounds``; refined: what some are counted from.
    """
    return counts_of_faces(
        jobs, model_arrays(model).area, most, alike,
        lambda numbers: counts_by_area(refined(numbers), fields),
    )  # fmt: skip


def counts_by_area(jobs: list[FaceJob], fields: FaceFields) -> np.ndarray:
    """Triangles (f,) by the metric area within the loops of each face; on a narrow face those
    between its sides, which cost nothing to make."""
    strips = [strip_mesh(job) for job in jobs]
    makes = InwardFaces()
    inward = [None if strip else makes.face(job) for strip, job in zip(strips, jobs)]
    areas = np.full(len(jobs), np.nan)
    grown = {number: face for number, face in enumerate(inward) if face is not None}
    areas[list(grown)] = metric_areas_inward(list(grown.values()))
    for number, (job, strip) in enumerate(zip(jobs, strips)):
        if strip is None and np.isnan(areas[number]):
            areas[number] = metric_area(fields(job)[1], job.rings)
    counts = combined(TRIANGLES * areas, fewest_of(jobs))
    for number, strip in enumerate(strips):
        if strip is not None:
            counts[number] = len(strip.triangles)
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


class _Curvatures(NamedTuple):
    """Of the curved faces of a model, at points of their boxes."""

    faces: np.ndarray
    """(c,) their numbers."""
    first: np.ndarray
    """(c + 1,) where the points of each begin."""
    k1: np.ndarray
    k2: np.ndarray
    regular: np.ndarray
    """(n,) bool: curvatures (n,) are known there."""
    largest: np.ndarray
    """(n,) the larger of them, without its sign; 0 where they are not known."""

    @classmethod
    def of(cls, model: CadModel) -> Self:
        faces = np.array([k for k, f in enumerate(model.faces) if f.surface.kind != "plane"], int)
        surfaces = [model.faces[face].surface for face in faces.tolist()]
        count = np.array([1 if has_even_curvature(own) else FEW**2 for own in surfaces], int)
        first = offsets(count)
        box = np.array([own.domain for own in surfaces], float).reshape(-1, 2, 2)
        at = np.full((first[-1], 2), 0.5)
        at[np.repeat(count > 1, count)] = np.tile(cell_centres(FEW), ((count > 1).sum(), 1))
        low, side = np.repeat(box[..., 0], count, 0), np.repeat(np.diff(box)[..., 0], count, 0)
        k1, k2, degenerate = curvatures_at(low + at * side, first, [own.core for own in surfaces])
        regular = ~degenerate.astype(bool)
        largest = np.where(regular, np.maximum(np.abs(k1), np.abs(k2)), 0.0)
        return cls(faces, first, k1, k2, regular, largest)


_KNOWN: WeakKeyDictionary[CadModel, _Curvatures] = WeakKeyDictionary()  # of any sizes the same


def _curvatures(model: CadModel) -> _Curvatures:
    if model not in _KNOWN:
        _KNOWN[model] = _Curvatures.of(model)
    return _KNOWN[model]


class Bends(NamedTuple):
    """What the curvature of the faces of a model asks for within their boxes, at a few points."""

    least: np.ndarray
    """(f,) the smallest size, infinite where curvature asks for none."""
    turn: np.ndarray
    """(f,) radians that the surface turns by along an edge, at most."""
    rules: dict[int, SizeRules]
    """By the ``id`` of each set of sizes."""

    @classmethod
    def of(cls, model: CadModel, sizings: Sequence[Sizing]) -> Self:
        """sizings: of the faces."""
        known, rules = _curvatures(model), dict[int, SizeRules]()
        least, turn = np.full(len(sizings), np.inf), np.zeros(len(sizings))
        own = np.array([id(sizings[face]) for face in known.faces.tolist()], int)
        for sizing in {id(sizing): sizing for sizing in sizings}.values():
            allowed = rules[id(sizing)] = SizeRules.of(sizing, model.diagonal)
            which = np.flatnonzero(own == id(sizing))
            if not len(which):
                continue
            rows: np.ndarray | slice = slice(None)
            start = known.first[:-1]
            if len(which) < len(own):
                rows = rows_of(known.first, which)
                start = offsets(known.first[which + 1] - known.first[which])[:-1]
            faces, largest = known.faces[which], known.largest[rows]
            sizes = np.full(len(largest), allowed.clamp[1])
            if allowed.follows_curvature:
                found = allowed.shorter(known.k1[rows], known.k2[rows])
                sizes = np.where(known.regular[rows], found, sizes)
                least[faces] = np.minimum.reduceat(sizes, start)
            turn[faces] = np.maximum.reduceat(sizes * largest, start)
        return cls(least, turn, rules)


def quick_bounds(
    model: CadModel, nodes: CutEdges, sizings: list[Sizing], bends: Bends
) -> np.ndarray:  # fmt: skip
    """Triangles (f,) of the faces at most, of size requests at a few points of their boxes, all
    faces at once; infinite where sizes depend on the place by a law."""
    arrays = model_arrays(model)
    edges = np.full(len(nodes), np.inf)
    cut = np.flatnonzero(counts_of(nodes.first))
    if len(cut):
        edges[cut] = np.minimum.reduceat(nodes.rows.sizes, nodes.first[cut])
    smallest = bends.least.copy()
    np.minimum.at(smallest, arrays.coedge_face, edges[arrays.coedge_edge])
    limits: dict[int, tuple[float, float]] = {}
    for sizing in {id(sizing): sizing for sizing in sizings}.values():
        if sizing.has_law:
            return np.full(len(sizings), np.inf)
        floor, top = bends.rules[id(sizing)].clamp
        limits[id(sizing)] = floor, min([top, *(getattr(s, "size", top) for s in sizing.sources)])
    every = [limits[id(sizing)] for sizing in sizings] if len(limits) > 1 else [*limits.values()]
    floors, tops = np.array(every).reshape(-1, 2).T  # one for all, or (f,)
    smallest = np.maximum(np.minimum(smallest, tops), floors)
    return TRIANGLES * arrays.area / smallest**2


def is_foreseen(
    sizings: Sequence[Sizing], counts: np.ndarray, fewest: np.ndarray, bends: Bends
) -> bool:
    """Is the mesh of the first round the last one, and are ``counts`` (f,) its triangles?

    sizings: of the faces. fewest: (f,) that their loops allow.
    """
    if not all(map(is_one_round, {id(sizing): sizing for sizing in sizings}.values())):
        return False
    unknown = thin_counts(counts, fewest)
    folded = bends.turn > LARGEST_TURN
    if folded.any():
        bent = np.where(folded, counts * (bends.turn / LARGEST_TURN) ** 2, 0.0)
        unknown = np.maximum(unknown, bent)
    return float(unknown.sum()) <= FEW_UNKNOWN * float(counts.sum())


def thin_counts(counts: np.ndarray, fewest: np.ndarray) -> np.ndarray:
    """Those of the triangles ``counts`` (f,): on faces that are about as wide as
    these, where neither the boundary nor the area tells how many there are."""
    thin = (counts > THIN[0] * fewest) & (counts < THIN[1] * fewest)
    return np.where(thin, counts, 0.0)


def require_model_within(
    model: CadModel, jobs: Callable[[], list[FaceJob]], nodes: CutEdges,
    sizings: list[Sizing], sizing: Sizing,
) -> None:  # fmt: skip
    """Raise ``SizingError`` with advice when a model would have more than ``sizing.limit``
    triangles. ``jobs``: makes them; asked only where the bounds leave it open."""
    quick = quick_bounds(model, nodes, sizings, Bends.of(model, sizings))
    if quick.sum() <= sizing.limit:
        return
    least, most = bounds(model, nodes, sizings)
    if most.sum() <= sizing.limit:
        return
    names = [face.label(number) for number, face in enumerate(model.faces)]
    require_within(sizing.limit, Estimate.of(least), names)
    every = jobs()
    alike = Alike.among(every, model_arrays(model).area)
    counts = model_counts(
        model, every, quick, alike, lambda numbers: [every[k] for k in numbers], FaceFields()
    )
    require_within(sizing.limit, Estimate.of(counts, model=True), names)
