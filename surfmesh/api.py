"""The verbs: ``load`` a surface, ``mesh`` it."""

from pathlib import Path

from surfmesh.errors import FileFormatError, SurfaceError
from surfmesh.geometry.planar_domain import PlanarDomain
from surfmesh.geometry.surface import Surface
from surfmesh.geometry.surface_file import gallery, load_surface_file
from surfmesh.meshing.parametric_mesh import mesh_parametric
from surfmesh.meshing.planar_mesh import mesh_planar
from surfmesh.meshing.stages import Progress
from surfmesh.sizing.distance_size import default_wishes
from surfmesh.sizing.sizing import Sizing
from surfmesh.surface_mesh import SurfaceMesh


def load(path: str | Path) -> Surface:
    """The surface of a file, or of the gallery by its name.

    A ``.toml`` file holds formulas or a planar domain, a ``.svg`` drawing a planar domain.

    Raises ``FileFormatError`` for a file of another kind, ``SurfaceError`` or ``DomainError``
    for what is wrong in it.
    """
    place = Path(path)
    if place.suffix == "" and not place.exists():
        known = gallery()
        if str(path) in known:
            return load_surface_file(known[str(path)])
        raise FileFormatError(f"no file and no gallery surface called {str(path)!r}")
    return load_surface_file(place)


def mesh(
    surface: Surface,
    sizing: Sizing | float | dict | None = None,
    *,
    optimise: bool = True,
    progress: Progress | None = None,
) -> SurfaceMesh:
    """Triangulate a surface.

    sizing: what is wanted; a number is a uniform edge length; None takes the defaults of the
    surface's formula file, or sensible ones. optimise=False gives the raw packing with its
    boundary, as in the paper. progress: called with (stage, share done).

    Raises ``SizingError``, ``SurfaceError`` or ``MeshingError`` with the place and the reason.
    """
    if not isinstance(surface, Surface):
        raise SurfaceError(f"cannot mesh a {type(surface).__name__}: a Surface is needed")
    if sizing is None:
        sizing = default_wishes(surface) or None
    work = mesh_planar if isinstance(surface, PlanarDomain) else mesh_parametric
    return work(surface, Sizing.of(sizing), optimise, progress)
