"""Faces whose sizes the core grows inward from their edges: planes and cylinders without a law.

What holds for all faces with one set of sizes is found once, see ``InwardFaces``: a model has few
sets, and thousands of faces.
"""

import math

from surfmesh._core.faces import FaceManner, InwardFace
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.boundary_field import (
    has_room_for_lattice,
    largest_size,
    largest_within,
    speeds_of,
)
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import SizeRules


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
        speeds, on_lattice = speeds_of(surface), False
        radius = None if surface.kind == "plane" else speeds[0]
        extent = math.hypot(speeds[0] * (u1 - u0), speeds[1] * (v1 - v0))
        largest = known.largest(radius, extent)
        if largest is None:
            largest = largest_size(surface, sizing, domain)
        elif radius is not None and has_room_for_lattice(surface, domain, largest):
            larger = known.largest(radius, extent, True)
            if larger is not None and larger > largest:
                on_lattice, largest = True, larger
        return InwardFace(
            as_core_surface(surface), boundary, speeds, largest, known.slope,
            known.manner(job.optimise, on_lattice), look_for_tubes and surface.kind != "plane",
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
        self._manners: dict[tuple[bool, bool], FaceManner] = {}
        self._largest: dict[tuple[float | None, bool], tuple[float, float | None]] = {}
        self._rules: dict[float, SizeRules] = {}

    def manner(self, optimise: bool, on_lattice: bool) -> FaceManner:
        """How a face is meshed in the first round."""
        key = optimise, on_lattice
        if key not in self._manners:
            self._manners[key] = face_manner(self.sizing, optimise, True, on_lattice)
        return self._manners[key]

    def largest(
        self, radius: float | None, extent: float, on_lattice: bool = False
    ) -> float | None:
        """The largest size on a plane (None) or a cylinder up to so large; None where that
        depends on how large it is."""
        key = radius, on_lattice
        reach, found = self._largest.get(key, (0.0, None))
        if not extent < reach:
            reach = 2.0 ** (math.frexp(extent)[1] + 1)  # the diagonal is no longer
            found = largest_within(self.sizing, radius, reach, on_lattice, self._rules_within)
            self._largest[key] = reach, found
        return found

    def _rules_within(self, sizing: Sizing, diagonal: float) -> SizeRules:
        """Made once for each power of two."""
        if diagonal not in self._rules:
            self._rules[diagonal] = SizeRules.of(sizing, diagonal)
        return self._rules[diagonal]


def manner_of(job: FaceJob, field: SizeField) -> FaceManner:
    """How a face is meshed with the sizes of this field."""
    return face_manner(field.sizing, job.optimise, job.limits is None, field.law.is_on_lattice)


def face_manner(sizing: Sizing, optimise: bool, is_first: bool, on_lattice: bool) -> FaceManner:
    """How a face is meshed. is_first: its sizes come from no earlier round."""
    return FaceManner(
        sizing.straight_chord, sizing.angle, sizing.min_size or 0.0,
        optimise, is_first, sizing.is_anisotropic, sizing.gradient,
        keeps_lowered=sizing.is_balanced, on_lattice=on_lattice,

        fewest=sizing.uses_evenly and (is_first or sizing.is_anisotropic),
        largest=sizing.largest_stated,
    )  # fmt: skip
