"""A mesh whose surfaces and corner parameters are known: what distances and normals are of."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import interpolate
from surfmesh.geometry.surface import Surface
from surfmesh.result.mesh_parts import Parametrisation
from surfmesh.result.surface_mesh import SurfaceMesh

Rows = NDArray[np.integer[Any]]


class KnownSurfaces(NamedTuple):
    """The mesh and the parameters of its corners."""

    mesh: SurfaceMesh
    corners: Parametrisation

    @classmethod
    def of(cls, mesh: SurfaceMesh) -> KnownSurfaces | None:
        """None where a surface is missing, or there is nothing to look at."""
        corners, faces = mesh.parametrisation, mesh.face_ids
        if not mesh.surfaces or corners is None or not len(mesh.triangles):
            return None
        if not 0 <= int(faces.min()) <= int(faces.max()) < len(mesh.surfaces):
            return None
        return cls(mesh, corners)

    def uv(self, triangles: Rows) -> NDArray[np.float64]:
        """(k, 3, 2) parameters of the corners of some triangles."""
        return self.corners.uv_points[self.corners.uv_triangles[triangles]]

    def points(self, triangles: Rows) -> NDArray[np.float64]:
        """(k, 3, 3) their corners."""
        return self.mesh.points[self.mesh.triangles[triangles]]

    def samples(
        self, triangle: NDArray[np.int32], rule: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (k, 3) and parameters (k, 2) at ``weights[rule]`` of ``triangle``, both (k,)."""
        points = interpolate(self.mesh.points, self.mesh.triangles, _int32(triangle), rule, weights)
        return points, self.sample_uv(triangle, rule, weights)

    def sample_uv(
        self, triangle: NDArray[np.int32], rule: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(k, 2) the parameters alone."""
        uv_points, uv_triangles = self.corners.uv_points, self.corners.uv_triangles
        return interpolate(uv_points, uv_triangles, _int32(triangle), rule, weights)

    def by_surface(self, faces: Rows) -> Iterator[tuple[Surface, NDArray[np.intp]]]:
        """Each surface that occurs among ``faces`` (k,), and the rows where it does."""
        for face in np.unique(faces).tolist():
            yield self.mesh.surfaces[face], np.flatnonzero(faces == face)

    def evaluate(self, faces: Rows, uv: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 3) points of the surfaces of ``faces`` (k,) at uv (k, 2)."""
        if len(self.mesh.surfaces) == 1:
            return self.mesh.surfaces[0].evaluate(uv, 0)[0]
        points = np.empty((len(uv), 3))
        for surface, here in self.by_surface(faces):
            points[here] = surface.evaluate(uv[here], 0)[0]
        return points


def _int32(rows: Rows) -> NDArray[np.int32]:
    return rows.astype(np.int32, copy=False)
