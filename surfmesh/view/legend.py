"""What is written around the colours, and what can be drawn and told apart at all."""

from pathlib import Path

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.quality.measures.shape import alpha
from surfmesh.result.surface_mesh import SurfaceMesh

EDGES_UP_TO = 25_000  # triangles; more would paint the surface black
NAMED = 3  # solids that a title lists
LISTED = 16  # names of faces beside their colours
INK = "#202428"


def title_of(mesh: SurfaceMesh) -> str:
    """One line over the picture: name, counts, shape."""
    name = name_of(mesh)
    shape = alpha(mesh)
    return (
        f"{name + ': ' if name else ''}{len(mesh.triangles):,} triangles, "
        f"{len(mesh.points):,} nodes; alpha mean {shape.mean():.3f}, smallest {shape.min():.3f}"
    )


def name_of(mesh: SurfaceMesh) -> str:
    """The names of its solids, or of its only surface, or how many faces there are; empty when
    nothing is known.
    """
    solids = [name for name in dict.fromkeys(mesh.groups.solid_names) if name]
    if solids:
        return ", ".join(solids) if len(solids) <= NAMED else f"{len(solids):,} solids"
    names = list(dict.fromkeys(surface.name for surface in mesh.surfaces))
    if len(names) == 1:
        return names[0]
    return f"{len(mesh.surfaces):,} faces" if names else ""


def named_faces(mesh: SurfaceMesh) -> list[tuple[int, str]]:
    """Numbers and names of faces that have one, the first ``LISTED``."""
    used = set(np.unique(mesh.face_ids).tolist())
    names = enumerate(mesh.groups.face_names)
    found = [(face, name) for face, name in names if name and face in used]
    return found[:LISTED]


def unit_of(mesh: SurfaceMesh, count: int = 2) -> str:
    """The unit of length: that of the CAD model where it is known. count: one or several."""
    return mesh.groups.unit or ("model unit" if count == 1 else "model units")


def require_drawable(mesh: SurfaceMesh, path: Path) -> None:
    """Raise ``FileFormatError`` when there is nothing to draw, or no place for it."""
    if not len(mesh.triangles):
        raise FileFormatError(f"{path}: nothing to draw, the mesh has no triangles")
    lost = np.flatnonzero(~np.isfinite(mesh.points).all(axis=1))
    if len(lost):
        raise FileFormatError(f"{path}: vertex {lost[0]} has no finite place to be drawn at")


def with_edges(mesh: SurfaceMesh, asked: bool | None, circles: bool = False) -> bool:
    """``asked``, or when that is None whether the edges of ``mesh`` can be told apart.

    Between circles they cannot.
    """
    return len(mesh.triangles) <= EDGES_UP_TO and not circles if asked is None else asked
