"""A mesh in several files: .vtu pieces in a folder beside an index, ``mesh.pvtu``.

    mesh.pvtu                       names the pieces; field data of the whole (names, CAD edges)
    mesh.pvtu.pieces/1f0c2a9e-0.vtu  whole faces each: its points, its triangles, and what numbers
    mesh.pvtu.pieces/1f0c2a9e-1.vtu  these have in the whole (GlobalPointIds, GlobalCellIds)

Points on edges between pieces are in each of them, with one number, by which they are welded.
The name of a piece begins with a hash of what is in all of them, so that pieces of another mesh
are never written over; the index takes its place last. Until then the old mesh is whole, and from
then on the new one. What the old index named, and pieces that no index has named for an hour, are
removed after that.
"""

import hashlib
import re
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError, printable
from surfmesh.io.atomic import replacing, require_place
from surfmesh.io.group_record import CAD_NUMBERS
from surfmesh.io.leftovers import AGE
from surfmesh.io.vtk_xml import (
    CELL_DATA,
    FIELD_DATA,
    METRIC,
    METRIC_ROWS,
    POINT_DATA,
    content_of,
    mesh_of,
)
from surfmesh.io.vtk_xml_reading import VtkContent, read_index, read_vtk
from surfmesh.io.xml_writing import CELL_IDS, POINT_IDS, Content, write_grid, write_index
from surfmesh.result.surface_mesh import SurfaceMesh

LARGEST = 250_000
"""Triangles of a piece, about; a face is never parted."""

METRIC_IDS = "surfmesh_inverse_size_ids"  # of the rows of a piece's table, in the whole
GHOST = "vtkGhostType"  # of cells that another piece has, in files of other programs
MOST_PIECES = 100_000

_NAME = re.compile(r"[0-9a-f]{16}-[0-9]+\.vtu")


def save(mesh: SurfaceMesh, path: Path) -> None:
    """Write pieces and index. Raises ``FileFormatError``; an old mesh is then as it was."""
    whole = content_of(mesh)
    parts = _parts(mesh.face_ids)

    def write(places: list[Path]) -> Content:
        for place, kept in zip(places, parts):
            piece = _piece(whole, kept)
            write_piece(piece, place)
        return piece

    held = {name: values for name, values in whole.of_all.items() if name != METRIC}
    save_pieces(path, _digest(whole), len(parts), write, held)


def write_piece(piece: Content, place: Path) -> None:
    """One of the files, in full or not at all."""
    with replacing(place) as temporary:
        write_grid(piece, temporary)


def folder_of(path: Path) -> Path:
    """Where the pieces of an index are, which is made. Raises ``FileFormatError``."""
    require_place(path)
    folder = path.with_name(f"{path.name}.pieces")
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise _refusal(path, error) from error
    return folder


def save_pieces(
    path: Path,
    digest: str,
    count: int,
    write: Callable[[list[Path]], Content],
    of_all: Mapping[str, NDArray],
) -> None:
    """Have pieces written to these places, then the index with the field data of the whole.

    digest: 16 hexadecimal digits that no other mesh has. write: returns a piece, or one without
    rows: the arrays of all of them. Raises ``FileFormatError``.
    """
    before = _named_by(path)
    folder = folder_of(path)
    places = [folder / f"{digest}-{number}.vtu" for number in range(count)]
    new = [place for place in places if not place.exists()]
    try:
        like = write(places)
        with replacing(path) as temporary:
            sources = [f"{folder.name}/{place.name}" for place in places]
            write_index(sources, like, of_all, temporary)
    except BaseException as error:
        _remove(new)
        forget_empty(folder)
        if isinstance(error, OSError):
            raise _refusal(path, error) from error
        raise
    _remove(piece for piece in _unused(folder, before) if piece not in places)


def _refusal(path: Path, error: OSError) -> FileFormatError:
    return FileFormatError(f"{path}: cannot be written: {error.strerror or error}")


def _parts(face_ids: NDArray) -> list[NDArray[np.int64]]:
    """Triangles of each piece, ascending."""
    faces, of = np.unique(face_ids, return_inverse=True)
    counts = np.bincount(of.reshape(-1), minlength=len(faces))
    piece = np.empty(len(faces), np.int64)
    parts = parts_of(counts)
    for number, own in enumerate(parts):
        piece[own] = number
    of_triangle = piece[of.reshape(-1)]
    return [np.flatnonzero(of_triangle == number) for number in range(len(parts))]


def parts_of(counts: NDArray) -> list[NDArray[np.int64]]:
    """Rows of the faces of each piece, in their order, about as many triangles each.

    counts: (f,) triangles of the faces.
    """
    total = int(counts.sum())
    middles = (np.cumsum(counts) - 0.5 * counts) / total
    piece = (middles * max(1, round(total / LARGEST))).astype(int)
    return [np.flatnonzero(piece == number) for number in np.unique(piece).tolist()]


def forget_empty(folder: Path) -> None:
    """Remove the folder of pieces where there are none."""
    with suppress(OSError):
        folder.rmdir()


def _piece(whole: Content, kept: NDArray[np.int64]) -> Content:
    """Some cells of a mesh as a mesh by itself that knows its numbers in the whole."""
    cells = whole.cells[kept]
    used = _used(cells, whole.cells, len(whole.points), kept)
    of_points = {name: values[used] for name, values in whole.of_points.items()}
    of_cells = {name: values[kept] for name, values in whole.of_cells.items()}
    of_all = {n: v for n, v in whole.of_all.items() if n not in CAD_NUMBERS and n != METRIC}
    if METRIC in whole.of_all:
        corners = whole.of_cells[METRIC_ROWS]
        rows = _used(corners[kept], corners, len(whole.of_all[METRIC]), kept)
        of_cells[METRIC_ROWS] = np.searchsorted(rows, corners[kept]).astype(np.int32)
        of_all |= {METRIC: whole.of_all[METRIC][rows], METRIC_IDS: rows.astype(np.int64)}
    return Content(
        whole.points[used],
        np.searchsorted(used, cells),
        of_points | {POINT_IDS: used.astype(np.int64)},
        of_cells | {CELL_IDS: kept.astype(np.int64)},
        of_all,
    )


def _used(own: NDArray, every: NDArray, count: int, kept: NDArray[np.int64]) -> NDArray[np.int64]:
    """The numbers below ``count`` among ``own``; the first piece has those of no triangle too."""
    used = np.zeros(count, bool)
    if kept[0] == 0:
        used[:] = True
        used[every.ravel()] = False
    used[own.ravel()] = True
    return np.flatnonzero(used)


def _digest(whole: Content) -> str:
    found = hashlib.sha256()
    tables = [{"": whole.points}, {"": whole.cells}, whole.of_points, whole.of_cells, whole.of_all]
    for name, values in (entry for table in tables for entry in table.items()):
        found.update(f"{name}{values.shape}".encode())
        found.update(np.ascontiguousarray(values).data.cast("B") if values.size else b"")
    return found.hexdigest()[:16]


def _named_by(index: Path) -> list[str]:
    """Pieces of ours that an index names; none where there is no index that can be read."""
    try:
        sources, _ = read_index(index, ())
    except (FileFormatError, OSError):
        return []
    names = [PurePosixPath(source).name for source in sources]
    return [name for name in names if _NAME.fullmatch(name)]


def _unused(folder: Path, before: list[str]) -> Iterator[Path]:
    """Pieces that the old index named, and those of saves that never came to their index."""
    with suppress(OSError):
        for piece in folder.iterdir():
            if _NAME.fullmatch(piece.name):
                with suppress(OSError):
                    if piece.name in before or time.time() - piece.stat().st_mtime > AGE:
                        yield piece


def _remove(pieces: Iterator[Path] | list[Path]) -> None:
    for piece in pieces:
        with suppress(OSError):
            piece.unlink()


def read(path: Path) -> SurfaceMesh:
    """The mesh that was saved; pieces of other programs are joined by GlobalPointIds too."""
    sources, field = read_index(path, FIELD_DATA)
    if not sources or len(sources) > MOST_PIECES:
        raise FileFormatError(f"{path}: names {len(sources)} pieces; 1 to {MOST_PIECES} are read")
    places = [_place(path, source) for source in sources]
    found = [
        read_vtk(place, (*POINT_DATA, POINT_IDS), (*CELL_DATA, CELL_IDS, GHOST),
                 (*FIELD_DATA, METRIC_IDS))
        for place in places
    ]  # fmt: skip
    found = [_without_ghosts(piece) for piece in found]
    return mesh_of(_joined(path, found, field))


def _place(index: Path, source: str) -> Path:
    """Where a piece is: below the folder of the index, wherever the file says."""
    within = PurePosixPath(source.replace("\\", "/"))
    if not source or within.is_absolute() or ".." in within.parts or ":" in source:
        raise FileFormatError(
            f"{index}: names the piece {printable(source[:80])!r}, which is not below its folder"
        )
    place = index.parent / within
    if place.suffix.lower() != ".vtu" or not place.is_file():
        raise FileFormatError(
            f"{index}: its piece {printable(source[:80])!r} is no .vtu file there"
        )
    return place


def _without_ghosts(piece: VtkContent) -> VtkContent:
    """Without the cells that another piece has too."""
    if GHOST not in piece.cell_data:
        return piece
    own = piece.cell_data[GHOST] == 0
    of_cells = {name: values[own] for name, values in piece.cell_data.items() if name != GHOST}
    return piece._replace(cells=piece.cells[own], cell_data=of_cells)


def _joined(path: Path, pieces: list[VtkContent], field: dict[str, NDArray]) -> VtkContent:
    """One mesh: points of one number are one point, triangles lie in the order of their numbers."""
    shifts = np.cumsum([0, *(len(piece.points) for piece in pieces)])
    numbers = _numbers(path, [p.point_data.get(POINT_IDS) for p in pieces], int(shifts[-1]))
    points = _whole(path, [piece.points for piece in pieces], numbers)
    cells = np.concatenate([own.cells + shift for own, shift in zip(pieces, shifts)])
    if len({piece.cells.shape[1] for piece in pieces}) > 1:
        raise FileFormatError(f"{path}: its pieces differ in the nodes of a triangle")
    order = _order(path, [piece.cell_data.get(CELL_IDS) for piece in pieces], len(cells))
    of_points = {
        name: _whole(path, values, numbers)
        for name in POINT_DATA
        if (values := _of_all(path, name, [piece.point_data for piece in pieces]))
    }
    of_cells = {
        name: np.concatenate(values)
        for name in CELL_DATA
        if (values := _of_all(path, name, [piece.cell_data for piece in pieces]))
    }
    field = {**pieces[0].field_data, **field}
    _join_metric(path, pieces, of_cells, field)
    of_cells = {name: values[order] for name, values in of_cells.items()}
    return VtkContent(points, numbers[cells[order]], of_points, of_cells, field)


def _of_all(path: Path, name: str, tables: list[dict[str, NDArray]]) -> list[NDArray]:
    """An array of every piece; none where no piece has it."""
    found = [table[name] for table in tables if name in table]
    if found and (len(found) < len(tables) or len({values.shape[1:] for values in found}) > 1):
        raise FileFormatError(f"{path}: {name!r} is in some of the pieces only, or differs")
    return found


def _numbers(path: Path, ids: list[NDArray | None], count: int) -> NDArray[np.int64]:
    """(count,) The number of every point of every piece in the whole."""
    known = [own for own in ids if own is not None]
    if len(known) < len(ids):
        return np.arange(count)
    found = np.concatenate(known)
    used = np.unique(found)
    if found.dtype.kind not in "iu" or (len(used) and (used[0] < 0 or used[-1] >= count)):
        raise FileFormatError(f"{path}: {POINT_IDS} of its pieces are not numbers of points")
    if not np.array_equal(used, np.arange(len(used))):
        raise FileFormatError(f"{path}: points are missing in its pieces, by their {POINT_IDS}")
    return found.astype(np.int64)


def _whole(path: Path, parts: list[NDArray], numbers: NDArray[np.int64]) -> NDArray:
    """Values by number; pieces that have the same point say the same of it."""
    values = np.concatenate(parts)
    found = np.zeros((int(numbers.max(initial=-1)) + 1, *values.shape[1:]), values.dtype)
    found[numbers] = values
    if not np.array_equal(found[numbers], values, equal_nan=True):
        raise FileFormatError(f"{path}: its pieces do not belong together: shared points differ")
    return found


def _order(path: Path, ids: list[NDArray | None], count: int) -> NDArray[np.int64]:
    """The rows of cells in the order of their numbers, if all have one."""
    known = [own for own in ids if own is not None]
    if len(known) < len(ids):
        return np.arange(count)
    order = np.argsort(np.concatenate(known), kind="stable")
    if len(order) != count:
        raise FileFormatError(f"{path}: {CELL_IDS} of its pieces are not one a triangle")
    return order


def _join_metric(
    path: Path, pieces: list[VtkContent], of_cells: dict[str, NDArray], field: dict[str, NDArray]
) -> None:
    """The tables of sizes that depend on the direction become one, in place."""
    field.pop(METRIC, None)
    field.pop(METRIC_IDS, None)
    tables = [piece.field_data for piece in pieces]
    if METRIC_ROWS not in of_cells or not all({METRIC, METRIC_IDS} <= set(t) for t in tables):
        of_cells.pop(METRIC_ROWS, None)
        return
    ids = [table[METRIC_IDS].reshape(-1) for table in tables]
    rows = [table[METRIC].reshape(-1, 6) for table in tables]
    local = [piece.cell_data[METRIC_ROWS] for piece in pieces]
    for own, table, places in zip(ids, rows, local):
        fits = len(own) == len(table) and own.dtype.kind in "iu" and places.dtype.kind in "iu"
        if not fits or (places.size and not 0 <= places.min() <= places.max() < len(own)):
            raise FileFormatError(f"{path}: the tables of sizes of its pieces do not fit")
    numbers = np.concatenate(ids)
    if numbers.size and not 0 <= numbers.min() <= numbers.max() < len(numbers):
        raise FileFormatError(f"{path}: the tables of sizes of its pieces do not fit")
    field[METRIC] = _whole(path, rows, numbers.astype(np.int64))
    of_cells[METRIC_ROWS] = np.concatenate([own[places] for own, places in zip(ids, local)])
