"""Surfaces of CAD models and of formulas, evaluated in blocks."""

from collections.abc import Sequence
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

OPERATIONS: tuple = ...

BLOCK: int = 256

class Tape:
    """A straight-line program of elementary operations. Immutable."""

    def __init__(self, inputs: int, constants: Sequence[float], instructions: Sequence[tuple[str, int, Sequence[int], int]], registers: int, outputs: Sequence[int]) -> None:
        """
        Slots are numbered inputs first, then constants, then registers.

        instructions: (operation, target, operands, exponent) each, operation one of OPERATIONS, exponent 0 but for "integer_power". ValueError for a program that reads what was not written, writes elsewhere than into registers, or the like.
        """

    def evaluate(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))]:
        """
        Outputs at points (n, inputs), three together: (m, n, 3).

        What is undefined comes out as nan or infinity.
        """

    def bounds(self, lo: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], kinks: bool) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None))], Annotated[NDArray[numpy.float64], dict(shape=(None, None))]]:
        """
        Bounds over cells: lo, hi (n, inputs) -> lower, upper (n, outputs).

        Infinite where nothing is known. kinks: False leaves out what second derivatives are across kinks.
        """
