"""Poles where the surface is thinner than any cone: horns, needles, drops with a pointed end.

The rings about such a pole are soon far shorter than three edges, however small the edges. So
the surface is meshed up to the ring that is about as wide as ``chord``, and a fan of triangles
closes it: a cone lies less than the ring's radius from what it stands for.

     pole  o========-------.....______
           |\\\\      -------.....______   r ~ d^m, m > 1
           cut: first ring, five or six edges
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.geometry.files.known_facts import known_facts
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.functions.numeric import NumericSurface
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Surface
from surfmesh.result.mesh_part import TRIANGLE, Renumbering
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import DEFAULT_CHORD
from surfmesh.sizing.options.sizing import Sizing

FAR, NEAR = 1e-2, 1e-4
"""Fractions of the domain from the pole between which width over distance is compared."""

POINTED = 0.5
"""Factor by which it falls from the one to the other at least: at cones and spheres it stays."""

DEEPEST = 0.5
"""Fraction of the domain that is cut off at most."""

ROUND = 33
"""Points of a ring that are looked at."""

FEWEST = 5.0
"""Edges of a ring where ``size`` or ``min_size`` alone decide how long they are."""

HALVES = 50


@dataclass(frozen=True)
class Cusp:
    """A side that is a point, and where the surface is cut before it."""

    side: int
    axis: int
    pole: float
    cut: float


def find_cusps(surface: Surface, sides: SideTopology, sizing: Sizing) -> tuple[Cusp, ...]:
    """The pointed poles of a surface that is not trimmed."""
    if surface.loops or not isinstance(surface, (ParametricSurface, NumericSurface)):
        return ()
    found = []
    for side in np.flatnonzero(sides.collapsed):
        axis = 1 if side in (0, 2) else 0
        first, last = surface.domain[axis]
        pole, way = (first, last - first) if side in (0, 3) else (last, first - last)
        width, distance = _rings(surface, axis, pole, way, np.array([FAR, NEAR]))
        if width[1] * distance[0] > POINTED * width[0] * distance[1]:
            continue
        fraction = _first_as_wide(surface, axis, pole, way, _target_width(surface, sizing))
        if fraction is not None:
            found.append(Cusp(int(side), axis, pole, pole + fraction * way))
    return tuple(found)


def without_cusps(surface: Any, cusps: Sequence[Cusp]) -> Any:
    """The same surface, its domain cut off at the first rings."""
    domain = [list(span) for span in surface.domain]
    for cusp in cusps:
        domain[cusp.axis][0 if cusp.side in (0, 3) else 1] = cusp.cut
    (u0, u1), (v0, v1) = domain
    return surface.with_domain(((u0, u1), (v0, v1)))


def closed_at(mesh: SurfaceMesh, surface: Surface, cusps: Sequence[Cusp]) -> SurfaceMesh:
    """``mesh`` of the surface without its cusps, each first ring joined to its pole by a fan."""
    for cusp in cusps:
        mesh = _with_fan(mesh, surface, cusp)
    return mesh.replaced(surfaces=(surface,), groups=None, facts=known_facts(surface))


def _with_fan(mesh: SurfaceMesh, surface: Surface, cusp: Cusp) -> SurfaceMesh:
    corners, sizes = mesh.parametrisation, mesh.sizes
    assert corners is not None and sizes is not None  # noqa: S101  every mesh of a surface has them
    on = corners.uv_points[:, cusp.axis] == cusp.cut
    start, end = corners.uv_triangles, np.roll(corners.uv_triangles, -1, axis=1)
    row, k = np.nonzero(on[start] & on[end])
    a, b = start[row, k], end[row, k]
    pole = 0.5 * (corners.uv_points[a] + corners.uv_points[b])
    pole[:, cusp.axis] = cusp.pole
    apex = np.arange(len(corners.uv_points), len(corners.uv_points) + len(pole))
    ring = mesh.triangles[row, k], mesh.triangles[row, (k + 1) % 3]
    tip = np.full(len(row), len(mesh.points))
    fan = np.concatenate([corners.uv_triangles, np.stack([b, a, apex], axis=1)])
    as_theirs = Renumbering(np.append(np.arange(len(mesh.triangles)), row))
    return mesh.replaced(
        points=np.concatenate([mesh.points, surface.evaluate(pole[:1])[0]]),
        triangles=np.concatenate([mesh.triangles, np.stack([ring[1], ring[0], tip], axis=1)]),
        parametrisation=corners.with_corners(pole, a, fan),
        model_links=mesh.model_links.renumbered({TRIANGLE: as_theirs}),
        sizes=np.append(sizes, sizes[ring[0]].mean()),
    )


def _target_width(surface: Surface, sizing: Sizing) -> float:
    """Radius of the first ring."""
    edge = sizing.min_size or 0.0
    chord = sizing.chord
    if chord is None:
        if isinstance(sizing.size, float):
            edge = max(edge, sizing.size)
            chord = 0.0
        else:
            extent = np.ptp(surface.evaluate(parameter_grid(surface.domain, 9))[0], axis=0)
            chord = DEFAULT_CHORD * norm(extent)
    return max(chord, FEWEST * edge / (2.0 * np.pi))


def _rings(
    surface: Surface, axis: int, pole: float, way: float, fractions: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Radii (k,) of the rings at ``fractions`` (k,) of the way, their distances from the pole."""
    first, last = surface.domain[1 - axis]
    uv = np.empty((len(fractions) + 1, ROUND, 2))
    uv[..., axis] = pole + way * np.append(fractions, 0.0)[:, None]
    uv[..., 1 - axis] = np.linspace(first, last, ROUND)
    r = surface.evaluate(uv.reshape(-1, 2))[0].reshape(len(uv), ROUND, 3)
    centre = 0.5 * (r.max(axis=1) + r.min(axis=1))
    width = np.linalg.norm(r - centre[:, None], axis=2).max(axis=1)
    return width[:-1], np.linalg.norm(r[:-1] - r[-1:], axis=2).max(axis=1)


def _first_as_wide(
    surface: Surface, axis: int, pole: float, way: float, target: float
) -> float | None:
    """Fraction of the way to the first ring of the ``target`` radius; None if that is too far."""
    fractions = np.geomspace(1e-6, DEEPEST, 80)
    wide = np.flatnonzero(_rings(surface, axis, pole, way, fractions)[0] >= target)
    if not len(wide) or wide[0] == 0:
        return None
    low, high = fractions[wide[0] - 1], fractions[wide[0]]
    for _ in range(HALVES):
        middle = 0.5 * (low + high)
        if _rings(surface, axis, pole, way, np.array([middle]))[0][0] < target:
            low = middle
        else:
            high = middle
    return float(high)
