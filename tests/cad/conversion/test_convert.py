"""Converted geometry against OCP's own values and derivatives."""

import os
import pickle
from collections import defaultdict

import numpy as np
import pytest

pytest.importorskip("OCP")

from OCP import Geom, Geom2d
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepTools import BRepTools
from OCP.GeomConvert import GeomConvert
from OCP.gp import (
    gp_Ax1,
    gp_Ax2,
    gp_Ax3,
    gp_Ax22d,
    gp_Dir,
    gp_Dir2d,
    gp_Pnt,
    gp_Pnt2d,
    gp_Vec,
    gp_Vec2d,
)
from OCP.IGESControl import IGESControl_Reader
from OCP.STEPControl import STEPControl_Reader
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from surfmesh.cad.conversion.convert import curve2d_of, curve_of, surface_of
from surfmesh.errors import CadError, SurfaceError
from surfmesh.geometry.cad_surfaces.curves import Curve
from surfmesh.geometry.surface import Surface

EVERYTHING = os.environ.get("SURFMESH_ALL_CAD") == "1"
SAMPLE = (  # small files that hold every kind of surface between them
    "analysissitus__gehause_rohteil.brep",
    "analysissitus__shading_wrongshape_025.brep",
    "build123d__M6-1x12-countersunk-screw.step",
    "librepcb_base.lplib__2b43fadb-ea79-4df2-af3f-432fabec4f25.step",
    "pygem__test_pipe.igs",
    "siconos-tutorials__platine.stp",
    "tigl__surface.brep",
)
FACES = 25  # of each file of the sample
POINTS = 5  # on each face and edge
TOLERANCE = 1e-9
FRAME = gp_Ax3(gp_Pnt(1.0, -2.0, 3.0), gp_Dir(1.0, 2.0, 3.0), gp_Dir(1.0, 0.0, -1.0))


# ------------------------------------------------------------------------- what OCP says


def numbers(vectors):
    """gp points and vectors, in space or in the plane -> (k, d)."""
    return np.array([(v.X(), v.Y(), v.Z()) if hasattr(v, "Z") else (v.X(), v.Y()) for v in vectors])


def ocp_surface(surface, u, v):
    """r, r_u, r_v, r_uu, r_uv, r_vv: (6, 3)."""
    point, u1, v1, uu, vv, uv = gp_Pnt(), *(gp_Vec() for _ in range(5))
    surface.D2(u, v, point, u1, v1, uu, vv, uv)
    return numbers((point, u1, v1, uu, uv, vv))


def ocp_curve(curve, t):
    """c, c', c'': (3, d)."""
    plane = isinstance(curve, Geom2d.Geom2d_Curve)
    point, first, second = (gp_Pnt2d(), gp_Vec2d(), gp_Vec2d()) if plane else (
        gp_Pnt(), gp_Vec(), gp_Vec()
    )  # fmt: skip
    curve.D2(t, point, first, second)
    return numbers((point, first, second))


def relative_error(ours, theirs, spans):
    """Worst difference, relative to the values and to the scale of the whole over its spans.

    ours, theirs: (m, n, d); spans (m,): how far the parameters of each derivative go, e.g.
    du dv for r_uv.
    """
    scale = np.linalg.norm(theirs[0], axis=1).max() + np.ptp(theirs[0], axis=0).max()
    size = np.linalg.norm(theirs, axis=2) + (scale / np.array(spans))[:, None]
    return float((np.linalg.norm(ours - theirs, axis=2) / np.maximum(size, 1e-300)).max())


def surface_error(surface, domain, count=POINTS, seed=0):
    """(kind, worst relative error) of a converted surface at random points of a box."""
    (u0, u1), (v0, v1) = domain
    uv = np.random.default_rng(seed).uniform((u0, v0), (u1, v1), (count, 2))
    ours = surface_of(surface, domain)
    assert isinstance(ours, Surface)
    theirs = np.array([ocp_surface(surface, *place) for place in uv]).swapaxes(0, 1)
    du, dv = u1 - u0, v1 - v0
    spans = (1.0, du, dv, du * du, du * dv, dv * dv)
    return ours.kind, relative_error(np.array(ours.evaluate(uv, 2)), theirs, spans)


def curve_error(curve, first, last, count=POINTS, seed=0):
    """(kind, worst relative error) of a converted curve at random parameters."""
    t = np.random.default_rng(seed).uniform(first, last, count)
    plane = isinstance(curve, Geom2d.Geom2d_Curve)
    ours = curve2d_of(curve) if plane else curve_of(curve)
    assert isinstance(ours, Curve)
    assert ours.dimension == (2 if plane else 3)
    theirs = np.array([ocp_curve(curve, place) for place in t]).swapaxes(0, 1)
    spans = (last - first) ** np.arange(3.0)
    return ours.kind, relative_error(np.array(ours.evaluate(t, 2)), theirs, spans)


# ------------------------------------------------------------------------------ the corpus


def read(path):
    """The shape in a file, by OCP's plain readers."""
    if path.suffix == ".brep":
        shape = TopoDS_Shape()
        assert BRepTools.Read_s(shape, str(path), BRep_Builder())
        return shape
    igs = path.suffix.lower() in (".igs", ".iges")
    reader = IGESControl_Reader() if igs else STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return reader.OneShape()


def faces_of(shape):
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, found)
    return [TopoDS.Face_s(found.FindKey(i)) for i in range(1, found.Extent() + 1)]


def edges_of(face):
    explorer = TopExp_Explorer(face, TopAbs_EDGE)
    while explorer.More():
        yield TopoDS.Edge_s(explorer.Current())
        explorer.Next()


def sampled(faces, count):
    """About so many faces, evenly spread, and the first of each kind of surface."""
    first_of_kind = {}
    for number, face in enumerate(faces):
        first_of_kind.setdefault(type(BRep_Tool.Surface_s(face)), number)
    chosen = {*range(0, len(faces), max(1, len(faces) // count)), *first_of_kind.values()}
    return [faces[number] for number in sorted(chosen)]


def worst_errors(faces):
    """{"surface plane": (worst error, how many), "curve line": ..., "pcurve line": ...}."""
    errors = defaultdict(list)
    for face in faces:
        u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
        kind, error = surface_error(BRep_Tool.Surface_s(face), ((u0, u1), (v0, v1)))
        errors[f"surface {kind}"].append(error)
        for edge in edges_of(face):
            first, last = BRep_Tool.Range_s(edge)
            curve = BRep_Tool.Curve_s(edge, 0.0, 0.0)
            if curve is not None and not BRep_Tool.Degenerated_s(edge):
                kind, error = curve_error(curve, first, last)
                errors[f"curve {kind}"].append(error)
            pcurve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
            if pcurve is not None:
                kind, error = curve_error(pcurve, *BRep_Tool.Range_s(edge, face))
                errors[f"pcurve {kind}"].append(error)
    return {kind: (np.max(values), len(values)) for kind, values in errors.items()}


def test_corpus(cad_folder, cad_files):
    found = {}
    for path in cad_files if EVERYTHING else [cad_folder / name for name in SAMPLE]:
        faces = faces_of(read(path))
        chosen = faces if EVERYTHING else sampled(faces, FACES)
        for kind, (error, count) in worst_errors(chosen).items():
            assert error < TOLERANCE, f"{path.name}: {kind}"
            worst, total = found.get(kind, (0.0, 0))
            found[kind] = max(worst, error), total + count
    kinds = {kind.split()[1] for kind in found if kind.startswith("surface")}
    assert kinds == {
        "plane", "cylinder", "cone", "sphere", "torus",
        "bspline", "bezier", "extrusion", "revolution", "offset",
    }  # fmt: skip
    if EVERYTHING:  # shown by pytest -s
        for kind, (error, count) in sorted(found.items()):
            print(f"{kind:20} {count:6}   {error:.1e}")


# --------------------------------------------------------------- surfaces and curves by hand


def left_handed():
    frame = gp_Ax3(FRAME.Ax2())
    frame.YReverse()
    return frame


def circle():
    return Geom.Geom_Circle(gp_Ax2(gp_Pnt(5.0, 1.0, 0.0), gp_Dir(0.1, 1.0, 0.3)), 2.0)


def periodic_curve(first_multiplicity=1):
    """Degree 3, periodic, with a knot of multiplicity 2 and uneven weights."""
    multiplicities = [first_multiplicity, 2, 1, 1, first_multiplicity]
    count = sum(multiplicities[:-1])
    rng = np.random.default_rng(count)
    poles, weights = TColgp_Array1OfPnt(1, count), TColStd_Array1OfReal(1, count)
    for i in range(count):
        turn = 2.0 * np.pi * i / count
        poles.SetValue(i + 1, gp_Pnt(np.cos(turn), 2.0 * np.sin(turn), rng.normal()))
        weights.SetValue(i + 1, rng.uniform(0.5, 2.0))
    knots, times = TColStd_Array1OfReal(1, 5), TColStd_Array1OfInteger(1, 5)
    for i, knot in enumerate((1.0, 1.7, 2.0, 3.5, 4.0)):
        knots.SetValue(i + 1, knot)
        times.SetValue(i + 1, multiplicities[i])
    return Geom.Geom_BSplineCurve(poles, weights, knots, times, 3, True)


def unclamped_curve():
    """Degree 3, not periodic, whose knots are not repeated at the ends."""
    rng = np.random.default_rng(5)
    poles = TColgp_Array1OfPnt(1, 6)
    for i in range(6):
        poles.SetValue(i + 1, gp_Pnt(*rng.normal(size=3)))
    knots, times = TColStd_Array1OfReal(1, 10), TColStd_Array1OfInteger(1, 10)
    for i in range(10):
        knots.SetValue(i + 1, float(i * i))
        times.SetValue(i + 1, 1)
    return Geom.Geom_BSplineCurve(poles, knots, times, 3)


def bezier_surface(rational):
    rng = np.random.default_rng(7)
    poles, weights = TColgp_Array2OfPnt(1, 5, 1, 3), TColStd_Array2OfReal(1, 5, 1, 3)
    for i in range(1, 6):
        for j in range(1, 4):
            poles.SetValue(i, j, gp_Pnt(i, j, rng.normal()))
            weights.SetValue(i, j, rng.uniform(0.5, 2.0))
    return Geom.Geom_BezierSurface(poles, weights) if rational else Geom.Geom_BezierSurface(poles)


def spline_torus():
    return GeomConvert.SurfaceToBSplineSurface_s(Geom.Geom_ToroidalSurface(FRAME, 3.0, 1.0))


def trimmed(surface):
    return Geom.Geom_RectangularTrimmedSurface(surface, 0.1, 0.9, 0.2, 0.8)


SURFACES = {
    "plane": lambda: Geom.Geom_Plane(FRAME),
    "left-handed plane": lambda: Geom.Geom_Plane(left_handed()),
    "cylinder": lambda: Geom.Geom_CylindricalSurface(FRAME, 2.0),
    "left-handed cylinder": lambda: Geom.Geom_CylindricalSurface(left_handed(), 2.0),
    "cone": lambda: Geom.Geom_ConicalSurface(FRAME, 0.4, 2.0),
    "narrowing cone": lambda: Geom.Geom_ConicalSurface(left_handed(), -0.4, 2.0),
    "sphere": lambda: Geom.Geom_SphericalSurface(left_handed(), 2.0),
    "torus": lambda: Geom.Geom_ToroidalSurface(FRAME, 3.0, 1.0),
    "left-handed torus": lambda: Geom.Geom_ToroidalSurface(left_handed(), 3.0, 1.0),
    "periodic rational B-spline": spline_torus,
    "bezier": lambda: bezier_surface(False),
    "rational bezier": lambda: bezier_surface(True),
    "extrusion": lambda: Geom.Geom_SurfaceOfLinearExtrusion(periodic_curve(), gp_Dir(1, 2, 3)),
    "revolution": lambda: Geom.Geom_SurfaceOfRevolution(periodic_curve(2), gp_Ax1()),
    "offset": lambda: Geom.Geom_OffsetSurface(bezier_surface(True), 0.3),
    "offset of a periodic one": lambda: Geom.Geom_OffsetSurface(spline_torus(), -0.3),
    "offset of a left-handed torus": lambda: Geom.Geom_OffsetSurface(
        Geom.Geom_ToroidalSurface(left_handed(), 3.0, 1.0), 0.3
    ),
    "offset of a narrowing cone": lambda: Geom.Geom_OffsetSurface(
        Geom.Geom_ConicalSurface(left_handed(), -0.4, 2.0), -0.3
    ),
    "trimmed": lambda: trimmed(bezier_surface(True)),
    "trimmed, then offset": lambda: Geom.Geom_OffsetSurface(trimmed(bezier_surface(False)), 0.2),
    "extruded trimmed offset curve": lambda: Geom.Geom_SurfaceOfLinearExtrusion(
        Geom.Geom_TrimmedCurve(
            Geom.Geom_OffsetCurve(periodic_curve(), 0.1, gp_Dir(0.1, 0.2, 1)), 1.2, 3.9
        ),
        gp_Dir(0, 1, 3),
    ),
    "turned offset curve": lambda: Geom.Geom_SurfaceOfRevolution(
        Geom.Geom_OffsetCurve(circle(), 0.5, gp_Dir(0, 1, 0)), gp_Ax1()
    ),
}


@pytest.mark.parametrize("name", SURFACES)
def test_surfaces(name):
    surface = SURFACES[name]()
    assert surface_error(surface, ((0.15, 0.85), (0.25, 0.75)), 50)[1] < TOLERANCE


@pytest.mark.parametrize("name", [n for n in SURFACES if SURFACES[n]().IsUPeriodic()])
@pytest.mark.parametrize("box", [(5.0, 8.0), (-9.0, -4.0), (20.0, 21.0)])
def test_boxes_across_the_seam(name, box):
    surface = SURFACES[name]()
    v = (5.0, 8.0) if surface.IsVPeriodic() else (0.1, 0.9)
    assert surface_error(surface, (box, v), 50)[1] < TOLERANCE
    periods = surface_of(surface, (box, v)).periods
    assert periods[0] == pytest.approx(surface.UPeriod())
    assert periods[1] == (pytest.approx(surface.VPeriod()) if surface.IsVPeriodic() else None)


def test_a_non_periodic_spline_goes_on_beyond_its_ends():
    surface = bezier_surface(True)
    assert surface_error(surface, ((-0.2, 1.2), (-0.1, 1.3)), 50)[1] < TOLERANCE
    assert curve_error(unclamped_curve(), 0.0, 45.0, 50)[1] < TOLERANCE


AXES = gp_Ax2(gp_Pnt(1.0, -2.0, 3.0), gp_Dir(1.0, 2.0, 3.0), gp_Dir(1.0, 0.0, -1.0))
PLANE_AXES = gp_Ax22d(gp_Pnt2d(1.0, -2.0), gp_Dir2d(1.0, 2.0), False)  # clockwise
CURVES = {
    "line": lambda: Geom.Geom_Line(AXES.Axis()),
    "circle": circle,
    "ellipse": lambda: Geom.Geom_Ellipse(AXES, 3.0, 1.0),
    "hyperbola": lambda: Geom.Geom_Hyperbola(AXES, 3.0, 1.0),
    "parabola": lambda: Geom.Geom_Parabola(AXES, 0.7),
    "periodic spline": periodic_curve,
    "periodic spline with a double knot at its seam": lambda: periodic_curve(2),
    "periodic spline with a corner at its seam": lambda: periodic_curve(3),
    "spline with single knots at its ends": unclamped_curve,
    "offset": lambda: Geom.Geom_OffsetCurve(periodic_curve(2), 0.3, gp_Dir(1, 2, 3)),
    "trimmed": lambda: Geom.Geom_TrimmedCurve(circle(), 1.0, 2.0),
    "trimmed the other way": lambda: Geom.Geom_TrimmedCurve(circle(), 1.0, 2.0, False),
    "circle in the plane": lambda: Geom2d.Geom2d_Circle(PLANE_AXES, 2.0),
    "ellipse in the plane": lambda: Geom2d.Geom2d_Ellipse(PLANE_AXES, 2.0, 1.0),
    "hyperbola in the plane": lambda: Geom2d.Geom2d_Hyperbola(PLANE_AXES, 2.0, 1.0),
    "parabola in the plane": lambda: Geom2d.Geom2d_Parabola(PLANE_AXES, 0.7),
    "line in the plane": lambda: Geom2d.Geom2d_Line(gp_Pnt2d(1, 2), gp_Dir2d(1, 3)),
    "offset in the plane": lambda: Geom2d.Geom2d_OffsetCurve(
        Geom2d.Geom2d_TrimmedCurve(Geom2d.Geom2d_Ellipse(PLANE_AXES, 2.0, 1.0), 0.0, 3.0), 0.3
    ),
}


@pytest.mark.parametrize("name", CURVES)
def test_curves(name):
    curve = CURVES[name]()
    box = (1.2, 3.9)
    if "single" in name:
        box = (9.0, 36.0)
    if "trimmed" in name:
        box = (curve.FirstParameter(), curve.LastParameter())
    assert curve_error(curve, *box, 50)[1] < TOLERANCE
    if curve.IsPeriodic():
        assert curve_error(curve, -7.0, 9.0, 50)[1] < TOLERANCE
        ours = curve2d_of(curve) if "plane" in name else curve_of(curve)
        assert ours.period == pytest.approx(curve.Period())


@pytest.mark.parametrize("name", SURFACES)
def test_a_pickled_surface_is_the_same_and_needs_no_ocp(name):
    surface = surface_of(SURFACES[name](), ((0.15, 0.85), (0.25, 0.75)), "face 7")
    data = pickle.dumps(surface)
    assert b"OCP" not in data
    copy = pickle.loads(data)
    assert (copy.name, copy.kind, copy.domain) == ("face 7", surface.kind, surface.domain)
    uv = np.random.default_rng(1).uniform(0.3, 0.7, (9, 2))
    assert np.array_equal(copy.evaluate(uv, 2), surface.evaluate(uv, 2))


def test_what_is_not_known_is_refused():
    with pytest.raises(CadError, match=r"face 3 .*null"):
        surface_of(None, ((0, 1), (0, 1)), "face 3")
    with pytest.raises(CadError, match="null"):
        curve_of(None)
    with pytest.raises(SurfaceError, match=r"face 3: the parameter box .* not finite"):
        surface_of(Geom.Geom_Plane(FRAME), ((0, 1), (0, 2e400)), "face 3")
