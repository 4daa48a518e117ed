"""Kinks of abs, max, min and Piecewise: found, followed by edges, few triangles on flat pieces."""

import math

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.geometry.formulas.kinks import kink_lines

TAU = 2 * math.pi


def height(z, half=1.0):
    return sm.ParametricSurface("u", "v", z, u=(-half, half), v=(-half, half))


def length_along(mesh, guide):
    """Length in (u, v) of the mesh's edges on which ``guide`` is zero at both ends and amid."""
    a, b = mesh.points[mesh.edges, :2].transpose(1, 0, 2)
    on = [abs(guide(*p.T)) < 1e-9 for p in (a, b, 0.5 * (a + b))]
    return np.linalg.norm((b - a)[np.all(on, axis=0)], axis=1).sum()


@given(
    st.floats(0.0, TAU),
    st.floats(-0.6, 0.6),
    st.floats(0.3, 3.0),
    st.sampled_from((1e-3, 1.0, 1e3)),
)
@settings(max_examples=6, deadline=None, derandomize=True)
def test_a_roof_has_as_many_triangles_as_planes_and_its_ridge_is_an_edge(turn, away, slope, half):
    cos, sin = math.cos(turn), math.sin(turn)
    surface = height(f"{slope}*abs({cos}*u + {sin}*v - {away * half})", half)
    mesh = sm.mesh(surface, sm.Sizing(chord=5e-3 * half))
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.triangles < 400 and report.deviation_max < 1e-9 * half
    (line,) = kink_lines(surface)
    wanted = np.linalg.norm(line.uv[-1] - line.uv[0]) / half
    scaled = sm.SurfaceMesh(points=mesh.points / half, triangles=mesh.triangles)
    assert length_along(scaled, lambda u, v: cos * u + sin * v - away) == pytest.approx(wanted)


LINES = [  # formula, length of all kinks in (u, v)
    ("abs(u**2+v**2-0.5)", TAU * math.sqrt(0.5)),
    ("abs((u-0.3)**2+(v-0.2)**2-1e-4)", TAU * 1e-2),  # within a cell of the grid
    ("max(u, v, 0)", 2 + math.sqrt(2)),
    ("abs(u*v)", 4),
    ("min(u, v, -u, -v)", 4 * math.sqrt(2)),
    ("abs(u - 1)", 0),  # on a side
    ("max(u, 0) + min(u, 0)", 0),  # no kink at all
    ("abs(abs(u) - 0.001)", 6),
    ("abs(abs(u) - abs(v))", 4 + 4 * math.sqrt(2)),  # a kink that is bent where it meets others
    ("abs(2*abs(u - 0.1) - abs(v + 0.05))", 4 + 2 * math.sqrt(5)),
    ("abs(abs(abs(u) - 0.5) - abs(v))", 8 + 4 * math.sqrt(2)),
    ("max(0, 1 - 1000*abs(u - 0.5137))", 6),
    ("sqrt(u**2)", 2),
    (sp.Piecewise((sp.Symbol("u") ** 2, sp.Symbol("u") > 0), (-sp.Symbol("u"), True)), 2),
]


@pytest.mark.parametrize("high", [1.2, 1.0])
def test_kinks_of_kinks_share_their_meetings(high):
    surface = sm.ParametricSurface(
        "u", "v", "abs(2*abs(u-0.1)-abs(v+0.05))", u=(-1, 1), v=(-1, high)
    )
    mesh = sm.mesh(surface, chord=0.01)
    assert mesh.report.clean and not mesh.warnings and len(mesh.triangles) < 250


@pytest.mark.parametrize("z, wanted", LINES, ids=str)
def test_all_kinks_are_found(z, wanted):
    lines = kink_lines(height(z))
    found = sum(np.linalg.norm(np.diff(line.uv, axis=0), axis=1).sum() for line in lines)
    assert found == pytest.approx(wanted, rel=0.1 if wanted < 0.1 else 2e-3, abs=1e-9)


@pytest.mark.parametrize(
    "z, most", [("max(u, v, 0)", 220), ("min(u, v, -u, -v)", 250), ("abs(u) + abs(v)", 220)]
)
@pytest.mark.parametrize("more", [{}, {"anisotropy": 5}])
def test_flat_pieces_get_few_triangles(z, most, more):
    report = sm.check(sm.mesh(height(z), sm.Sizing(chord=5e-3, **more)))
    assert report.clean and report.deviation_max < 1e-12 and report.triangles < most
    assert report.quasi_unit_share > 0.9


@pytest.mark.parametrize(
    "z", ["abs(u**2+v**2-0.5)", "0.2*abs(sin(5*u)*cos(3*v))", "max(0, 1-1000*abs(u-0.5137))"]
)
@pytest.mark.parametrize("asked", [{"chord": 5e-3}, {"size": 0.15}, {"chord": 0.02, "angle": 20}])
def test_curved_and_steep_kinks_are_clean(z, asked):
    report = sm.check(sm.mesh(height(z), sm.Sizing(**asked)))
    assert report.clean and report.unseen == 0 and report.triangles < 8000, report.problems


def test_kinks_cross_seams_and_poles():
    ridge = "(1+0.2*abs(v-0.3*sin(u)))"
    tube = sm.ParametricSurface(f"{ridge}*cos(u)", f"{ridge}*sin(u)", "v", u=(0, TAU), v=(-1, 1))
    lens = "(1+0.1*abs(cos(v)-0.3))"
    ball = sm.ParametricSurface(
        f"{lens}*sin(v)*cos(u)", f"{lens}*sin(v)*sin(u)", f"{lens}*cos(v)", u=(0, TAU),
        v=(0, math.pi),
    )  # fmt: skip
    for surface, euler in ((tube, 0), (ball, 2)):
        report = sm.check(sm.mesh(surface, sm.Sizing(chord=0.02)))
        assert report.clean and report.euler == euler and report.triangles < 800, report.problems


@pytest.mark.parametrize(
    "z", ["sign(u - 0.3)", "0.1*floor(7*u)", "Heaviside(u - v)", "atan2(v, u)"]
)
def test_a_torn_surface_is_refused_with_the_place(z):
    with pytest.raises(sm.errors.SurfaceError, match=r"jumps by .* through \(u, v\) = \("):
        sm.mesh(height(z), sm.Sizing(size=0.2))


def test_what_is_continuous_is_not_torn():
    plain = sm.ParametricSurface("u*sign(u)*sign(u)", "v", "0", u=(-1, 1), v=(-1, 1))
    assert kink_lines(plain) == []


@pytest.mark.parametrize(
    "x", ["sign(u)*sqrt(abs(u))", "sign(u)*abs(u)**(1/3)", "cbrt(u)", "1000*cbrt(u - 0.3)"]
)
@pytest.mark.parametrize("options", [{}, {"size": 0.15}, {"anisotropy": 6}], ids=str)
def test_an_edge_runs_where_the_speed_has_no_bound(x, options):
    scale = 1000 if "1000" in x else 1
    surface = sm.ParametricSurface(x, f"{scale}*v", "0", u=(-1, 1), v=(-1, 1))
    (line,) = kink_lines(surface)
    assert np.ptp(line.uv[:, 0]) < 1e-15
    asked = {"chord": 0.005 * scale, **options}
    asked |= {"size": 0.15 * scale} if "size" in options else {}
    report = sm.check(sm.mesh(surface, sm.Sizing(**asked)))
    assert report.clean, report.problems
    ends = surface.evaluate(np.array([[-1.0, 0.0], [1.0, 0.0]]))[0][:, 0]
    assert report.area == pytest.approx(2 * scale * np.ptp(ends), rel=1e-9)
    assert report.triangles < 700
