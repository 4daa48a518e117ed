"""What kind of surface the triangles form: closed, manifold, oriented, in how many pieces."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import JoinedTriangles
from surfmesh.geometry.components import components
from surfmesh.quality.measures.joined import joined_triangles
from surfmesh.result.surface_mesh import SurfaceMesh

NO_CHAINS = np.empty((0, 2), np.int32)  # of half-edges along crowded edges


class Topology(NamedTuple):
    """Counts and verdicts from connectivity alone; no coordinate is looked at."""

    vertices: int  # used by a triangle
    edges: int
    triangles: int
    components: int  # pieces that share no vertex
    boundary_edges: int
    boundary_loops: int  # chains of boundary edges that hang together
    crowded_edges: NDArray[np.int32]  # edges of three or more triangles
    pinched_vertices: NDArray[np.int32]  # vertices where two fans of triangles only touch
    clashing_edges: NDArray[np.int32]  # edges that both triangles run along the same way
    fans: NDArray[np.int64]  # (n,) of triangles at each vertex, as shared edges join them
    balanced: bool  # every edge is run along as often one way as the other

    @property
    def euler(self) -> int:
        """V - E + F."""
        return self.vertices - self.edges + self.triangles

    @property
    def closed(self) -> bool:
        """No boundary: every edge is shared."""
        return self.triangles > 0 and self.boundary_edges == 0

    @property
    def manifold(self) -> bool:
        """No edge has more than two triangles, and those at every vertex form one fan."""
        return not len(self.crowded_edges) and not len(self.pinched_vertices)

    @property
    def oriented(self) -> bool:
        """Neighbours run along their common edge in opposite directions."""
        return not len(self.clashing_edges)


def topology(mesh: SurfaceMesh, joined: JoinedTriangles | None = None) -> Topology:
    """Topology of ``mesh``; vertex numbers must be in range (``mesh.broken_invariant()``).

    joined: the mesh, where it is at hand.
    """
    joined = joined or joined_triangles(mesh)
    vertices, pieces, free, fans, pinched, crowded, clashing = joined.topology(NO_CHAINS)
    half_edges, along = _crowded_half_edges(mesh, crowded)
    if len(crowded):
        *_, fans, pinched, _, _ = joined.topology(_chains(half_edges, along))
    return Topology(
        vertices=vertices,
        edges=len(mesh.edges),
        triangles=len(mesh.triangles),
        components=pieces,
        boundary_edges=free,
        boundary_loops=_boundary_loops(mesh) if free else 0,
        crowded_edges=crowded,
        pinched_vertices=pinched,
        clashing_edges=clashing,
        fans=fans,
        balanced=bool(len(mesh.triangles)) and not free and not len(clashing)
        and _is_balanced(mesh, half_edges, along),
    )  # fmt: skip


def _boundary_loops(mesh: SurfaceMesh) -> int:
    """Chains of boundary edges that hang together."""
    boundary = mesh.connectivity.boundary
    labels = components(len(mesh.points), boundary)
    return len(np.unique(labels[boundary]))


def vertex_components(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(n,) the smallest number among the vertices that each hangs together with."""
    return components(len(mesh.points), mesh.edges)


def half_edges_along(
    mesh: SurfaceMesh, edges: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
    """All half-edges that run along some of ``mesh.edges``, in its order, and the rows of these.

    edges: (k, 2) in the order of ``mesh.edges``.
    """
    if not len(edges):
        return np.empty(0, np.int64), np.empty(0, np.intp)
    corners = mesh.triangles.reshape(-1).astype(np.int64)
    following = mesh.triangles[:, (1, 2, 0)].reshape(-1).astype(np.int64)
    near = np.zeros(len(mesh.points), bool)
    near[edges] = True
    half_edges = np.flatnonzero(near[corners] & near[following])
    width = np.array([len(mesh.points), 1], np.int64)
    ends = np.stack([corners[half_edges], following[half_edges]], axis=1)
    keys, known = np.sort(ends, axis=1) @ width, edges @ width
    row = np.minimum(np.searchsorted(known, keys), len(known) - 1)
    here = known[row] == keys
    return half_edges[here], row[here]


def _crowded_half_edges(
    mesh: SurfaceMesh, crowded: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Half-edges (k,) of edges of three triangles or more, in order of edges, and the edges."""
    if not len(crowded):
        return np.empty(0, np.int64), crowded
    half_edges, row = half_edges_along(mesh, mesh.edges[crowded])
    order = np.argsort(row, kind="stable")
    return half_edges[order], crowded[row[order]]


def _chains(half_edges: NDArray[np.int64], edges: NDArray[np.int32]) -> NDArray[np.int32]:
    """(k, 2) those of one edge of three or more triangles one after the other."""
    along = np.flatnonzero(edges[1:] == edges[:-1])
    return np.stack([half_edges[along], half_edges[along + 1]], axis=1).astype(np.int32)


def _is_balanced(mesh: SurfaceMesh, half_edges: NDArray, edges: NDArray) -> bool:
    """Are crowded edges run along as often one way as the other?"""
    if not len(edges):
        return True
    corners = mesh.triangles.reshape(-1)
    ahead = corners[half_edges] == mesh.edges[edges, 0]
    return not np.bincount(edges, np.where(ahead, 1.0, -1.0)).any()
