"""Triangles that look the other way than the true surface near them."""

import numpy as np
from scipy.spatial import cKDTree


def reversed_triangles(
    corners: np.ndarray, places: np.ndarray, normals: np.ndarray, near: int, against: float
) -> int:
    """How many triangles (m, 3, 3) look against all of the so many nearest true normals.

    places, normals: (n, 3) of the true surface, the latter of any length; zero ones are left
    out. against: cosine, below zero, that a normal must have to each of them.
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    own = _unit(np.cross(b - a, c - a))
    true = _unit(normals)
    kept = np.abs(true).max(axis=1) > 0.0
    _, found = cKDTree(places[kept]).query(corners.mean(axis=1), k=near)
    cosines = np.einsum("ij,ikj->ik", own, true[kept][found])
    return int((cosines.max(axis=1) < against).sum())


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Of length one; zero where they vanish."""
    largest = np.abs(vectors).max(axis=1, keepdims=True)
    scaled = vectors / np.where(largest > 0.0, largest, 1.0)
    length = np.linalg.norm(scaled, axis=1, keepdims=True)
    return scaled / np.where(length > 0.0, length, 1.0)
