"""The triangles of a CAD model before it is meshed, and a bound that costs nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from surfmesh.cad.centres import inner_samples
from surfmesh.cad.model import CadFace, CadModel
from surfmesh.geometry.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.kernels.background import scalar_sizes_at
from surfmesh.meshing.edge_nodes import EdgeNodes
from surfmesh.meshing.estimation import Estimate, face_triangles, require_within
from surfmesh.meshing.face_data import FaceJob
from surfmesh.meshing.face_job import face_field
from surfmesh.meshing.solid_contents import AIM, SMALLEST_STEP, TOLERANCE, largest_misfits
from surfmesh.sizing.metric_area import TRIANGLES
from surfmesh.sizing.size_bounds import SizeBounds
from surfmesh.sizing.size_field import SizeField
from surfmesh.sizing.sizing import Sizing

SAMPLES, FEW = 24, 9
"""Points each way of a grid on a face."""

STEPS = 5
"""How often the sizes of a solid may be lowered."""

BETWEEN = 0.35
"""In edges: mean distance from the nearest vertex. Lowered sizes hold at vertices and grow."""

BETWEEN_ROUND, UNEVEN, GENTLE = 1.0, 0.15, 0.85
"""On cylinders, for each unit that a step lies below GENTLE: what BETWEEN is larger by, and the
share of triangles that bring nothing, as sizes are uneven. Measured on pins."""


def model_counts(
    model: CadModel, jobs: list[FaceJob], sizing: Sizing
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles on each face (f,) in the first round and at last, of the jobs of the first.

    sizing: of the whole model. Raises ``SizingError`` where a size field cannot be made.
    """
    counts = np.zeros(len(jobs))
    follows = sizing.chord is not None and TOLERANCE * sizing.chord < model.diagonal
    if any(job.sizing.is_anisotropic for job in jobs):  # area and volume are not looked after
        follows = False
    misfits = np.zeros((len(jobs), 3))
    for number, job in enumerate(jobs):
        field = face_field(job)[1]
        counts[number] = face_triangles(job, field)
        if follows and job.surface.kind != "plane":
            misfits[number] = _misfit(model.faces[number], job, field)
    first = counts.copy()
    if follows:
        finer, more = _refinement(model, sizing, misfits)
        counts *= more
        for number in _neighbours(model, finer):
            job = _with_finer_edges(model.faces[number], jobs[number], finer, model)
            counts[number] = face_triangles(job, face_field(job)[1])
    return first, counts


def bounds(
    model: CadModel, nodes: list[EdgeNodes | None], sizings: list[Sizing]
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (f,) that each face has at least and at most, of its wishes at a few points.

    At least: the largest size holds everywhere. At most: the smallest, also of sources.
    """
    least, most = np.zeros(len(model.faces)), np.zeros(len(model.faces))
    for number, (face, sizing) in enumerate(zip(model.faces, sizings)):
        edges = [nodes[c.edge].sizes.min() for c in face.coedges if nodes[c.edge] is not None]
        allowed = SizeBounds.of(sizing, model.diagonal)
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


def _misfit(face: CadFace, job: FaceJob, field: SizeField) -> np.ndarray:
    """Volume towards r_u x r_v, its absolute value, and area that the mesh of a face misses.

    On the quadric of mean curvature H a unit triangle of size h lies H h^2 / 8 from it in the
    mean; its area is smaller by 2 H times that, larger by half the mean squared slope.
    """
    uv = inner_samples(face, SAMPLES)
    if not len(uv):
        return np.zeros(3)
    forms = forms_from_derivatives(*job.surface.evaluate(uv, 2)[1:])
    k = curvatures(forms)
    density = np.sqrt(np.maximum(forms.E * forms.G - forms.F**2, 0.0))
    size = np.empty(len(uv))
    scalar_sizes_at(field.background, field.scaling.to_plane(uv), size)
    mean = 0.5 * (k.k1 + k.k2)
    squares = k.k1**2 + k.k2**2
    known = ~forms.degenerate & np.isfinite(mean)
    share = np.where(known, density, 0.0)
    share *= face.area / max(share.sum(), np.finfo(float).tiny)
    gap = np.where(known, mean * size**2 / 8.0, 0.0)
    area = np.where(known, (squares / 48.0 - mean**2 / 4.0) * size**2, 0.0)
    return np.array([share @ gap, abs(share @ gap), share @ area])


def _refinement(
    model: CadModel, sizing: Sizing, misfits: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Factors (f,) on the sizes of faces whose solids lose too much area or volume, and on
    their triangles."""
    tolerance = TOLERANCE * sizing.chord / model.diagonal
    factors, more = np.ones(len(model.faces)), np.ones(len(model.faces))
    for solid in model.solids:
        faces = [face for shell in solid.shells for face, _ in shell]
        sign = {
            face: -1.0 if flag != model.faces[face].reversed else 1.0
            for shell in solid.shells for face, flag in shell
        }  # fmt: skip
        if not solid.closed or not solid.volume > 0.0:
            continue
        area = math.fsum(model.faces[face].area for face in faces)
        chosen = largest_misfits(misfits[:, 1], faces)
        cylinders = np.mean([model.faces[face].kind == "cylinder" for face in chosen] or [0.0])
        scale = uneven = 1.0  # scale: of the squares of sizes
        def error(scale: float, faces=faces, sign=sign, chosen=chosen, area=area, solid=solid):
            missing = np.array([
                misfits[f, [0, 2]] * [sign[f], 1.0] * (scale if f in chosen else 1.0) for f in faces
            ]).sum(axis=0)  # fmt: skip
            return max(abs(missing[0]) / solid.volume, abs(missing[1]) / area)

        for _ in range(STEPS):
            now = error(scale)
            if now <= tolerance:
                break
            step = max(SMALLEST_STEP, math.sqrt(AIM * tolerance / now))
            hard = float(cylinders) * max(0.0, GENTLE - step)
            scale *= (step + (BETWEEN + BETWEEN_ROUND * hard) * sizing.gradient) ** 2
            uneven *= 1.0 + UNEVEN * hard
        for face in chosen:
            factors[face] = min(factors[face], math.sqrt(scale))
            more[face] = max(more[face], uneven / scale)
    return factors, more


def _neighbours(model: CadModel, finer: np.ndarray) -> list[int]:
    """Faces that keep their sizes (factor 1 of ``finer`` (f,)) beside others that do not."""
    found: set[int] = set()
    for face in np.flatnonzero(finer < 1.0).tolist():
        for coedge in model.faces[face].coedges:
            found.update(model.faces_of_edge(coedge.edge))
    return sorted(face for face in found if finer[face] == 1.0)


def _with_finer_edges(face: CadFace, job: FaceJob, finer: np.ndarray, model: CadModel) -> FaceJob:
    """The job with the sizes and the nodes of edges that finer neighbours will have."""
    loops = []
    for loop, coedges in zip(job.loops, face.loops):
        pieces = []
        for piece, coedge in zip(loop, coedges):
            factor = min(finer[other] for other in model.faces_of_edge(coedge.edge))
            if factor < 1.0 and not piece.degenerate:
                old = np.arange(len(piece.uv))
                at = np.linspace(0.0, old[-1], max(2, round(old[-1] / factor) + 1))
                uv, points = (
                    np.stack([np.interp(at, old, column) for column in rows.T], axis=1)
                    for rows in (piece.uv, piece.points)
                )
                sizes = factor * np.interp(at, old, piece.sizes)
                numbers = piece.numbers[np.round(at).astype(int)]
                piece = replace(piece, uv=uv, points=points, sizes=sizes, numbers=numbers)
            pieces.append(piece)
        loops.append(tuple(pieces))
    return replace(job, loops=tuple(loops))


def names_of_faces(model: CadModel) -> list[str]:
    """For messages."""
    return [f"face {k} ({face.name or face.kind})" for k, face in enumerate(model.faces)]


def require_model_within(
    model: CadModel, jobs: Callable[[], list[FaceJob]], nodes: list[EdgeNodes | None],
    sizings: list[Sizing], sizing: Sizing,
) -> None:  # fmt: skip
    """Raise ``SizingError`` with advice when a model would have more than ``sizing.limit``
    triangles. ``jobs``: makes them; asked only where the bounds leave it open."""
    least, most = bounds(model, nodes, sizings)
    if most.sum() <= sizing.limit:
        return
    names = names_of_faces(model)
    require_within(sizing.limit, Estimate.of(least), names)
    _, counts = model_counts(model, jobs(), sizing)
    require_within(sizing.limit, Estimate.of(counts, model=True), names)
