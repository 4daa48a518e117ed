"""The meshes of all faces joined into one: what neighbours share are the numbers of nodes.

0 .. v-1           v .. s-1              s .. n-1
CAD vertices       nodes of edges        inner points of face after face
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from surfmesh._core.faces import FaceJoiner, JoinedFaces, has_crowded_side
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.facts import model_facts
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.errors import MeshingError
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.faces.face_data import FaceMesh
from surfmesh.meshing.faces.face_state import FaceState
from surfmesh.meshing.solids.groups import groups_of
from surfmesh.meshing.solids.model_findings import face_findings, loose_edges
from surfmesh.result.connectivity import connect
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

FINER = 0.6
"""Factor on the sizes where faces share an edge of triangles that they should not."""


def joined_mesh(
    model: CadModel, faces: list[FaceState], nodes: CutEdges, vertex: np.ndarray,
    sizing: Sizing, seconds: Mapping[str, float],
) -> SurfaceMesh:  # fmt: skip
    """One mesh of all faces that have triangles; what is missing is among its findings.

    vertex: (v,) for each CAD vertex the number that it has in the mesh. Raises ``MeshingError``
    where no face has a triangle.
    """
    turned, solids = orientation(model)
    is_stretched = any(state.mesh.inverse_sizes is not None for state in faces)
    there = [state for state in faces if not state.mesh.is_empty]
    if not there:
        reasons = [state.reason for state in faces if state.reason]
        raise MeshingError(f"no face could be meshed: {'; '.join(reasons[:5])}")
    joined = _joined(_shared_nodes(model, nodes), there, turned)
    face_ids, rank, sizes = joined.face_ids, joined.rank, joined.sizes
    edges = _edge_segments(nodes, rank)
    findings = face_findings(faces, model.left_out)
    return SurfaceMesh(
        points=joined.points,
        triangles=joined.triangles,
        uv_points=joined.uv,
        uv_triangles=joined.uv_triangles,
        face_ids=face_ids,
        surfaces=tuple(face.surface for face in model.faces),
        turned_faces=turned,
        narrow_faces=np.array([state.mesh.narrow for state in faces], bool),
        solid_ids=solids.take(face_ids, axis=0),
        edge_segments=edges.segments,
        edge_ids=edges.ids,
        edge_parameters=edges.parameters,
        edge_curves=model.edges,
        vertex_ids=rank[vertex],
        sizes=np.where(np.isfinite(sizes), sizes, model.diagonal),
        groups=groups_of(model),
        metric_root_3d=(
            np.concatenate([metric_roots(state.mesh) for state in there]) if is_stretched else None
        ),
        sizing=sizing,
        seconds=seconds,
        warnings=(
            *model.healing, *loose_edges(model, sizing), *(found.text for found in findings)
        ),
        findings=tuple(findings),
        facts=model_facts(model),
    )  # fmt: skip


class _Shared(NamedTuple):
    """What faces may share: CAD vertices and the nodes of edges."""

    points: np.ndarray  # (s, 3)
    sizes: np.ndarray  # (s,) infinite where nothing is known


def _shared_nodes(model: CadModel, nodes: CutEdges) -> _Shared:
    _, places, numbers, wanted = nodes.rows
    corners = model_arrays(model).corners
    points = np.zeros((max(len(corners), int(numbers.max(initial=-1)) + 1), 3))
    points[: len(corners)] = corners
    points[numbers] = places
    sizes = np.full(len(points), np.inf)
    np.minimum.at(sizes, numbers, wanted)
    return _Shared(points, sizes)


def _joined(shared: _Shared, faces: list[FaceState], turned: np.ndarray) -> JoinedFaces:
    """With the inner points of face after face; turned: (f,) of all faces of the model."""
    joiner, is_turned = FaceJoiner(), turned.tolist()
    for state in faces:
        number = state.number
        state.mesh.add_to(joiner, state.job.boundary, number, is_turned[number])
    return joiner.joined(*shared)


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


def _edge_segments(nodes: CutEdges, rank: np.ndarray) -> _EdgeSegments:
    """Those whose nodes are all used; rank: vertex of the mesh by number of the node, or -1."""
    count = np.diff(nodes.first)
    is_start = np.ones(len(nodes.rows.t), bool)
    is_start[nodes.first[1:][count > 0] - 1] = False
    start = np.flatnonzero(is_start)
    pairs = np.stack([start, start + 1], axis=1)
    segments = rank[nodes.rows.numbers[pairs]]
    ids = np.repeat(np.arange(len(nodes)), np.maximum(count - 1, 0))
    parameters = nodes.rows.t[pairs]
    there = (segments[:, 0] >= 0) & (segments[:, 1] >= 0)
    if there.all():
        return _EdgeSegments(segments, ids, parameters)
    return _EdgeSegments(segments[there], ids[there], parameters[there])


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


def shared_vertices(mesh: SurfaceMesh) -> np.ndarray:
    """(n,) bool: vertices that faces may share. All edges that more than one face can use are
    between two of them."""
    shared = np.zeros(len(mesh.points), bool)
    shared[mesh.edge_segments] = True
    assert mesh.vertex_ids is not None  # noqa: S101 for mypy: every mesh of a model has them
    shared[mesh.vertex_ids[mesh.vertex_ids >= 0]] = True
    return shared


def crowded_chords(model: CadModel, mesh: SurfaceMesh) -> np.ndarray:
    """Edges (k, 2) of triangles between common nodes that more triangles have than should: along
    an edge of the model as many as it has uses, elsewhere two."""
    if mesh.edge_segments is None or not len(mesh.edge_segments):
        return np.empty((0, 2), np.int64)
    shared = shared_vertices(mesh)
    if not has_crowded_side(mesh.triangles, shared.view(np.uint8)):
        return np.empty((0, 2), np.int64)
    table = connect(mesh.triangles[shared[mesh.triangles].sum(axis=1) > 1])
    crowded = table.uses > 2
    if not crowded.any():
        return np.empty((0, 2), np.int64)
    code = np.array([len(mesh.points), 1], np.int64)
    along, place = np.unique(np.sort(mesh.edge_segments, axis=1) @ code, return_inverse=True)
    users = np.bincount(model_arrays(model).coedge_edge, minlength=len(model.edges))
    allowed = np.bincount(place.reshape(-1), users[mesh.edge_ids])
    keys = table.edges @ code
    row = np.minimum(np.searchsorted(along, keys), len(along) - 1)
    most = np.where(along[row] == keys, np.maximum(allowed[row], 2), 2)
    bad = np.flatnonzero(table.uses > most)
    return table.edges[bad]


def limits_where_crowded(
    model: CadModel, mesh: SurfaceMesh, sizing: Sizing
) -> dict[int, SizeLimits]:
    """Smaller sizes, by face, where faces made the same chord between their common nodes."""
    ends = crowded_chords(model, mesh).ravel()
    if not len(ends):
        return {}
    assert mesh.sizes is not None  # noqa: S101 for mypy: every mesh of a model has them
    limits = SizeLimits(mesh.points[ends], FINER * mesh.sizes[ends], sizing.gradient)
    at = np.isin(mesh.triangles, ends).any(axis=1)
    return {face: limits for face in np.unique(mesh.face_ids[at]).tolist()}
