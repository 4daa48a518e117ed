"""
Two surfaces that meet: places on both, bounds over cells, traced branches.
"""

from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.surfaces


def pull_onto_both(a: surfmesh._core.surfaces.Surface, b: surfmesh._core.surfaces.Surface, uv_a: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_b: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], normal: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None = None, through: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None = None, widths: Annotated[NDArray[numpy.float64], dict(shape=(None, 4), order='C', device='cpu', writable=False)] | None = None, steps: int = 12) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Points on two surfaces near guesses (n, 2): uv_a, uv_b (n, 2), the points amid both (n, 3), the gaps (n,).

    normal, through: (n, 3) planes in which they lie. widths: (n, 4) of u, v, s, t that count as equally long steps; None: in space.
    """

def pull_onto_curve(curve: surfmesh._core.surfaces.Curve, first: float, last: float, surface: surfmesh._core.surfaces.Surface, fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Where a curve from ``first`` to ``last`` meets a surface, near guesses (n,), (n, 2): fractions (n,), uv (n, 2), points of the curve (n, 3), gaps (n,).
    """

def bound_cells(surface: surfmesh._core.surfaces.Surface, lo: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Boxes around a surface over cells with the corners lo, hi (n, 2), and cones of its normals: low, high (n, 3), corners (n, 4, 3), sag (n, 3), axis (n, 3), angle (n,).
    """

def bound_pieces(curve: surfmesh._core.surfaces.Curve, first: float, last: float, lo: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    The same for a curve from ``first`` to ``last`` over its fractions lo to hi (n,), with cones of its directions; corners (n, 2, 3).
    """

def overlap(one: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]], i: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], other: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]], j: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], axis: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    May cell i of the one and cell j of the other meet? (n,) 0 or 1.

    Boxes: low, high, corners, sag. axis: (m, 3) of the other, along which slabs are compared too.
    """

def cross_surely(one: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], i: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], other: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], j: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """Is no normal of cell i parallel to one of cell j? (n,) 0 or 1."""

def pierces_surely(one: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], i: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], other: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], j: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Is no direction of piece i at right angles to a normal of cell j? (n,) 0 or 1.
    """

def trace_branch(a: surfmesh._core.surfaces.Surface, b: surfmesh._core.surfaces.Surface, uv_a: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_b: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], way: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], singular: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], step: float, gap: float, closed: bool, rate_a: Annotated[NDArray[numpy.float64], dict(shape=(2), order='C', device='cpu', writable=False)] | None = None, rate_b: Annotated[NDArray[numpy.float64], dict(shape=(2), order='C', device='cpu', writable=False)] | None = None) -> tuple[bool, int, Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]]:
    """
    The branch from row 0 of (m, ...) arrays of ends along its way, to one of the others: whether it came to one, its row, the points (n, 3), their uv_a, uv_b (n, 2).

    rate_a, rate_b: (2,) of u and v along the way at the start, where the surfaces do not say. step: the first; gap: what is on both surfaces.
    """

def strip_integrals(surface: surfmesh._core.surfaces.Surface, fixed: float, ends: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], knots: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], places: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], agree: float, halvings: int, origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)] | None = None) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Integrals (n,) over u from ``fixed`` to ends (n, 2), each at its v: of the area, or of the volume between the surface and an origin.

    places, weights: a rule over [0, 1], used between all knots (k,), which rise, and on halves until two results agree, relative to the integral of the absolute value.
    """

def lie_on_branch(a: surfmesh._core.surfaces.Surface, b: surfmesh._core.surfaces.Surface, trace: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv_a: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_b: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], tolerance: float) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Which points (n, 3), on both surfaces, lie on a traced branch? (n,) 0 or 1.
    """
