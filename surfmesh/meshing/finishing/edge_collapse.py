"""Short edges of a finished mesh, collapsed: tiny edges and slivers of a CAD model go away.

         c                      c            the edge a-b becomes its end b, its two triangles
       / | \\                   / \\           vanish; the triangles around a that are left must
     /   |   \\               /     \\         not turn over
    ---a-+-b---     ->     ----b----
     \\   |   /               \\     /         Allowed where a and b have no other common
       \\ | /                   \\ /           neighbours than the far corners of these triangles
         d                      d            (the link condition): the topology stays.

Source: Dey, Edelsbrunner, Guha, Nekhayev, "Topology preserving edge contraction", 1999.
"""

import heapq

import numpy as np

from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.small_matrices import norm
from surfmesh.result.mesh_parts import Parametrisation
from surfmesh.result.surface_mesh import SurfaceMesh

LEAST = 5e-4
"""Edges shorter than this fraction of the diagonal are collapsed, if ``min_size`` does not say."""

LARGEST_TURN = np.cos(np.radians(45.0))
"""No triangle that is left turns farther, neither at once nor in all."""

INNER, ON_EDGE, CORNER = 0, 1, 2
"""Vertices inside a face give way to those on its edges, these to the model's vertices."""


def simplified(mesh: SurfaceMesh, least: float) -> SurfaceMesh:
    """The mesh without edges shorter than ``least``, as far as shape and topology allow.

    Points do not move: each edge becomes one of its ends. A sliver between two edges of a model
    becomes one row of edges that belongs to both; faces that vanish are listed in the warnings.
    """
    length = np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)
    short = np.flatnonzero(length < least)
    if not len(short):
        return mesh
    work = _Work(mesh)
    ends = mesh.edges[short].tolist()
    queue = [(size, a, b) for size, (a, b) in zip(length[short].tolist(), ends)]
    heapq.heapify(queue)
    while queue:
        _, a, b = heapq.heappop(queue)
        for gone, kept in ((a, b), (b, a)):
            if work.may_collapse(gone, kept):
                for near in work.collapse(gone, kept):
                    far = norm(mesh.points[near] - mesh.points[kept])
                    if far < least:
                        heapq.heappush(queue, (far, near, kept))
                break
    return work.mesh()


class _Work:
    """The mesh while it changes: triangles, and around each vertex the ones it belongs to."""

    def __init__(self, mesh: SurfaceMesh) -> None:
        self.old = mesh
        self.triangles = mesh.triangles.astype(np.int64)
        order = np.argsort(self.triangles.ravel(), kind="stable")
        bounds = np.searchsorted(self.triangles.ravel()[order], np.arange(len(mesh.points) + 1))
        self._rows, self._bounds = order // 3, bounds
        self._around: dict[int, set[int]] = {}
        self.gone = np.zeros(len(mesh.triangles), bool)
        self.kept_as = np.arange(len(mesh.points))
        self.rank = np.zeros(len(mesh.points), np.int8)
        if mesh.edge_segments is not None and mesh.vertex_ids is not None:
            self.rank[mesh.edge_segments.ravel()] = ON_EDGE
            self.rank[mesh.vertex_ids[mesh.vertex_ids >= 0]] = CORNER
        self.replaced: list[tuple[int, int]] = []  # corners that have another vertex now

    def around(self, vertex: int) -> set[int]:
        """Triangles at a vertex."""
        if vertex not in self._around:
            rows = self._rows[self._bounds[vertex] : self._bounds[vertex + 1]]
            self._around[vertex] = set(rows.tolist())
        return self._around[vertex]

    def may_collapse(self, gone: int, kept: int) -> bool:
        """Is there such an edge, and would shape and topology survive?"""
        if self.kept_as[gone] != gone or self.kept_as[kept] != kept:
            return False
        if self.rank[gone] > self.rank[kept]:
            return False
        shared = self.around(gone) & self.around(kept)
        if not shared:
            return False
        opposite = {v for t in shared for v in self.triangles[t].tolist()} - {gone, kept}
        if len(opposite) != len(shared) or self._ring(gone) & self._ring(kept) != opposite:
            return False
        return self._stays_upright(gone, kept, shared)

    def _ring(self, vertex: int) -> set[int]:
        return {v for t in self.around(vertex) for v in self.triangles[t].tolist()} - {vertex}

    def _stays_upright(self, gone: int, kept: int, shared: set[int]) -> bool:
        rows = np.array(sorted(self.around(gone) - shared), np.int64)
        if not len(rows):
            return False  # nothing would be left of this part
        points, corners = self.old.points, self.triangles[rows]
        after = _normals(points[np.where(corners == gone, kept, corners)])
        length = np.linalg.norm(after, axis=1)
        if not (length > 0.0).all():
            return False
        first = self.old.triangles[rows]  # all turns together are one
        for before in (corners,) if (corners == first).all() else (corners, first):
            normals = _normals(points[before])
            least = LARGEST_TURN * np.linalg.norm(normals, axis=1) * length
            if (np.einsum("ij,ij->i", normals, after) < least).any():
                return False
        return True

    def collapse(self, gone: int, kept: int) -> list[int]:
        """Do it; returns the neighbours that ``kept`` has now."""
        shared = self.around(gone) & self.around(kept)
        for t in shared:
            self.gone[t] = True
            for v in self.triangles[t].tolist():
                self.around(v).discard(t)
        for t in sorted(self.around(gone)):
            corner = int(np.flatnonzero(self.triangles[t] == gone)[0])
            self.triangles[t, corner] = kept
            self.replaced.append((t, corner))
        self.around(kept).update(self.around(gone))
        self.around(gone).clear()
        self.kept_as[gone] = kept
        return sorted(self._ring(kept))

    def mesh(self) -> SurfaceMesh:
        """What is left, with new numbers."""
        old, live = self.old, ~self.gone
        final = self.kept_as.copy()
        while (final[final] != final).any():
            final = final[final]
        empty = np.setdiff1d(np.unique(old.face_ids), old.face_ids[live])
        said = [f"simplified: {old.face_name(k)} (face {k}) has vanished" for k in empty]
        return old.submesh(live, final, self._corners()).with_warnings(*said)

    def _corners(self) -> Parametrisation | None:
        """Parameters of all corners; those with another vertex are found anew on their face."""
        old, corners = self.old, self.old.parametrisation
        changed = np.array(sorted({pair for pair in self.replaced if not self.gone[pair[0]]}))
        if corners is None or not len(changed):
            return None
        rows = corners.uv_triangles.astype(np.int64)
        triangle, corner = changed.T
        points = old.points[self.triangles[triangle, corner]]
        source = rows[triangle, corner]
        uv = corners.uv_points[source].copy()
        face = old.face_ids[triangle]
        for number in np.unique(face):
            of = face == number
            uv[of] = closest_point(old.surfaces[number], points[of], uv[of], steps=8)[0]
        rows[triangle, corner] = len(corners.uv_points) + np.arange(len(changed))
        return corners.with_corners(uv, source, rows)


def _normals(corners: np.ndarray) -> np.ndarray:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
