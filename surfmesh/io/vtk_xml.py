"""VTK's XML files, .vtu (unstructured grid) and .vtp (polygons), through PyVista."""

from pathlib import Path

import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOXML import (
    vtkXMLPolyDataReader,
    vtkXMLReader,
    vtkXMLUnstructuredGridReader,
)

from surfmesh.errors import FileFormatError
from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh


def to_pyvista(mesh: SurfaceMesh) -> pyvista.PolyData:
    """PolyData with point data ``size``, cell data ``face_id`` and ``alpha``; nothing merged.

    Arrays are copies: the mesh stays immutable whatever is done to the result.
    """
    data = pyvista.PolyData.from_regular_faces(mesh.points.copy(), mesh.triangles)
    if mesh.sizes is not None:
        data.point_data["size"] = mesh.sizes.copy()
    data.cell_data["face_id"] = mesh.face_ids.copy()
    data.cell_data["alpha"] = alpha(mesh)
    data.set_active_scalars(None)
    return data


def write(mesh: SurfaceMesh, path: Path) -> None:
    data = to_pyvista(mesh)
    if mesh.uv_points is not None:
        data.cell_data["uv"] = mesh.uv.reshape(-1, 6)  # u, v of the three corners
    data.field_data["one_sided"] = np.array([mesh.one_sided], np.uint8)
    if path.suffix.lower() == ".vtu":
        data = data.cast_to_unstructured_grid()
    with pyvista.vtk_verbosity("off"):
        data.save(path)
    if not path.stat().st_size:  # VTK reports a full disk on its own console only
        raise FileFormatError(f"{path}: VTK could not write it")


def read(path: Path) -> SurfaceMesh:
    grid = path.suffix.lower() == ".vtu"
    data = _loaded(path, vtkXMLUnstructuredGridReader() if grid else vtkXMLPolyDataReader())
    cells = data if grid else data.cast_to_unstructured_grid()
    if set(np.unique(cells.celltypes).tolist()) - {int(pyvista.CellType.TRIANGLE)}:
        raise FileFormatError(f"{path}: holds cells that are not triangles")
    uv_points = uv_triangles = None
    if "uv" in data.cell_data:
        uv_points = np.asarray(data.cell_data["uv"]).reshape(-1, 2)
        uv_triangles = np.arange(len(uv_points)).reshape(-1, 3)
    field = data.field_data
    return SurfaceMesh(
        points=data.points,
        triangles=cells.cell_connectivity.reshape(-1, 3),
        uv_points=uv_points,
        uv_triangles=uv_triangles,
        face_ids=data.cell_data.get("face_id"),
        sizes=data.point_data.get("size"),
        one_sided=bool(field["one_sided"][0]) if "one_sided" in field else False,
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
