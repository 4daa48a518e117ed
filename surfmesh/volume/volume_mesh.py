"""Tetrahedra that fill the solids of a surface mesh.

The nodes of the surface keep their numbers, so that its faces, edges and names say the same here:

    nodes: [ surface.nodes | inner points | inner middles of edges | those of split tetrahedra ]

A tetrahedron is positive: corner 3 lies to the left of the triangle 0, 1, 2, which thus is seen
counter-clockwise from inside. Middles of edges follow the corners, of 01, 12, 20, 03, 13, 23: the
order of VTK and Abaqus.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    import pyvista

LEGS = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
"""Ends of its edges, in the order of their middles."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class VolumeMesh:
    """Tetrahedra, by solids, and the surface around them. Lengths are in model units.

    nodes: (n, 3) float, those of the surface first.
    elements: (k, 4) int32 rows of ``nodes``, or (k, 10) for order 2.
    solid_ids: (k,) int32 the solid of each tetrahedron, as ``surface.solid_ids`` numbers them.
    surface: the triangles that were filled, with their names.
    engine: who made the tetrahedra.
    warnings: what the user should know of them, as that the surface is a new one.
    """

    nodes: NDArray[np.float64]
    elements: NDArray[np.int32]
    solid_ids: NDArray[np.int32]
    surface: SurfaceMesh
    engine: str = ""
    warnings: tuple[str, ...] = ()

    @property
    def order(self) -> int:
        """2 when edges have nodes in their middle, else 1."""
        return 1 if self.elements.shape[1] == 4 else 2

    @property
    def tetrahedra(self) -> NDArray[np.int32]:
        """(k, 4) the corners."""
        return self.elements[:, :4]

    @cached_property
    def volumes(self) -> NDArray[np.float64]:
        """(k,) of the straight tetrahedra of the corners."""
        a, b, c, d = (self.nodes[corner] for corner in self.tetrahedra.T)
        return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0

    @property
    def volume(self) -> float:
        """Of all straight tetrahedra together."""
        return float(self.volumes.sum())

    @cached_property
    def shapes(self) -> NDArray[np.float64]:
        """(k,) 6 sqrt(2) volume / (root mean square edge)^3: 1 for the regular, 0 for the flat.

        Source: V. N. Parthasarathy et al., "A comparison of tetrahedron quality measures",
        Finite Elem. Anal. Des. 15 (1994), gamma.
        """
        ends = self.nodes[self.tetrahedra[:, LEGS]]
        squares = np.square(ends[:, :, 1] - ends[:, :, 0]).sum(axis=2).mean(axis=1)
        return 6.0 * np.sqrt(2.0) * self.volumes / squares**1.5

    @cached_property
    def face_sides(self) -> NDArray[np.int64]:
        """(m, 2) for each triangle of the surface the tetrahedron behind it and which of its sides
        0 .. 3 it is (012, 013, 123, 023, as Abaqus counts them); the one before it where there is
        none behind.
        """
        from surfmesh.volume.solid_regions import sides_of_triangles

        behind, before = sides_of_triangles(self.tetrahedra, self.surface.triangles)
        found = np.where(behind >= 0, behind, before)
        return np.column_stack((found // 4, found % 4))

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """Grid with cell data ``solid_id``; names of solids in field data ``solid_names``."""
        import pyvista

        kind = pyvista.CellType.TETRA if self.order == 1 else pyvista.CellType.QUADRATIC_TETRA
        grid = pyvista.UnstructuredGrid({kind: self.elements.astype(np.int64)}, self.nodes.copy())
        grid.cell_data["solid_id"] = self.solid_ids.copy()
        count = int(self.solid_ids.max(initial=-1)) + 1
        grid.field_data["solid_names"] = [self.surface.groups.solid_label(i) for i in range(count)]
        return grid

    def save(self, path: str | Path) -> Path:
        """Write .vtu, .msh, .inp (CalculiX and Abaqus), .su2 or .mesh; returns the path.

        Raises ``FileFormatError`` for another extension and for a place that cannot be written.
        """
        from surfmesh.volume.volume_files import save

        return save(self, path)

    def __repr__(self) -> str:
        solids = len(np.unique(self.solid_ids))
        return (
            f"VolumeMesh({len(self.nodes)} nodes, {len(self.elements)} tetrahedra, "
            f"{solids} {'solid' if solids == 1 else 'solids'}, order {self.order})"
        )
