"""What is asked of a mesh from a file before anybody computes with it."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.geometry.number_range import RANGE
from surfmesh.io.numbers_of_groups import with_dense_numbers
from surfmesh.result.surface_mesh import SurfaceMesh


def usable(path: Path, mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh of ``path`` when its numbers fit each other, with groups numbered from 0.

    Raises ``FileFormatError`` for no triangles, vertices that are not there, numbers that are not
    finite or beyond ``RANGE.coordinate``, and edges and vertices of CAD that are not of the mesh.
    """
    if not len(mesh.triangles):
        raise FileFormatError(f"{path}: there are no triangles in it")
    for name in ("points", "mid_points", "uv_points", "sizes", "metric_root_3d"):
        _require_finite(path, name, getattr(mesh, name))
    broken = mesh.broken_invariant()
    if broken and "is outside" in broken:
        raise FileFormatError(f"{path}: {broken}")
    n = len(mesh.points)
    _require_range(path, "edge_segments", mesh.edge_segments, 0, n)
    _require_range(path, "vertex_ids", mesh.vertex_ids, -1, n)
    rows = None if mesh.promises is None else len(mesh.promises)
    if rows not in (None, 1) and not -1 < int(mesh.face_ids.max()) < rows:
        raise FileFormatError(f"{path}: has promises for {rows} faces, but more faces")
    return with_dense_numbers(_without_odd_sizes(mesh))


def _without_odd_sizes(mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh, without sizes where one is not positive: what a program calls "size" may be
    something else. Its warnings say so."""
    if mesh.sizes is None or (mesh.sizes > 0.0).all():
        return mesh
    row = int(mesh.sizes.argmin())
    said = f"the file's sizes are left out: sizes[{row}] = {mesh.sizes[row]:g} is not positive"
    return mesh.replaced(sizes=None).with_warnings(said)


def _require_finite(path: Path, name: str, values: NDArray | None) -> None:
    if values is None or not values.size:
        return
    with np.errstate(invalid="ignore"):
        if -RANGE.coordinate <= values.min() and values.max() <= RANGE.coordinate:  # false for nan
            return
        bad = ~(np.abs(values) <= RANGE.coordinate).reshape(len(values), -1).all(axis=1)
    row = int(np.flatnonzero(bad)[0])
    raise FileFormatError(
        f"{path}: {name}[{row}] = {values[row].tolist()}: numbers have to be finite and at most "
        f"{RANGE.coordinate:g}"
    )


def _require_range(path: Path, name: str, values: NDArray | None, low: int, end: int) -> None:
    if values is None or not values.size or low <= int(values.min()) <= int(values.max()) < end:
        return
    row = int(np.flatnonzero(((values < low) | (values >= end)).reshape(len(values), -1).any(1))[0])
    found = values[row].tolist()
    raise FileFormatError(f"{path}: {name}[{row}] = {found} is outside {low}..{end - 1}")
