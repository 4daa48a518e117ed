"""DAGMC's .h5m, written by cad_to_dagmc: solids of a material, each face once between two.

cad_to_dagmc 0.15 writes such files with h5py alone; MOAB, which reads them, is not on PyPI.
"""

from collections.abc import Callable, Mapping
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.atomic import replacing
from surfmesh.io.group_record import solids_of_faces
from surfmesh.io.msh import names_of_solids
from surfmesh.result.surface_mesh import SurfaceMesh

LONGEST = 28  # characters of a material: NAME has 32 bytes, "mat:" and the name


def save_dagmc(mesh: SurfaceMesh, path: str | Path, materials: str | Mapping[str, str]) -> Path:
    """Write solids and their materials for OpenMC and others that track through DAGMC.

    materials: one for all solids, or of each solid by its name (``groups.solid_label``, and its
    number where several have one name: ``part 0``). Lengths are those of the mesh: DAGMC takes
    them as centimetres. A face between two solids is there once, with both sides; the numbers of
    faces and solids are those of the mesh + 1.

    Raises ``FileFormatError`` for a place that cannot be written, a mesh without solids, a solid
    without a material, a material that is not 1 to 28 characters of ASCII, and a name that no
    solid has; ``ImportError`` where there is no cad_to_dagmc.
    """
    path = Path(path)
    if path.suffix.lower() != ".h5m":
        raise FileFormatError(f"{path}: the extension must be .h5m")
    sides = solids_of_faces(mesh)
    solids = np.unique(sides[sides >= 0]).tolist()
    if not solids:
        raise FileFormatError(f"{path}: nothing to write, the mesh encloses no solid")
    tags = _materials(path, [name for _, name in names_of_solids(mesh, solids)], materials)
    write = _writer()
    with replacing(path) as temporary, TemporaryDirectory() as folder:
        made = Path(folder, "made.h5m")  # HDF5 locks its file, which ``replacing`` does too
        with redirect_stdout(StringIO()):
            write(mesh.points, _triangles_by_solid(mesh, sides), tags, str(made))
        temporary.write_bytes(made.read_bytes())
    return path


def _materials(path: Path, labels: list[str], given: str | Mapping[str, str]) -> list[str]:
    """The material of each solid."""
    by_name = dict.fromkeys(labels, given) if isinstance(given, str) else dict(given)
    for name in by_name:
        if name not in labels:
            known = ", ".join(map(repr, labels))
            raise FileFormatError(f"{path}: no solid is called {name!r}; there are {known}")
    for label in labels:
        if label not in by_name:
            raise FileFormatError(f"{path}: {label!r} has no material")
        material = by_name[label]
        if not (material.isascii() and material.isprintable() and 0 < len(material) <= LONGEST):
            reason = f"{material!r} is no material of 1 to {LONGEST} characters of ASCII"
            raise FileFormatError(f"{path}: {reason}")
    return [by_name[label] for label in labels]


def _triangles_by_solid(
    mesh: SurfaceMesh, sides: np.ndarray
) -> dict[int, dict[int, list[list[int]]]]:
    """Corners by solid and face, turned outward: those of the first solid of a face are kept."""
    outward: dict[int, dict[int, list[list[int]]]] = {
        solid + 1: {} for solid in np.unique(sides[sides >= 0]).tolist()
    }
    order = np.argsort(mesh.face_ids, kind="stable")
    starts = np.searchsorted(mesh.face_ids[order], np.arange(len(sides) + 1))
    for face, (behind, before) in enumerate(sides.tolist()):
        corners = mesh.triangles[order[starts[face] : starts[face + 1]]]
        if behind >= 0:
            outward[behind + 1][face + 1] = corners.tolist()
        if before >= 0:
            outward[before + 1][face + 1] = corners[:, ::-1].tolist()
    return outward


def _writer() -> Callable[..., object]:
    try:
        from cad_to_dagmc.core import vertices_to_h5m
    except ImportError as error:
        raise ImportError(f".h5m needs {error.name}: pip install cad_to_dagmc") from None
    return vertices_to_h5m
