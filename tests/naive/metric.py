"""Metric lengths and shapes with numpy's own linear algebra."""

import numpy as np


def matrix(h) -> np.ndarray:
    """(h11, h12, h22) -> 2 x 2."""
    return np.array([[h[0], h[1]], [h[1], h[2]]])


def length(p, q, hp, hq) -> float:
    """| ((H(p) + H(q)) / 2)^-1 (q - p) |."""
    mean = (matrix(hp) + matrix(hq)) / 2
    return float(np.linalg.norm(np.linalg.solve(mean, np.asarray(q) - np.asarray(p))))


def alpha(a, b, c) -> float:
    """4 sqrt(3) area / sum of squared edges in the plane, negative when clockwise."""
    u, v = np.asarray(b) - a, np.asarray(c) - a
    total = u @ u + v @ v + (u - v) @ (u - v)
    return float(2 * np.sqrt(3) * (u[0] * v[1] - u[1] * v[0]) / total) if total else 0.0


def star_energy(centre, ring, size, ring_sizes, stiffness) -> float:
    """Sum of (1 / alpha)^2 / 2 over the star's triangles and stiffness (l - 1)^2 over spokes."""
    energy = 0.0
    for k in range(len(ring)):
        p, q = ring[k], ring[(k + 1) % len(ring)]
        energy += 0.5 / alpha(centre, p, q) ** 2
        l = np.linalg.norm(p - centre) / (0.5 * (size + ring_sizes[k]))
        energy += stiffness * (l - 1.0) ** 2
    return energy


def metric_root_3d(w) -> np.ndarray:
    """W (xx, xy, xz, yy, yz, zz) -> 3 x 3."""
    xx, xy, xz, yy, yz, zz = w
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def tangent_metric(h, long, along, normal) -> np.ndarray:
    """M (3 x 3) of the sizes ``long`` along a unit tangent and h across it; 0 along the normal."""
    across = np.cross(normal, along)
    return np.outer(along, along) / long**2 + np.outer(across, across) / h**2


def turned(vector, normal, onto) -> np.ndarray:
    """The vector turned by the smallest rotation that takes the unit ``normal`` to ``onto``."""
    axis = np.cross(normal, onto)
    sine, cosine = np.linalg.norm(axis), float(normal @ onto)
    if sine < 1e-12:
        return np.array(vector, float)
    k = axis / sine
    return vector * cosine + np.cross(k, vector) * sine + k * (k @ vector) * (1 - cosine)
