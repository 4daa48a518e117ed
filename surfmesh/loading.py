"""What can be meshed, from whatever names it: files, the gallery, objects of CadQuery.

     a path, a name       -> load             ->  a surface, a domain, a CAD model
     whatever mesh takes  -> model_or_surface ->  the same

What only one kind of surface needs is imported once it is there: the first mesh of a formula
waits for no CAD.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.is_cad_model import is_cad_model
from surfmesh.cad.reading.read_file import SUFFIXES, begun_reading
from surfmesh.errors import CadError, FileFormatError, SurfaceError, did_you_mean, shown
from surfmesh.geometry.files.surface_file import OF_SURFACES, gallery, load_surface_file
from surfmesh.geometry.files.toml_entries import sets_key
from surfmesh.geometry.surface import Surface
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.truth_value import truth_value

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.geometry.planar.planar_domain import PlanarDomain


def load(
    path: str | Path,
    units: str | None = None,
    *,
    imprint: bool | float = False,
    sew: float | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    isolate: bool = True,
) -> Surface | CadModel:
    """The surface or CAD model of a file, or the surface of the gallery by its name.

    A ``.toml`` file holds formulas, a planar domain or surfaces that meet (which give a model as
    ``intersect`` does), a ``.svg`` drawing a planar domain;
    STEP, IGES and BREP files hold CAD models, in ``units`` ("mm", "m", "in", ...; None: mm).

    imprint, sew: of a CAD model, lengths in its units. imprint=True: bodies that touch share
    their faces, which are meshed once; a number is how near touches. sew=0.01: loose faces whose
    edges lie as near are joined, and closed shells of them become solids.

    time_limit, memory_limit: seconds of processor time and MB of memory that reading a CAD file
    may take, inf for no limit. None: the environment variables SURFMESH_READ_SECONDS and
    SURFMESH_READ_MEMORY, else 8 s and 1000 MB and, for each MB of the file, 25 s and 100 MB.

    isolate: a CAD file is read in a process of its own, which is ended at those limits. False reads
    a file that you trust in this one, sooner where OCP is loaded already; no limit holds then, and
    a file that makes OCP crash ends your program.

    Raises ``CadError`` for a CAD file without a model, ``FileFormatError`` for a file of
    another kind, ``SurfaceError`` or ``DomainError`` for what is wrong in it.
    """
    try:
        place = Path(path)
    except TypeError:
        raise FileFormatError(f"a path or a name is needed, not {shown(path)}") from None
    isolate, joins = truth_value("isolate", isolate, CadError), bool(Joining.of(imprint, sew))
    if place.suffix.lower() in SUFFIXES:
        with begun_reading(
            place, units=units, time_limit=time_limit, memory_limit=memory_limit, imprint=imprint,
            sew=sew, isolate=isolate,
        ) as reading:  # fmt: skip
            import surfmesh.meshing.model_mesh  # noqa: F401  needed next, while a child reads

            return reading.model()
    if joins:
        raise CadError(f"imprint and sew are for CAD models, and {place.name} holds none")
    if not isolate or time_limit is not None or memory_limit is not None:
        raise CadError(
            "time_limit, memory_limit and isolate are of reading CAD files, and "
            f"{place.name} is none"
        )
    if units is not None:
        raise CadError(
            f"units are those of a CAD file; {place.name} is none, its lengths have none"
        )
    if place.suffix == "" and not place.exists():
        place = _of_gallery(str(path))
    if place.suffix.lower() not in OF_SURFACES:
        raise FileFormatError(_not_to_load(place))
    if place.suffix.lower() == ".toml" and sets_key(place, "intersect"):
        from surfmesh.intersection.meeting_file import load_meeting_file

        return load_meeting_file(place)
    return load_surface_file(place)


def _not_to_load(place: Path) -> str:
    from surfmesh.io import FORMATS

    if place.suffix.lower() in FORMATS:
        return f"{place}: holds a mesh, not a surface: check and surfmesh.io.read read it"
    known = " ".join((*SUFFIXES, *OF_SURFACES))
    found = f"extension '{place.suffix}' is not known" if place.suffix else "has no extension"
    return f"{place}: {found}; surfaces and CAD models come from {known}, and from the gallery"


def _of_gallery(name: str) -> Path:
    """The file of a gallery surface, or of ready-made surfaces that meet."""
    known = gallery()
    if name not in known:
        from surfmesh.intersection.meeting_file import meeting_gallery

        known = known | meeting_gallery()
    if name not in known:
        hint = did_you_mean(name, known) or "; sm.gallery() lists what there is"
        raise FileFormatError(f"no file and no gallery surface called {name!r}{hint}")
    return known[name]


def model_or_surface(thing: Any) -> Surface | CadModel:
    """What is to be meshed; of a path or a name what ``load`` gives, of CadQuery the model."""
    if isinstance(thing, (str, Path)):
        return load(thing)
    if is_cad_model(thing):
        return thing
    if isinstance(thing, Surface):  # by all that a surface can do: it takes longer
        return thing
    if not _is_cad(thing):
        raise SurfaceError(
            f"cannot mesh a {type(thing).__name__}: a surface, a CAD model, a CadQuery object or "
            "the path of a file is needed"
        )
    from surfmesh.cad.cadquery.from_cadquery import from_cadquery

    return from_cadquery(thing)


def is_domain(thing: Any) -> TypeGuard[PlanarDomain]:
    """Without importing what only domains need."""
    home = sys.modules.get("surfmesh.geometry.planar.planar_domain")
    return home is not None and isinstance(thing, home.PlanarDomain)


def _is_cad(thing: Any) -> bool:
    """Is it an object of CadQuery, build123d or OCP, or does it wrap one?"""
    if type(thing).__module__.split(".")[0] in ("cadquery", "build123d", "OCP"):
        return "OCP" in sys.modules
    return hasattr(thing, "wrapped")


def mesh_of_file(path: str | Path) -> SurfaceMesh:
    """What ``surfmesh.io.read`` gives; ``FileFormatError`` says what to do with what is no mesh."""
    from surfmesh.io import read

    if Path(path).suffix.lower() in (*SUFFIXES, *OF_SURFACES) or str(path) in gallery():
        raise FileFormatError(f"{path} is no mesh, but what one is made of: mesh it first")
    return read(path)
