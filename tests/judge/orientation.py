"""Triangles that look the other way than the true surface near them."""

import numpy as np
import pyvista
import trimesh
from scipy.spatial import cKDTree

AGAINST = -0.1, -0.3
"""Cosine to the nearest true triangle's normal, and to those of all triangles near: with both,
a thin wall's other side is not taken for the triangle's own."""
NEAR = 16


def reversed_triangles(mesh: trimesh.Trimesh, truth: trimesh.Trimesh, reach: float = 0.0) -> int:
    """How many triangles of the mesh look against all true ones near them: the nearest ones, and
    those within reach, as far as walls may be thinner than the chord."""
    centres, own = mesh.triangles_center, _unit(mesh.triangles_cross)
    true, middles = _unit(truth.triangles_cross), truth.triangles_center
    cell, _ = pyvista.wrap(truth).find_closest_cell(centres, return_closest_point=True)
    doubtful = np.flatnonzero(np.einsum("ij,ij->i", own, true[cell]) < AGAINST[0])
    _, found = cKDTree(middles).query(centres[doubtful], k=min(NEAR, len(middles)))
    cosines = np.einsum("ij,ikj->ik", own[doubtful], true[found])
    against = doubtful[cosines.max(axis=1) < AGAINST[1]]
    return sum(
        _distance(centres[k], truth, true @ own[k] >= AGAINST[1]) > reach for k in against.tolist()
    )


def _distance(point: np.ndarray, truth: trimesh.Trimesh, chosen: np.ndarray) -> float:
    """From a point to those of the true triangles."""
    if not chosen.any():
        return float("inf")
    some = pyvista.wrap(trimesh.Trimesh(truth.vertices, truth.faces[chosen], process=False))
    _, foot = some.find_closest_cell(point, return_closest_point=True)
    return float(np.linalg.norm(foot - point))


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Of length one; zero where they vanish."""
    largest = np.abs(vectors).max(axis=1, keepdims=True)
    scaled = vectors / np.where(largest > 0.0, largest, 1.0)
    length = np.linalg.norm(scaled, axis=1, keepdims=True)
    return scaled / np.where(length > 0.0, length, 1.0)
