"""VTK's XML files, .vtu (unstructured grid) and .vtp (polygons), and PyVista's data.

Read by ``vtk_xml_reading``.

Names and the like are the bytes of a JSON text in the field data ``surfmesh_groups``: arrays of
strings hold ASCII alone, and meshio refuses a file that has one. For those who look, each name of a
face, a solid and an edge is the name of a field array too, ``face top``, with its numbers.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import needs
from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.io.group_record import CAD_NUMBERS, as_cad_numbers, cad_numbers
from surfmesh.io.vtk_xml_reading import VtkContent, read_vtk
from surfmesh.io.xml_writing import Content, write_grid, write_polygons
from surfmesh.quality.measures.shape import alpha
from surfmesh.quality.measures.tolerances import tolerance_rows
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    import pyvista

GROUPS = "surfmesh_groups"
PROMISES = "surfmesh_promises"  # chord, angle, min_size of each face or of all; 0: not asked for
METRIC, METRIC_ROWS = "surfmesh_inverse_sizes", "inverse_size_row"
"""Sizes that depend on the direction: a table W = xx, xy, xz, yy, yz, zz (|W d| is the step d in
wanted lengths) in field data, and the rows of the three corners of each triangle."""


SHOWN = 200  # names that are arrays of their own; what is looked at one by one
POINT_DATA, CELL_DATA = ("size",), ("face_id", "solid_id", "uv", METRIC_ROWS)
FIELD_DATA = ("one_sided", GROUPS, METRIC, PROMISES, *CAD_NUMBERS)
"""The arrays that are read."""


def to_pyvista(mesh: SurfaceMesh) -> "pyvista.PolyData":
    """PolyData with point data ``size``, cell data ``face_id`` and ``alpha``; nothing merged.

    Where there are solids or colours: cell data ``solid_id`` (behind and before a triangle) and
    ``colour`` (red, green, blue of 0..255). Arrays are copies: the mesh stays immutable whatever
    is done to the result.
    """
    with needs("view", "to_pyvista"):
        import pyvista

    data = pyvista.PolyData.from_regular_faces(mesh.points.copy(), mesh.triangles)
    if mesh.sizes is not None:
        data.point_data["size"] = mesh.sizes.copy()
    for name, values in _of_triangles(mesh).items():
        data.cell_data[name] = values.copy()
    groups = mesh.groups
    for kind, names in (("face", groups.face_names), ("solid", groups.solid_names)):
        if any(names):
            plain = [name.encode("ascii", "replace").decode() for name in names]  # VTK's limit
            data.field_data[f"{kind}_names"] = plain
    data.set_active_scalars(None)
    return data


def _of_triangles(mesh: SurfaceMesh) -> dict[str, NDArray]:
    found: dict[str, NDArray] = {"face_id": mesh.face_ids, "alpha": alpha(mesh)}
    if mesh.solid_ids is not None:
        found["solid_id"] = mesh.solid_ids
    colours = triangle_colours(mesh)
    if colours is not None:
        found["colour"] = np.where(colours < 0, NO_COLOUR, colours).astype(np.uint8)
    return found


def _numbers_by_name(groups: MeshGroups) -> dict[str, NDArray]:
    """The numbers of what has a name, under this name."""
    found: dict[str, list[int]] = {}
    named = (groups.face_names, "face"), (groups.solid_names, "solid"), (groups.edge_names, "edge")
    for names, kind in named:
        for number, name in enumerate(names):
            if name:
                found.setdefault(f"{kind} {name}", []).append(number)
    shown = list(found.items())[:SHOWN]
    return {name: np.array(numbers, np.int32) for name, numbers in shown}


def write(mesh: SurfaceMesh, path: Path) -> None:
    grid = path.suffix.lower() == ".vtu"
    (write_grid if grid else write_polygons)(content_of(mesh, grid), path)


def content_of(mesh: SurfaceMesh, grid: bool = True) -> Content:
    """All that a file holds. grid: with the nodes of second order."""
    of_triangles = _of_triangles(mesh)
    field: dict[str, NDArray] = {"one_sided": np.array([mesh.one_sided], np.uint8)}
    corners = mesh.parametrisation
    if corners is not None:
        of_triangles["uv"] = corners.uv_points[corners.uv_triangles].reshape(-1, 6)  # u, v thrice
        if corners.metric_root_3d is not None:
            of_triangles[METRIC_ROWS] = corners.uv_triangles
            field[METRIC] = corners.metric_root_3d
    field[GROUPS] = np.frombuffer(json.dumps(mesh.groups.plain()).encode(), np.uint8)
    promises = tolerance_rows(mesh)
    if promises is not None:
        field[PROMISES] = np.nan_to_num(promises)  # VTK's XML has no nan
    field |= {name: numbers for name, numbers in cad_numbers(mesh).items() if len(numbers)}
    field |= _numbers_by_name(mesh.groups)
    points, cells, sizes = mesh.points, mesh.triangles, mesh.sizes
    if grid:
        points, cells, sizes = mesh.nodes, mesh.elements, mesh.node_sizes
    of_points = {} if sizes is None else {"size": sizes}
    return Content(points, cells, of_points, of_triangles, field)


def read(path: Path) -> SurfaceMesh:
    return mesh_of(read_vtk(path, POINT_DATA, CELL_DATA, FIELD_DATA))


def mesh_of(found: VtkContent) -> SurfaceMesh:
    """The mesh that ``content_of`` made this of, or what another program has written."""
    points, triangles, cells, field = found.points, found.cells, found.cell_data, found.field_data
    sizes, mid_points = found.point_data.get("size"), None
    if triangles.shape[1] == 6:
        points, triangles, mid_points, kept = split_six_nodes(points, triangles)
        sizes = None if sizes is None else sizes[kept]
    uv_points = uv_triangles = None
    if "uv" in cells:
        uv_points = cells["uv"].reshape(-1, 2)
        uv_triangles = np.arange(len(uv_points)).reshape(-1, 3)
    metric_root = None
    if uv_points is not None and METRIC in field and METRIC_ROWS in cells:
        table = field[METRIC].astype(float).reshape(-1, 6)
        rows = cells[METRIC_ROWS].reshape(-1, 3)
        if rows.size and 0 <= rows.min() <= rows.max() < len(table):
            corners, uv_triangles, metric_root = uv_points, rows, table
            uv_points = np.zeros((len(table), 2))
            uv_points[rows.ravel()] = corners
    promises = None
    if PROMISES in field:
        promises = field[PROMISES].astype(float).reshape(-1, 3)
        promises = np.where(promises > 0.0, promises, np.nan)
    groups = field[GROUPS].tobytes().decode() if GROUPS in field else "{}"
    return SurfaceMesh(
        points=points,
        triangles=triangles,
        mid_points=mid_points,
        uv_points=uv_points,
        uv_triangles=uv_triangles,
        face_ids=cells.get("face_id"),
        sizes=sizes,
        metric_root_3d=metric_root,
        one_sided=bool(field["one_sided"][0]) if "one_sided" in field else False,
        solid_ids=cells.get("solid_id"),
        groups=MeshGroups.of_plain(json.loads(groups)),
        promises=promises,
        **as_cad_numbers(field),
    )
