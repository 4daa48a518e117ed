"""Faces whose sizes the core grows inward from their edges: planes and cylinders without a law.

What holds for all faces with one set of sizes is found once, see ``InwardFaces``: a model has few
sets, and thousands of faces.
"""

from surfmesh._core import faces as core
from surfmesh._core.faces import FaceManner, InwardFace
from surfmesh.geometry.cad_surfaces.elementary import Cylinder
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import asked_rules


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
        radius = surface.radius if isinstance(surface, Cylinder) else None
        if (radius is None and surface.kind != "plane") or job.limits is not None:
            return None
        known = self._known.get(id(sizing))
        if known is None:
            known = self._known[id(sizing)] = _Sizes(sizing)
        if known.asked is None:
            return None
        return core.inward_face(
            as_core_surface(surface), job.boundary, radius, known.asked, known.slope,
            known.manner(job.optimise), look_for_tubes and radius is not None,
        )  # fmt: skip


class _Sizes:
    """A set of sizes, and what follows from it on any plane or cylinder."""

    def __init__(self, sizing: Sizing) -> None:
        self.sizing = sizing
        """Kept, so that no other one gets its ``id``."""
        self.slope = sizing.gradient
        self.asked = None if sizing.has_law else asked_rules(sizing)
        """All that the core needs to know beside the sizes of edges; None where that is not all."""
        self._manners: dict[bool, FaceManner] = {}

    def manner(self, optimise: bool) -> FaceManner:
        """How a face is meshed in the first round."""
        if optimise not in self._manners:
            self._manners[optimise] = face_manner(self.sizing, optimise, True, False)
        return self._manners[optimise]


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
