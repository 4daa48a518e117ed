"""A whole CAD model: meshed in one piece or face by face, counted and explained beforehand.

sizes by name  ->  volumes kept, gaps crossed  ->  model_rounds  ->  vertices off the surface,
                              ^                         |            short edges collapsed
                              +------- volumes ---------+
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import SizingError
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.model_rules import with_model_rules
from surfmesh.meshing.estimate.estimation import Estimate
from surfmesh.meshing.estimate.least_counts import least_of_model
from surfmesh.meshing.estimate.model_estimate import FaceFields, is_foreseen
from surfmesh.meshing.estimate.trial_faces import ratios
from surfmesh.meshing.estimate.trial_mesh import (
    FEW,
    LESS_STRETCHED,
    WHOLE,
    WHOLE_STRETCHED,
    counts_within_budget,
)
from surfmesh.meshing.estimate.trial_mesh import ROUNDS as TRIAL_ROUNDS
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.faces.face_state import FaceState
from surfmesh.meshing.faces.face_workers import FaceWorkers
from surfmesh.meshing.finishing.balanced_rounds import (
    WIDER,
    balanced_in_rounds,
    widened_model,
)
from surfmesh.meshing.finishing.edge_collapse import LEAST, simplified
from surfmesh.meshing.finishing.enclosed_solids import solids_of_model
from surfmesh.meshing.model_rounds import MeshingManner, ModelRounds
from surfmesh.meshing.patch.refinement_loop import MAX_ROUNDS, refined_in_rounds
from surfmesh.meshing.progress import Progress, Stopwatch
from surfmesh.meshing.solids.model_findings import require_all_read
from surfmesh.meshing.solids.volumes import VolumeAims
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.model_sizing import ModelSizing, model_sizing
from surfmesh.sizing.options.sizing import ON_SURFACE, Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

if TYPE_CHECKING:
    from surfmesh.meshing.explain.explanation import Explanation

MAX_VOLUME_ROUNDS = 4
"""How often a model is meshed for the sake of its volumes, at most: once in most cases."""


def mesh_model(
    model: CadModel, sizing: Any, optimise: bool = True, progress: Progress | None = None,
    strict: bool = True, simplify: bool = False, workers: FaceWorkers | None = None,
    rounds: int = MAX_ROUNDS, samples: EdgeSamples | None = None,
) -> SurfaceMesh:  # fmt: skip
    """Mesh all faces of a model; neighbours share the nodes of their common edges.

    sizing: what ``model_sizing`` takes, sizes by name among it.
    simplify=True collapses what is shorter than ``min_size``, or else than a two-thousandth of
    the diagonal, at the end. workers: who meshes the faces; the mesh is the same with any number
    of them.
    strict=False delivers what could be meshed and lists the other faces in ``warnings``.
    samples: of the edges at these sizes, where they are known already.
    Raises ``MeshingError`` that names the faces that could not be meshed, with the reasons.
    """
    if strict:
        require_all_read(model)
    watch, workers = Stopwatch(progress), workers or FaceWorkers()
    if watch.counts_work:  # which ends at the same face everywhere
        workers = replace(workers, at_once=1)
    how = MeshingManner(optimise, strict, workers, rounds, watch, samples)
    asked = model_sizing(model, sizing)
    if asked.base.is_balanced:
        return _balanced(model, asked, how, simplify)
    mesh = _with_volumes(model, asked, how)
    return simplified(mesh, asked.base.min_size or LEAST * model.diagonal) if simplify else mesh


def _with_volumes(model: CadModel, asked: ModelSizing, how: MeshingManner) -> SurfaceMesh:
    """The mesh whose sizes keep the volumes that are asked for."""
    aims = VolumeAims(model, asked.base.volume)

    def one_round(by_solid: Mapping[int, float]) -> tuple[SurfaceMesh, dict[int, float]]:
        with how.watch.stage("sizing"):
            wanted = with_model_rules(model, asked, by_solid)
        mesh = ModelRounds(model, wanted, replace(how, samples=None) if by_solid else how).mesh()
        return mesh, aims.lowered_after(mesh, by_solid)

    return refined_in_rounds(one_round, lambda lower, _: lower, MAX_VOLUME_ROUNDS)


def _balanced(
    model: CadModel, asked: ModelSizing, how: MeshingManner, simplify: bool
) -> SurfaceMesh:
    """The mesh with its vertices off the surface, which gives solids their volumes."""
    shortest = asked.base.min_size or LEAST * model.diagonal

    def on_surface(wider: float, limits: Mapping[int, SizeLimits]) -> SurfaceMesh:
        with how.watch.stage("sizing"):
            wanted = with_model_rules(model, widened_model(asked, wider))
        mesh = ModelRounds(model, wanted, how).mesh(limits)
        return simplified(mesh, shortest) if simplify else mesh

    def chords(mesh: SurfaceMesh) -> np.ndarray:
        return np.array([asked.of_face(k).chord or np.inf for k in range(len(mesh.surfaces))])

    def angles(mesh: SurfaceMesh) -> np.ndarray:
        return np.array([asked.of_face(k).angle or np.inf for k in range(len(mesh.surfaces))])

    mesh = balanced_in_rounds(on_surface, chords, angles, solids_of_model)
    return mesh.replaced(sizing=asked.base, promises=asked.promises(len(mesh.surfaces)))


class FacesApart(NamedTuple):
    """A model whose faces lie in files, each by itself."""

    rims: SurfaceMesh
    """Of each face the triangles at its boundary; what faces share has the numbers of the whole."""
    faces: list[FaceState]
    nodes: CutEdges


def mesh_faces_apart(
    model: CadModel, sizing: Any, workers: FaceWorkers, optimise: bool = True,
    progress: Progress | None = None, strict: bool = True,
) -> FacesApart:  # fmt: skip
    """As ``mesh_model``, without joining the faces, which ``workers.store`` keeps.

    Raises ``SizingError`` for what needs the whole mesh: ``volume``.
    """
    if strict:
        require_all_read(model)
    how = MeshingManner(optimise, strict, workers, MAX_ROUNDS, Stopwatch(progress))
    asked = model_sizing(model, sizing)
    if asked.base.volume is not None:
        raise SizingError("volume needs the whole mesh: it cannot be kept of one in partitions")
    if asked.base.order == 2:
        raise SizingError("a mesh in partitions is of order 1: leave order out")
    if asked.base.is_balanced:
        raise SizingError("vertices are balanced in a whole mesh: not in one in partitions")
    with how.watch.stage("sizing"):
        wanted = with_model_rules(model, asked)
    rounds = ModelRounds(model, wanted, how)
    return FacesApart(rounds.mesh(), rounds.faces, rounds.nodes)


def estimate_model(model: CadModel, sizing: Any) -> Estimate:
    """Triangles and memory of ``mesh_model``. Raises ``SizingError`` for requests that cannot be
    met."""
    asked = model_sizing(model, sizing)
    balanced = asked.base.is_balanced
    if balanced:  # what is made first, with its vertices on the surface
        wide = widened_model(asked)
        asked = replace(wide, base=wide.base.replaced(vertices=ON_SURFACE))
    before = UnmeshedModel(model, asked, few=True)
    stretched = before.wanted.is_anisotropic
    least = _least(before, balanced)
    whole, fields = WHOLE_STRETCHED if stretched else WHOLE, FaceFields()
    sizings = [state.sizing for state in before.faces]
    small, foreseen = before.most.sum() <= (LESS_STRETCHED * whole if stretched else FEW), False
    counts: np.ndarray | None = None
    if not small:
        counts = before.counts(fields)
        foreseen = is_foreseen(sizings, counts, before.alike.fewest, before.bends)
        small = counts.sum() <= (FEW if foreseen else whole)
    if small:
        samples = before.samples if stretched else None  # else there are too few
        made = counts_within_budget(lambda budget: mesh_model(
            model, asked, progress=budget, strict=False, rounds=TRIAL_ROUNDS, samples=samples
        ))  # fmt: skip
        if made is not None:
            return Estimate.of(made, stretched, True, least)
    counts = before.counts(fields) if counts is None else counts
    if not foreseen or any(map(_follows_curvature, sizings)):
        counts = counts * ratios(before.jobs, counts, before.alike, before.refined, fields)
    return Estimate.of(counts, stretched, True, least)


def _follows_curvature(sizing: Sizing) -> bool:
    return sizing.chord is not None or sizing.angle is not None


def _least(before: UnmeshedModel, balanced: bool) -> float | None:
    """The fewest triangles that the chords of the faces allow; None without any."""
    asked = [face.sizing.chord for face in before.faces]
    if before.wanted.base.is_curved or all(chord is None for chord in asked):
        return None
    chords = np.array([np.inf if chord is None else chord for chord in asked])
    chords /= WIDER if balanced else 1.0
    return least_of_model(before.model, before.nodes, before.jobs, chords, balanced)


def explain_size(model: CadModel, sizing: Any, point: np.ndarray) -> Explanation:
    """Which of the size requests decides at a point (3,), or at the nearest one of the model."""
    before = UnmeshedModel(model, sizing)
    from surfmesh.meshing.explain.explanation import explain_model

    jobs = before.refined(range(len(model.faces)))
    return explain_model(model, before.wanted, before.samples, jobs, point)
