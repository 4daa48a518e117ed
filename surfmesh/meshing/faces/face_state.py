"""What is known of one face of a model between the rounds of meshing."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace, CadModel
from surfmesh.cad.model.loop_faults import ExactLoops, exact_loops
from surfmesh.meshing.edges.edge_nodes import EdgeNodes
from surfmesh.meshing.edges.edge_samples import EdgeSamples, NarrowFace
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh
from surfmesh.meshing.faces.face_sizings import face_sizings
from surfmesh.meshing.patch.refinement_loop import StagnationCheck
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits


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
    mesh: FaceMesh = field(default_factory=FaceMesh)
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
        self, limits: SizeLimits | None, nodes: list[EdgeNodes | None],
        before: list[EdgeNodes | None],
    ) -> bool:  # fmt: skip
        """Do its limits or the nodes of its edges differ from those that it was meshed from?"""
        return (
            not before
            or self.job.limits is not limits
            or any(nodes[c.edge] is not before[c.edge] for c in self.face.coedges)
        )

    def take(self, mesh: FaceMesh) -> None:
        """Its mesh of this round."""
        self.mesh = mesh
        places = 0 if mesh.refinement is None else len(mesh.refinement.sizes)
        self.stagnation.record(places, mesh.count, bool(mesh.failure), self.job.nodes)

    def job_from(
        self, model: CadModel, nodes: list[EdgeNodes | None], samples: EdgeSamples,
        limits: SizeLimits | None = None, optimise: bool = True,
    ) -> FaceJob:  # fmt: skip
        """What it is meshed from when its edges have these nodes."""
        loops = tuple(
            tuple(
                _coedge_nodes(model, coedge, nodes[coedge.edge], samples.vertex) for coedge in loop
            )
            for loop in self.face.loops
        )
        return FaceJob(
            self.face.surface, loops, self.sizing, limits, optimise,
            exact=self.exact, narrow=self.narrow,
        )  # fmt: skip


def face_states(model: CadModel, samples: EdgeSamples, wanted: ModelSizing) -> list[FaceState]:
    """All faces before the first round."""
    sizings = face_sizings(model, samples, wanted)
    return [
        FaceState(
            number, face, sizings[number], samples.narrow.get(number),
            exact_loops(model, number, samples.vertex),
        )
        for number, face in enumerate(model.faces)
    ]  # fmt: skip


def first_jobs(
    model: CadModel, faces: list[FaceState], nodes: list[EdgeNodes | None], samples: EdgeSamples,
    limits: Mapping[int, SizeLimits] | None = None,
) -> list[FaceJob]:  # fmt: skip
    """The jobs of all faces before anything is known of their meshes."""
    known = limits or {}
    return [state.job_from(model, nodes, samples, known.get(state.number)) for state in faces]


def _coedge_nodes(
    model: CadModel, coedge: CadCoedge, cut: EdgeNodes | None, vertex: np.ndarray
) -> CoedgeNodes:
    """The nodes of an edge as a loop walks along it; of one that is a vertex, both ends."""
    edge = model.edges[coedge.edge]
    if cut is None:
        number = int(vertex[edge.start])
        return CoedgeNodes(
            uv=coedge.walk(np.array([0.0, 1.0])),
            numbers=np.full(2, number, np.int64),
            points=np.tile(model.vertices[number].point, (2, 1)),
            sizes=np.full(2, np.inf),
            degenerate=True,
            tolerance=edge.tolerance,
        )
    order = slice(None, None, -1) if coedge.reversed else slice(None)
    return CoedgeNodes(
        uv=coedge.uv(cut.t)[order],
        numbers=cut.numbers[order],
        points=cut.points[order],
        sizes=cut.sizes[order],
        tolerance=edge.tolerance,
    )
