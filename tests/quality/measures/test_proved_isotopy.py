"""A mesh is isotopic to its surface only where no two of its points can meet on their way."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.proof import prove_isotopy
from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.geometry.core_surface import as_core_surface
from tests.core.proof.test_triangle_bounds import places_of

HOLDS, BENT, NEAR = 0, 1, 2


def answer(surface, chord):
    mesh = sm.mesh(surface, sm.Sizing(chord=chord), strict=False)
    return mesh, sm.check(mesh, prove=True).proof.isotopic


@pytest.mark.parametrize("name, chord", [("torus", 0.02), ("helicoid", 0.01), ("mobius", 0.01)])
def test_simple_surfaces_are(name, chord):
    mesh, found = answer(sm.load(name), chord)
    assert found.answer is True and "than they are apart" in found.because
    moves_less_than_apart(mesh)


def moves_less_than_apart(mesh):
    """By random pairs of points: of the same triangle, of neighbours, of any."""
    from surfmesh._core.proof import curved_pieces

    triangles = np.ascontiguousarray(mesh.triangles)
    table = mesh.connectivity
    corners = np.ascontiguousarray(mesh.points[triangles])
    twins = twins_of(table.half_edges, table.uses, len(triangles))
    face = FaceTriangles(corners, np.ascontiguousarray(mesh.uv), triangles, twins)
    bends = curved_pieces(as_core_surface(mesh.surfaces[0]), *face)
    draw = np.random.default_rng(5)
    weights = draw.dirichlet((1.0, 1.0, 1.0), 3)
    at, _ = places_of(face.uv, bends, weights)
    x = np.einsum("qk,mkd->mqd", weights, corners)
    r = mesh.surfaces[0].evaluate(at.reshape(-1, 2), 0)[0].reshape(x.shape)
    h, m = r - x, len(triangles)
    one = np.repeat(np.arange(m), 3)
    beside = np.where(twins >= 0, twins // 3, one)
    for a, b in ((one, one), (one, beside), (one, draw.integers(0, m, len(one)))):
        p, q = draw.integers(0, 3, (2, len(a)))
        apart = np.linalg.norm(x[a, p] - x[b, q], axis=1)
        assert (np.linalg.norm(h[a, p] - h[b, q], axis=1) <= apart).all()


def roll(gap, turns=2.0):
    """A sheet rolled up, so far from itself."""
    radius = f"(1 + {gap}*u/(2*pi))"
    return sm.ParametricSurface(
        f"{radius}*cos(u)", f"{radius}*sin(u)", "v", u=(0, 2 * np.pi * turns), v=(0, 1)
    )


def test_sheets_that_nearly_touch_are_not():
    _, found = answer(roll(0.02), 0.015)
    assert found.answer is not True
    _, found = answer(roll(0.02), 0.002)
    assert found.answer is True


def test_a_tiny_hole_is_seen_by_way_of_finer_triangles():
    """Of a torus whose hole is as small as its chord: none of its stars is flat there."""
    thick = sm.ParametricSurface(
        "(1 + 0.95*cos(v))*cos(u)", "(1 + 0.95*cos(v))*sin(u)", "0.95*sin(v)",
        u=(0, 2 * np.pi), v=(0, 2 * np.pi),
    )  # fmt: skip
    for chord in (0.05, 0.002):
        _, found = answer(thick, chord)
        assert found.answer is True


def test_what_crosses_itself_is_not():
    eight = sm.ParametricSurface("sin(u)", "sin(2*u)", "v", u=(0, 2 * np.pi), v=(0, 1))
    for chord in (0.05, 0.005):
        _, found = answer(eight, chord)
        assert found.answer is not True


def test_spheres_and_paraboloids_are_with_their_poles():
    paraboloid = sm.ParametricSurface("v*cos(u)", "v*sin(u)", "v^2", u=(0, 2 * np.pi), v=(0, 1))
    for surface, chord in ((sm.load("sphere"), 0.005), (paraboloid, 0.003)):
        _, found = answer(surface, chord)
        assert found.answer is True


def test_a_ball_that_is_covered_twice_is_left_open():
    twice = sm.ParametricSurface(
        "sin(v)*cos(u)", "sin(v)*sin(u)", "cos(v)", u=(0, 4 * np.pi), v=(0, np.pi)
    )
    _, found = answer(twice, 0.01)
    assert found.answer is not True


@pytest.mark.parametrize("a, b, c", [(1.0, 1.5, 1.0), (1.0, 2.0, 1.2), (1.0, 3.0, 1.0)])
def test_ellipsoids_are_by_way_of_finer_triangles_at_their_poles(a, b, c):
    surface = sm.ParametricSurface(
        f"{a}*sin(v)*cos(u)", f"{b}*sin(v)*sin(u)", f"{c}*cos(v)", u=(0, 2 * np.pi), v=(0, np.pi)
    )
    _, found = answer(surface, 0.01)
    assert found.answer is True


def test_cones_are_that_are_not_sharp():
    def cone(radius):
        return sm.ParametricSurface(
            f"{radius}*v*cos(u)", f"{radius}*v*sin(u)", "v", u=(0, 2 * np.pi), v=(0, 1)
        )

    _, found = answer(cone(1.0), 0.003)
    assert found.answer is True
    _, found = answer(cone(0.2), 0.003)
    assert found.answer is not True


def solids():
    cq = pytest.importorskip("cadquery")
    box = cq.Workplane().box(3, 2, 1)
    yield "box", box, True
    yield "filleted box", box.edges().fillet(0.2), True
    yield "hole", box.faces(">Z").workplane().hole(0.6), True
    yield "cone", cq.Workplane().add(cq.Solid.makeCone(1, 0.3, 2)), True
    yield "ends", cq.Workplane().add(cq.Solid.makeCylinder(1, 2)).edges().fillet(0.5), True
    yield "chamfer", cq.Workplane().cylinder(2, 0.5).edges().chamfer(0.1), True
    crossing = cq.Workplane("YZ").cylinder(3, 0.4)
    yield "crossing", cq.Workplane().cylinder(3, 0.5).union(crossing), None


def test_solids_are_where_their_faces_have_one_curve_over_their_sides():
    for name, part, expected in solids():
        model = sm.from_cadquery(part)
        mesh = sm.mesh(model, sm.Sizing(chord=model.diagonal / 1000), jobs=1)
        found = sm.check(mesh, prove=True).proof.isotopic
        assert found.answer is expected, (name, found)
        if expected is None:
            assert "apart along an edge of both" in found.because


def test_a_slot_narrower_than_the_chord_is_left_open():
    cq = pytest.importorskip("cadquery")
    slot = cq.Workplane().cylinder(2, 1.0).cut(cq.Workplane().cylinder(2, 0.5))
    core = cq.Workplane().cylinder(2, 0.49999)
    model = sm.from_cadquery(slot.add(core))
    mesh = sm.mesh(model, sm.Sizing(chord=0.01), jobs=1, strict=False)
    assert sm.check(mesh, prove=True).proof.isotopic.answer is not True


FLAT = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)


@pytest.mark.parametrize("away, fault", [(0.049, HOLDS), (0.051, NEAR)])
def test_two_sheets_a_tenth_apart(away, fault):
    points = np.concatenate([FLAT, FLAT + (0, 0, 0.1)])
    triangles = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)], np.int32)
    found = prove_isotopy(points, triangles, np.full(4, away), np.full(4, 0.3))
    assert found[0] == fault
    if fault:
        assert {found[1] // 2, found[2] // 2} == {0, 1}


def test_stars():
    triangles = np.array([(0, 1, 2), (0, 2, 3)], np.int32)

    def fault(points, slope):
        return prove_isotopy(points, triangles, np.zeros(2), np.full(2, slope))[0]

    assert fault(FLAT, 0.99) == HOLDS and fault(FLAT, 1.0) == BENT
    half_closed = FLAT.copy()
    half_closed[3] = (0.9, 0.5, 0.8)  # folded over along the diagonal
    assert fault(half_closed, 0.9) == BENT
    over = FLAT.copy()
    over[3] = (1.0, 0.1, 0.0)  # on the other one
    assert fault(over, 0.001) == BENT
    inwards = FLAT.copy()
    inwards[2] = (0.2, 0.2, 0.0)  # the quadrilateral has a corner inwards
    assert fault(inwards, 0.6) == HOLDS and fault(inwards, 0.95) == BENT


def test_shapes_are_looked_at():
    triangles = np.array([(0, 1, 2)], np.int32)
    with pytest.raises(ValueError, match="slope"):
        prove_isotopy(FLAT, triangles, np.zeros(1), np.zeros(2))
    with pytest.raises(ValueError, match="out of range"):
        prove_isotopy(FLAT, triangles + 2, np.zeros(1), np.zeros(1))
