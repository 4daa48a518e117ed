"""VTK's XML files, .vtu (unstructured grid) and .vtp (polygons), and PyVista's data.

Names and the like are the bytes of a JSON text in the field data ``surfmesh_groups``: arrays of
strings hold ASCII alone, and meshio refuses a file that has one.
"""

import json
from pathlib import Path

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOXML import (
    vtkXMLPolyDataReader,
    vtkXMLReader,
    vtkXMLUnstructuredGridReader,
)

from surfmesh.errors import FileFormatError
from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.io.xml_writing import Content, write_grid, write_polygons
from surfmesh.mesh_groups import MeshGroups
from surfmesh.quality.promises import plain_promises
from surfmesh.quality.shape import alpha
from surfmesh.six_nodes import node_values, split_six_nodes
from surfmesh.surface_mesh import SurfaceMesh

GROUPS = "surfmesh_groups"
BESIDE = ("edge_segments", "edge_ids", "vertex_ids")  # field data of the same names
PROMISES = "surfmesh_promises"  # chord, angle, min_size of each face or of all; 0: not asked for
METRIC, METRIC_ROWS = "surfmesh_inverse_sizes", "inverse_size_row"
"""Sizes that depend on the direction: a table W = xx, xy, xz, yy, yz, zz (|W d| is the step d in
wanted lengths) in field data, and the rows of the three corners of each triangle."""


def to_pyvista(mesh: SurfaceMesh) -> pyvista.PolyData:
    """PolyData with point data ``size``, cell data ``face_id`` and ``alpha``; nothing merged.

    Where there are solids or colours: cell data ``solid_id`` (behind and before a triangle) and
    ``colour`` (red, green, blue of 0..255). Arrays are copies: the mesh stays immutable whatever
    is done to the result.
    """
    data = pyvista.PolyData.from_regular_faces(mesh.points.copy(), mesh.triangles)
    if mesh.sizes is not None:
        data.point_data["size"] = mesh.sizes.copy()
    for name, values in _of_triangles(mesh).items():
        data.cell_data[name] = values.copy()
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


def write(mesh: SurfaceMesh, path: Path) -> None:
    grid = path.suffix.lower() == ".vtu"
    of_triangles = _of_triangles(mesh)
    field = {"one_sided": np.array([mesh.one_sided], np.uint8)}
    if mesh.uv_points is not None:
        of_triangles["uv"] = mesh.uv.reshape(-1, 6)  # u, v of the three corners
    if mesh.inverse_sizes is not None:
        of_triangles[METRIC_ROWS] = mesh.uv_triangles
        field[METRIC] = mesh.inverse_sizes
    field[GROUPS] = np.frombuffer(json.dumps(mesh.groups.plain()).encode(), np.uint8)
    promises = plain_promises(mesh)
    if promises is not None:
        field[PROMISES] = np.nan_to_num(promises)  # VTK's XML has no nan
    for name in BESIDE:
        if getattr(mesh, name) is not None and len(getattr(mesh, name)):
            field[name] = getattr(mesh, name)
    points, cells, sizes = mesh.points, mesh.triangles, mesh.sizes
    if grid and mesh.order == 2:
        points, cells = mesh.nodes, mesh.elements
        sizes = None if sizes is None else node_values(sizes, mesh.edges)
    of_points = {} if sizes is None else {"size": sizes}
    content = Content(points, cells, of_points, of_triangles, field)
    (write_grid if grid else write_polygons)(content, path)


def read(path: Path) -> SurfaceMesh:
    grid = path.suffix.lower() == ".vtu"
    data = _loaded(path, vtkXMLUnstructuredGridReader() if grid else vtkXMLPolyDataReader())
    cells = data if grid else data.cast_to_unstructured_grid()
    kinds = set(np.unique(cells.celltypes).tolist())
    six = kinds == {int(pyvista.CellType.QUADRATIC_TRIANGLE)}
    if kinds - {int(pyvista.CellType.TRIANGLE)} and not six:
        raise FileFormatError(f"{path}: holds cells that are not triangles")
    points, sizes, mid_points = data.points, data.point_data.get("size"), None
    triangles = cells.cell_connectivity.reshape(-1, 6 if six else 3)
    if six:
        points, triangles, mid_points, kept = split_six_nodes(points, triangles)
        sizes = None if sizes is None else sizes[kept]
    uv_points = uv_triangles = None
    if "uv" in data.cell_data:
        uv_points = np.asarray(data.cell_data["uv"]).reshape(-1, 2)
        uv_triangles = np.arange(len(uv_points)).reshape(-1, 3)
    field = data.field_data
    inverse_sizes = None
    if uv_points is not None and METRIC in field and METRIC_ROWS in data.cell_data:
        table = np.asarray(field[METRIC], float).reshape(-1, 6)
        rows = np.asarray(data.cell_data[METRIC_ROWS]).reshape(-1, 3)
        if rows.size and 0 <= rows.min() <= rows.max() < len(table):
            corners, uv_triangles, inverse_sizes = uv_points, rows, table
            uv_points = np.zeros((len(table), 2))
            uv_points[rows.ravel()] = corners
    promises = None
    if PROMISES in field:
        promises = np.asarray(field[PROMISES], float).reshape(-1, 3)
        promises = np.where(promises > 0.0, promises, np.nan)
    groups = bytes(np.asarray(field[GROUPS])).decode() if GROUPS in field else "{}"
    return SurfaceMesh(
        points=points,
        triangles=triangles,
        mid_points=mid_points,
        uv_points=uv_points,
        uv_triangles=uv_triangles,
        face_ids=data.cell_data.get("face_id"),
        sizes=sizes,
        inverse_sizes=inverse_sizes,
        one_sided=bool(field["one_sided"][0]) if "one_sided" in field else False,
        solid_ids=data.cell_data.get("solid_id"),
        groups=MeshGroups.of_plain(json.loads(groups)),
        promises=promises,
        **{name: np.asarray(field[name]) for name in BESIDE if name in field},
    )


def _loaded(path: Path, reader: vtkXMLReader) -> pyvista.DataSet:
    """What ``reader`` finds; VTK's complaints become one error and are not printed."""
    complaints = []
    for source in (reader, reader.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda *event: complaints.append(event))
    console = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(vtkStringOutputWindow())  # the XML parser has no observers
    try:
        with pyvista.vtk_verbosity("off"):
            if not reader.CanReadFile(str(path)):
                raise FileFormatError(f"{path}: not a {path.suffix} file")
            reader.SetFileName(str(path))
            reader.Update()
    finally:
        vtkOutputWindow.SetInstance(console)
    if complaints or reader.GetErrorCode():
        raise FileFormatError(f"{path}: the {path.suffix} file is damaged or incomplete")
    return pyvista.wrap(reader.GetOutput())
