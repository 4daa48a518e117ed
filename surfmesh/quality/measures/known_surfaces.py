"""A mesh whose surfaces and corner parameters are known: what distances and normals are of."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
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
        self, triangle: Rows, rule: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (k, 3) and parameters (k, 2) at ``weights[rule]`` of ``triangle``, both (k,)."""
        points = self._at(self.mesh.points, self.mesh.triangles, triangle, rule, weights)
        return points, self.sample_uv(triangle, rule, weights)

    def sample_uv(
        self, triangle: Rows, rule: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(k, 2) the parameters alone."""
        corners = self.corners
        return self._at(corners.uv_points, corners.uv_triangles, triangle, rule, weights)

    @staticmethod
    def _at(
        values: NDArray[np.float64], triangles: NDArray[np.int32], triangle: Rows,
        rule: NDArray[np.int32], weights: NDArray[np.float64],
    ) -> NDArray[np.float64]:  # fmt: skip
        """Only the triangles that are asked for are handed on: every one of them is checked."""
        rows = np.arange(len(triangle), dtype=np.int32)
        return interpolate(values, triangles[triangle], rows, rule, weights)

    def by_surface(self, faces: Rows) -> Iterator[tuple[Surface, NDArray[np.intp]]]:
        """Each surface that occurs among ``faces`` (k,), and the rows where it does."""
        if not len(faces):
            return
        if len(self.mesh.surfaces) == 1:
            yield self.mesh.surfaces[0], np.arange(len(faces))
            return
        order = np.argsort(faces, kind="stable")
        starts = np.flatnonzero(np.diff(faces[order], prepend=-1))
        for start, end in pairwise([*starts.tolist(), len(faces)]):
            yield self.mesh.surfaces[int(faces[order[start]])], order[start:end]

    def evaluate(
        self, faces: Rows, uv: NDArray[np.float64], order: int = 0
    ) -> tuple[NDArray[np.float64], ...]:
        """What the surfaces of ``faces`` (k,) give at uv (k, 2): points (k, 3), at order 1 r_u and
        r_v too."""
        if len(self.mesh.surfaces) == 1:
            return self.mesh.surfaces[0].evaluate(uv, order)
        found = tuple(np.empty((len(uv), 3)) for _ in range(1 + 2 * order))
        for surface, here in self.by_surface(faces):
            for array, values in zip(found, surface.evaluate(uv[here], order)):
                array[here] = values
        return found
