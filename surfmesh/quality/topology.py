"""What kind of surface the triangles form: closed, manifold, oriented, in how many pieces."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.kernels.measure import component_labels
from surfmesh.surface_mesh import SurfaceMesh


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
        """The triangles at every vertex form one fan, closed or open."""
        return not len(self.crowded_edges) and not len(self.pinched_vertices)

    @property
    def oriented(self) -> bool:
        """Neighbours run along their common edge in opposite directions."""
        return not len(self.clashing_edges)


def topology(mesh: SurfaceMesh) -> Topology:
    """Topology of ``mesh``; vertex numbers must be in range (``mesh.check()``)."""
    n, corners = len(mesh.points), mesh.triangles.reshape(-1)
    table = mesh.connectivity
    used = np.zeros(n, bool)
    used[corners] = True
    boundary = table.boundary
    return Topology(
        vertices=int(used.sum()),
        edges=len(table.edges),
        triangles=len(mesh.triangles),
        components=_count(vertex_components(mesh), used),
        boundary_edges=len(boundary),
        boundary_loops=_count(_labels(n, boundary), np.unique(boundary)),
        crowded_edges=np.flatnonzero(table.uses > 2).astype(np.int32),
        pinched_vertices=_pinched(mesh),
        clashing_edges=_clashing(mesh),
    )


def vertex_components(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(n,) the smallest number among the vertices that each hangs together with."""
    return _labels(len(mesh.points), mesh.edges)


def _labels(count: int, pairs: NDArray[np.int32]) -> NDArray[np.int32]:
    labels = np.empty(count, np.int32)
    component_labels(pairs, labels)
    return labels


def _count(labels: NDArray[np.int32], members: NDArray) -> int:
    """Number of components among ``members``: those that are their own label."""
    return int((labels == np.arange(len(labels), dtype=np.int32))[members].sum())


def _clashing(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """Edges whose two half-edges start at the same end."""
    table, corners = mesh.connectivity, mesh.triangles.reshape(-1)
    same = corners[table.half_edges[:, 0]] == corners[table.half_edges[:, 1]]
    same &= table.uses == 2
    return np.flatnonzero(same).astype(np.int32)


def _pinched(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """Vertices with more than one fan: corners joined across shared edges, then counted.

    The half-edges 3t+i and 3s+j of one edge, whichever way they run, join the corners at
    each end of it. An edge of three or more triangles joins nothing: that is named already.
    """
    table, corners = mesh.connectivity, mesh.triangles.reshape(-1)
    here, there = table.half_edges[table.uses == 2].T
    links = np.empty((2 * len(here), 2), np.int32)
    links[0::2, 0], links[1::2, 0] = here, _next(here)
    same = corners[here] == corners[there]
    there_end = _next(there)
    links[0::2, 1] = np.where(same, there, there_end)
    links[1::2, 1] = np.where(same, there_end, there)
    labels = _labels(len(corners), links)
    del links
    heads = corners[labels == np.arange(len(corners), dtype=np.int32)]
    fans = np.bincount(heads, minlength=len(mesh.points))
    fans[mesh.edges[table.uses > 2]] = 1
    return np.flatnonzero(fans > 1).astype(np.int32)


def _next(half_edge: NDArray[np.int32]) -> NDArray[np.int32]:
    return half_edge + np.where(half_edge % 3 == 2, np.int32(-2), np.int32(1))
