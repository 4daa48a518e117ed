"""A whole CAD model: edges, then faces, joined by number into one mesh.

edges cut once -> one job a face -> faces meshed -> joined by node numbers
  ^                                     |
  +---- smaller sizes where faces ------+
        failed or lie too far away
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import model_arrays, rows_of
from surfmesh.errors import SizingError
from surfmesh.meshing.edges.edge_nodes import CutEdges, cut_edges
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.meshing.edges.face_proximity import with_face_gaps
from surfmesh.meshing.estimate.estimation import Estimate
from surfmesh.meshing.estimate.face_counts import Alike
from surfmesh.meshing.estimate.least_counts import least_of_model
from surfmesh.meshing.estimate.model_estimate import (
    Bends,
    FaceFields,
    is_foreseen,
    model_counts,
    quick_bounds,
    require_model_within,
)
from surfmesh.meshing.estimate.trial_faces import ratios
from surfmesh.meshing.estimate.trial_mesh import (
    FEW,
    LESS_STRETCHED,
    WHOLE,
    WHOLE_STRETCHED,
    counts_within_budget,
)
from surfmesh.meshing.estimate.trial_mesh import ROUNDS as TRIAL_ROUNDS
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import edge_refinement
from surfmesh.meshing.faces.face_state import FaceState, face_jobs, face_states, later_jobs
from surfmesh.meshing.faces.face_workers import FACE_WORK, FaceWorkers
from surfmesh.meshing.faces.opposite_faces import copied, opposite_pairs
from surfmesh.meshing.finishing.balanced_rounds import (
    WIDER,
    balanced_in_rounds,
    solids_of_model,
    widened_model,
)
from surfmesh.meshing.finishing.curved_requests import requests_for_curved
from surfmesh.meshing.finishing.edge_collapse import LEAST, simplified
from surfmesh.meshing.patch.refinement_loop import MAX_ROUNDS, refined_in_rounds
from surfmesh.meshing.processors import allowed_threads
from surfmesh.meshing.progress import Progress, Stopwatch
from surfmesh.meshing.solids.crowded_chords import (
    with_crowded_chords_cut,
    with_flat_corners_cut,
)
from surfmesh.meshing.solids.joining import joined_mesh, limits_where_crowded
from surfmesh.meshing.solids.model_findings import (
    not_refined,
    require_all_meshed,
    require_all_read,
)
from surfmesh.meshing.solids.volumes import VolumeAims
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.model_sizing import ModelSizing, model_sizing
from surfmesh.sizing.options.sizing import ON_SURFACE, Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits
from surfmesh.sizing.rules.volume_rule import with_volume_rule

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
    how = _How(optimise, strict, workers, rounds, watch, samples)
    asked = model_sizing(model, sizing)
    if asked.base.is_balanced:
        return _balanced(model, asked, how, simplify)
    mesh = _with_volumes(model, asked, how)
    return simplified(mesh, asked.base.min_size or LEAST * model.diagonal) if simplify else mesh


def _with_volumes(model: CadModel, asked: ModelSizing, how: _How) -> SurfaceMesh:
    """The mesh whose sizes keep the volumes that are asked for."""
    aims = VolumeAims(model, asked.base.volume)

    def one_round(by_solid: Mapping[int, float]) -> tuple[SurfaceMesh, dict[int, float]]:
        with how.watch.stage("sizing"):
            wanted = _with_model_rules(model, asked, by_solid)
        mesh = _Rounds(model, wanted, replace(how, samples=None) if by_solid else how).mesh()
        return mesh, aims.lowered_after(mesh, by_solid)

    return refined_in_rounds(one_round, lambda lower, _: lower, MAX_VOLUME_ROUNDS)


def _balanced(model: CadModel, asked: ModelSizing, how: _How, simplify: bool) -> SurfaceMesh:
    """The mesh with its vertices off the surface, which gives solids their volumes."""
    shortest = asked.base.min_size or LEAST * model.diagonal

    def on_surface(wider: float, limits: Mapping[int, SizeLimits]) -> SurfaceMesh:
        with how.watch.stage("sizing"):
            wanted = _with_model_rules(model, widened_model(asked, wider))
        mesh = _Rounds(model, wanted, how).mesh(limits)
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
    how = _How(optimise, strict, workers, MAX_ROUNDS, Stopwatch(progress))
    asked = model_sizing(model, sizing)
    if asked.base.volume is not None:
        raise SizingError("volume needs the whole mesh: it cannot be kept of one in partitions")
    if asked.base.order == 2:
        raise SizingError("a mesh in partitions is of order 1: leave order out")
    if asked.base.is_balanced:
        raise SizingError("vertices are balanced in a whole mesh: not in one in partitions")
    with how.watch.stage("sizing"):
        wanted = _with_model_rules(model, asked)
    rounds = _Rounds(model, wanted, how)
    return FacesApart(rounds.mesh(), rounds.faces, rounds.nodes)


@dataclass(frozen=True)
class _How:
    """How a model is meshed, whatever its sizes: see ``mesh_model``."""

    optimise: bool
    strict: bool
    workers: FaceWorkers
    rounds: int
    watch: Stopwatch
    samples: EdgeSamples | None = None
    """Of the edges, where they are known before."""


class _Rounds:
    """The way round of the picture above, for one set of sizes."""

    def __init__(self, model: CadModel, wanted: ModelSizing, how: _How) -> None:
        self.model, self.wanted, self.how, self.watch = model, wanted, how, how.watch
        with self.watch.stage("sizing"):
            with allowed_threads(how.workers.threads):
                self.samples = how.samples or sample_edges(model, wanted)
            self.faces = face_states(model, self.samples, wanted)
            self.opposite = opposite_pairs(model, self.samples)
        self.nodes = CutEdges()
        self.not_refined: list[FaceState] = []
        self.may_be_crowded = True
        """May faces have made the same chord in the mesh that was joined last?"""

    def mesh(self, limits: Mapping[int, SizeLimits] | None = None) -> SurfaceMesh:
        """The mesh of the last round, with what could not be mended in it.

        limits: of sizes by face, known from the start.
        """
        mesh = refined_in_rounds(self._round, SizeLimits.joined_with, self.how.rounds, limits)
        not_refined_yet = self.not_refined
        if mesh is None or any(state.may_be_forced for state in self.faces):
            self._force_faces()
            with self.watch.stage("mapping"):
                mesh = self._joined()
            self.may_be_crowded = True
        if self.how.strict:
            require_all_meshed(self.model, self.faces)
        if self.may_be_crowded:
            mesh = with_crowded_chords_cut(self.model, mesh)
        mesh = with_flat_corners_cut(self.model, mesh)
        mesh = mesh.replaced(promises=self.wanted.promises(len(self.faces)))
        return mesh.with_warnings(*not_refined(not_refined_yet))

    def _round(
        self, limits: Mapping[int, SizeLimits]
    ) -> tuple[SurfaceMesh | None, dict[int, SizeLimits]]:
        """The mesh, None where no face has one yet, and the smaller sizes that faces ask for."""
        before = self.nodes
        self._cut_edges(limits)
        outdated = [
            state for state in self.faces
            if state.is_outdated(limits.get(state.number), self.nodes, before)
        ]  # fmt: skip
        self._mesh_faces(outdated, limits)
        asking = {s.number: s.refinement for s in self.faces if s.mesh.refinement is not None}
        refinements = {number: found for number, found in asking.items() if found is not None}
        mesh = None
        if not refinements or not all(state.mesh.is_empty for state in self.faces):
            with self.watch.stage("mapping"):
                mesh = self._joined()
                crowded = limits_where_crowded(self.model, mesh, self.wanted.base)
            self.may_be_crowded = bool(crowded)
            for more in (crowded, {} if crowded else self._too_far(mesh, limits)):
                for number, limit in more.items():
                    refinements[number] = limit.joined_with(refinements.get(number))
        self.not_refined = [self.faces[k] for k in sorted({*asking, *refinements})]
        return mesh, refinements

    def _too_far(
        self, mesh: SurfaceMesh, limits: Mapping[int, SizeLimits]
    ) -> dict[int, SizeLimits]:
        """Smaller sizes, by face, where quadratic triangles keep not to the chord."""
        if not self.wanted.base.is_curved or not self.how.optimise:
            return {}
        faces = [self.wanted.of_face(k) for k in range(len(self.model.faces))]
        chords = np.array([face.chord for face in faces], float)
        return requests_for_curved(mesh, chords, self.wanted.base.gradient, limits)

    def _cut_edges(self, limits: Mapping[int, SizeLimits]) -> None:
        first = not self.nodes
        model, sizing = self.model, self.wanted.base
        with self.watch.stage("sizing"):
            with allowed_threads(self.how.workers.threads):
                self.nodes = cut_edges(model, sizing, self.samples, limits, self.nodes)
            if first:
                jobs = partial(face_jobs, model, self.faces, self.nodes)
                sizings = [state.sizing for state in self.faces]
                require_model_within(model, jobs, self.nodes, sizings, sizing)

    def _mesh_faces(self, outdated: list[FaceState], limits: Mapping[int, SizeLimits]) -> None:
        with self.watch.stage("faces"):
            jobs = later_jobs(self.model, outdated, self.nodes, limits, self.how.optimise)
            meshes = self.how.workers.meshed(jobs)
            for count, (place, mesh) in enumerate(meshes, 1):
                state = outdated[place]
                state.job = jobs[place]
                state.take(mesh)
                if self.watch.counts_work:
                    self.watch.spend(FACE_WORK + state.job.nodes + mesh.count)
                self.watch.pulse(count / len(outdated))
            self._copy_opposite({state.number for state in outdated})

    def _copy_opposite(self, changed: set[int]) -> None:
        """Two sides of a thin wall have the same triangles."""
        for first, second, width in self.opposite:
            if first in changed or second in changed:
                one, other = self.faces[first], self.faces[second]
                twin = copied(one.mesh.whole(), one.job, other.job, width)
                other.mesh = other.mesh if twin is None else self.how.workers.kept(twin)

    def _force_faces(self) -> None:
        """Faces that have failed in every round are meshed as well as they can be."""
        with self.watch.stage("faces"):
            for state in self.faces:
                if state.may_be_forced:
                    state.mesh = self.how.workers.work(replace(state.job, last=True))

    def _joined(self) -> SurfaceMesh:
        vertex, sizing, seconds = self.samples.vertex, self.wanted.base, self.watch.seconds
        with allowed_threads(self.how.workers.threads):
            return joined_mesh(self.model, self.faces, self.nodes, vertex, sizing, seconds)


def estimate_model(model: CadModel, sizing: Any) -> Estimate:
    """Triangles and memory of ``mesh_model``. Raises ``SizingError`` for requests that cannot be
    met."""
    asked = model_sizing(model, sizing)
    balanced = asked.base.is_balanced
    if balanced:  # what is made first, with its vertices on the surface
        wide = widened_model(asked)
        sizing = replace(wide, base=wide.base.replaced(vertices=ON_SURFACE))
    before = _Unmeshed(model, sizing, few=True)
    stretched = before.wanted.is_anisotropic
    least = _least(before, balanced)
    whole, fields = WHOLE_STRETCHED if stretched else WHOLE, FaceFields()
    sizings = [state.sizing for state in before.faces]
    small, foreseen = before.most.sum() <= (LESS_STRETCHED * whole if stretched else FEW), False
    counts: np.ndarray | None = None
    if not small:
        counts = before.counts(fields)
        foreseen = is_foreseen(sizings, counts, before.alike.outlines.fewest, before.bends)
        small = counts.sum() <= (FEW if foreseen else whole)
    if small:
        samples = before.samples if stretched else None  # else there are too few
        made = counts_within_budget(lambda budget: mesh_model(
            model, sizing, progress=budget, strict=False, rounds=TRIAL_ROUNDS, samples=samples
        ))  # fmt: skip
        if made is not None:
            return Estimate.of(made, stretched, True, least)
    counts = before.counts(fields) if counts is None else counts
    if not foreseen or any(map(_follows_curvature, sizings)):
        counts = counts * ratios(before.jobs, counts, before.alike, before.refined, fields)
    return Estimate.of(counts, stretched, True, least)


def _follows_curvature(sizing: Sizing) -> bool:
    return sizing.chord is not None or sizing.angle is not None


def _least(before: _Unmeshed, balanced: bool) -> float | None:
    """The fewest triangles that the chords of the faces allow; None without any."""
    asked = [face.sizing.chord for face in before.faces]
    chords = np.array([np.inf if chord is None else chord for chord in asked])
    if before.wanted.base.is_curved or not np.isfinite(chords).any():
        return None
    chords /= WIDER if balanced else 1.0
    return least_of_model(before.model, before.nodes, before.jobs, chords, balanced)


def explain_size(model: CadModel, sizing: Any, point: np.ndarray) -> Explanation:
    """Which of the size requests decides at a point (3,), or at the nearest one of the model."""
    before = _Unmeshed(model, sizing)
    from surfmesh.meshing.explain.explanation import explain_model

    jobs = before.refined(range(len(model.faces)))
    return explain_model(model, before.wanted, before.samples, jobs, point)


def _with_model_rules(
    model: CadModel, asked: ModelSizing, aims: Mapping[int, float] | None = None
) -> ModelSizing:
    """With what follows from volumes and from gaps between faces; aims: see ``VolumeAims``."""
    return with_face_gaps(model, with_volume_rule(model, asked, aims))


class _Unmeshed:
    """All that precedes the first mesh of a model: samples of its edges, its faces, their jobs."""

    def __init__(self, model: CadModel, sizing: Any, few: bool = False) -> None:
        """few: samples of edges, see ``sample_edges``, where sizes are the same all ways."""
        asked = model_sizing(model, sizing)
        asked = widened_model(asked) if asked.base.is_balanced else asked
        self.model = model
        self.wanted = _with_model_rules(model, asked)
        few = few and not self.wanted.is_anisotropic
        self.samples = sample_edges(model, self.wanted, few)
        self.faces = face_states(model, self.samples, self.wanted)
        nodes = cut_edges(model, self.wanted.base, self.samples, {})
        sizings = [state.sizing for state in self.faces]
        self.bends = Bends.of(model, sizings)
        self.most = quick_bounds(model, nodes, sizings, self.bends)
        """Triangles (f,) of the faces at most, roughly."""
        self.nodes = nodes
        """Of the edges, as they are cut in the first round."""
        self._asked: dict[int, SizeLimits | None] = {}
        self._refined: dict[int, FaceJob] = {}

    @cached_property
    def jobs(self) -> list[FaceJob]:
        """What the faces are meshed from in the first round."""
        return face_jobs(self.model, self.faces, self.nodes)

    def refined(self, numbers: Sequence[int]) -> list[FaceJob]:
        """What some faces are meshed from in the second round, where sizes depend on the direction:
        long edges are cut again then, and many of them. Else in the first."""
        if not self.wanted.is_anisotropic:
            return [self.jobs[number] for number in numbers]
        new = sorted(set(numbers) - self._refined.keys())
        if new:
            limits = self._asked_around(new)
            nodes = cut_edges(self.model, self.wanted.base, self.samples, limits, self.nodes)
            made = face_jobs(self.model, [self.faces[k] for k in new], nodes, limits)
            self._refined.update(zip(new, made))
        return [self._refined[number] for number in numbers]

    @cached_property
    def alike(self) -> Alike:
        """Which faces are alike."""
        return Alike.among(self.jobs, model_arrays(self.model).area)

    def counts(self, fields: FaceFields) -> np.ndarray:
        """Triangles (f,) of the faces, by a closer look at some of them."""
        return model_counts(self.model, self.jobs, self.most, self.alike, self.refined, fields)

    def _asked_around(self, numbers: list[int]) -> dict[int, SizeLimits]:
        """What some faces and their neighbours ask of their edges, see ``edge_refinement``; where
        the first of alike ones asks for nothing none does."""
        arrays = model_arrays(self.model)
        edges = arrays.coedge_edge[rows_of(arrays.first_of_face, np.array(numbers))]
        near = np.unique(arrays.coedge_face[np.isin(arrays.coedge_edge, edges)]).tolist()
        leader = self.alike.leader.tolist()
        asking = [k for k in near if self._asked_by(leader[k]) is not None]
        asked = {number: self._asked_by(number) for number in asking}
        return {number: more for number, more in asked.items() if more is not None}

    def _asked_by(self, number: int) -> SizeLimits | None:
        if number not in self._asked:
            self._asked[number] = edge_refinement(self.jobs[number])
        return self._asked[number]
