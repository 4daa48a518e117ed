"""Which points lie inside closed models: by the parity of a ray's crossings with their faces.

On the faces themselves, not on triangles: a ray is an edge, and ``piercings`` finds all places
where it meets a face. A ray that comes near an edge, or grazes a face, gives way to another one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadModel
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curves import Line
from surfmesh.geometry.small_matrices import norm
from surfmesh.intersection.cells import FaceCells
from surfmesh.intersection.contacts import SAME
from surfmesh.intersection.piercings import crossings
from surfmesh.intersection.regions import Region
from surfmesh.intersection.tracing import place

WAYS = np.array(
    [(0.31, 0.57, 0.761), (-0.62, 0.41, 0.669), (0.53, -0.71, 0.464), (-0.38, -0.29, -0.878),
     (0.87, 0.13, -0.475), (0.11, 0.93, -0.351), (-0.77, 0.59, 0.244), (0.23, -0.67, -0.706)]
)  # fmt: skip
"""Directions of rays, one after the other until one is decided; not along axes."""


class Body:
    """Faces that enclose a body, of which it can be said what lies inside."""

    def __init__(self, faces: Sequence[CadFace], size: float, name: str) -> None:
        self.size, self.name = size, name
        self.cells = [FaceCells(face) for face in faces]
        boxes = [cells.bounds(cells.start(), 0)[0] for cells in self.cells]
        self.low = np.array([box.low.min(axis=0) for box in boxes])
        self.high = np.array([box.high.max(axis=0) for box in boxes])
        self.regions = [Region(face) for face in faces]

    @staticmethod
    def of(model: CadModel, size: float) -> Body | None:
        """Of a model that is closed bodies and nothing else, else None."""
        held = {face for solid in model.solids for shell in solid.shells for face, _ in shell}
        if not model.solids or not all(s.closed for s in model.solids):
            return None
        if held != set(range(len(model.faces))):
            return None
        return Body(model.faces, size, model.name)

    def holds(self, point: np.ndarray) -> bool:
        """Does a point lie inside? Raises ``SurfaceError`` where no ray decides."""
        for way in WAYS:
            count = self._count(point, way / norm(way))
            if count is not None:
                return count % 2 == 1
        raise SurfaceError(
            f"it is not certain whether {place(point)} lies inside {self.name}: it is on its "
            "surface, or every ray from there meets an edge"
        )

    def _count(self, point: np.ndarray, way: np.ndarray) -> int | None:
        """How often a ray meets the faces; None where that is not certain."""
        length = 4.0 * self.size
        ray = CadEdge(
            curve=Line(point, way), t0=0.0, t1=length, start=0, end=0, tolerance=0.0,
            degenerate=False, name="", length=length,
        )  # fmt: skip
        total = 0
        for k in np.flatnonzero(self._are_on_ray(point, way)).tolist():
            cells, region = self.cells[k], self.regions[k]
            found = crossings(ray, cells, SAME * self.size)
            if found.along is not None or found.touches.any():
                return None
            if not len(found.uv):
                continue
            inside = region.inside(found.uv)
            near = region.distance(found.uv) <= 0.0
            if near.any() or (inside & (found.fraction < 1e-9)).any():
                return None
            total += int(inside.sum())
        return total

    def _are_on_ray(self, point: np.ndarray, way: np.ndarray) -> np.ndarray:
        """Faces whose boxes a ray passes through, or nearly: it runs along no axis."""
        room = SAME * self.size
        one, other = (self.low - room - point) / way, (self.high + room - point) / way
        first, last = np.minimum(one, other).max(axis=1), np.maximum(one, other).min(axis=1)
        return (first <= last) & (last >= 0.0)
