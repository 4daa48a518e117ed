"""How large a model is, from points on its edges and inside its faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadVertex
from surfmesh.cad.model.curve_samples import points_of, walked
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.rings import next_ones
from surfmesh.geometry.small_matrices import norm

EDGE_FRACTIONS = np.linspace(0.0, 1.0, 17)
GRID = 9  # points each way in the (u, v) box of a face; eight intervals meet the axes of a sphere


def diagonal(
    vertices: Sequence[CadVertex], edges: Sequence[CadEdge], faces: Sequence[CadFace]
) -> float:
    """Diagonal of the box around the points; a box of curved faces may be a little larger."""
    points = [np.array([vertex.point for vertex in vertices])]
    real = [edge for edge in edges if edge.curve is not None]
    if real:
        points.append(points_of(real, EDGE_FRACTIONS).reshape(-1, 3))
    every = np.concatenate(points)
    lo, hi = every.min(axis=0), every.max(axis=0)
    for face in faces:
        if face.kind == "plane":
            continue
        grid = parameter_grid(face.surface.domain, GRID)
        on_grid = face.surface.evaluate(grid, 0)[0]
        beyond = ~((on_grid >= lo) & (on_grid <= hi)).all(axis=1)
        if beyond.any():
            more = np.concatenate([[lo, hi], on_grid[_inside(face, grid) & beyond]])
            lo, hi = more.min(axis=0), more.max(axis=0)
    return norm(hi - lo)


def _inside(face: CadFace, grid: np.ndarray) -> np.ndarray:
    """Which points (n, 2) of the (u, v) plane lie inside the loops, by crossings to the left."""
    crossings = np.zeros(len(grid), int)
    for loop in face.loops:
        corners = walked(loop, EDGE_FRACTIONS[:-1]).reshape(-1, 2)
        (u0, v0), (u1, v1) = corners.T, next_ones(corners).T
        rise = np.where(v1 == v0, 1.0, v1 - v0)
        u, v = grid[:, :1], grid[:, 1:]
        spans = (v0 > v) != (v1 > v)
        crossings += (spans & (u0 + (v - v0) / rise * (u1 - u0) < u)).sum(axis=1)
    return crossings % 2 == 1
