"""Faces whose sizes the core finds from their curvature and their edges: all but planes and
cylinders, see ``src/faces/graded_face.hpp``.

Left to ``face_mesh.py``: poles, sizes that depend on the direction or that a law gives, what
earlier rounds ask for, and triangles that are to be proved.
"""

from surfmesh._core.faces import FaceManner, GradedFace
from surfmesh._core.sizing import AskedRules
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.inward_faces import face_manner
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import asked_rules

KINDS = frozenset(
    ("cone", "sphere", "torus", "bspline", "bezier", "extrusion", "revolution", "offset")
)


class GradedFaces:
    """Makes them of jobs: what holds for all faces with one set of sizes is made once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Sizing, AskedRules | None]] = {}
        """By the ``id`` of the sizes, which are kept so that no others get it."""
        self._manners: dict[tuple[int, bool], FaceManner] = {}

    def face(self, job: FaceJob) -> GradedFace | None:
        """What the core meshes a face from; None where it needs to be told the sizes inside.

        Raises ``SurfaceError`` for a boundary without width or height.
        """
        surface, boundary, sizing = job.surface, job.boundary, job.sizing
        if surface.kind not in KINDS or job.limits is not None or boundary.has_degenerate:
            return None
        asked = None if sizing.proof else self._asked(sizing)
        if asked is None:
            return None
        over_box = surface.with_domain(boundary.box)
        return GradedFace(
            as_core_surface(surface), as_core_surface(over_box), over_box.steady_axes,
            over_box.pieces, boundary, asked, sizing.gradient,
            self._manner(sizing, job.optimise),
        )  # fmt: skip

    def _asked(self, sizing: Sizing) -> AskedRules | None:
        if id(sizing) not in self._known:
            self._known[id(sizing)] = sizing, asked_rules(sizing)
        return self._known[id(sizing)][1]

    def _manner(self, sizing: Sizing, optimise: bool) -> FaceManner:
        key = id(sizing), optimise
        if key not in self._manners:
            self._manners[key] = face_manner(sizing, optimise, is_first=True, on_lattice=False)
        return self._manners[key]
