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

    def derivative_magnitudes(self, lo: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], order: int = 2) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))] | None:
        """
        Bounds of the absolute values of all derivatives over cells, or None when they are not known.

        lo, hi: (n, 2) corners -> (n, m, 3) in the sequence of ``evaluate``, those of r itself 0. order: 2 or 3.
        """

class CallbackSurface(Surface):
    """An object of Python that is asked for each block."""

    def __init__(self, surface: object) -> None:
        """
        surface: has ``domain``, ``evaluate`` and ``derivative_bounds`` as the protocol surfmesh.geometry.surface.Surface.
        """

class Curve:
    """A map from a parameter into space or into the (u, v) plane."""

    @property
    def dimension(self) -> int:
        """2 or 3"""

    def evaluate(self, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], order: int = 0) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, None))]:
        """(n,) -> (order + 1, n, dimension): c, c', c'', ..."""

def points_on(curves: Sequence[Curve], t: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, None))]:
    """
    Points of n curves of one dimension, row i of t (n, k) on curve i -> (n, k, dimension).
    """

def line(origin: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Curve:
    """origin + t direction"""

def ellipse(origin: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], major: float, minor: float) -> Curve:
    """origin + major cos t x + minor sin t y"""

def hyperbola(origin: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], major: float, minor: float) -> Curve:
    """origin + major cosh t x + minor sinh t y"""

def parabola(origin: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], focal: float) -> Curve:
    """origin + t^2 / (4 focal) x + t y"""

def spline_curve(knots: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], control: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None, limits: tuple[float, float] | None, period: float) -> Curve:
    """
    control (n, 2) or (n, 3); weights (n,) or None; limits: first and last parameter of the part in use, at whose ends the derivatives are those inside; period: 0 for none.
    """

def spline_through_points(places: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], values: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], degree: int) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, None))]]:
    """
    Knots (n + degree + 1,) and control points (n, d) of the spline of odd degree through values (n, d) at places (n,) that rise, n > degree; no knot at the places next to its ends.
    """

def offset_curve(curve: Curve, distance: float, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)] | None, limits: tuple[float, float] | None) -> Curve:
    """
    A curve beside another: c + distance m / |m| with m = c' x direction in space, (c'_y, -c'_x) in the plane, where direction is None.
    """

def spline_basis(knots: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], degree: int, t: float, order: int, first: float, last: float, period: float) -> tuple[int, float, Annotated[NDArray[numpy.float64], dict(shape=(None, None))]]:
    """
    The span of t, t brought into it by whole periods, and the spline functions that are not zero there with their derivatives, (order + 1, degree + 1).

    At a knot that is an end of first .. last, the part in use, the span lies inside. period: 0 for none.
    """

def plane(domain: tuple[tuple[float, float], tuple[float, float]], origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)]) -> Surface:
    """origin + u x + v y"""

def cylinder(domain: tuple[tuple[float, float], tuple[float, float]], origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], radius: float) -> Surface:
    """origin + radius e(u) + v z, with e(u) = cos u x + sin u y"""

def cone(domain: tuple[tuple[float, float], tuple[float, float]], origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], radius: float, angle: float) -> Surface:
    """origin + (radius + v sin angle) e(u) + v cos angle z"""

def sphere(domain: tuple[tuple[float, float], tuple[float, float]], origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], radius: float) -> Surface:
    """origin + radius cos v e(u) + radius sin v z"""

def torus(domain: tuple[tuple[float, float], tuple[float, float]], origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], radius: float, tube: float) -> Surface:
    """origin + (radius + tube cos v) e(u) + tube sin v z"""

def spline_surface(domain: tuple[tuple[float, float], tuple[float, float]], knots_u: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], knots_v: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], control: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None, periods: tuple[float, float]) -> Surface:
    """
    control (nu, nv, 3); weights (nu, nv) or None; periods of u and v: 0 for none.

    At a crease that is a side of the domain, the derivatives are those inside.
    """

def extrusion(domain: tuple[tuple[float, float], tuple[float, float]], curve: Curve, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)]) -> Surface:
    """c(u) + v direction"""

def revolution(domain: tuple[tuple[float, float], tuple[float, float]], curve: Curve, origin: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)], axis: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', device='cpu', writable=False)]) -> Surface:
    """
    c(v) turned by the angle u about the axis through origin, of unit length
    """

def curve_on_surface(surface: Surface, pcurve: Curve, shift: float, rate: float) -> Curve:
    """
    r(p(shift + rate t)) with a curve p in (u, v); derivatives beyond the second are no numbers.
    """

def offset_surface(basis: Surface, distance: float) -> Surface:
    """
    r + distance n with n along r_u x r_v, for a basis that has third derivatives.
    """

SAME_SIDE: float = 1e-09

def coincident_sides(surface: Surface, rounding: Sequence[float]) -> tuple[list[bool], list[int], list[bool]]:
    """
    Of the four sides of a surface's domain, numbered as Python's ``sides``: is it one point in space, the side that it coincides with or -1, does it run against that.

    rounding: how far the rounding of a parameter moves each of them, a fraction of the surface.
    """

PROJECTION_MARGIN: float = 0.01

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

    def enclose(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None))], Annotated[NDArray[numpy.float64], dict(shape=(None, None))]]:
        """
        Outputs at points (n, inputs), proved: each within rad of mid, both (n, outputs).

        Constants are taken within four ulps; rad is infinite where nothing is known.
        """

    def bounds(self, lo: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], hi: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], kinks: bool) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None))], Annotated[NDArray[numpy.float64], dict(shape=(None, None))]]:
        """
        Bounds over cells: lo, hi (n, inputs) -> lower, upper (n, outputs).

        Infinite where nothing is known. kinks: False leaves out what second derivatives are across kinks.
        """

class FormulaSurface(Surface):
    """The surface of three formulas."""

    def __init__(self, tapes: Sequence[Tape | None], domain: tuple[tuple[float, float], tuple[float, float]], limits: Sequence[tuple[Sequence[float], Sequence[float], Sequence[float]]]) -> None:
        """
        tapes: of r, with r_u and r_v, with r_uu, r_uv, r_vv; None for an order that is not wanted.

        limits: for u and for v (places, lowest, highest): places of infinite speed, and within which limits derivatives are taken between them; all empty where the speed is finite.
        """

def monotone_cubic(x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], at: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Values and derivatives (m,) at ``at`` (m,) of a cubic through y (n,) at rising x (n,) that rises where they do.
    """

class ChartAxis:
    """A monotone map between one parameter and its scaled coordinate."""

    def __init__(self, extent: float, knots: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], slopes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], pieces: Annotated[NDArray[numpy.float64], dict(shape=(None, 7), order='C', device='cpu', writable=False)] | None = None) -> None:
        """
        knots, slopes (k,): the parameter and its derivative at k even coordinates from 0 to extent.
        pieces (p, 7), where knots are of the bent parameter: first, last, powers at both ends, their beta function, clearance at both ends.
        """

    @property
    def extent(self) -> float: ...

    @property
    def knots(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]: ...

    @property
    def slopes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]: ...

    def parameter_and_rate(self, x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        The parameter (n,) at scaled coordinates x (n,), and its derivative by x (n,).

        Linear outside [0, extent], constant where the parameter is bent.
        """

CHART_SAMPLES: int = 257

CHART_SAMPLES_OF_PIECE: int = 32

class Chart:
    """(u, v) of a surface and the scaled plane, axis by axis."""

    def __init__(self, u: ChartAxis, v: ChartAxis, scaling: tuple[int, int, float, tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]]] | None = None) -> None:
        """scaling: as below."""

    @staticmethod
    def of(surface: Surface, steady: tuple[bool, bool], pieces: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 7), order='C', device='cpu', writable=False)] | None, Annotated[NDArray[numpy.float64], dict(shape=(None, 7), order='C', device='cpu', writable=False)] | None], samples: int, to_poles: bool) -> Chart:
        """
        The chart of a surface from its speeds. steady: axes along which the speed is the same everywhere. pieces: (p, 7) of the axes with speeds without bound, or None. samples: along each axis. to_poles: axes that run to elongated poles are scaled.
        """

    @staticmethod
    def uniform(domain: tuple[tuple[float, float], tuple[float, float]], speeds: tuple[float, float]) -> Chart:
        """Where |r_u| and |r_v| are the same everywhere."""

    @property
    def u(self) -> ChartAxis: ...

    @property
    def v(self) -> ChartAxis: ...

    @property
    def scaling(self) -> object:
        """
        The axis that is scaled towards elongated poles, 0 or 1, which ends are poles (0: the first, 1: the last, 2: both), an angle, and the elongations at both ends, (k,) and (l,) at even places of the other axis: see pole_scaling.hpp; or None.
        """

    def to_uv_and_rates(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]]:
        """xy (n, 2) -> uv (n, 2) and (du/dx, dv/dy) (n, 2)."""

    def crossed_rates(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """xy (n, 2) -> (du/dy, dv/dx) (n, 2), zero but where an axis is scaled."""

    def to_plane(self, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """
        uv (n, 2), bent parameters where there are some -> xy (n, 2).

        Exact at the ends of the axes; what lies beyond is moved there.
        """
