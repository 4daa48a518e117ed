"""First and second fundamental forms, normals, principal curvatures and directions.

    I = [E F; F G]     E = r_u.r_u   F = r_u.r_v   G = r_v.r_v
    II = [L M; M N]    L = r_uu.n    M = r_uv.n    N = r_vv.n      n = r_u x r_v / |r_u x r_v|

Source: do Carmo, "Differential Geometry of Curves and Surfaces", chapters 2-5 and 3-3. With
this sign a sphere whose normal points outwards has k1 = k2 = -1/R.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.geometry.quadrature import gauss_rule
from surfmesh.geometry.small_matrices import product
from surfmesh.geometry.surface import Surface

DEGENERATE = 1e-10  # |r_u x r_v| / (E + G): the sine of r_u and r_v times their ratio; below
# it second derivatives divided by it keep no digits
UMBILIC = 1e-13  # (k1 - k2) / (|k1| + |k2|): below it the principal directions are round-off
NORMAL_NUDGE = 1e-6  # of the domain: where the normal of a degenerate point is taken


class FundamentalForms(NamedTuple):
    """The two forms at n points; each coefficient is (n,) float."""

    E: np.ndarray
    F: np.ndarray
    G: np.ndarray
    L: np.ndarray
    M: np.ndarray
    N: np.ndarray
    normal: np.ndarray  # (n, 3) unit, along r_u x r_v; (0, 0, 0) where nothing better is known
    degenerate: np.ndarray  # (n,) bool: r_u and r_v do not span a plane (pole, apex, cusp)


class PrincipalCurvatures(NamedTuple):
    """Curvatures at n points; 1/length. Zero at degenerate points."""

    k1: np.ndarray  # (n,) the larger principal curvature
    k2: np.ndarray  # (n,) the smaller
    d1: np.ndarray  # (n, 2) direction of k1 in (u, v), of unit length in I
    d2: np.ndarray  # (n, 2) direction of k2, at right angles to d1 in I, to the left of it
    gaussian: np.ndarray  # (n,) K = k1 k2
    mean: np.ndarray  # (n,) H = (k1 + k2) / 2


def forms(surface: Surface, uv: np.ndarray) -> FundamentalForms:
    """Both forms of a surface at uv (n, 2).

    The normal of a degenerate point is the one a millionth of the domain further inside.
    """
    uv = np.asarray(uv, dtype=float).reshape(-1, 2)
    result = forms_from_derivatives(*surface.evaluate(uv, 2)[1:])
    if result.degenerate.any():
        lo, hi = np.array(surface.domain).T
        places = uv[result.degenerate]
        towards = np.where(places > 0.5 * (lo + hi), -1.0, 1.0)
        _, r_u, r_v = surface.evaluate(places + towards * NORMAL_NUDGE * (hi - lo), 1)
        result.normal[result.degenerate] = _unit_normal(r_u, r_v)[0]
    return result


def forms_from_derivatives(
    r_u: np.ndarray, r_v: np.ndarray, r_uu: np.ndarray, r_uv: np.ndarray, r_vv: np.ndarray
) -> FundamentalForms:
    """Both forms from the derivatives of r, each (n, 3)."""
    E, F, G = _dot(r_u, r_u), _dot(r_u, r_v), _dot(r_v, r_v)
    normal, area = _unit_normal(r_u, r_v)
    degenerate = ~(area > DEGENERATE * (E + G))
    normal[degenerate] = 0.0
    L, M, N = _dot(r_uu, normal), _dot(r_uv, normal), _dot(r_vv, normal)
    return FundamentalForms(E, F, G, L, M, N, normal, degenerate)


def curvatures(forms: FundamentalForms) -> PrincipalCurvatures:
    """Principal curvatures and directions, finite everywhere.

    I = C C^T with C lower triangular (Cholesky) turns II into the symmetric shape operator
    S = C^-1 II C^-T of an orthonormal frame of the tangent plane, whose eigenvalues are k1 and
    k2; no digits are lost to a stretched (u, v). At umbilics the pair of directions is the one
    with d1 along u; at degenerate points the curvatures are 0 and the directions (1, 0), (0, 1).
    """
    E, F, G, L, M, N, _, degenerate = forms
    a = np.sqrt(np.where(degenerate, 1.0, E))
    b = np.where(degenerate, 0.0, F) / a
    c = np.sqrt(np.where(degenerate, 1.0, np.maximum(E * G - F * F, 0.0))) / a
    c = np.where(c > 0.0, c, 1.0)
    s11 = L / (a * a)
    s12 = (M - b * L / a) / (a * c)
    s22 = (N - 2.0 * b * M / a + b * b * L / (a * a)) / (c * c)

    mean = np.where(degenerate, 0.0, 0.5 * (s11 + s22))
    half = np.where(degenerate, 0.0, 0.5 * (s11 - s22))
    s12 = np.where(degenerate, 0.0, s12)
    radius = elementary_functions.hypot(half, s12)
    umbilic = radius <= UMBILIC * np.abs(mean)
    turn = np.where(umbilic, 0.0, 0.5 * elementary_functions.atan2(s12, half))
    sin, cos = elementary_functions.sincos(turn)
    d1 = np.stack([cos / a - b * sin / (a * c), sin / c], axis=1)
    d2 = np.stack([-sin / a - b * cos / (a * c), cos / c], axis=1)
    k1, k2 = mean + radius, mean - radius
    return PrincipalCurvatures(k1, k2, d1, d2, k1 * k2, mean)


def area(surface: Surface, cells: int = 64, points: int = 8) -> float:
    """Area of a surface by Gauss quadrature of |r_u x r_v|.

    cells each way, points each way in a cell: the error falls as cells^(-2 points) on a smooth
    surface. Trimming loops are followed exactly; a loop inside another is a hole in it.
    """
    if surface.loops:
        from surfmesh.geometry.inside_loops import nesting_depth  # shapely, where it is needed

        areas = (_area_in_loop(surface, loop, cells, points) for loop in surface.loops)
        return sum(-a if depth % 2 else a for a, depth in zip(areas, nesting_depth(surface.loops)))
    (u, u_weights), (v, v_weights) = (
        gauss_rule(first, last, cells, points) for first, last in surface.domain
    )
    rows = [product(_density(surface, u, np.full(len(u), row)), u_weights) for row in v]
    return float(product(np.array(rows), v_weights))


def _area_in_loop(surface: Surface, loop: np.ndarray, cells: int, points: int) -> float:
    """Green's theorem: the integral of |r_u x r_v| over a polygon is that of A dv round it.

    A(u, v) is the integral of |r_u x r_v| along v = const from the domain's left side to u.
    """
    left = surface.domain[0][0]
    t, weights = gauss_rule(0.0, 1.0, cells, points)
    total = 0.0
    for start, end in zip(loop, np.roll(loop, -1, axis=0)):
        if start[1] == end[1]:
            continue
        corners = start + t[:, None] * (end - start)
        strips = [_strip(surface, left, u, v, cells, points) for u, v in corners]
        total += (end[1] - start[1]) * float(product(np.array(strips), weights))
    return abs(total)


def _strip(surface: Surface, left: float, u: float, v: float, cells: int, points: int) -> float:
    across, weights = gauss_rule(left, u, cells, points)
    return float(product(_density(surface, across, np.full(len(across), v)), weights))


def _density(surface: Surface, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    _, r_u, r_v = surface.evaluate(np.column_stack([u, v]), 1)
    return _unit_normal(r_u, r_v)[1]


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _unit_normal(r_u: np.ndarray, r_v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The unit normal (n, 3), zero where there is none, and |r_u x r_v| (n,)."""
    cross = np.empty_like(r_u)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        cross[:, i] = r_u[:, j] * r_v[:, k] - r_u[:, k] * r_v[:, j]
    length = np.sqrt(_dot(cross, cross))
    return cross / np.where(length > 0.0, length, 1.0)[:, None], length
