"""Vertices as their faces see them, and the steps that move them by given lengths along normals.

  face 1  n1 |  / step           a site is a vertex on one face; along the edge of two faces
             | /                 one step has to reach both lengths:   n1 . step = t1
-------------o                                                         n2 . step = t2
              \\ `- n2           planes stay what they are: their t is 0, exactly. Where
        face 2 \\                 normals nearly coincide the mean length is taken, and beside
                                 a plane none
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import tangent_plane_offsets
from surfmesh.geometry.small_matrices import product, thin_svd
from surfmesh.result.surface_mesh import SurfaceMesh

FLAT = 1e-9  # of the mesh's extent: a face no farther from its triangles may be a plane
ALIKE = 1e-7  # of 1 - cosine: normals of a plane
BENT = 0.9  # cosine between a normal and the mean around it, below which the mean is taken
INDEPENDENT = 0.5  # least singular value of normals that are given different lengths
SPANNED = 0.2  # the same below which a direction lies in all the tangent planes


class Sites(NamedTuple):
    """A vertex on one face each."""

    of_corner: NDArray[np.int64]  # (m, 3) of the corners of triangles
    vertex: NDArray[np.int64]  # (s,)
    normal: NDArray[np.float64]  # (s, 3) unit, or zero
    slope: NDArray[np.float64]  # (m, 3) cosine between the normals of triangle and site
    is_plane: NDArray[np.bool_]  # (s,) the face is one

    @classmethod
    def of(cls, mesh: SurfaceMesh, distances: NDArray[np.float64]) -> Sites:
        """distances: (m, q) of the triangles from their surfaces."""
        faces = len(mesh.surfaces)
        keys = mesh.triangles.astype(np.int64) * faces + mesh.face_ids[:, None]
        found, first, of_corner = np.unique(keys.ravel(), return_index=True, return_inverse=True)
        of_corner = of_corner.reshape(-1, 3)
        across = _triangle_normals(mesh)
        vertex, face = np.divmod(found, faces)
        normal = _site_normals(mesh, face, first)
        around = np.zeros((len(found), 3))
        for k in range(3):
            np.add.at(around, of_corner[:, k], across)
        size = np.linalg.norm(around, axis=1, keepdims=True)
        around /= np.maximum(size, np.finfo(float).tiny)
        is_bent = np.einsum("ij,ij->i", normal, around) < BENT
        if not mesh.one_sided:
            normal[is_bent] = around[is_bent]
        unit = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
        slope = np.einsum("ij,ikj->ik", unit, normal[of_corner])
        return cls(of_corner, vertex, normal, slope, _planes(mesh, distances, unit)[face])


def _triangle_normals(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(m, 3) twice their areas, on the side of the normals of their surfaces."""
    a, b, c = (mesh.points[corner] for corner in mesh.triangles.T)
    normal: NDArray[np.float64] = np.cross(b - a, c - a)
    if mesh.turned_faces is not None:
        normal[mesh.turned_faces[mesh.face_ids]] *= -1.0
    return normal


def _site_normals(
    mesh: SurfaceMesh, face: NDArray[np.int64], corner: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(s, 3) of the surfaces at corners 3 t + k of triangles."""
    corners = mesh.parametrisation
    assert corners is not None  # noqa: S101  for mypy: whoever has surfaces has parameters
    uv = corners.uv_points[corners.uv_triangles.ravel()[corner]]
    normal = np.zeros((len(face), 3))
    for number in np.unique(face).tolist():
        own = np.flatnonzero(face == number)
        foot, ru, rv = (np.ascontiguousarray(x) for x in mesh.surfaces[number].evaluate(uv[own], 1))
        normal[own] = tangent_plane_offsets(foot, foot, ru, rv)[:, :3]
    return normal


def _planes(
    mesh: SurfaceMesh, distances: NDArray[np.float64], unit: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(f,) faces whose triangles lie on them, all in one plane."""
    faces = len(mesh.surfaces)
    extent = float(np.ptp(mesh.points, axis=0).max())
    farthest = np.zeros(faces)
    np.maximum.at(farthest, mesh.face_ids, np.abs(distances).max(axis=1))
    first = np.zeros(faces, np.int64)
    first[mesh.face_ids[::-1]] = np.arange(len(unit))[::-1]
    turned = np.zeros(faces)
    cosine = np.einsum("ij,ij->i", unit, unit[first[mesh.face_ids]])
    np.maximum.at(turned, mesh.face_ids, 1.0 - cosine)
    return (farthest <= FLAT * extent) & (turned <= ALIKE)


class Steps:
    """The steps (n, 3) of vertices for lengths (s,) that their sites are to move by."""

    def __init__(self, sites: Sites, vertices: int) -> None:
        self.sites, self.count = sites, vertices
        order = np.argsort(sites.vertex, kind="stable")
        uses = np.bincount(sites.vertex, minlength=vertices)
        start = np.cumsum(uses) - uses
        self._single = order[start[uses == 1]]
        self._single = self._single[~sites.is_plane[self._single]]
        self._groups: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]] = []
        for many in np.unique(uses[uses > 1]).tolist():
            vertex = np.flatnonzero(uses == many)
            rows = order[start[vertex][:, None] + np.arange(many)]
            self._groups.append((vertex, rows, _inverses(sites, rows)))

    def of(self, lengths: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 3): as near to the lengths (s,) as one step of each vertex can be."""
        steps, one = np.zeros((self.count, 3)), self._single
        steps[self.sites.vertex[one]] = lengths[one, None] * self.sites.normal[one]
        for vertex, rows, inverse in self._groups:
            steps[vertex] = np.einsum("gij,gj->gi", inverse, lengths[rows])
        return steps

    def reached(self, steps: NDArray[np.float64]) -> NDArray[np.float64]:
        """The lengths (s,) that the steps (n, 3) have along the normals of sites."""
        found: NDArray[np.float64] = np.einsum(
            "ij,ij->i", self.sites.normal, steps[self.sites.vertex]
        )
        return found

    def within_all_faces(self, directions: NDArray[np.float64]) -> NDArray[np.float64]:
        """What of directions (n, 3) lies in the tangent planes of all faces at a vertex."""
        normal, one = self.sites.normal, np.flatnonzero(np.bincount(self.sites.vertex) == 1)
        left = directions.copy()
        row = np.searchsorted(self.sites.vertex, one)
        along = np.einsum("ij,ij->i", left[one], normal[row])
        left[one] -= along[:, None] * normal[row]
        for vertex, rows, _ in self._groups:
            _, s, v = thin_svd(normal[rows])
            kept = np.where(s > SPANNED, 1.0, 0.0)[:, :, None] * v
            left[vertex] -= np.einsum("gki,gkj,gj->gi", kept, kept, left[vertex])
        return left


def _inverses(sites: Sites, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """(g, 3, k) from the lengths of k sites to the step of their vertex; rows: (g, k)."""
    normal, plane = sites.normal[rows], sites.is_plane[rows][:, :, None]
    _, s, v = thin_svd(np.where(plane, normal, 0.0))
    held = np.where(s > ALIKE, 1.0, 0.0)[:, :, None] * v
    free = np.eye(3) - np.einsum("gki,gkj->gij", held, held)
    u, s, v = thin_svd(product(np.where(plane, 0.0, normal), free))
    inverse = np.where(s > INDEPENDENT, 1.0 / np.maximum(s, INDEPENDENT), 0.0)
    found: NDArray[np.float64] = np.einsum("gki,gk,gjk->gij", v, inverse, u)
    return found
