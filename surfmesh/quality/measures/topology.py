"""What kind of surface the triangles form: closed, manifold, oriented, in how many pieces."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh.geometry.components import components
from surfmesh.result.surface_mesh import SurfaceMesh


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


def topology(mesh: SurfaceMesh) -> Topology:
    """Topology of ``mesh``; vertex numbers must be in range (``mesh.broken_invariant()``)."""
    n, table = len(mesh.points), mesh.connectivity
    boundary = table.boundary
    extra = _crowded_half_edges(mesh)
    fans = _fans(mesh, extra)
    used = fans > 0
    clashing = _clashing(mesh)
    even = len(mesh.triangles) > 0 and not len(boundary) and not len(clashing)
    even = even and _is_balanced(mesh, extra)
    return Topology(
        vertices=int(np.count_nonzero(used)),
        edges=len(table.edges),
        triangles=len(mesh.triangles),
        components=_count(vertex_components(mesh), used),
        boundary_edges=len(boundary),
        boundary_loops=(
            _count(components(n, boundary), np.unique(boundary)) if len(boundary) else 0
        ),
        crowded_edges=np.flatnonzero(table.uses > 2).astype(np.int32),
        pinched_vertices=np.flatnonzero(fans > 1).astype(np.int32),
        clashing_edges=clashing,
        fans=fans,
        balanced=even,
    )


def vertex_components(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(n,) the smallest number among the vertices that each hangs together with."""
    return components(len(mesh.points), mesh.edges)


def _count(labels: NDArray[np.int32], members: NDArray) -> int:
    """Number of components among ``members``: those that are their own label."""
    return int((labels == np.arange(len(labels), dtype=np.int32))[members].sum())


def _clashing(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """Edges whose two half-edges start at the same end."""
    table = mesh.connectivity
    return quality.clashing_edges(mesh.triangles, table.half_edges, table.uses)


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


def _crowded_half_edges(mesh: SurfaceMesh) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Half-edges (k,) of edges of three triangles or more, in order of edges, and the edges."""
    crowded = np.flatnonzero(mesh.connectivity.uses > 2)
    if not len(crowded):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    half_edges, row = half_edges_along(mesh, mesh.edges[crowded])
    order = np.argsort(row, kind="stable")
    return half_edges[order], crowded[row[order]]


def _is_balanced(mesh: SurfaceMesh, crowded: tuple[NDArray, NDArray]) -> bool:
    """Are crowded edges run along as often one way as the other?"""
    half_edges, edges = crowded
    if not len(edges):
        return True
    corners = mesh.triangles.reshape(-1)
    ahead = corners[half_edges] == mesh.edges[edges, 0]
    return not np.bincount(edges, np.where(ahead, 1.0, -1.0)).any()


def _fans(mesh: SurfaceMesh, crowded: tuple[NDArray, NDArray]) -> NDArray[np.int64]:
    """Fans at each vertex: corners joined across shared edges, then counted.

    The half-edges 3t+i and 3s+j of one edge, whichever way they run, join the corners at
    each end of it; those of an edge of three or more triangles one after the other.
    """
    pairs = mesh.connectivity.half_edges
    half_edges, edges = (array.astype(np.int32) for array in crowded)
    if len(edges):
        along = np.flatnonzero(edges[1:] == edges[:-1])
        chains = np.stack([half_edges[along], half_edges[along + 1]], axis=1)
        pairs = np.concatenate([pairs[mesh.connectivity.uses == 2], chains])
    return quality.triangle_fans(mesh.triangles, len(mesh.points), pairs)
