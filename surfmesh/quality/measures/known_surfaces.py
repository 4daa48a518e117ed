"""A mesh whose surfaces and corner parameters are known: what distances and normals are of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import (
    plane_triangles,
    prepared_surfaces,
    sampled_surface,
    surface_distances,
    surface_points,
)
from surfmesh._core.space import interpolate
from surfmesh._core.surfaces import Surface as CoreSurface
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.result.mesh_parts import Parametrisation
from surfmesh.result.surface_mesh import SurfaceMesh

Rows = NDArray[np.integer[Any]]
Arrays = tuple[
    list[CoreSurface], NDArray[np.float64], NDArray[np.int32], NDArray[np.float64],
    NDArray[np.int32], NDArray[np.int32],
]  # fmt: skip


@dataclass(frozen=True)
class KnownSurfaces:
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
        return self.corners.uv_points.take(self.corners.uv_triangles.take(triangles, 0), 0)

    def middle_uv(self, triangles: Rows) -> NDArray[np.float64]:
        """(k, 2) the means of these."""
        a, b, c = self.uv(triangles).transpose(1, 0, 2)
        return (a + b + c) / 3.0

    def points(self, triangles: Rows) -> NDArray[np.float64]:
        """(k, 3, 3) their corners."""
        return self.mesh.points.take(self.mesh.triangles.take(triangles, 0), 0)

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

    @cached_property
    def diagonal(self) -> float:
        """Of the box around the vertices."""
        return diagonal(self.mesh.points)

    @cached_property
    def core_surfaces(self) -> list[CoreSurface]:
        """Those of the mesh, as the core has them."""
        return [as_core_surface(surface) for surface in self.mesh.surfaces]

    @cached_property
    def prepared_surfaces(self) -> list[CoreSurface]:
        """The same for many places: points and first derivatives are as theirs to rounding."""
        return prepared_surfaces(self.core_surfaces, self.mesh.face_ids)

    @property
    def arrays(self) -> Arrays:
        """Surfaces, points, triangles, parameters, triangles of these, faces: what the core takes
        as a mesh on its surfaces."""
        return self._on(self.core_surfaces)

    @property
    def prepared_arrays(self) -> Arrays:
        """The same on ``prepared_surfaces``."""
        return self._on(self.prepared_surfaces)

    def _on(self, surfaces: list[CoreSurface]) -> Arrays:
        mesh, corners = self.mesh, self.corners
        return (
            surfaces, mesh.points, mesh.triangles, corners.uv_points, corners.uv_triangles,
            mesh.face_ids,
        )  # fmt: skip

    @cached_property
    def in_plane(self) -> NDArray[np.uint8]:
        """(m,) 1 for the triangles of planes whose corners are r(u, v) to rounding: between them
        there is nothing to be seen."""
        return plane_triangles(*self.arrays)

    def sampled(
        self, triangle: Rows, rule: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Parameters (k, 2) at ``weights[rule]`` of ``triangle``, both (k,), the points (k, 3) of
        the surfaces there, and how far (k,) these are from the triangle."""
        return sampled_surface(
            *self.arrays, triangle.astype(np.int32, copy=False), rule, np.ascontiguousarray(weights)
        )

    def surface_distances(
        self, triangle: NDArray[np.int32], weights: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """How far (k w,) points of the surfaces at barycentric weights (w, 3) over triangles (k,)
        are from them, triangle after triangle."""
        return surface_distances(*self.arrays, triangle, weights)

    def points_at(self, faces: Rows, uv: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 3) of the surfaces of ``faces`` (k,) at uv (k, 2)."""
        (points,) = surface_points(self.core_surfaces, faces.astype(np.int32, copy=False), uv, 0)
        return points
