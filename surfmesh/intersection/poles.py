"""Where curves leave a pole of a surface: a side of its (u, v) that is one point in space.

v1 +---o-------o---+     r_v leads out of the pole in another direction at each u; a surface
   |   |       |   |     with the normal n through the pole is met in a curve that leaves it
   |   |       |   |     where r_v . n = 0
v0 +---------------+
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm, product
from surfmesh.intersection.pcurve_fitting import nearest_on_surface
from surfmesh.intersection.tracing import place

SAMPLES = 257
NEAR_END = 1e-7
"""Of the range of the side: a curve that leaves there runs along the next edge."""


BESIDE = 1e-2
"""Of the length of the side: places so near to it are on it."""


TOUCHED = 1e-6
"""Sine between a surface through a pole and the tangent plane there: one that touches it."""

RING, RING_SAMPLES = 1e-3, 32
"""Of the range that leads out of a pole: where it is looked on which side the other surface is."""


class WayOut(NamedTuple):
    """fraction: of the degenerate edge. way: (3,) unit. rate: (2,) of u and v along it."""

    fraction: float
    way: np.ndarray
    rate: np.ndarray


def ways_out_of_pole(
    surface: FaceSurface, coedge: CadCoedge, normal: np.ndarray, along_edges: bool = False
) -> list[WayOut]:
    """All places of a degenerate side where a curve on a surface with this normal (3,) leaves.

    None where the other surface touches the pole. along_edges: those that leave along the next
    edges are these edges, and left out; else ``SurfaceError`` is raised for them.
    """
    ends = coedge.uv(np.array([0.0, 1.0]))
    axis = int(np.argmin(np.abs(ends[1] - ends[0])))  # the parameter that leads out
    low, high = surface.domain[axis]
    inward = 1.0 if ends[0, axis] - low < high - ends[0, axis] else -1.0

    def out(fraction: np.ndarray) -> np.ndarray:
        return inward * surface.evaluate(coedge.uv(fraction), 1)[1 + axis]

    def height(fraction: float) -> float:
        return float(product(out(np.array([fraction]))[0], normal))

    fractions = np.linspace(0.0, 1.0, SAMPLES)
    ways = out(fractions)
    heights = product(ways, normal)
    size = np.linalg.norm(ways, axis=1).max()
    if np.abs(heights).max() < TOUCHED * size:
        return []
    found = []
    for k in np.flatnonzero((heights[:-1] > 0.0) != (heights[1:] > 0.0)):
        t = _root(height, fractions[k], fractions[k + 1])
        if min(t, 1.0 - t) < NEAR_END:
            if along_edges:
                continue
            raise SurfaceError(
                f"a curve on {surface.name} leaves its pole along an edge at "
                f"{place(surface.evaluate(ends[:1])[0][0])}; turn one of the surfaces"
            )
        way = out(np.array([t]))[0]
        speed = norm(way)
        rate = np.zeros(2)
        rate[axis] = inward / speed
        found.append(WayOut(float(t), way / speed, rate))
    return found


def contact_at_pole(
    surface: FaceSurface, coedge: CadCoedge, normal: np.ndarray, other: FaceSurface, same: float
) -> str:
    """What a surface with this normal (3,) does at a pole that it passes through: "leaves" it in
    curves, or touches it: "touch" in the pole alone, "flat" on a patch.

    Raises ``SurfaceError`` where it touches and goes through.
    """
    ends = coedge.uv(np.array([0.0, 1.0]))
    axis = int(np.argmin(np.abs(ends[1] - ends[0])))
    low, high = surface.domain[axis]
    uv = coedge.uv((np.arange(RING_SAMPLES) + 0.5) / RING_SAMPLES)
    pole, *rates = surface.evaluate(uv, 1)
    ways = rates[axis]
    if np.abs(product(ways, normal)).max() >= TOUCHED * np.linalg.norm(ways, axis=1).max():
        return "leaves"
    uv[:, axis] += RING * (high - low) * (1.0 if uv[0, axis] - low < high - uv[0, axis] else -1.0)
    points = surface.evaluate(uv, 0)[0]
    foot, distance = nearest_on_surface(other, points)
    up = np.einsum("ij,j->i", points - other.evaluate(foot, 0)[0], normal)
    if (distance <= same).all():
        return "flat"
    if (up > same).all() or (up < -same).all():
        return "touch"
    raise SurfaceError(
        f"{surface.name} and {other.name} touch at the pole {place(pole[0])} of the first and go "
        "through each other there; move or change one of them"
    )


def fraction_at_pole(coedge: CadCoedge, uv: np.ndarray) -> float | None:
    """Where on a degenerate side a place (2,) lies; None for elsewhere."""
    start, end = coedge.uv(np.array([0.0, 1.0]))
    step = end - start
    fraction = float(product(uv - start, step) / product(step, step))
    off = np.abs(uv - start - fraction * step).max()
    return fraction if -1e-3 < fraction < 1.001 and off <= BESIDE * np.abs(step).max() else None


def _root(height: Callable[[float], float], low: float, high: float) -> float:
    """By halving: signs differ at both ends."""
    rising = height(low) < height(high)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if (height(middle) > 0.0) == rising:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)
