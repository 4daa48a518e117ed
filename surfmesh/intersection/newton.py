"""Points pulled onto two surfaces, or onto a curve and a surface, by Newton's method.

The compiled core does it for blocks of points (``src/intersection/common_points.hpp``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from surfmesh._core import intersection
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface

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
    normal: np.ndarray | None = None, through: np.ndarray | None = None,
    widths: np.ndarray | None = None,
) -> Pulled:  # fmt: skip
    """Points on both surfaces near guesses (n, 2); with ``normal`` and ``through`` (n, 3) in the
    planes that these give. widths: (n, 4) of u, v, s, t that count as equally long steps; None:
    such as are equally long in space.

    Those that have not come together have a gap, nan where the surface is not finite.
    """
    found = intersection.pull_onto_both(a.core, b.core, uv_a, uv_b, normal, through, widths)
    return Pulled(*found)


Curve = Callable[[np.ndarray, int], tuple[np.ndarray, ...]]
"""Fractions (n,), order -> points (n, 3), and derivatives by the fraction."""


def pulled_onto_curve(
    edge: CadEdge, surface: FaceSurface, fraction: np.ndarray, uv: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Where an edge, not degenerate, meets a surface, near guesses (n,), (n, 2).

    Returns fractions within 0 to 1, uv, the points of the curve, and the gaps (n,).
    """
    assert edge.curve is not None  # noqa: S101
    core = edge.curve.core
    return intersection.pull_onto_curve(core, edge.t0, edge.t1, surface.core, fraction, uv)


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
