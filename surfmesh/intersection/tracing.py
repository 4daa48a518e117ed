"""Curves traced on two surfaces, from a start to the end that they come to.

The compiled core does it (``src/intersection/tracing.hpp``). The ends of open branches are where
edges of one face meet the other (``piercings``); a closed branch ends where it starts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from surfmesh._core import intersection
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.intersection.newton import unit_normals


@dataclass
class End:
    """A place where a branch starts or ends: on both surfaces.

    way: (3,) unit direction into both faces. node: its number; image_a, image_b: which of the
    places in (u, v) of the faces it is. singular: a branch point, or a pole of a surface, where
    no normal tells the way. rate_a, rate_b: (2,) of u and v along the way, where the surfaces do
    not say. touches: the surfaces have one tangent plane along the curve that leaves.
    """

    node: int
    uv_a: np.ndarray
    uv_b: np.ndarray
    point: np.ndarray
    way: np.ndarray
    image_a: object = None
    image_b: object = None
    singular: bool = False
    rate_a: np.ndarray | None = None
    rate_b: np.ndarray | None = None
    touches: bool = False
    used: bool = field(default=False, compare=False)


@dataclass(frozen=True, eq=False)
class Trace:
    """Points of a branch (n, 3), their (u, v) on both surfaces (n, 2); start and end.

    A closed branch has its first point once more at the end, and no ends. touches: the surfaces
    have one tangent plane all along.
    """

    points: np.ndarray
    uv_a: np.ndarray
    uv_b: np.ndarray
    start: End | None
    end: End | None
    touches: bool = False

    @property
    def closed(self) -> bool:
        return self.start is None


class Tracer:
    """Of branches on one pair of surfaces. step: the first, model units; gap: what is on both."""

    def __init__(self, a: FaceSurface, b: FaceSurface, step: float, gap: float) -> None:
        self.a, self.b, self.step, self.gap = a, b, step, gap

    def tangent(self, uv_a: np.ndarray, uv_b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit n_A x n_B (n, 3), and the sine of the angle between the tangent planes (n,)."""
        cross = np.cross(unit_normals(self.a, uv_a), unit_normals(self.b, uv_b))
        sine = np.linalg.norm(cross, axis=1)
        return cross / np.maximum(sine, 1e-300)[:, None], sine

    def trace(self, start: End, ends: Sequence[End], closed: bool = False) -> Trace:
        """The branch from ``start`` along its way, to one of ``ends``; closed: back to the only
        one of these, which is the start seen from the other side.

        Raises ``SurfaceError`` with the place where it is lost.
        """
        known = [start, *(end for end in ends if not end.used or closed)]
        found, number, points, uv_a, uv_b = intersection.trace_branch(
            self.a.core, self.b.core,
            np.array([end.uv_a for end in known]), np.array([end.uv_b for end in known]),
            np.array([end.point for end in known]), np.array([end.way for end in known]),
            np.array([end.singular for end in known], np.uint8),
            self.step, self.gap, closed, start.rate_a, start.rate_b,
        )  # fmt: skip
        if found:
            return Trace(
                points, uv_a, uv_b, None if closed else start, None if closed else known[number]
            )
        raise SurfaceError(
            f"{self.a.name} and {self.b.name}: their common curve cannot be followed at "
            f"{place(points[-1])}: the surfaces touch there, or leave their domain"
        )

    def lie_on(self, trace: Trace, points: np.ndarray, tolerance: float) -> np.ndarray:
        """Which points (n, 3), on both surfaces, lie on a traced branch? (n,) bool."""
        return intersection.lie_on_branch(
            self.a.core, self.b.core, trace.points, trace.uv_a, trace.uv_b, points, tolerance
        ).astype(bool)


def place(point: np.ndarray) -> str:
    """(x, y, z) for messages."""
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
