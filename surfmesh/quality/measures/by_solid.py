"""The figures of each solid of a CAD model, beside the exact ones."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import JoinedTriangles, solid_counts
from surfmesh.quality.measures.solids import around_solids
from surfmesh.quality.measures.topology import Topology
from surfmesh.result.surface_mesh import SurfaceMesh


@dataclass(frozen=True, kw_only=True)
class SolidRow:
    """Model units. None: not known, or without meaning as the solid is not closed."""

    solid: int
    name: str
    triangles: int
    closed: bool  # every edge is run along as often one way as the other
    euler: int
    euler_exact: int | None
    area: float
    area_exact: float | None
    area_error: float | None  # area / area_exact - 1
    volume: float | None
    volume_exact: float | None
    volume_error: float | None


class SolidFigures(NamedTuple):
    """By solid (s,), and triangles counted."""

    triangles: NDArray[np.int64]
    area: NDArray[np.float64]
    volume: NDArray[np.float64]  # without meaning where it is open
    behind: int  # triangles that have a solid behind them
    before: int  # before them
    both: int

    @classmethod
    def of(
        cls,
        mesh: SurfaceMesh,
        joined: JoinedTriangles,
        area: NDArray[np.float64],
        bulges: NDArray[np.float64] | None,
    ) -> Self:
        """bulges: (m,) volume between each triangle, if it is curved, and its straight one."""
        if mesh.solid_ids is None:
            return cls(np.empty(0, np.int64), np.empty(0), np.empty(0), 0, 0, 0)
        exact = mesh.facts.solids if mesh.facts is not None else ()
        count = max(int(mesh.solid_ids.max(initial=-1)) + 1, len(exact))
        return cls(*joined.solid_figures(mesh.solid_ids, area, bulges, count))

    def is_around_all(self, mesh: SurfaceMesh) -> bool:
        """Does a solid lie behind or before every triangle?"""
        return self.behind + self.before - self.both == len(mesh.triangles)

    def is_whole(self, mesh: SurfaceMesh) -> bool:
        """Do all triangles lie around one solid, which is behind them?"""
        count = len(mesh.triangles)
        return len(self.triangles) == 1 and not self.before and 0 < self.behind == count


def by_solid(mesh: SurfaceMesh, found: SolidFigures, topo: Topology) -> tuple[SolidRow, ...]:
    """Rows of all solids; a face between two of them counts for both. None without solid_ids.

    topo: of the whole mesh.
    """
    exact = mesh.facts.solids if mesh.facts is not None else ()
    triangles, area, volume, count = found.triangles, found.area, found.volume, len(found.triangles)
    if found.is_whole(mesh):  # it has been counted
        euler, closed = np.array([topo.euler]), [topo.balanced]
    else:
        around, _, solid = around_solids(mesh)
        vertices, edges, opened = solid_counts(around, solid, len(mesh.points), count)
        euler = vertices - edges + triangles
        closed = [bool(triangles[k] > 0 and opened[k] == 0) for k in range(count)]
    exact_area = [exact[k].area if k < len(exact) else None for k in range(count)]
    exact_volume = [exact[k].volume if k < len(exact) else None for k in range(count)]
    return tuple(
        SolidRow(
            solid=k,
            name=exact[k].name if k < len(exact) else "",
            triangles=int(triangles[k]),
            closed=closed[k],
            euler=int(euler[k]),
            euler_exact=exact[k].euler if k < len(exact) else None,
            area=float(area[k]),
            area_exact=exact_area[k],
            area_error=relative_error(float(area[k]), exact_area[k]),
            volume=float(volume[k]) if closed[k] else None,
            volume_exact=exact_volume[k],
            volume_error=relative_error(float(volume[k]), exact_volume[k]) if closed[k] else None,
        )
        for k in range(count)
    )


def relative_error(found: float | None, exact: float | None) -> float | None:
    """By how much a measure is off, however its surface is turned; None where one is not known."""
    if found is None or not exact:
        return None
    return abs(found) / abs(exact) - 1.0


def volume_of_all(rows: tuple[SolidRow, ...]) -> float | None:
    """Sum over the solids, or None when one of them is open."""
    volumes = [row.volume for row in rows if row.volume is not None]
    return sum(volumes) if rows and len(volumes) == len(rows) else None
