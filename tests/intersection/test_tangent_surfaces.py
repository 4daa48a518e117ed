"""Surfaces that touch along curves and in points, and edges that lie on the other surface."""

from math import pi

import numpy as np
import pytest

import surfmesh as sm

TURN = (0, "2*pi")


def surface(x, y, z, u, v):
    """What a surface is made of; its name comes later."""
    return {"x": x, "y": y, "z": z, "u": u, "v": v}


def ball(x=0.0, y=0.0, z=0.0, radius=1.0):
    return surface(
        f"{x} + {radius}*cos(u)*cos(v)", f"{y} + {radius}*sin(u)*cos(v)", f"{z} + {radius}*sin(v)",
        TURN, ("-pi/2", "pi/2"),
    )  # fmt: skip


def tube(half=2.0):
    return surface("cos(u)", "sin(u)", "v", TURN, (-half, half))


def plane(x, y, z, half=3.0):
    return surface(x, y, z, (-half, 1.01 * half), (-half, half))


def common(model):
    """Edges that faces of two inputs share."""
    sources = {k: tag.name for tag in model.tags if tag.name in ("a", "b") for k in tag.faces}
    return [
        edge for number, edge in enumerate(model.edges)
        if {"a", "b"} <= {sources.get(face) for face in model.faces_of_edge(number)}
    ]  # fmt: skip


def called(one, other):
    """Two surfaces called a and b."""
    return [sm.ParametricSurface(**one, name="a"), sm.ParametricSurface(**other, name="b")]


def met(one, other):
    """Both, called a and b, as a checked model with a clean mesh."""
    model = sm.intersect(called(one, other))
    assert not model.broken_invariant()
    report = sm.check(sm.mesh(model, 0.4))
    assert report.clean, report.problems
    return model


TORUS = surface("(3 + cos(v))*cos(u)", "(3 + cos(v))*sin(u)", "sin(v)", TURN, TURN)
LYING = {  # surfaces, length of their common curve
    "torus, plane of its seam": (TORUS, plane("u", "v", "0", 5.0), 12.0 * pi),
    "torus, plane of a meridian": (TORUS, plane("u", "0", "v", 5.0), 4.0 * pi),
    "ball, plane of its seam": (ball(), plane("u", "0", "v"), 2.0 * pi),
    "ball, plane of its equator": (ball(), plane("u", "v", "0"), 2.0 * pi),
    "tube, plane of its axis and seam": (tube(), plane("u", "0", "v"), 8.0),
    "tube, plane of its end": (tube(), plane("u", "v", "2"), 2.0 * pi),
    "plane, edge of another": (
        plane("u", "v", "0"), surface("u", "0.3*u", "v", (-1, 1), (0, 1)),
        2.0 * np.hypot(1.0, 0.3),
    ),
    "plane, edge to edge": (
        plane("u", "v", "0"), surface("3.03", "u", "v", (-4, 1), (0, 1)), 4.0
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LYING)
def test_an_edge_on_the_other_surface_is_the_curve(name):
    one, other, length = LYING[name]
    model = met(one, other)
    assert sum(edge.length for edge in common(model)) == pytest.approx(length, rel=1e-9)


def test_the_seam_of_a_body_lies_in_a_plane():
    cq = pytest.importorskip("cadquery")
    rod = cq.Workplane().circle(1.0).extrude(2.0)
    wall = sm.ParametricSurface("u", "0", "v", u=(-2, 2.1), v=(-1, 3), name="wall")
    model = sm.intersect([rod, wall], keep={"wall": "-0"})
    assert not model.broken_invariant()
    (inside,) = (face for face in model.faces if face.name == "wall")
    assert inside.area == pytest.approx(4.0, rel=1e-9)
    seam = [k for k, edge in enumerate(model.edges) if len(model.faces_of_edge(k)) == 3]
    assert sum(model.edges[k].length for k in seam) == pytest.approx(8.0, rel=1e-9)
    assert sm.check(sm.mesh(model, 0.3)).clean


TOUCHING = {  # surfaces, length of the curve along which they touch, distance from it
    "torus, plane on its top": (
        TORUS, plane("u", "v", "1", 5.0), 6.0 * pi, lambda p: np.hypot(*p[:, :2].T) - 3.0
    ),
    "ball in a tube": (ball(), tube(), 2.0 * pi, lambda p: p[:, 2]),
    "tube, plane on its seam": (tube(), plane("1", "u", "v"), 4.0, lambda p: p[:, 1]),
    "tube, plane aside": (tube(), plane("u", "-1", "v"), 4.0, lambda p: p[:, 0]),
}  # fmt: skip


@pytest.mark.parametrize("name", TOUCHING)
def test_surfaces_touch_along_a_curve(name):
    one, other, length, off = TOUCHING[name]
    model = met(one, other)
    edges = common(model)
    assert sum(edge.length for edge in edges) == pytest.approx(length, rel=1e-9)
    for edge in edges:
        points = edge.evaluate(np.linspace(0.0, 1.0, 101))[0]
        assert np.abs(off(points)).max() < 1e-8
    tags = {tag.name for tag in model.tags}
    assert "a-b" not in tags or "a+b" not in tags or name == "ball in a tube"


POINTS = {
    "spheres side by side": (ball(0.1, 0.2, 0.0), ball(0.1, 0.2 + 1.6, 1.2)),
    "a sphere in another": (ball(radius=2.0), ball(0.0, 0.6, 0.8)),
    "a bowl on a plane": (
        surface("u", "v", "u**2 + v**2", (-1, 1.1), (-1, 1)), plane("u", "v", "0")
    ),
    "a pole on a plane": (ball(), plane("u", "v", "1")),
}  # fmt: skip


@pytest.mark.parametrize("name", POINTS)
def test_a_touch_in_a_point_leaves_both_as_they_are(name):
    one, other = POINTS[name]
    model = sm.intersect(called(one, other))
    assert not model.broken_invariant() and len(model.faces) == 2
    if "pole" not in name:
        assert any("a and b touch at (" in sentence for sentence in model.healing)


def test_balls_that_touch_have_both_volumes():
    model = sm.intersect(called(ball(), ball(0.0, 1.2, 1.6)), keep="union")
    assert model.volume == pytest.approx(8.0 * pi / 3.0, rel=1e-9)
    assert len(model.solids) == 2


def test_a_saddle_crosses_its_tangent_plane_in_two_curves():
    saddle = surface("u", "v", "u*u - v*v", (-1, 1.1), (-1.2, 1))
    model = met(saddle, plane("u", "v", "0", 1.5))
    edges = common(model)
    ends = np.bincount([vertex for edge in edges for vertex in (edge.start, edge.end)])
    assert len(edges) == 4 and ends.max() == 4
    for edge in edges:
        x, y, _ = edge.evaluate(np.linspace(0.0, 1.0, 51))[0].T
        assert np.abs(np.abs(x) - np.abs(y)).max() < 1e-9


@pytest.mark.parametrize("size", [0.6, 0.4])
def test_the_circles_of_villarceau_have_a_clean_mesh(size):
    slope = np.tan(np.arcsin(1.0 / 3.0))
    model = sm.intersect(called(TORUS, plane("u", "v", f"{slope}*u", 5.0)))
    edges = common(model)
    assert sum(edge.length for edge in edges) == pytest.approx(12.0 * pi, rel=1e-9)
    report = sm.check(sm.mesh(model, size))
    assert report.clean, report.problems
