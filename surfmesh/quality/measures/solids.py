"""The solids of a CAD model's mesh, one by one: a face between two of them counts for both."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.surface_mesh import SurfaceMesh


class AroundSolids(NamedTuple):
    """Triangles around all solids, facing outwards; those between two solids are there twice."""

    triangles: NDArray[np.int32]  # (k, 3) vertices
    rows: NDArray[np.intp]  # (k,) of the mesh's triangles
    solid: NDArray[np.int32]  # (k,)


def solids_beside(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """(m, 2) solid behind each triangle and before it; -1, as where no solid is known: none."""
    if mesh.solid_ids is None:
        return np.full((len(mesh.triangles), 2), -1, np.int32)
    return mesh.solid_ids


def bounds_solid(mesh: SurfaceMesh, solid: int) -> NDArray[np.bool_]:
    """(m,) does a solid lie behind or before a triangle?"""
    behind, before = solids_beside(mesh).T
    return (behind == solid) | (before == solid)


def bounds_none(mesh: SurfaceMesh) -> NDArray[np.bool_]:
    """(m,) is a triangle of no solid?"""
    behind, before = solids_beside(mesh).T
    return (behind < 0) & (before < 0)


def around_solids(mesh: SurfaceMesh) -> AroundSolids:
    """Those behind which a solid lies, then those before which one lies, turned over."""
    behind, before = solids_beside(mesh).T
    if len(behind) and behind.min() >= 0 and before.max() < 0:  # as a rule
        return AroundSolids(mesh.triangles, np.arange(len(behind)), behind.copy())
    ahead, against = np.flatnonzero(behind >= 0), np.flatnonzero(before >= 0)
    rows = np.concatenate([ahead, against])
    solid = np.concatenate([behind[ahead], before[against]])
    triangles = mesh.triangles[rows]
    triangles[len(ahead) :] = triangles[len(ahead) :, ::-1]
    return AroundSolids(triangles, rows, solid)


def solid_mesh(mesh: SurfaceMesh, solid: int) -> SurfaceMesh:
    """The triangles around one solid, facing outwards; on its own vertices, without (u, v)."""
    behind, before = (solids_beside(mesh) == solid).T
    rows = np.concatenate([np.flatnonzero(behind), np.flatnonzero(before)])
    plain = SurfaceMesh(
        points=mesh.points, triangles=mesh.triangles, face_ids=mesh.face_ids, sizes=mesh.sizes,
        sizing=mesh.sizing, groups=mesh.groups,
    ).submesh(rows)  # fmt: skip
    triangles = plain.triangles.copy()
    triangles[behind.sum() :] = triangles[behind.sum() :, ::-1]
    return replace(plain, triangles=triangles)


def shares_faces(mesh: SurfaceMesh) -> bool:
    """Do two solids of the model have a face in common?"""
    behind, before = solids_beside(mesh).T
    return bool(((behind >= 0) & (before >= 0)).any())
