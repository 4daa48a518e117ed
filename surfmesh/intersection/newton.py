"""Points pulled onto two surfaces, or onto a curve and a surface, by Newton's method.

r_A(u, v) - r_B(s, t) = 0          three equations for four unknowns: the shortest step in
                                   space; or a fourth one, which says where along the curve
c(t) - r(u, v) = 0                 three for three
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface

STEPS = 12
"""At most: from a good guess four are enough."""

BEYOND = 0.02
"""Of the domain: how far steps may leave it."""


class Pulled(NamedTuple):
    """uv_a, uv_b: (n, 2). point: (n, 3) amid both. gap: (n,) between both."""

    uv_a: np.ndarray
    uv_b: np.ndarray
    point: np.ndarray
    gap: np.ndarray


def limits_of(surface: FaceSurface) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the (u, v) box that steps stay in."""
    box = np.array(surface.domain)
    room = BEYOND * (box[:, 1] - box[:, 0])
    return box[:, 0] - room, box[:, 1] + room


def pulled_onto_both(
    a: FaceSurface, b: FaceSurface, uv_a: np.ndarray, uv_b: np.ndarray,
    normal: np.ndarray | None = None, through: np.ndarray | None = None, steps: int = STEPS,
    widths: np.ndarray | None = None,
) -> Pulled:  # fmt: skip
    """Points on both surfaces near guesses (n, 2); with ``normal`` and ``through`` (n, 3) in the
    planes that these give. widths: (n, 4) of u, v, s, t that count as equally long steps; None:
    such as are equally long in space.

    Those that have not come together have a gap, nan where the surface is not finite.
    """
    limits_a, limits_b = limits_of(a), limits_of(b)
    uv_a, uv_b = np.clip(uv_a, *limits_a), np.clip(uv_b, *limits_b)
    small = np.full(len(uv_a), False)
    for _ in range(steps):
        ra, rb = a.evaluate(uv_a, 1), b.evaluate(uv_b, 1)
        gap = ra[0] - rb[0]
        columns = np.stack([ra[1], ra[2], -rb[1], -rb[2]], axis=2)  # (n, 3, 4)
        speed = np.maximum(np.linalg.norm(columns, axis=1), 1e-300)
        if widths is not None:
            speed = (speed * widths).max(axis=1, keepdims=True) / widths
        columns = columns / speed[:, None]
        if normal is None or through is None:
            step = _least_step(columns, gap)
        else:
            row = np.zeros((len(uv_a), 1, 4))
            row[:, 0, :2] = np.einsum("nij,ni->nj", columns[:, :, :2], normal)
            left = np.einsum("ni,ni->n", normal, ra[0] - through)
            step = _solved(
                np.concatenate([columns, row], axis=1), np.concatenate([gap, left[:, None]], 1)
            )
        step = np.where(small[:, None], 0.0, np.nan_to_num(step) / speed)
        uv_a, uv_b = uv_a - step[:, :2], uv_b - step[:, 2:]
        uv_a, uv_b = np.clip(uv_a, *limits_a), np.clip(uv_b, *limits_b)
        move = np.abs(step * speed).max(axis=1)
        small |= move <= 1e-14 * (1.0 + np.abs(ra[0]).max(axis=1))
        if small.all():
            break
    (pa,), (pb,) = a.evaluate(uv_a, 0), b.evaluate(uv_b, 0)
    return Pulled(uv_a, uv_b, 0.5 * (pa + pb), np.linalg.norm(pa - pb, axis=1))


def _least_step(columns: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """The shortest solution x (n, 4) of J x = gap, J (n, 3, 4) of rank 3 or nearly less."""
    square = np.einsum("nij,nkj->nik", columns, columns)
    square = np.nan_to_num(square) + 1e-14 * np.eye(3)
    return np.einsum("nij,ni->nj", columns, np.linalg.solve(square, gap[..., None])[..., 0])


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Of square systems (n, k, k); zero where they have no single solution."""
    size = np.abs(np.linalg.det(np.nan_to_num(matrix)))
    fine = size > 1e-13
    found = np.zeros(right.shape)
    if fine.any():
        found[fine] = np.linalg.solve(matrix[fine], right[fine][..., None])[..., 0]
    return found


Curve = Callable[[np.ndarray, int], tuple[np.ndarray, ...]]
"""Fractions (n,), order -> points (n, 3), and derivatives by the fraction."""


def pulled_onto_curve(
    curve: Curve, surface: FaceSurface, fraction: np.ndarray, uv: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Where a curve meets a surface, near guesses (n,), (n, 2).

    Returns fractions within 0 to 1, uv, the points of the curve, and the gaps (n,).
    """
    limits = limits_of(surface)
    fraction, uv = fraction.copy(), uv.copy()
    for _ in range(STEPS):
        c, tangent = curve(fraction, 1)
        r, r_u, r_v = surface.evaluate(uv, 1)
        columns = np.stack([tangent, -r_u, -r_v], axis=2)
        speed = np.maximum(np.linalg.norm(columns, axis=1), 1e-300)
        step = np.nan_to_num(_solved(columns / speed[:, None], c - r)) / speed
        fraction = np.clip(fraction - step[:, 0], 0.0, 1.0)
        uv = np.clip(uv - step[:, 1:], *limits)
        if np.abs(step * speed).max(initial=0.0) <= 1e-15 * (1.0 + np.abs(c).max(initial=0.0)):
            break
    c, r = curve(fraction, 0)[0], surface.evaluate(uv, 0)[0]
    return fraction, uv, c, np.linalg.norm(c - r, axis=1)


def uv_directions(surface: FaceSurface, uv: np.ndarray, way: np.ndarray) -> np.ndarray:
    """(n, 2) the rates of u and v along tangent directions (n, 3) at uv (n, 2)."""
    _, r_u, r_v = surface.evaluate(uv, 1)
    e, f, g = (np.einsum("ij,ij->i", p, q) for p, q in ((r_u, r_u), (r_u, r_v), (r_v, r_v)))
    a, b = np.einsum("ij,ij->i", r_u, way), np.einsum("ij,ij->i", r_v, way)
    det = np.maximum(e * g - f * f, 1e-300)
    return np.stack([(g * a - f * b) / det, (e * b - f * a) / det], axis=1)


def unit_normals(surface: FaceSurface, uv: np.ndarray) -> np.ndarray:
    """(n, 3) along r_u x r_v; zero where there is none."""
    _, r_u, r_v = surface.evaluate(uv, 1)
    normal = np.cross(r_u, r_v)
    return normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
