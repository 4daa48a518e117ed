"""Geometry of OCP -> curves and surfaces of `surfmesh.geometry`, exactly or not at all.

What comes out holds plain numbers and arrays: the same parametrisation, no approximation, no
OCP. Trimmed curves and surfaces become what they trim: a parameter keeps its meaning, and the
ends are the caller's. Locations are applied by the caller, through OCP.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from OCP import Geom, Geom2d

from surfmesh.errors import CadError
from surfmesh.geometry.cad_surfaces.curves import (
    Circle,
    CoreCurve,
    Ellipse,
    Hyperbola,
    Line,
    Parabola,
)
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.elementary_offsets import elementary_offset
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface, bezier_knots
from surfmesh.geometry.cad_surfaces.offset import OffsetCurve, OffsetSurface
from surfmesh.geometry.cad_surfaces.swept import ExtrusionSurface, RevolutionSurface
from surfmesh.geometry.surface import Domain


def surface_of(surface: Geom.Geom_Surface, domain: Domain, name: str = "") -> FaceSurface:
    """The surface under a face; domain: the face's parameter box ((u0, u1), (v0, v1)).

    Raises CadError for a kind of surface that is not known, SurfaceError for an empty box.
    """
    while isinstance(surface, Geom.Geom_RectangularTrimmedSurface):
        surface = surface.BasisSurface()
    make = _SURFACES.get(type(surface))
    if make is None:
        raise CadError(
            f"{name or 'a face'} lies on a surface of the kind {_kind(surface)}, which is not "
            "known; convert it to a B-spline in the program that made the model"
        )
    return make(surface, domain=domain, name=name)


def curve_of(curve: Geom.Geom_Curve) -> CoreCurve:
    """The curve of an edge in space. Raises CadError for a kind that is not known."""
    while isinstance(curve, Geom.Geom_TrimmedCurve):
        curve = curve.BasisCurve()
    return _curve(curve)


def curve2d_of(curve: Geom2d.Geom2d_Curve) -> CoreCurve:
    """The curve of an edge in the (u, v) plane of a face.

    Raises CadError for a kind that is not known.
    """
    while isinstance(curve, Geom2d.Geom2d_TrimmedCurve):
        curve = curve.BasisCurve()
    return _curve(curve)


def _curve(curve: Any) -> CoreCurve:
    make = _CURVES.get(type(curve))
    if make is None:
        raise CadError(
            f"an edge lies on a curve of the kind {_kind(curve)}, which is not known; convert "
            "it to a B-spline in the program that made the model"
        )
    return make(curve)


def _kind(geometry: Any) -> str:
    return "null" if geometry is None else geometry.DynamicType().Name()


def _vector(point: Any) -> np.ndarray:
    """The coordinates of a point, a direction or a vector, in space or in the plane."""
    return np.array(point.Coord())


# -------------------------------------------------------------------------------- surfaces


def _frame(surface: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Origin, x, y, z; y is to the left of x or, in a left-handed frame, to the right."""
    position = surface.Position()
    axes = position.XDirection(), position.YDirection(), position.Direction()
    x, y, z = (_vector(axis) for axis in axes)
    return _vector(position.Location()), x, y, z


def _plane(surface: Geom.Geom_Plane, **face: Any) -> Plane:
    return Plane(*_frame(surface), **face)


def _cylinder(surface: Geom.Geom_CylindricalSurface, **face: Any) -> Cylinder:
    return Cylinder(*_frame(surface), radius=surface.Radius(), **face)


def _cone(surface: Geom.Geom_ConicalSurface, **face: Any) -> Cone:
    radius, angle = surface.RefRadius(), surface.SemiAngle()
    return Cone(*_frame(surface), radius=radius, angle=angle, **face)


def _sphere(surface: Geom.Geom_SphericalSurface, **face: Any) -> Sphere:
    return Sphere(*_frame(surface), radius=surface.Radius(), **face)


def _torus(surface: Geom.Geom_ToroidalSurface, **face: Any) -> Torus:
    radius, tube = surface.MajorRadius(), surface.MinorRadius()
    return Torus(*_frame(surface), radius=radius, tube=tube, **face)


def _bezier_surface(surface: Geom.Geom_BezierSurface, **face: Any) -> BSplineSurface:
    control, weights = _net(surface)
    knots = bezier_knots(surface.UDegree()), bezier_knots(surface.VDegree())
    return BSplineSurface(*knots, control, weights, kind="bezier", **face)


def _bspline_surface(surface: Geom.Geom_BSplineSurface, **face: Any) -> BSplineSurface:
    control, weights = _net(surface)
    knots_u, rows = _unrolled(surface.UKnotSequence(), surface.UDegree(), len(control))
    knots_v, columns = _unrolled(surface.VKnotSequence(), surface.VDegree(), control.shape[1])
    net = np.ix_(rows, columns)
    return BSplineSurface(
        knots_u,
        knots_v,
        control[net],
        None if weights is None else weights[net],
        (
            _period(surface.IsUPeriodic(), knots_u, surface.UDegree()),
            _period(surface.IsVPeriodic(), knots_v, surface.VDegree()),
        ),
        **face,
    )


def _extrusion(surface: Geom.Geom_SurfaceOfLinearExtrusion, **face: Any) -> ExtrusionSurface:
    direction = _vector(surface.Direction())
    return ExtrusionSurface(curve_of(surface.BasisCurve()), direction, **face)


def _revolution(surface: Geom.Geom_SurfaceOfRevolution, **face: Any) -> RevolutionSurface:
    axis = surface.Axis()
    origin, direction = _vector(axis.Location()), _vector(axis.Direction())
    return RevolutionSurface(curve_of(surface.BasisCurve()), origin, direction, **face)


def _offset_surface(surface: Geom.Geom_OffsetSurface, **face: Any) -> FaceSurface:
    basis = surface_of(surface.BasisSurface(), **face)
    elementary = elementary_offset(basis, surface.Offset())
    return elementary or OffsetSurface(basis, surface.Offset(), **face)


def _net(surface: Any) -> tuple[np.ndarray, np.ndarray | None]:
    """Control points (nu, nv, 3) and weights (nu, nv), or None where they are all the same."""
    rows, columns = range(1, surface.NbUPoles() + 1), range(1, surface.NbVPoles() + 1)
    poles = surface.Poles()  # called with two indices: OCP 7.8 gives arrays no Value
    control = np.array([[poles(i, j).Coord() for j in columns] for i in rows])
    if not (surface.IsURational() or surface.IsVRational()):
        return control, None
    return control, np.array([[surface.Weight(i, j) for j in columns] for i in rows])


# ---------------------------------------------------------------------------------- curves


def _line(curve: Any) -> Line:
    position = curve.Position()
    return Line(_vector(position.Location()), _vector(position.Direction()))


def _axes(curve: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Origin, x, y."""
    x, y = (_vector(axis.Direction()) for axis in (curve.XAxis(), curve.YAxis()))
    return _vector(curve.Location()), x, y


def _circle(curve: Any) -> Circle:
    return Circle(*_axes(curve), radius=curve.Radius())


def _ellipse(curve: Any) -> Ellipse:
    return Ellipse(*_axes(curve), major=curve.MajorRadius(), minor=curve.MinorRadius())


def _hyperbola(curve: Any) -> Hyperbola:
    return Hyperbola(*_axes(curve), major=curve.MajorRadius(), minor=curve.MinorRadius())


def _parabola(curve: Any) -> Parabola | Line:
    origin, x, y = _axes(curve)
    if curve.Focal() == 0.0:  # OCCT's degenerate parabola is its axis
        return Line(origin, x)
    return Parabola(origin, x, y, focal=curve.Focal())


def _bezier_curve(curve: Any) -> BSplineCurve:
    control, weights = _polygon(curve)
    return BSplineCurve(bezier_knots(curve.Degree()), control, weights, kind="bezier")


def _bspline_curve(curve: Any) -> BSplineCurve:
    control, weights = _polygon(curve)
    knots, rows = _unrolled(curve.KnotSequence(), curve.Degree(), len(control))
    weights = None if weights is None else weights[rows]
    period = _period(curve.IsPeriodic(), knots, curve.Degree())
    return BSplineCurve(knots, control[rows], weights, period)


def _offset_curve(curve: Geom.Geom_OffsetCurve) -> OffsetCurve:
    return OffsetCurve(curve_of(curve.BasisCurve()), curve.Offset(), _vector(curve.Direction()))


def _offset_curve2d(curve: Geom2d.Geom2d_OffsetCurve) -> OffsetCurve:
    return OffsetCurve(curve2d_of(curve.BasisCurve()), curve.Offset())


def _polygon(curve: Any) -> tuple[np.ndarray, np.ndarray | None]:
    """Control points (n, d) and weights (n,), or None where they are all the same."""
    poles = range(1, curve.NbPoles() + 1)
    control = np.array([curve.Pole(i).Coord() for i in poles])
    return control, np.array([curve.Weight(i) for i in poles]) if curve.IsRational() else None


# --------------------------------------------------------------------------- knot sequences


def _unrolled(sequence: Any, degree: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Flat knots, and which control point belongs to each of their functions.

    A periodic sequence goes on beyond its ends, and has more functions than control points:
    these come round again.
    """
    at = range(sequence.Lower(), sequence.Upper() + 1)
    knots = np.array([sequence(i) for i in at])  # to iterate over it takes twenty times as long
    return knots, np.arange(len(knots) - degree - 1) % count


def _period(periodic: bool, knots: np.ndarray, degree: int) -> float | None:
    return float(knots[-1 - degree] - knots[degree]) if periodic else None


_SURFACES: dict[type, Callable[..., FaceSurface]] = {
    Geom.Geom_Plane: _plane,
    Geom.Geom_CylindricalSurface: _cylinder,
    Geom.Geom_ConicalSurface: _cone,
    Geom.Geom_SphericalSurface: _sphere,
    Geom.Geom_ToroidalSurface: _torus,
    Geom.Geom_BezierSurface: _bezier_surface,
    Geom.Geom_BSplineSurface: _bspline_surface,
    Geom.Geom_SurfaceOfLinearExtrusion: _extrusion,
    Geom.Geom_SurfaceOfRevolution: _revolution,
    Geom.Geom_OffsetSurface: _offset_surface,
}
_CURVES: dict[type, Callable[[Any], CoreCurve]] = {
    Geom.Geom_Line: _line,
    Geom.Geom_Circle: _circle,
    Geom.Geom_Ellipse: _ellipse,
    Geom.Geom_Hyperbola: _hyperbola,
    Geom.Geom_Parabola: _parabola,
    Geom.Geom_BezierCurve: _bezier_curve,
    Geom.Geom_BSplineCurve: _bspline_curve,
    Geom.Geom_OffsetCurve: _offset_curve,
    Geom2d.Geom2d_Line: _line,
    Geom2d.Geom2d_Circle: _circle,
    Geom2d.Geom2d_Ellipse: _ellipse,
    Geom2d.Geom2d_Hyperbola: _hyperbola,
    Geom2d.Geom2d_Parabola: _parabola,
    Geom2d.Geom2d_BezierCurve: _bezier_curve,
    Geom2d.Geom2d_BSplineCurve: _bspline_curve,
    Geom2d.Geom2d_OffsetCurve: _offset_curve2d,
}
