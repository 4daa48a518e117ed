"""How large a model is, from points on its edges and inside its faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadVertex
from surfmesh.cad.model.curve_samples import next_ones, points_of, walked
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.small_matrices import norm

EDGE_FRACTIONS = np.linspace(0.0, 1.0, 17)
GRID = 9  # points each way in the (u, v) box of a face; eight intervals meet the axes of a sphere


def diagonal(
    vertices: Sequence[CadVertex], edges: Sequence[CadEdge], faces: Sequence[CadFace]
) -> float:
    """Diagonal of the box around the points; a box of curved faces may be a little larger."""
    boxes = [_box(np.array([vertex.point for vertex in vertices]))]
    real = [edge for edge in edges if edge.curve is not None]
    if real:
        boxes.append(_box(points_of(real, EDGE_FRACTIONS).reshape(-1, 3)))
    for face in faces:
        uv = _inside(face)
        if face.kind != "plane" and len(uv):
            boxes.append(_box(face.surface.evaluate(uv, 0)[0]))
    lo, hi = np.array(boxes).transpose(1, 0, 2)
    return norm(hi.max(axis=0) - lo.min(axis=0))


def _box(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return points.min(axis=0), points.max(axis=0)


def _inside(face: CadFace) -> np.ndarray:
    """(n, 2) grid points of the (u, v) box that lie inside the loops, by crossings to the left."""
    if face.kind == "plane":
        return np.empty((0, 2))
    grid = parameter_grid(face.surface.domain, GRID)
    crossings = np.zeros(len(grid), int)
    for loop in face.loops:
        corners = walked(loop, EDGE_FRACTIONS[:-1]).reshape(-1, 2)
        (u0, v0), (u1, v1) = corners.T, next_ones(corners).T
        rise = np.where(v1 == v0, 1.0, v1 - v0)
        u, v = grid[:, :1], grid[:, 1:]
        spans = (v0 > v) != (v1 > v)
        crossings += (spans & (u0 + (v - v0) / rise * (u1 - u0) < u)).sum(axis=1)
    return grid[crossings % 2 == 1]
