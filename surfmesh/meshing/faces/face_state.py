"""What is known of one face of a model between the rounds of meshing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from surfmesh._core.faces import face_boundaries
from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.loop_faults import ExactLoops, exact_loops
from surfmesh.cad.model.model_arrays import model_arrays, offsets, rows_of
from surfmesh.meshing.edges.edge_nodes import CutEdges, EdgeNodes
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
    known, arrays = limits or {}, model_arrays(model)
    numbers = np.array([state.number for state in faces], np.int64)
    which = rows_of(arrays.first_of_face, numbers)
    coedges = np.diff(arrays.first_of_loop)[rows_of(arrays.first_loop_of_face, numbers)]
    loops = np.diff(arrays.first_loop_of_face)[numbers]
    boundaries = face_boundaries(
        *_nodes(model, which, nodes), *_uses(model, which, nodes),
        coedges.astype(np.int32), loops.astype(np.int32),
    )  # fmt: skip
    return [
        FaceJob(
            state.face.surface, boundary, state.sizing, known.get(state.number), optimise,
            exact=state.exact, narrow=state.narrow,
        )
        for state, boundary in zip(faces, boundaries)
    ]  # fmt: skip


def _nodes(
    model: CadModel, which: np.ndarray, nodes: CutEdges
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """uv, numbers, points and sizes of the nodes of some coedges, in the direction of the edges;
    of an edge that is a vertex, both ends. And where the rows of each coedge begin."""
    arrays = model_arrays(model)
    edges = arrays.coedge_edge[which]
    first, rows = nodes.first, nodes.rows
    vertices = np.unique(edges[first[edges + 1] == first[edges]]).tolist()
    if vertices:  # behind the others
        place, count = first[:-1].copy(), np.diff(first)
        place[vertices] = first[-1] + 2 * np.arange(len(vertices))
        count[vertices] = 2
        more = [_point_nodes(model, arrays.vertex, edge) for edge in vertices]
        rows = EdgeNodes(*(np.concatenate(part) for part in zip(rows, *more)))
    else:
        place, count = first[:-1], np.diff(first)
    own = offsets(count[edges])
    at = np.repeat(place[edges] - own[:-1], count[edges]) + np.arange(own[-1])
    uv = np.ascontiguousarray(arrays.pcurves.points(which, own, rows.t[at])[:, :2])
    return uv, rows.numbers[at], rows.points[at], rows.sizes[at], own


def _uses(
    model: CadModel, which: np.ndarray, nodes: CutEdges
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of some coedges: are they reversed, are they one point, the tolerance of their edges."""
    arrays = model_arrays(model)
    edges = arrays.coedge_edge[which]
    is_point = (nodes.first[edges + 1] == nodes.first[edges]).view(np.uint8)
    return arrays.coedge_reversed[which].view(np.uint8), is_point, arrays.tolerance[edges]


def _point_nodes(model: CadModel, vertex: np.ndarray, edge: int) -> EdgeNodes:
    """Both ends of an edge that is one point in space."""
    number = int(vertex[model.edges[edge].start])
    points = np.tile(model.vertices[number].point, (2, 1))
    return EdgeNodes(np.array([0.0, 1.0]), points, np.full(2, number, np.int64), np.full(2, np.inf))
