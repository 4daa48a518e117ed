"""Planes, cylinders, cones, spheres and tori as wholes: distances from them, which are one surface.

In the frame of the surface, with h along its axis and r from it:

    plane  |h|     cylinder  |r - R|     cone  |(r - R) cos a - h sin a|     sphere  |p| - R
    torus  |hypot(r - R, h) - tube|
"""

from __future__ import annotations

import numpy as np

from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import product

GRID = 7
"""Samples each way of a face, that lie on the other surface where both are one."""


def distance_to_elementary(surface: FaceSurface, points: np.ndarray) -> np.ndarray:
    """(n,) of points (n, 3) from a surface of these five kinds, continued beyond its box."""
    assert isinstance(surface, (Plane, Cylinder, Cone, Sphere, Torus))  # noqa: S101
    step = points - surface.origin
    h = product(step, surface.z)
    if isinstance(surface, Plane):
        return np.abs(h)
    r = np.hypot(product(step, surface.x), product(step, surface.y))
    if isinstance(surface, Cylinder):
        return np.abs(r - surface.radius)
    if isinstance(surface, Cone):  # of both halves the nearer one
        cos, sin = np.cos(surface.angle), np.sin(surface.angle)
        one = np.abs((r - surface.radius) * cos - h * sin)
        return np.minimum(one, np.abs((-r - surface.radius) * cos - h * sin))
    if isinstance(surface, Sphere):
        return np.abs(np.hypot(r, h) - surface.radius)
    away = np.hypot(r - surface.radius, h)
    return np.minimum(
        np.abs(away - surface.tube), np.abs(np.hypot(r + surface.radius, h) - surface.tube)
    )


def are_one_surface(a: FaceSurface, b: FaceSurface, same: float) -> bool | None:
    """Are two surfaces pieces of one? Said of two elementary ones alone, else None."""
    kinds = (Plane, Cylinder, Cone, Sphere, Torus)
    if not (isinstance(a, kinds) and isinstance(b, kinds)):
        return None
    return type(a) is type(b) and all(
        bool((distance_to_elementary(one, _samples(other)) <= same).all())
        for one, other in ((a, b), (b, a))
    )


def _samples(surface: FaceSurface) -> np.ndarray:
    box = np.array(surface.domain)
    line = np.linspace(0.0, 1.0, GRID)
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    return surface.evaluate(box[:, 0] + grid * (box[:, 1] - box[:, 0]), 0)[0]
