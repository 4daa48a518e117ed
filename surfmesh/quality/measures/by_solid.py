"""The figures of each solid of a CAD model, beside the exact ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import enclosed_volumes, face_shapes, solid_counts
from surfmesh.quality.measures.shape import Shapes
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


def by_solid(
    mesh: SurfaceMesh,
    shape: Shapes,
    topo: Topology,
    bulges: NDArray[np.float64] | None = None,
) -> tuple[SolidRow, ...]:
    """Rows of all solids; a face between two of them counts for both. None without solid_ids.

    topo: of the whole mesh. bulges: (m,) volume between each triangle, if it is curved, and its
    straight one.
    """
    if mesh.solid_ids is None:
        return ()
    exact = mesh.facts.solids if mesh.facts is not None else ()
    count = max(int(mesh.solid_ids.max(initial=-1)) + 1, len(exact))
    if not count:
        return ()
    around, rows, solid = around_solids(mesh)
    own_area = shape.area if around is mesh.triangles else shape.area[rows]
    triangles, area, _, _ = face_shapes(solid, own_area, own_area, count)
    apexes = _first_corners(mesh, around, solid, count)
    volume = enclosed_volumes(mesh.points, around, solid, apexes)
    if bulges is not None:
        outwards = np.where((around == mesh.triangles[rows]).all(axis=1), 1.0, -1.0)
        volume += np.bincount(solid, outwards * bulges[rows], count)
    if count == 1 and around is mesh.triangles:  # the whole mesh: it has been counted
        euler, closed = np.array([topo.euler]), [topo.balanced]
    else:
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


def _first_corners(
    mesh: SurfaceMesh, around: NDArray[np.int32], solid: NDArray[np.int32], count: int
) -> NDArray[np.float64]:
    """(count, 3) a point of each solid: volumes to one far away cancel in rounding."""
    if not len(around):
        return np.zeros((count, 3))
    if count == 1:
        return mesh.points[around[:1, 0]]
    first = np.full(count, -1)
    first[solid[::-1]] = np.arange(len(solid))[::-1]  # the last that is written stays: the first
    return np.where(first[:, None] < 0, 0.0, mesh.points[around[first, 0]])


def relative_error(found: float | None, exact: float | None) -> float | None:
    """By how much a measure is off, however its surface is turned; None where one is not known."""
    if found is None or not exact:
        return None
    return abs(found) / abs(exact) - 1.0


def volume_of_all(rows: tuple[SolidRow, ...]) -> float | None:
    """Sum over the solids, or None when one of them is open."""
    volumes = [row.volume for row in rows if row.volume is not None]
    return sum(volumes) if rows and len(volumes) == len(rows) else None
