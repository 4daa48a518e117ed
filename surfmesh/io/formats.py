"""Which module writes and reads which extension, and the two verbs."""

import warnings
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.atomic import replacing, require_place
from surfmesh.io.found_mesh import usable
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.truth_value import truth_value

# Each module has write(mesh, path) and read(path); it is imported when it is needed.
FORMATS = {
    ".vtu": "surfmesh.io.vtk_xml",
    ".vtp": "surfmesh.io.vtk_xml",
    ".stl": "surfmesh.io.stl",
    ".obj": "surfmesh.io.obj",
    ".ply": "surfmesh.io.ply",
    ".glb": "surfmesh.io.glb",
    ".msh": "surfmesh.io.msh",
    ".inp": "surfmesh.io.inp",
    ".bdf": "surfmesh.io.bdf",
    ".xdmf": "surfmesh.io.xdmf",
    ".off": "surfmesh.io.off",
    ".med": "surfmesh.io.med",
    ".3mf": "surfmesh.io.threemf",
    ".su2": "surfmesh.io.su2",
    ".mesh": "surfmesh.io.medit",
}

IN_PIECES = {".pvtu": "surfmesh.io.pvtu"}
"""Formats of several files: an index and, in a folder beside it, pieces. Such a module has
``save(mesh, path)`` and ``read(path)``."""

SECOND_ORDER = (".vtu", ".pvtu", ".msh", ".inp", ".bdf", ".xdmf", ".med")
"""Formats that hold nodes amid edges."""

CHOICES = {"solids": (".stl", ("solids", "faces")), "target": (".inp", ("abaqus", "calculix"))}
"""Options of ``save`` for one format each, and the words that they take."""

LONGEST = 400  # characters of a refusal beside the path: it may quote what is in the file


def save(
    mesh: SurfaceMesh, path: str | Path, *, ascii: bool = False, solids: str = "", target: str = ""
) -> Path:  # fmt: skip
    """Write ``mesh`` to ``path``; all of it or nothing. Returns the path.

    Points are in double precision but for .stl and .glb (single), .inp (20 characters) and .bdf
    (16 characters). Faces, their names, colours and kinds, solids and the unit come back from
    all formats but .stl; ``benchmarks/formats.py`` prints what survives where, here and with
    other programs. ``size`` is in .vtu, .vtp, .ply, .msh and .xdmf; corner parameters ``uv``,
    sizes that depend on the direction and what was promised of the faces are in .vtu and .vtp;
    nodes of order 2 in .vtu, .msh, .inp, .bdf, .xdmf and .med (needs meshio and h5py), the other
    formats hold the corners alone, which a ``UserWarning`` says. .pvtu is an index of several .vtu
    files in a folder beside it, cut between faces, for meshes too large for one.

    ascii: .stl as text, one body with a name for each solid. solids: ``"faces"``, for .stl: text,
    one body for each name of a face, as programs that read patches from it want. target:
    ``"calculix"``, for .inp of order 2, writes S6; without it STRI65 stands there, as Abaqus and
    meshio know it. .su2 of a planar domain has triangles as elements and named edges as markers,
    of a surface in space markers alone.

    Raises ``FileFormatError`` for an extension that is not known, a folder that is not
    there, a place that cannot be written, a mesh without triangles.
    """
    path = Path(path)
    module = _module(path)
    if not len(mesh.triangles):
        raise FileFormatError(f"{path}: nothing to write, the mesh has no triangles")
    if mesh.order == 2 and path.suffix.lower() not in SECOND_ORDER:
        others = ", ".join(SECOND_ORDER)
        warnings.warn(
            f"{path}: {path.suffix} holds the corners alone; for order 2 use {others}",
            stacklevel=2,
        )
    ascii = truth_value("ascii", ascii, FileFormatError)
    if ascii and not hasattr(module, "write_ascii"):
        raise FileFormatError(f"{path}: only .stl has an ASCII form to choose; leave ascii out")
    chosen = _chosen(path, solids=solids, target=target)
    if path.suffix.lower() in IN_PIECES:
        module.save(mesh, path)
        return path
    with replacing(path) as temporary:
        if ascii or "solids" in chosen:
            module.write_ascii(mesh, temporary, **chosen)
        else:
            module.write(mesh, temporary, **chosen)
    return path


def _chosen(path: Path, **options: str) -> dict[str, str]:
    """The options that were given. Raises ``FileFormatError`` where one has no meaning."""
    given = {name: word for name, word in options.items() if word}
    for name, word in given.items():
        extension, words = CHOICES[name]
        if path.suffix.lower() != extension:
            raise FileFormatError(f"{path}: {name} is a choice of {extension} alone; leave it out")
        if word not in words:
            known = " or ".join(map(repr, words))
            raise FileFormatError(f"{path}: {name} must be {known}, not {word!r}")
    return given


def read(path: str | Path) -> SurfaceMesh:
    """Read a triangle mesh. It carries no surface, so its deviation cannot be known.

    Numbers of faces, solids and edges are those of the file; where one is beyond
    ``numbers_of_groups.DENSE`` they are counted from 0, which the mesh's ``warnings`` say.

    Raises ``FileFormatError`` for a file that is missing, that cannot be understood, that holds
    anything but triangles or numbers that nobody can compute with, or that would unpack to far
    more than it is.
    """
    path = Path(path)
    module = _module(path)
    if not path.is_file():
        raise FileFormatError(f"{path}: {'not a file' if path.exists() else 'no such file'}")
    try:
        with np.errstate(all="ignore"):  # of what is not a number: ``usable`` looks at it
            mesh = module.read(path)
    except FileFormatError as error:
        said = str(error)
        if len(said) <= len(str(path)) + LONGEST:
            raise
        raise FileFormatError(f"{said[: len(str(path)) + LONGEST]} ...") from None
    except MemoryError:
        raise
    except Exception as error:  # parsers of foreign formats raise whatever they like
        reason = f"not a readable {path.suffix} file: {_brief(error)}"
        raise FileFormatError(f"{path}: {reason}") from error
    return usable(path, mesh)


def require_writable(path: str | Path, *extensions: str) -> None:
    """Raise what ``save`` would raise for this place, before any work is done.

    extensions: those that will do; without any: those of ``FORMATS``.
    """
    path = Path(path)
    if not extensions:
        _home(path)
    elif path.suffix.lower() not in extensions:
        raise FileFormatError(f"{path}: the extension must be {' or '.join(extensions)}")
    require_place(path)


def _module(path: Path) -> ModuleType:
    return import_module(_home(path))


def _home(path: Path) -> str:
    """Name of the module for ``path``."""
    homes = FORMATS | IN_PIECES
    try:
        return homes[path.suffix.lower()]
    except KeyError:
        known = " ".join(homes)
        found = f"extension '{path.suffix}' is not known" if path.suffix else "has no extension"
        other = _OTHERS.get(path.suffix.lower(), "")
        raise FileFormatError(f"{path}: {found}; known are {known}{other}") from None


_OTHERS = {
    ".html": "; a report is written by surfmesh.view.html_report, or by 'surfmesh report'",
    ".h5m": "; DAGMC, which needs materials too: mesh.save_dagmc(path, materials)",
    ".png": "; a picture is written by mesh.plot, or by --picture",
}
"""What else a place may be meant for."""


def _brief(error: Exception) -> str:
    """The first line of what ``error`` says, or its name when it says nothing."""
    said = str(error).strip().splitlines()
    if isinstance(error, RecursionError):
        return "it is nested too deep"
    if said and ("int_max_str_digits" in said[0] or "too large to convert" in said[0]):
        return "a whole number in it has too many digits"
    return said[0][:200] if said else type(error).__name__
