"""The rounds in which a CAD model is meshed, for one set of sizes.

edges cut once -> one job a face -> faces meshed -> joined by node numbers
  ^                                     |
  +---- smaller sizes where faces ------+
        failed or lie too far away
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.meshing.edges.edge_nodes import CutEdges, cut_edges
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.meshing.estimate.model_estimate import require_model_within
from surfmesh.meshing.faces.face_state import FaceState, face_jobs, face_states, later_jobs
from surfmesh.meshing.faces.face_workers import FACE_WORK, FaceWorkers
from surfmesh.meshing.faces.opposite_faces import copied, opposite_pairs
from surfmesh.meshing.finishing.curved_requests import requests_for_curved
from surfmesh.meshing.patch.refinement_loop import refined_in_rounds
from surfmesh.meshing.processors import allowed_threads
from surfmesh.meshing.progress import Stopwatch
from surfmesh.meshing.solids.crowded_chords import with_crowded_chords_cut, with_flat_corners_cut
from surfmesh.meshing.solids.joining import joined_mesh, limits_where_crowded
from surfmesh.meshing.solids.model_findings import not_refined, require_all_meshed
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.rules.size_limits import SizeLimits


@dataclass(frozen=True)
class MeshingManner:
    """How a model is meshed, whatever its sizes: see ``mesh_model``."""

    optimise: bool
    strict: bool
    workers: FaceWorkers
    rounds: int
    watch: Stopwatch
    samples: EdgeSamples | None = None
    """Of the edges, where they are known before."""


class ModelRounds:
    """The way round of the picture above."""

    def __init__(self, model: CadModel, wanted: ModelSizing, how: MeshingManner) -> None:
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
