"""Proved bounds of the distance between triangles and surfaces."""

from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.surfaces


def triangle_bounds(surface: surfmesh._core.surfaces.Surface, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], bends: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], limits: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], rims: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], depth: int, corners_are_on_surface: bool = True, slope: float = float('inf'), curved: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)] | None = None) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 29))] | None:
    """
    Of triangles with corners (m, 3, 3) and parameters (m, 3, 2): (m, 29) numbers, or None where the surface has no bounds.

    Height over the plane; how far the piece leaves the sides 0, 1, 2 within it; how far it is from these at rims; shift within the plane; the whole distance point by point; how far corners are off; what ring_bounds asks of sides; the slope of that distance; what look_closer asks of cells. Triangles whose height, or distance at a rim (bit k of ``rims``: side k), is beyond ``limits`` are cut in four, ``depth`` times. bends (m, 3, 2): of ``curved_pieces``. corners_are_on_surface=False: the corners give the plane alone. slope: what the slope of the distance should keep to, likewise. curved (m, 3, 3): how far middles of the sides of quadratic triangles are from those of straight ones; then the whole distance alone is meant, and infinite on surfaces without fourth derivatives.
    """

def curved_pieces(surface: surfmesh._core.surfaces.Surface, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], twins: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], middles: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)] | None = None) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2))]:
    """
    (m, 3, 2) how far the middles of sides 0, 1, 2 are moved in (u, v), for pieces that are hardly shifted within their triangles; 0 on surfaces without fourth derivatives.

    triangles: (m, 3) vertices; twins: (3 m,), -1 at rims; middles: (m, 3, 3) of the sides in space, where they are not straight.
    """

def straightened(bends: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], twins: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], is_bad: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2))]:
    """
    The same with straight sides of the triangles that have ``is_bad`` (m,).
    """

def prove_isotopy(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], away: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], slope: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[int, int, int]:
    """
    Can the mesh be deformed into its surface? (0, -1, -1): it can; (1, v, -1): not known, as pieces may change too fast at vertex v; (2, s, t): triangles s and t may meet.

    away: (m,) how far points of each triangle move at most; slope: (m,) how fast that changes.
    """

def bent_stars(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], slope: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """(k,) vertices at which pieces may change too fast for their stars."""

def side_rates(surface: surfmesh._core.surfaces.Surface, ends: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
    """
    (k, 2) how fast the curve over a straight side of (u, v) leaves the side at most, along and across it; infinite without bounds.

    ends: (k, 2, 3), uv: (k, 2, 2).
    """

def polar_moves(surface: surfmesh._core.surfaces.Surface, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], base: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], is_v: bool, value: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))] | None:
    """
    (m, 2) how fast and how far points of triangles at a pole move to the surface at most, along rays; None on surfaces without fourth derivatives.

    corners (m, 3, 3): pole first; base (m, 3, 2): Bezier points of the curve in (u, v) over the side from the second corner to the third; is_v: the pole is where v, or u, has ``value``.
    """

def curve_bounds(curve: surfmesh._core.surfaces.Curve, t: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.float64], dict(shape=(None, 2, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    (k,) how far pieces of a curve, from t[:, 0] to t[:, 1], and the segments between ``ends`` (k, 2, 3) are from each other at most; infinite where the curve has no bounds.
    """

def parted_half_edges(uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], twins: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    (k,) half-edges with a twin after them whose ends have other parameters in the twin's triangle, as at seams.

    uv: (m, 3, 2); twins: (3 m,), -1 at rims.
    """

def ring_bounds(corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], twins: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], bounds: Annotated[NDArray[numpy.float64], dict(shape=(None, 29), order='C', device='cpu', writable=False)], limits: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.uint8], dict(shape=(None,))]]:
    """
    (m,) how far triangles and surface are from each other at most, both ways, each with its neighbours; (m,) whether it took them.

    triangles: (m, 3) vertices; twins: (3 m,) the opposite half-edge of each, -1 at rims; bounds: of ``triangle_bounds``; limits: (m,) within which little less is not looked for.
    """

def look_closer(surface: surfmesh._core.surfaces.Surface, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], bends: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], twins: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], bounds: Annotated[NDArray[numpy.float64], dict(shape=(None, 29), order='C', device='cpu', writable=False)], which: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], limits: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], levels: int, bound: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], gaps: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], gap_owners: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], gap_bounds: Annotated[NDArray[numpy.float64], dict(shape=(None, 29), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    The bounds ``bound`` (m,) of ``ring_bounds``, lower for those ``which`` (k,) of which a closer look at up to 4^levels cells each shows that.

    gaps: (g, 3, 2) triangles of the (u, v) plane that have none in space, at poles; gap_owners: (g,) the triangle that each lies beside, ascending; gap_bounds: their bounds along the axes of these.
    """
