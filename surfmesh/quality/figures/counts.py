"""What was looked at: names and numbers."""

from dataclasses import dataclass

from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.result.surface_mesh import SurfaceMesh

SHOWN = 3  # names


@dataclass(frozen=True, kw_only=True)
class Counts(Part):
    """How large the mesh is."""

    surface: str  # names of the surfaces; what they are from, where none has a name of its own
    nodes: int
    triangles: int
    faces: int

    @classmethod
    def of(cls, measured: Measurements) -> "Counts":
        """Faces are those of the model where it is known."""
        mesh = measured.mesh
        return cls(
            surface=_names(mesh, measured.facts.source),
            nodes=len(mesh.points),
            triangles=len(mesh.triangles),
            faces=len(mesh.surfaces) or len(measured.faces.numbers),
        )


def _names(mesh: SurfaceMesh, source: str) -> str:
    if source and len(mesh.surfaces) > 1 and not any(mesh.groups.face_names):
        return source
    names = list(dict.fromkeys(map(mesh.groups.face_label, range(len(mesh.surfaces)))))
    more = len(names) - SHOWN
    return ", ".join(names[:SHOWN]) + (f" and {more} more" if more > 0 else "")
