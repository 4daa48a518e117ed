"""The meshes of all faces joined into one: what neighbours share are the numbers of nodes.

0 .. v-1           v .. s-1              s .. n-1
CAD vertices       nodes of edges        inner points of face after face
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.facts import model_facts
from surfmesh.errors import MeshingError
from surfmesh.meshing.edges.edge_nodes import EdgeNodes
from surfmesh.meshing.faces.face_data import FaceMesh
from surfmesh.meshing.faces.face_state import FaceState
from surfmesh.meshing.solids.groups import groups_of
from surfmesh.meshing.solids.model_findings import face_findings, loose_edges
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

FINER = 0.6
"""Factor on the sizes where faces share an edge of triangles that they should not."""


def joined_mesh(
    model: CadModel, faces: list[FaceState], nodes: list[EdgeNodes | None], vertex: np.ndarray,
    sizing: Sizing, seconds: Mapping[str, float],
) -> SurfaceMesh:  # fmt: skip
    """One mesh of all faces that have triangles; what is missing is among its findings.

    vertex: (v,) for each CAD vertex the number that it has in the mesh. Raises ``MeshingError``
    where no face has a triangle.
    """
    turned, solids = orientation(model)
    is_stretched = any(state.mesh.inverse_sizes is not None for state in faces)
    joined = _Joined(model, nodes)
    for state in faces:
        if len(state.mesh.triangles):
            joined.add(state, turned[state.number])
            if is_stretched:
                joined.roots.append(metric_roots(state.mesh))
    if not joined.triangles:
        reasons = [state.reason for state in faces if state.reason]
        raise MeshingError(f"no face could be meshed: {'; '.join(reasons[:5])}")
    points, sizes = np.concatenate(joined.points), np.concatenate(joined.sizes)
    triangles, face_ids = np.concatenate(joined.triangles), np.concatenate(joined.face_ids)
    used = np.zeros(len(points), bool)
    used[triangles.ravel()] = True
    rank = np.where(used, np.cumsum(used) - 1, -1)
    edges = _edge_segments(nodes, rank)
    findings = face_findings(faces, model.left_out)
    return SurfaceMesh(
        points=points[used],
        triangles=rank[triangles],
        uv_points=np.concatenate(joined.uv_points),
        uv_triangles=np.concatenate(joined.uv_triangles),
        face_ids=face_ids,
        surfaces=tuple(face.surface for face in model.faces),
        turned_faces=turned,
        narrow_faces=np.array([state.mesh.narrow for state in faces], bool),
        solid_ids=solids[face_ids],
        edge_segments=edges.segments,
        edge_ids=edges.ids,
        edge_parameters=edges.parameters,
        edge_curves=model.edges,
        vertex_ids=rank[vertex],
        sizes=np.where(np.isfinite(sizes), sizes, model.diagonal)[used],
        groups=groups_of(model),
        metric_root_3d=np.concatenate(joined.roots) if is_stretched else None,
        sizing=sizing,
        seconds=seconds,
        warnings=(
            *model.healing, *loose_edges(model, sizing), *(found.text for found in findings)
        ),
        findings=tuple(findings),
        facts=model_facts(model),
    )  # fmt: skip


class _Joined:
    """The arrays of the whole mesh while face after face is added to them."""

    def __init__(self, model: CadModel, nodes: list[EdgeNodes | None]) -> None:
        cuts = [cut for cut in nodes if cut is not None]
        shared = max([len(model.vertices), *(int(cut.numbers.max()) + 1 for cut in cuts)])
        points, self.shared_sizes = np.zeros((shared, 3)), np.full(shared, np.inf)
        points[: len(model.vertices)] = [vertex.point for vertex in model.vertices]
        for cut in cuts:
            points[cut.numbers] = cut.points
            np.minimum.at(self.shared_sizes, cut.numbers, cut.sizes)
        self.points, self.sizes = [points], [self.shared_sizes]
        self.triangles: list[np.ndarray] = []
        self.face_ids: list[np.ndarray] = []
        self.uv_points: list[np.ndarray] = []
        self.uv_triangles: list[np.ndarray] = []
        self.roots: list[np.ndarray] = []
        self._total, self._uv_total = shared, 0

    def add(self, state: FaceState, turned: bool) -> None:
        """Add the triangles of a face, turned over or not."""
        mesh = state.mesh
        names = np.concatenate([piece.numbers for loop in state.job.loops for piece in loop])
        inside = mesh.slots < 0
        own = np.empty(len(mesh.points), np.int64)
        own[~inside] = names[mesh.slots[~inside]]
        own[inside] = self._total + np.arange(int(inside.sum()))
        self._total += int(inside.sum())
        # poles have no edge of a size
        np.minimum.at(self.shared_sizes, own[~inside], mesh.sizes[~inside])
        self.points.append(mesh.points[inside])
        self.sizes.append(mesh.sizes[inside])
        order = [0, 2, 1] if turned else [0, 1, 2]
        self.triangles.append(own[mesh.triangles][:, order])
        self.uv_points.append(mesh.uv_points)
        self.uv_triangles.append(self._uv_total + mesh.uv_triangles[:, order].astype(np.int64))
        self._uv_total += len(mesh.uv_points)
        self.face_ids.append(np.full(len(mesh.triangles), state.number, np.int32))


def metric_roots(mesh: FaceMesh) -> np.ndarray:
    """Of the ``uv_points`` of a face (n, 6), also of one whose sizes are the same all ways."""
    if mesh.inverse_sizes is not None:
        return mesh.inverse_sizes
    size = np.ones(len(mesh.uv_points))
    size[mesh.uv_triangles] = mesh.sizes[mesh.triangles]
    return np.array([1.0, 0.0, 0.0, 1.0, 0.0, 1.0]) / size[:, None]


class _EdgeSegments(NamedTuple):
    """Edges of the mesh that lie on CAD edges."""

    segments: np.ndarray  # (k, 2) vertices of the mesh
    ids: np.ndarray  # (k,) their CAD edges
    parameters: np.ndarray  # (k, 2) of their ends, 0 to 1


def _edge_segments(nodes: list[EdgeNodes | None], rank: np.ndarray) -> _EdgeSegments:
    """Those whose nodes are all used; rank: vertex of the mesh by number of the node, or -1."""
    edges = [(number, cut) for number, cut in enumerate(nodes) if cut is not None]
    if not edges:
        return _EdgeSegments(np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty((0, 2)))
    segments = rank[np.concatenate([_pairs(cut.numbers) for _, cut in edges])]
    ids = np.concatenate([np.full(len(cut.t) - 1, number) for number, cut in edges])
    parameters = np.concatenate([_pairs(cut.t) for _, cut in edges])
    there = (segments >= 0).all(axis=1)
    return _EdgeSegments(segments[there], ids[there], parameters[there])


def _pairs(values: np.ndarray) -> np.ndarray:
    """Each value with the one after it: (n,) -> (n - 1, 2)."""
    return np.stack([values[:-1], values[1:]], axis=1)


def orientation(model: CadModel) -> tuple[np.ndarray, np.ndarray]:
    """Which faces are turned over (f,), and the solids behind and before them (f, 2).

    A triangle's normal points out of the first solid and into the second; -1 is none.
    """
    turned = np.array([face.reversed for face in model.faces], bool)
    solids = np.full((len(model.faces), 2), -1, np.int32)
    for number, solid in enumerate(model.solids):
        for shell in solid.shells:
            for face, against in shell:
                solids[face, int(against)] = number
    inward = (solids[:, 0] < 0) & (solids[:, 1] >= 0)
    for shell in model.free_shells:
        for face, against in shell:
            inward[face] |= against
    solids[inward] = solids[inward][:, ::-1]
    return turned ^ inward, solids


def limits_where_crowded(
    model: CadModel, mesh: SurfaceMesh, sizing: Sizing
) -> dict[int, SizeLimits]:
    """Smaller sizes, by face, where faces made the same chord between their common nodes.

    Along an edge of the model there are as many triangles as it has uses.
    """
    table = mesh.connectivity
    crowded = table.uses > 2
    if not crowded.any() or mesh.edge_segments is None or not len(mesh.edge_segments):
        return {}
    code = np.array([len(mesh.points), 1], np.int64)
    along, place = np.unique(np.sort(mesh.edge_segments, axis=1) @ code, return_inverse=True)
    users = np.array([len(model.faces_of_edge(edge)) for edge in range(len(model.edges))])
    allowed = np.bincount(place.reshape(-1), users[mesh.edge_ids])
    keys = table.edges @ code
    row = np.minimum(np.searchsorted(along, keys), len(along) - 1)
    most = np.where(along[row] == keys, np.maximum(allowed[row], 2), 2)
    bad = np.flatnonzero(table.uses > most)
    if not len(bad):
        return {}
    ends = table.edges[bad].ravel()
    assert mesh.sizes is not None  # noqa: S101 for mypy: every mesh of a model has them
    limits = SizeLimits(mesh.points[ends], FINER * mesh.sizes[ends], sizing.gradient)
    at = np.isin(mesh.triangles, ends).any(axis=1)
    return {face: limits for face in np.unique(mesh.face_ids[at]).tolist()}
