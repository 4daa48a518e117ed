"""Surfaces that meet: models whose faces end on common curves, against closed forms."""

from math import pi

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.elementary import Torus
from surfmesh.geometry.cad_surfaces.nurbs import BSplineSurface
from surfmesh.geometry.cad_surfaces.offset import OffsetSurface

TURN = (0, "2*pi")


def sphere(x=0.0, y=0.0, z=0.0, radius=1.0, name="sphere"):
    return sm.ParametricSurface(
        f"{x} + {radius}*cos(u)*cos(v)", f"{y} + {radius}*sin(u)*cos(v)",
        f"{z} + {radius}*sin(v)", u=TURN, v=("-pi/2", "pi/2"), name=name,
    )  # fmt: skip


def tube(axis, radius, half, name):
    around = [f"{radius}*cos(u)", f"{radius}*sin(u)"]
    around.insert("xyz".index(axis), "v")
    return sm.ParametricSurface(*around, u=TURN, v=(-half, half), name=name)


def plane(height, half=2.0, name="plane"):
    return sm.ParametricSurface("u", "v", height, u=(-half, half), v=(-half, half), name=name)


def common_edges(model):
    return [edge for edge in model.edges if "/" in edge.name]


def lens(distance):
    """The common part of two unit spheres."""
    h = 1.0 - distance / 2.0
    return 2.0 * pi * h * h * (3.0 - h) / 3.0


def test_two_tubes_have_the_curve_of_the_closed_form():
    wide, thin = tube("z", 1.0, 2.0, "wide"), tube("x", 0.7, 2.1, "thin")
    model = sm.intersect([wide, thin])
    assert not model.broken_invariant()
    edges = common_edges(model)
    assert {edge.name for edge in edges} == {"wide/thin"}
    for edge in edges:
        x, y, z = edge.evaluate(np.linspace(0.0, 1.0, 301))[0].T
        assert np.abs(np.hypot(x, y) - 1.0).max() < 1e-9
        assert np.abs(np.hypot(y, z) - 0.7).max() < 1e-9
    # two closed curves around x = 1 and x = -1, cut by seams into pieces
    t = np.arange(400) * pi / 200  # y = 0.7 cos t, z = 0.7 sin t, x = +-sqrt(1 - y^2)
    slope = 0.49 * np.sin(t) * np.cos(t) / np.sqrt(1.0 - 0.49 * np.cos(t) ** 2)
    length = 2.0 * pi * np.sqrt(0.49 + slope**2).mean()
    assert sum(edge.length for edge in edges) == pytest.approx(2.0 * length, rel=1e-9)
    for name, whole in (("wide", 8.0 * pi), ("thin", 4.2 * 0.7 * 2.0 * pi)):
        area = sum(face.area for face in model.faces if face.name == name)
        assert area == pytest.approx(whole, rel=1e-8)


def test_the_mesh_of_tubes_is_clean_and_shares_the_curve():
    model = sm.intersect([tube("z", 1.0, 2.0, "wide"), tube("x", 0.7, 2.1, "thin")])
    mesh = sm.mesh(model, 0.2)
    report = sm.check(mesh)
    assert report.clean, report.problems
    uses = mesh.connectivity.uses
    assert (uses == 4).sum() > 30  # along the curve four sheets meet
    assert set(np.unique(uses)) == {1, 2, 4}


def test_parts_of_spheres_have_the_volumes_of_the_closed_form():
    pair = [sphere(name="a"), sphere(1.0, 0.03, 0.02, name="b")]
    part = lens(np.sqrt(1.0 + 0.03**2 + 0.02**2))
    ball = 4.0 * pi / 3.0
    for keep, volume in (
        ("common", part), ("union", 2.0 * ball - part), ("difference", ball - part)
    ):  # fmt: skip
        model = sm.intersect(pair, keep=keep)
        assert not model.broken_invariant()
        (solid,) = model.solids
        assert solid.closed
        assert solid.volume == pytest.approx(volume, rel=1e-9)
    report = sm.check(sm.mesh(model, 0.3))
    assert report.clean and report.closed


def test_three_surfaces_share_a_vertex():
    sheets = [
        sm.ParametricSurface("u", "v", "0.1*u*v", u=(-1, 1), v=(-1.1, 1), name="a"),
        sm.ParametricSurface("u", "0.1*u*u - 0.1", "v", u=(-1.2, 1), v=(-1.1, 1.2), name="b"),
        sm.ParametricSurface("0.07 + 0.1*v*u", "u", "v", u=(-1.2, 1.3), v=(-1.1, 1.2), name="c"),
    ]
    model = sm.intersect(sheets)
    assert not model.broken_invariant()
    ends = [edge.name for edge in model.edges for _ in (0, 1)]
    at = [vertex for edge in model.edges for vertex in (edge.start, edge.end)]
    meet = [
        k for k in range(len(model.vertices))
        if {"a/b", "a/c", "b/c"} <= {name for name, v in zip(ends, at) if v == k}
    ]  # fmt: skip
    assert len(meet) == 1
    x, y, z = model.vertices[meet[0]].point
    assert z == pytest.approx(0.1 * x * y, abs=1e-10)
    assert y == pytest.approx(0.1 * x * x - 0.1, abs=1e-10)
    assert x == pytest.approx(0.07 + 0.1 * z * y, abs=1e-10)
    assert sm.check(sm.mesh(model, 0.2)).clean


def test_a_small_loop_between_samples_is_found():
    bump = sm.ParametricSurface("u", "v", "1e-3 - (u - 0.31)**2 - (v + 0.17)**2",
                                u=(-2, 2), v=(-2, 2), name="bump")  # fmt: skip
    model = sm.intersect([bump, plane("0.0", 3.0)])
    (edge,) = common_edges(model)
    assert edge.closed
    assert edge.length == pytest.approx(2.0 * pi * np.sqrt(1e-3), abs=1e-9)


def test_surfaces_apart_stay_as_they_are():
    model = sm.intersect([sphere(name="a"), plane("1.000001", name="b")])
    assert len(model.faces) == 2
    assert not common_edges(model)


def test_sides_are_kept_by_sign_and_by_point():
    pair = [sphere(name="ball"), plane("0.25 + 0.01*u", name="floor")]
    whole = sm.intersect(pair)
    tags = {tag.name: tag.faces for tag in whole.tags}
    assert len(tags["ball"]) == 2 and len(tags["ball+floor"]) == len(tags["ball-floor"]) == 1
    top = sm.intersect(pair, keep={"ball": "+floor", "floor": "-ball"})
    assert len(top.faces) == 2
    (cap,) = (face for face in top.faces if face.name == "ball")
    assert cap.area == pytest.approx(2.0 * pi * (1.0 - 0.25 / np.hypot(1.0, 0.01)), rel=1e-9)
    same = sm.intersect(pair, keep={"ball": (0.0, 0.0, 1.0), 1: (0.0, 0.0, 0.25)})
    assert sorted(face.area for face in same.faces) == pytest.approx(
        sorted(face.area for face in top.faces)
    )
    mesh = sm.mesh(top, {"*": 0.3, "floor": 0.1})
    assert sm.check(mesh).clean


@pytest.mark.parametrize(
    "keep", ["some", "union", {"ball": "+nothing"}, {"cube": "+floor"}, {"ball": "above"}, 7]
)
def test_what_cannot_be_kept_is_refused(keep):
    with pytest.raises(SurfaceError, match="keep"):
        sm.intersect([sphere(name="ball"), plane("0.25", name="floor")], keep=keep)


def test_functions_are_sampled_and_it_is_said():
    def saddle(u, v):
        return u, v, u * v

    sheet = sm.NumericSurface(saddle, u=(-1, 1), v=(-1, 1), name="saddle")
    model = sm.intersect([sheet, plane("0.1 + 0.2*u")])
    assert any("samples only" in sentence for sentence in model.healing)
    for edge in common_edges(model):
        x, y, z = edge.evaluate(np.linspace(0.0, 1.0, 101))[0].T
        assert np.abs(z - x * y).max() < 1e-9
        assert np.abs(z - 0.1 - 0.2 * x).max() < 1e-9


def test_a_drilled_box_and_a_box_with_a_ball():
    cq = pytest.importorskip("cadquery")
    box = cq.Workplane().box(2, 2, 2)
    bar = cq.Workplane().cylinder(3, 0.5).translate((0.1, 0.05, 0))
    drilled = sm.intersect([box, bar], keep="difference")
    assert not drilled.broken_invariant()
    assert drilled.volume == pytest.approx(8.0 - pi / 2.0, rel=1e-9)
    assert sm.check(sm.mesh(drilled, 0.4)).clean
    mixed = sm.intersect([box, sphere(0.9, 0.1, 0.2, 0.5, name="ball")], keep="union")
    h = 0.4  # of the cap of the ball outside the box
    assert not mixed.broken_invariant()
    assert mixed.volume == pytest.approx(8.0 + pi * h * h * (1.5 - h) / 3.0, rel=1e-9)


def test_equal_tubes_meet_in_two_ellipses_that_cross():
    model = sm.intersect([tube("z", 1.0, 3.0, "up"), tube("x", 1.0, 3.0, "across")])
    assert not model.broken_invariant()
    edges = common_edges(model)
    for edge in edges:
        x, y, z = edge.evaluate(np.linspace(0.0, 1.0, 101))[0].T
        assert np.abs(np.abs(x) - np.abs(z)).max() < 1e-9  # in the planes x = z and x = -z
        assert np.abs(np.hypot(x, y) - 1.0).max() < 1e-9
    at = np.array([vertex.point for vertex in model.vertices])
    branch = [int(np.argmin(np.linalg.norm(at - (0, y, 0), axis=1))) for y in (-1.0, 1.0)]
    for vertex in branch:
        assert sum((edge.start == vertex) + (edge.end == vertex) for edge in edges) == 4
    assert sm.check(sm.mesh(model, 0.3)).clean


def test_a_plane_through_the_poles_of_a_sphere():
    upright = sm.ParametricSurface("0.3*u", "u", "v", u=(-3, 3.1), v=(-3, 3.1), name="wall")
    model = sm.intersect([sphere(name="ball"), upright], keep={"wall": "-ball"})
    assert not model.broken_invariant()
    edges = common_edges(model)
    assert sum(edge.length for edge in edges) == pytest.approx(2.0 * pi, rel=1e-9)
    disc = [face.area for face in model.faces if face.name == "wall"]
    assert sum(disc) == pytest.approx(pi, rel=1e-9)
    assert sm.check(sm.mesh(model, 0.3)).clean


def test_a_curve_that_is_not_followed_closely_is_said():
    # second derivatives of a quadratic spline jump at its knots
    rng = np.random.default_rng(3)
    knots = np.array([0, 0, 0, 0.31, 0.64, 1, 1, 1.0])
    grid = np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)), axis=-1)
    control = np.concatenate([grid, rng.uniform(-0.5, 0.5, (5, 5, 1))], axis=2).swapaxes(0, 1)
    spline = BSplineSurface(
        domain=((0.0, 1.0), (0.0, 1.0)), knots_u=knots, knots_v=knots, control=control, name="hide"
    )
    plane = sm.ParametricSurface("u", "v", "0.4*u + 0.01", u=(-2, 2), v=(-2, 2), name="plane")
    model = sm.intersect([spline, plane])
    loose = [edge for edge in model.edges if edge.tolerance > 2e-10 * model.diagonal]
    said = [sentence for sentence in model.healing if "off its surfaces" in sentence]
    assert len(said) == len([edge for edge in loose if edge.name == "hide/plane"]) > 0


def test_a_small_loop_on_an_offset_surface_is_found():
    turn = (-pi, pi)
    frame = dict(zip(("origin", "x", "y", "z"), np.concatenate([np.zeros((1, 3)), np.eye(3)])))
    basis = Torus(domain=((0.0, 2.0 * pi), turn), radius=3.0, tube=1.0, **frame)
    ring = OffsetSurface(domain=basis.domain, basis=basis, distance=0.5, name="ring")
    c, s, deep = np.cos(0.7), np.sin(0.7), 1e-4  # a plane that cuts a cap of this depth off
    away = 4.5 - deep
    plane = sm.ParametricSurface(
        f"{away * c} - {s}*u", f"{away * s} + {c}*u", "v", u=(-5, 5), v=(-2, 2.1), name="plane"
    )
    model = sm.intersect([ring, plane])
    curves = [edge for edge in model.edges if edge.name == "ring/plane"]
    assert len(curves) == 1 and curves[0].closed and not model.healing
    half = np.sqrt(2.0 * deep * np.array([4.5, 1.5]))  # of the ellipse that it nearly is
    points = curves[0].evaluate(np.linspace(0.0, 1.0, 101))[0]
    across = points @ np.array([-s, c, 0.0])
    assert np.abs(across).max() == pytest.approx(half[0], rel=1e-3)
    assert np.abs(points[:, 2]).max() == pytest.approx(half[1], rel=1e-3)
    off = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 3.0, points[:, 2]) - 1.5
    assert np.abs(off).max() < 1e-10 * model.diagonal
