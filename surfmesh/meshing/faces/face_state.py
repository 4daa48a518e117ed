"""What is known of one face of a model between the rounds of meshing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace, CadModel
from surfmesh.cad.model.loop_faults import ExactLoops, exact_loops
from surfmesh.cad.model.model_arrays import model_arrays, offsets, rows_of
from surfmesh.meshing.edges.edge_nodes import EdgeNodes
from surfmesh.meshing.edges.edge_samples import EdgeSamples, NarrowFace
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh
from surfmesh.meshing.faces.face_sizings import face_sizings
from surfmesh.meshing.patch.refinement_loop import StagnationCheck
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

_ENDS = np.array([0.0, 1.0])


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
        self.stagnation.record(places, len(mesh.triangles), bool(mesh.failure), self.job.nodes)


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


def face_jobs(
    model: CadModel, faces: Sequence[FaceState], nodes: list[EdgeNodes | None],
    limits: Mapping[int, SizeLimits] | None = None, optimise: bool = True,
) -> list[FaceJob]:  # fmt: skip
    """What some faces are meshed from when the edges have these nodes; limits: by face."""
    known, arrays = limits or {}, model_arrays(model)
    numbers = np.array([state.number for state in faces], np.int64)
    pieces = _coedge_nodes(model, rows_of(arrays.first_of_face, numbers), nodes)
    jobs, start = [], 0
    for state in faces:
        loops = []
        for loop in state.face.loops:
            loops.append(tuple(pieces[start : start + len(loop)]))
            start += len(loop)
        jobs.append(
            FaceJob(
                state.face.surface, tuple(loops), state.sizing, known.get(state.number), optimise,
                exact=state.exact, narrow=state.narrow,
            )
        )  # fmt: skip
    return jobs


def _coedge_nodes(
    model: CadModel, which: np.ndarray, nodes: list[EdgeNodes | None]
) -> list[CoedgeNodes]:
    """The nodes of the edges of some coedges as loops walk along them; of an edge that is a
    vertex, both ends."""
    arrays = model_arrays(model)
    cuts = [nodes[edge] for edge in arrays.coedge_edge[which].tolist()]
    fractions = [_ENDS if cut is None else cut.t for cut in cuts]
    first = offsets(np.array([len(t) for t in fractions], np.int64))
    places = arrays.pcurves.points(which, first, np.concatenate([_ENDS[:0], *fractions]))
    uv = np.ascontiguousarray(places[:, :2])
    rows = zip(which.tolist(), cuts, first[:-1].tolist(), first[1:].tolist())
    return [
        _nodes_of_one(model, arrays.coedges[number], cut, uv[a:b]) for number, cut, a, b in rows
    ]


def _nodes_of_one(
    model: CadModel, coedge: CadCoedge, cut: EdgeNodes | None, uv: np.ndarray
) -> CoedgeNodes:
    """uv (n, 2): of its nodes in the direction of the edge."""
    edge = model.edges[coedge.edge]
    order = slice(None, None, -1 if coedge.reversed else 1)
    if cut is None:
        number = int(model_arrays(model).vertex[edge.start])
        return CoedgeNodes(
            uv=uv[order],
            numbers=np.full(2, number, np.int64),
            points=np.tile(model.vertices[number].point, (2, 1)),
            sizes=np.full(2, np.inf),
            degenerate=True,
            tolerance=edge.tolerance,
        )
    return CoedgeNodes(
        uv[order], cut.numbers[order], cut.points[order], cut.sizes[order],
        tolerance=edge.tolerance,
    )  # fmt: skip
