"""Surfaces of CAD models and of formulas, evaluated in blocks."""

from typing import Annotated

import numpy
from numpy.typing import NDArray


class Surface:
    """A map from a rectangle of the (u, v) plane into space."""

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """((u0, u1), (v0, v1))"""

    def evaluate(self, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], order: int = 0) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))]:
        """
        (n, 2) -> (m, n, 3): r; r_u, r_v; r_uu, r_uv, r_vv; r_uuu, r_uuv, r_uvv, r_vvv.

        m = 1, 3, 6, 10 for the orders 0 to 3. ValueError where the surface does not have derivatives of so high an order.
        """

    def derivative_bounds(self, lo: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 5, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 5, 3))]] | None:
        """
        Bounds of r_u, r_v, r_uu, r_uv, r_vv over cells, or None when they are not known.

        lo, hi: (n, 2) corners of the cells -> lower, upper (n, 5, 3), infinite where unknown.
        """

class CallbackSurface(Surface):
    """An object of Python that is asked for each block."""

    def __init__(self, surface: object) -> None:
        """
        surface: has ``domain``, ``evaluate`` and ``derivative_bounds`` as the protocol surfmesh.geometry.surface.Surface.
        """

def closest_points(surface: Surface, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv_guess: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], steps: int = 2, margin: float = 0.01) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]]:
    """
    Nearest points of a surface to points (n, 3), from guesses (n, 2), never farther.

    margin: fraction of the domain by which they may leave it. Returns uv (n, 2), distance (n,), foot (n, 3).
    The search is local: a nearer part of the surface that the guess does not lead to is not found.
    """

def closest_points_in_triangles(surface: Surface, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], limit: float, steps: int) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Parameters (n, 2) of the nearest points of the surface, and the distances (n,).

    uv: (n, 2) first guesses. corners: (m, 3, 2) of triangles and ``triangle`` (n,) that of each point: the search begins anew from them where a point seems farther away than ``limit``.
    """

def bends_sharply(surface: Surface, triangles: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], radius: float) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Does the surface bend with less than ``radius`` (model units) within triangles (k, 3, 2) of (u, v)? (k,) of 0 and 1.

    Bends are found where the curvature of a sample shows them, or where the normals of two samples differ.
    """
