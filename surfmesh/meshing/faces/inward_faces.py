"""Faces whose sizes the core grows inward from their edges: planes and cylinders without a law.

What holds for all faces with one set of sizes is found once, see ``InwardFaces``: a model has few
sets, and thousands of faces.
"""

import math

from surfmesh._core.faces import FaceManner, InwardFace
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.boundary_field import (
    largest_size,
    largest_within,
    speeds_of,
)
from surfmesh.sizing.options.sizing import Sizing


def inward_face(job: FaceJob, look_for_tubes: bool = False) -> InwardFace | None:
    """Of one job alone, see ``InwardFaces``."""
    return InwardFaces().face(job, look_for_tubes)


class InwardFaces:
    """Makes them of jobs."""

    def __init__(self) -> None:
        self._known: dict[int, _Sizes] = {}

    def face(self, job: FaceJob, look_for_tubes: bool = False) -> InwardFace | None:
        """What the core meshes a face from; None where it needs to be told the sizes inside."""
        surface, sizing = job.surface, job.sizing
        if surface.kind not in ("plane", "cylinder") or job.limits is not None:
            return None
        known = self._known.get(id(sizing))
        if known is None:
            known = self._known[id(sizing)] = _Sizes(sizing)
        boundary = job.boundary
        if not known.may_grow or boundary.has_degenerate:
            return None
        (u0, u1), (v0, v1) = domain = boundary.box
        if not (u0 < u1 and v0 < v1):
            return None
        speeds = speeds_of(surface)
        largest = known.largest(
            None if surface.kind == "plane" else speeds[0],
            math.hypot(speeds[0] * (u1 - u0), speeds[1] * (v1 - v0)),
        )
        if largest is None:
            largest = largest_size(surface, sizing, domain)
        return InwardFace(
            as_core_surface(surface), boundary, speeds, largest, known.slope,
            known.manner(job.optimise), look_for_tubes and surface.kind != "plane",
        )  # fmt: skip


class _Sizes:
    """A set of sizes, and what follows from it on any plane or cylinder."""

    def __init__(self, sizing: Sizing) -> None:
        self.sizing = sizing
        """Kept, so that no other one gets its ``id``."""
        self.slope = sizing.gradient
        bounds = sizing.chord, sizing.angle, sizing.size
        self.may_grow = not (sizing.is_anisotropic or sizing.has_law) and any(
            x is not None for x in bounds
        )
        """Does the core know all sizes: those of edges and one that bounds them?"""
        self._manners: dict[bool, FaceManner] = {}
        self._largest: dict[float | None, tuple[float, float | None]] = {}

    def manner(self, optimise: bool) -> FaceManner:
        """How a face is meshed in the first round."""
        if optimise not in self._manners:
            self._manners[optimise] = _manner(self.sizing, optimise, True)
        return self._manners[optimise]

    def largest(self, radius: float | None, extent: float) -> float | None:
        """The largest size on a plane (None) or a cylinder up to so large; None where that
        depends on how large it is."""
        reach, found = self._largest.get(radius, (0.0, None))
        if not extent < reach:
            reach = 2.0 ** (math.frexp(extent)[1] + 1)  # the diagonal is no longer
            found = largest_within(self.sizing, radius, reach)
            self._largest[radius] = reach, found
        return found


def manner_of(job: FaceJob, sizing: Sizing) -> FaceManner:
    """How a face is meshed with these sizes."""
    return _manner(sizing, job.optimise, job.limits is None)


def _manner(sizing: Sizing, optimise: bool, is_first: bool) -> FaceManner:
    return FaceManner(
        sizing.straight_chord, sizing.angle, sizing.min_size or 0.0,
        optimise, is_first, sizing.is_anisotropic, sizing.gradient,
        keeps_lowered=sizing.is_balanced,
    )  # fmt: skip
