"""``data.surfmesh``: what surfmesh can do with triangles that PyVista holds.

data.surfmesh.check()            the report
data.surfmesh.mesh               the SurfaceMesh
data.surfmesh.tetrahedralize()   tetrahedra inside, a pyvista.UnstructuredGrid
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista

from surfmesh.errors import FileFormatError
from surfmesh.result.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    from surfmesh.quality import Report


@pyvista.register_dataset_accessor("surfmesh", pyvista.PolyData)
class SurfmeshAccessor:
    """Raises ``FileFormatError`` where the polygons of the data are not all triangles."""

    def __init__(self, data: pyvista.PolyData) -> None:
        self._data = data

    @cached_property
    def mesh(self) -> SurfaceMesh:
        """Points, triangles and, where there is cell data of these names, faces and solids."""
        data = self._data
        if not data.is_all_triangles or not data.n_cells:
            raise FileFormatError("the polygons are not all triangles: data.triangulate() first")
        cells = data.cell_data
        return SurfaceMesh(
            points=np.array(data.points, float),
            triangles=data.regular_faces.astype(np.int32),
            face_ids=np.array(cells["face_id"]) if "face_id" in cells else None,
            solid_ids=np.array(cells["solid_id"]) if "solid_id" in cells else None,
        )

    def check(self, **options: Any) -> Report:
        """The report of the mesh: ``surfmesh.check``."""
        from surfmesh import api

        return api.check(self.mesh, **options)

    def save(self, path: str | Path, **options: Any) -> Path:
        """Write to ``path``, format by extension: ``surfmesh.io.save``."""
        return self.mesh.save(path, **options)

    def tetrahedralize(self, engine: str = "tetgen", **options: Any) -> pyvista.UnstructuredGrid:
        """Tetrahedra inside the closed surface: ``surfmesh.volume.tetrahedralize``."""
        return self.mesh.tetrahedralize(engine, **options).to_pyvista()
