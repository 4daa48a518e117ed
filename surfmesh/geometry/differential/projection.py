"""The closest point of a surface, near a guess: how far is a mesh from what it stands for?

Gauss-Newton on |r(u, v) - p|^2: (J^T J) step = J^T (p - r) with J = (r_u, r_v). For a point at
distance d from a surface of curvature k each step divides the error by about 1 / (d k), so
two steps do for a mesh. Source: Nocedal, Wright, "Numerical Optimization", 2006, section 10.3.
"""

from __future__ import annotations

import numpy as np

from surfmesh.geometry.surface import Surface

MARGIN = 0.01  # of the domain: how far outside a foot may lie, so that seams are no walls
CONVERGED = 1e-3  # tangential step over distance: below it the distance is right to 5e-7
PARALLEL = 1e-12  # squared sine of r_u and r_v, below which only the longer one is followed
FROM_CORNER = 0.1  # of the way to the foot known so far: where a search begins anew
SHORTER = 0.25  # of a step that led farther from the point is tried next


def closest_point(
    surface: Surface,
    points: np.ndarray,
    uv_guess: np.ndarray,
    steps: int = 2,
    margin: float = MARGIN,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nearest points of a surface to points, from guesses, never farther than these.

    points: (n, 3), uv_guess: (n, 2). margin: fraction of the domain by which they may leave it.
    Returns uv (n, 2), distance (n,), foot (n, 3). The search is local: a nearer part of the
    surface that the guess does not lead to is not found.
    """
    points = np.asarray(points, dtype=float).reshape(-1, 3)
    uv = np.array(uv_guess, dtype=float).reshape(-1, 2)
    lo, hi = np.array(surface.domain).T
    lo, hi = lo - margin * (hi - lo), hi + margin * (hi - lo)

    foot, r_u, r_v = surface.evaluate(uv, 1)
    gap = points - foot
    squared = _dot(gap, gap)
    active = np.arange(len(points))
    step, progress = _gauss_newton(r_u, r_v, gap)
    for remaining in range(steps - 1, -1, -1):
        going = progress > CONVERGED**2 * squared[active]
        active, step, progress = active[going], step[going], progress[going]
        if not len(active):
            break
        trial = np.clip(uv[active] + step, lo, hi)
        trial_foot, *tangents = surface.evaluate(trial, 1 if remaining else 0)
        gap = points[active] - trial_foot
        trial_squared = _dot(gap, gap)
        better = trial_squared < squared[active]  # False for nan, where a formula ends
        nearer = active[better]
        uv[nearer], foot[nearer] = trial[better], trial_foot[better]
        squared[nearer] = trial_squared[better]
        if remaining:
            fresh_step, fresh_progress = _gauss_newton(tangents[0], tangents[1], gap)
            step = np.where(better[:, None], fresh_step, SHORTER * step)
            progress = np.where(better, fresh_progress, progress)
    return uv, np.sqrt(squared), foot


def closest_from_corners(
    surface: Surface,
    points: np.ndarray,
    uv: np.ndarray,
    distance: np.ndarray,
    corners: np.ndarray,
    steps: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Points that may be nearer: searched for anew from the ``corners`` (n, 3, 2) of triangles.

    uv: (n, 2) nearest to the points (n, 3) so far, and their ``distance`` (n,). About a singular
    point the search from the middle finds others. Returns uv and distance, never larger.
    """
    uv, distance = uv.copy(), distance.copy()
    for corner in corners.transpose(1, 0, 2):
        guess = corner + FROM_CORNER * (uv - corner)  # the corner may be the singular point
        found, other, _ = closest_point(surface, points, guess, steps)
        nearer = other < distance
        uv[nearer], distance[nearer] = found[nearer], other[nearer]
    return uv, distance


def _gauss_newton(
    r_u: np.ndarray, r_v: np.ndarray, gap: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The step (n, 2) in (u, v), and the squared length (n,) that it has in space."""
    E, F, G = _dot(r_u, r_u), _dot(r_u, r_v), _dot(r_v, r_v)
    a, b = _dot(r_u, gap), _dot(r_v, gap)
    determinant = E * G - F * F
    regular = determinant > PARALLEL * E * G
    safe = np.where(regular, determinant, 1.0)
    # at a pole or cusp: along the longer tangent alone
    along_u = np.where(E >= G, a / np.where(E > 0.0, E, 1.0), 0.0)
    along_v = np.where(E >= G, 0.0, b / np.where(G > 0.0, G, 1.0))
    step = np.stack(
        [
            np.where(regular, (G * a - F * b) / safe, along_u),
            np.where(regular, (E * b - F * a) / safe, along_v),
        ],
        axis=1,
    )
    return step, step[:, 0] * a + step[:, 1] * b


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)
