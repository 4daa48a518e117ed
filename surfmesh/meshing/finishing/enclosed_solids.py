"""The closed solids that a mesh encloses, whose volumes are known or can be found."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.quadrature import gauss_rule
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.finishing.kept_volumes import Solid
from surfmesh.result.surface_mesh import SurfaceMesh

CELLS, COARSER_CELLS, POINTS = 48, 32, 6
"""Each way, of the rules for a volume, whose results are compared."""

SAME_VOLUME = 1e-8
"""Relative difference of the two up to which the volume is known."""


def solids_of_model(mesh: SurfaceMesh) -> list[Solid]:
    """The closed solids of a model, all of whose faces are meshed."""
    facts, beside = mesh.facts, mesh.solid_ids
    if facts is None or beside is None:
        return []
    found = []
    for number, solid in enumerate(facts.solids):
        sign = (beside[:, 0] == number).astype(float) - (beside[:, 1] == number)
        if solid.closed and solid.volume > 0.0 and sign.any() and _is_closed(mesh, sign):
            found.append(Solid(sign, solid.volume))
    return found


def _is_closed(mesh: SurfaceMesh, sign: NDArray[np.float64]) -> bool:
    """Does each edge have as many of the triangles one way as the other?"""
    start, end = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    low, high = np.minimum(start, end).astype(np.int64), np.maximum(start, end)
    _, edge = np.unique(low * len(mesh.points) + high, return_inverse=True)
    along = np.where(start < end, 1.0, -1.0) * sign.repeat(3)
    return not np.bincount(edge.ravel(), along).any()


def solids_of_surface(mesh: SurfaceMesh) -> list[Solid]:
    """What one closed surface encloses, where its volume is known or the rule finds it."""
    if mesh.one_sided or not _is_closed(mesh, np.ones(len(mesh.triangles))):
        return []
    (surface,) = mesh.surfaces
    fine, coarse = (_enclosed(surface, cells) for cells in (CELLS, COARSER_CELLS))
    known = None if mesh.facts is None else mesh.facts.volume
    if known is None and not abs(fine - coarse) <= SAME_VOLUME * abs(fine):
        return []
    sign = 1.0 if fine > 0.0 else -1.0
    return [Solid(np.full(len(mesh.triangles), sign), abs(fine) if known is None else known)]


def _enclosed(surface: Surface, cells: int) -> float:
    """A third of the integral of r . (r_u x r_v) over (u, v), by Gauss's rule."""
    (u, wu), (v, wv) = (gauss_rule(low, high, cells, POINTS) for low, high in surface.domain)
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    point, ru, rv = surface.evaluate(uv, 1)
    rate = np.einsum("ij,ij->i", point, np.cross(ru, rv))
    return float((rate * np.outer(wu, wv).ravel()).sum()) / 3.0
