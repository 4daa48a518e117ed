"""How far mesh and surfaces are from each other at most, proved: face by face, edge by edge.

The bounds are those of ``accuracy.proof``. They say nothing of faces whose surface bounds nothing,
such as a function of the caller; these are named.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.proof import curve_bounds
from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.accuracy.joined_faces import FaceMoves
from surfmesh.accuracy.proof import FaceProof, proved_curved, proved_distances
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces, Rows
from surfmesh.quality.measures.tolerances import CHORD_SLACK, Tolerances
from surfmesh.result.connectivity import connect
from surfmesh.result.mesh_parts import EdgeLinks
from surfmesh.result.surface_mesh import SurfaceMesh

CLOSELY = 1.05
"""Times the sampled distance: how near it is worth to look where no chord was asked for."""

COMPARED = 0.3
"""Of the largest sampled distance: triangles that lie nearer say little about the bounds."""


class Proof(NamedTuple):
    """Distances in model units; infinite: nothing is proved."""

    bound: NDArray[np.float64]  # (m,) of each triangle and its piece of the surface, both ways
    limit: NDArray[np.float64]  # (m,) the chord of its face; infinite: none was asked for
    without_bounds: tuple[int, ...]  # faces whose surface bounds nothing
    edge_bound: NDArray[np.float64]  # (k,) of segments of CAD edges and their curves
    over_sampled: float | None  # median of bound / sampled distance, where that is large
    moves: tuple[tuple[int, FaceProof], ...]  # by face: from the mesh to its surface

    @property
    def is_proved(self) -> NDArray[np.bool_]:
        """(m,) within the chord, or at all where none was asked for."""
        return np.isfinite(self.bound) & (self.bound <= self.limit * (1.0 + CHORD_SLACK))


def proof(known: KnownSurfaces, fit: Deviation, tolerances: Tolerances, is_curved: bool) -> Proof:
    """Of all triangles, with ``fit``, what samples say both ways. is_curved: of quadratic ones."""
    mesh = known.mesh
    limit = tolerances.at(tolerances.chord, mesh.face_ids)
    sampled = CLOSELY * fit.by_triangle.max(initial=0.0)
    near = np.where(np.isfinite(limit), limit, sampled if np.isfinite(sampled) else 0.0)
    bound, without = np.full(len(mesh.triangles), np.inf), []
    moves: list[tuple[int, FaceProof]] = []
    for number, rows in _by_face(mesh):
        surface, face = mesh.surfaces[number], _face(known, rows)
        if is_curved:
            curved = proved_curved(surface, face, _middles(mesh, rows), near[rows])
            if curved is None:
                without.append(number)
            else:
                bound[rows] = curved
            continue
        found = proved_distances(surface, _as_meshed(face), near[rows])
        if found is None:
            without.append(number)
        else:
            bound[rows] = found.bound
            moves.append((number, found))
    edges = np.empty(0) if mesh.edge_links is None else _edge_bounds(mesh, mesh.edge_links)
    over = _over_sampled(bound, fit.by_triangle)
    return Proof(bound, limit, tuple(without), edges, over, tuple(moves))


def moved_faces(known: KnownSurfaces, found: Proof) -> list[FaceMoves]:
    """How the triangles of each face move to its surface, as far as that is known."""
    proved, faces = dict(found.moves), []
    for number, rows in _by_face(known.mesh):
        if number not in proved:
            continue
        face = _face(known, rows)
        numbers = np.zeros(int(face.vertices.max()) + 1, np.int64)
        numbers[face.vertices] = known.mesh.triangles[rows]
        surface = known.mesh.surfaces[number]
        faces.append(FaceMoves(surface, _as_meshed(face), numbers, proved[number]))
    return faces


def _middles(mesh: SurfaceMesh, rows: Rows) -> NDArray[np.float64]:
    """(k, 3, 3) nodes of the sides of some quadratic triangles."""
    return np.ascontiguousarray(mesh.nodes[mesh.elements[rows, 3:]])


def _by_face(mesh: SurfaceMesh) -> Iterator[tuple[int, Rows]]:
    """Number and triangles of each face that has some."""
    first = int(mesh.face_ids[0])
    if (mesh.face_ids == first).all():
        yield first, np.arange(len(mesh.triangles))
        return
    order = np.argsort(mesh.face_ids, kind="stable")
    starts = np.flatnonzero(np.diff(mesh.face_ids[order], prepend=-1))
    for rows in np.split(order, starts[1:]):
        if len(rows):
            yield int(mesh.face_ids[rows[0]]), rows


def _face(known: KnownSurfaces, rows: Rows) -> FaceTriangles:
    """The triangles of one face by themselves: edges to other faces are rims."""
    mesh = known.mesh
    if len(rows) == len(mesh.triangles) and len(mesh.points) <= 3 * len(rows):
        triangles, table = np.ascontiguousarray(mesh.triangles, np.int32), mesh.connectivity
    else:
        _, vertices = np.unique(mesh.triangles[rows], return_inverse=True)
        triangles = vertices.reshape(-1, 3).astype(np.int32)
        table = connect(triangles)
    twins = twins_of(table.half_edges, table.uses, len(rows))
    return FaceTriangles(known.points(rows), np.ascontiguousarray(known.uv(rows)), triangles, twins)


def _as_meshed(face: FaceTriangles) -> FaceTriangles:
    """The triangles along r_u x r_v, also those of a face that is turned over in its model.

    Their frames begin at the first side: so bounds are those that the mesher has seen.
    """
    u, v = face.uv.transpose(2, 1, 0).copy()
    if float(((u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0])).sum()) >= 0.0:
        return face
    twins = face.twins.reshape(-1, 3)[:, ::-1].ravel()
    turned = 3 * (twins // 3) + 2 - twins % 3
    other_way = (0, 2, 1)
    return FaceTriangles(
        np.ascontiguousarray(face.corners[:, other_way]),
        np.ascontiguousarray(face.uv[:, other_way]),
        np.ascontiguousarray(face.vertices[:, other_way]),
        np.where(twins < 0, twins, turned).astype(np.int32),
    )


def _edge_bounds(mesh: SurfaceMesh, links: EdgeLinks) -> NDArray[np.float64]:
    """Of the segments of edges whose curve is known."""
    if links.edge_parameters is None or not links.edge_curves:
        return np.empty(0)
    found = np.full(len(links.edge_segments), np.inf)
    for number in np.unique(links.edge_ids).tolist():
        edge = links.edge_curves[number] if number < len(links.edge_curves) else None
        rows = np.flatnonzero(links.edge_ids == number)
        if edge is None or edge.curve is None:
            continue
        t = edge.t0 + links.edge_parameters[rows] * (edge.t1 - edge.t0)
        ends = mesh.points[links.edge_segments[rows]]
        found[rows] = curve_bounds(edge.curve.core, np.ascontiguousarray(t), ends)
    return found


def _over_sampled(bound: NDArray[np.float64], sampled: NDArray[np.float64]) -> float | None:
    """Median of bound / sampled distance of the triangles that are among the farthest."""
    most = sampled.max(initial=0.0)
    if not 0.0 < most < np.inf:
        return None
    some = np.isfinite(bound) & (sampled > COMPARED * most)
    return float(np.median(bound[some] / sampled[some])) if some.any() else None
