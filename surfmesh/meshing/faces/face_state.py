"""What is known of one face of a model between the rounds of meshing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.loop_faults import ExactLoops, exact_loops
from surfmesh.cad.model.model_arrays import model_arrays, offsets
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.edges.edge_samples import EdgeSamples, NarrowFace
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.face_jobs import FaceJobs
from surfmesh.meshing.faces.face_sizings import face_sizings
from surfmesh.meshing.patch.refinement_loop import StagnationCheck
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

_NOT_MESHED = FaceMesh()


@dataclass
class FaceState:
    """One face: what it is, what it is to be meshed from now, and what became of it last."""

    number: int
    face: CadFace
    sizing: Sizing
    narrow: NarrowFace | None
    exact: ExactLoops
    job: FaceJob = field(init=False)
    """What it is meshed from; there from the first round on."""
    mesh: FaceMesh = field(default_factory=lambda: _NOT_MESHED)
    stagnation: StagnationCheck = field(default_factory=StagnationCheck)

    @property
    def label(self) -> str:
        """What it is called in messages."""
        return self.face.label(self.number)

    @property
    def reason(self) -> str:
        """Why it is missing or lies off its surface, with what it is called; mostly empty."""
        reason = self.mesh.failure or self.mesh.remark
        return f"{self.label}: {reason}" if reason else ""

    @property
    def refinement(self) -> SizeLimits | None:
        """The smaller sizes that it asks for, as long as they are of any use."""
        return None if self.stagnation.is_stalled else self.mesh.refinement

    @property
    def may_be_forced(self) -> bool:
        """Has it failed in a way that can be mended by force, see ``FaceJob.last``?"""
        return bool(self.mesh.failure) and not self.mesh.unmeshable

    def is_outdated(
        self, limits: SizeLimits | None, nodes: CutEdges, before: CutEdges
    ) -> bool:  # fmt: skip
        """Do its limits or the nodes of its edges differ from those that it was meshed from?"""
        return (
            not before
            or self.job.limits is not limits
            or any(nodes.made[c.edge] != before.made[c.edge] for c in self.face.coedges)
        )

    def take(self, mesh: FaceMesh) -> None:
        """Its mesh of this round."""
        self.mesh = mesh
        places = 0 if mesh.refinement is None else len(mesh.refinement.sizes)
        self.stagnation.record(places, mesh.count, bool(mesh.failure), self.job.nodes)


def face_states(model: CadModel, samples: EdgeSamples, wanted: ModelSizing) -> list[FaceState]:
    """All faces before the first round."""
    sizings = face_sizings(model, samples, wanted)
    return [
        FaceState(number, face, sizings[number], samples.narrow.get(number), exact)
        for number, (face, exact) in enumerate(zip(model.faces, exact_loops(model)))
    ]


def later_jobs(
    model: CadModel, faces: Sequence[FaceState], nodes: CutEdges,
    limits: Mapping[int, SizeLimits], optimise: bool,
) -> FaceJobs:  # fmt: skip
    """As ``face_jobs``, of some faces at a time."""
    arrays, numbers = model_arrays(model), np.array([state.number for state in faces], np.int64)
    own = np.diff(nodes.first)[arrays.coedge_edge]
    count = np.diff(offsets(np.where(own == 0, 2, own))[arrays.first_of_face])  # 2: a point

    def made(which: list[int]) -> list[FaceJob]:
        return face_jobs(model, [faces[k] for k in which], nodes, limits, optimise)

    return FaceJobs(count[numbers].tolist(), made)


def face_jobs(
    model: CadModel, faces: Sequence[FaceState], nodes: CutEdges,
    limits: Mapping[int, SizeLimits] | None = None, optimise: bool = True,
) -> list[FaceJob]:  # fmt: skip
    """What some faces are meshed from when the edges have these nodes; limits: by face."""
    known, numbers = limits or {}, np.array([state.number for state in faces], np.int64)
    boundaries = model_arrays(model).coedge_table.boundaries(numbers, nodes.first, *nodes.rows)
    return [
        FaceJob(
            state.face.surface, boundary, state.sizing, known.get(state.number), optimise,
            exact=state.exact, narrow=state.narrow,
        )
        for state, boundary in zip(faces, boundaries)
    ]  # fmt: skip
