"""Nodes amid edges within faces move along the surface so that curved triangles lie nearer to it.

A node may slide along the surface: it stays on it, but the parabolas through it change. Of a
surface z = II(x, x) / 2 + C(x, x, x) / 6 six nodes leave an error of third order, what they do not
see of C; a node that slides by s adds 4 l_i l_j II(s, x) to it, which can take most of it away (on
a curve: s = h^2 C / (24 II) along it takes all). Least squares over samples of all triangles:
Gauss-Newton, its equations by conjugate gradients. What is flat is left alone: sliding changes
nothing there.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.curved_triangles import are_bent, points_on, shape_functions
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.result.quadratic_triangles import six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

ROUNDS = 3  # of Gauss-Newton: the feet of the samples and the normals there change little
DESCENTS = 12  # of conjugate gradients in each
FARTHEST = 0.1  # of its edge: so far may a node slide; at a quarter the side would turn back
RELUCTANCE = 0.01  # slope of the surface against a triangle at which sliding is no more worth it
STEPS = 3  # of the search for feet, which starts from those of the round before

SAMPLES = np.array(
    [
        (0.8, 0.2, 0), (0.2, 0.8, 0), (0, 0.8, 0.2), (0, 0.2, 0.8), (0.2, 0, 0.8), (0.8, 0, 0.2),
        (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.2, 0.2, 0.6), (1 / 3, 1 / 3, 1 / 3),
    ]
)  # fmt: skip
"""Barycentric places (q, 3) where cubic errors are large; nodes have none."""


class _Equations(NamedTuple):
    """Signed distances of samples (m, q), and how they change as nodes slide."""

    distances: NDArray[np.float64]  # (m, q) along the normals of the surface
    rates: NDArray[np.float64]  # (m, q, 3, 2) by the steps of the three nodes along their tangents
    edges: NDArray[np.int64]  # (m, 3) the edges of these nodes
    number: int  # of edges

    def along(self, steps: NDArray) -> NDArray:
        """(m, q) what steps (e, 2) do to the distances, in first order."""
        return np.einsum("mqkd,mkd->mq", self.rates, steps[self.edges])

    def back(self, distances: NDArray) -> NDArray:
        """(e, 2) the transposed."""
        parts = np.einsum("mqkd,mq->mkd", self.rates, distances).reshape(-1, 2)
        edges = self.edges.ravel()
        return np.stack([np.bincount(edges, x, self.number) for x in parts.T], axis=1)

    def solution(self) -> NDArray[np.float64]:
        """Steps (e, 2) by conjugate gradients on the normal equations."""
        steps = np.zeros((self.number, 2))
        left = -self.back(self.distances)
        way, size = left.copy(), float((left**2).sum())
        for _ in range(DESCENTS):
            if size <= 0.0:
                break
            image = self.back(self.along(way)) + RELUCTANCE**2 * way
            length = size / float((way * image).sum())
            steps += length * way
            left -= length * image
            size, before = float((left**2).sum()), size
            way = left + (size / before) * way
        return steps


def slid_nodes(
    mesh: SurfaceMesh, middles: NDArray[np.float64], fixed: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Where the nodes amid edges (e, 3) of a mesh slide to, those that are not ``fixed`` (e,)."""
    if mesh.uv is None or mesh.sizing is None or mesh.sizing.chord is None:
        return middles
    edges = six_nodes(mesh.triangles, mesh.connectivity, 0)[:, 3:].astype(np.int64)
    chord = np.full(len(edges), mesh.sizing.chord)
    bent = are_bent(mesh.points, middles, mesh.edges, edges, chord)
    still = np.ones(len(fixed), bool)
    still[edges[bent]] = fixed[edges[bent]]
    if still.all():
        return middles
    fixed = still
    length = np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)
    search, start, found = _Search(mesh, edges, fixed), middles, middles
    for _ in range(ROUNDS):
        equations, tangents = search.equations(found)
        steps = equations.solution()
        moved = found + np.einsum("eid,ed->ei", tangents, steps)
        slid = moved - start
        far = np.linalg.norm(slid, axis=1) / (FARTHEST * length)
        moved = start + slid / np.maximum(far, 1.0)[:, None]
        found = search.on_surface(np.where(fixed[:, None], middles, moved))
    return found


class _Search:
    """The samples of a mesh's triangles on their surfaces, from guesses that become better."""

    def __init__(self, mesh: SurfaceMesh, edges: NDArray, fixed: NDArray) -> None:
        self.mesh = mesh
        assert mesh.uv is not None  # noqa: S101  for mypy
        self.rows = np.flatnonzero((~fixed)[edges].any(axis=1))
        self.edges = edges[self.rows]
        self.uv = np.einsum("qk,mkd->mqd", SAMPLES, mesh.uv[self.rows])
        half_edge = mesh.connectivity.half_edges[:, 0]
        self.owner = half_edge // 3
        side = half_edge % 3
        corners = mesh.uv[self.owner]
        rows = np.arange(len(side))
        self.middle_uv = 0.5 * (corners[rows, side] + corners[rows, (side + 1) % 3])
        faces = mesh.face_ids[self.rows]
        self.by_face = [(f, np.flatnonzero(faces == f)) for f in np.unique(faces).tolist()]
        owners = np.where(fixed, -1, mesh.face_ids[self.owner])
        self.edges_by_face = [
            (f, np.flatnonzero(owners == f)) for f in np.unique(owners).tolist() if f >= 0
        ]

    def on_surface(self, middles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Nodes (e, 3), the free ones put on their surfaces."""
        found = middles.copy()
        for face, own in self.edges_by_face:
            surface = self.mesh.surfaces[face]
            uv, _, foot = closest_point(surface, middles[own], self.middle_uv[own], STEPS)
            found[own], self.middle_uv[own] = foot, uv
        return found

    def equations(self, middles: NDArray[np.float64]) -> tuple[_Equations, NDArray[np.float64]]:
        """With the tangents (e, 3, 2) of the nodes, zero for fixed ones."""
        mesh, count = self.mesh, len(middles)
        corners = mesh.points[mesh.triangles[self.rows]]
        nodes = np.concatenate([corners, middles[self.edges]], axis=1)
        points = points_on(nodes, SAMPLES)
        distances, normals = np.zeros(points.shape[:2]), np.zeros(points.shape)
        for face, own in self.by_face:
            surface = mesh.surfaces[face]
            uv, _, foot = closest_point(
                surface, points[own].reshape(-1, 3), self.uv[own].reshape(-1, 2), STEPS
            )
            self.uv[own] = uv.reshape(self.uv[own].shape)
            _, ru, rv = surface.evaluate(uv, 1)
            normal = _unit(np.cross(ru, rv)).reshape(points[own].shape)
            distances[own] = ((points[own] - foot.reshape(normal.shape)) * normal).sum(axis=2)
            normals[own] = normal
        tangents = np.zeros((count, 3, 2))
        for face, own in self.edges_by_face:
            _, ru, rv = mesh.surfaces[face].evaluate(self.middle_uv[own], 1)
            first = _unit(ru)
            tangents[own] = np.stack([first, _unit(np.cross(np.cross(ru, rv), first))], axis=2)
        functions = shape_functions(SAMPLES)[:, 3:]
        rates = np.einsum("mqi,mkid->mqkd", normals, tangents[self.edges])
        rates *= functions[None, :, :, None]
        return _Equations(distances, rates, self.edges, count), tangents


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)
