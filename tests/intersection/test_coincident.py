"""Inputs whose faces lie on each other: refused with the place, or merged, with exact volumes."""

from math import pi

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import SurfaceError

cq = pytest.importorskip("cadquery")

TURN = (0, "2*pi")


def box(low, high):
    size = np.subtract(high, low).tolist()
    return cq.Workplane().box(*size, centered=False).translate(tuple(map(float, low)))


def rod(x, y, low, high, radius):
    return cq.Workplane().circle(radius).extrude(high - low).translate((x, y, low))


def volume(parts, keep):
    """Of what is kept, which is closed; 0 where nothing is."""
    try:
        model = sm.intersect(parts, keep=keep, coincident="merge")
    except SurfaceError as error:
        assert "nothing is left" in str(error)
        return 0.0
    assert not model.broken_invariant()
    assert all(solid.closed for solid in model.solids)
    return model.volume


PLATE = ((-2, -2, 0), (2, 2, 1))
CASES = {  # parts, volumes of the union and of the common part
    "on": ([box((0, 0, 0), (2, 2, 1)), box((0.5, 0.5, 1), (1.5, 1.5, 2))], 5.0, 0.0),
    "on, flush at two sides": ([box((0, 0, 0), (2, 2, 1)), box((0, 0, 1), (1, 1, 2))], 5.0, 0.0),
    "in, flush": ([box((0, 0, 0), (2, 2, 1)), box((0.5, 0.5, 0.5), (1.5, 1.5, 1))], 4.0, 0.5),
    "in the shape of an L": ([box((0, 0, 0), (2, 1, 1)), box((0, 0, 0), (1, 2, 1))], 3.0, 1.0),
    "the same": ([box((0, 0, 0), (2, 1, 1)), box((0, 0, 0), (2, 1, 1))], 2.0, 2.0),
    "along an edge": ([box((0, 0, 0), (1, 1, 1)), box((1, 1, 0), (2, 2, 1))], 2.0, 0.0),
    "in a corner": ([box((0, 0, 0), (1, 1, 1)), box((1, 1, 1), (2, 2, 2))], 2.0, 0.0),
    "a rod on a plate": ([box(*PLATE), rod(0, 0, 1, 2, 1)], 16.0 + pi, 0.0),
    "a rod in a plate": ([box(*PLATE), rod(0, 0, 0, 1, 1)], 16.0, pi),
    "a rod over the edge": ([box(*PLATE), rod(2, 0, 0, 1, 1)], 16.0 + pi / 2.0, pi / 2.0),
    "a rod at the corner": ([box(*PLATE), rod(2, 2, 0, 1, 1)], 16.0 + 0.75 * pi, 0.25 * pi),
    "rods on one axis": ([rod(0, 0, 0, 2, 1), rod(0, 0, 1, 3, 1)], 3.0 * pi, pi),
    "rods end to end": ([rod(0, 0, 0, 2, 1), rod(0, 0, 2, 3, 1)], 3.0 * pi, 0.0),
    "a rod that touches four edges": (
        [box((-1, -1, 0), (1, 1, 1)), rod(0, 0, 0, 1, 1)], 4.0, pi
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_volumes_of_what_is_kept_are_exact(name):
    parts, union, common = CASES[name]
    first = sm.intersect([parts[0], box((9, 9, 9), (10, 10, 10))], keep="difference").volume
    assert volume(parts, "union") == pytest.approx(union, rel=1e-9)
    assert volume(parts, "common") == pytest.approx(common, rel=1e-9)
    assert volume(parts, "difference") == pytest.approx(first - common, rel=1e-9)


CORNER = st.integers(0, 3)
BOX = st.tuples(*[st.tuples(CORNER, st.integers(1, 2)) for _ in range(3)])


def of_lattice(spans):
    return [low for low, _ in spans], [low + length for low, length in spans]


def shared(one, other):
    sides = [min(b, d) - max(a, c) for a, b, c, d in zip(*one, *other)]
    return float(np.prod(np.maximum(sides, 0)))


@settings(
    max_examples=12, deadline=None, derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)  # fmt: skip
@given(BOX, BOX)
def test_boxes_on_a_lattice_have_their_volumes(one, other):
    one, other = of_lattice(one), of_lattice(other)
    sizes = [float(np.prod(np.subtract(high, low))) for low, high in (one, other)]
    parts = [box(*one), box(*other)]
    common = shared(one, other)
    assert volume(parts, "union") == pytest.approx(sum(sizes) - common, rel=1e-12)
    assert volume(parts, "common") == pytest.approx(common, rel=1e-12)
    assert volume(parts, "difference") == pytest.approx(sizes[0] - common, rel=1e-12)


@settings(
    max_examples=8, deadline=None, derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)  # fmt: skip
@given(st.integers(-1, 5), st.integers(-1, 5), st.integers(-2, 2), st.integers(1, 4),
       st.sampled_from([0.5, 1.0, 1.5, 2.0]))  # fmt: skip
def test_rods_on_a_lattice_have_their_volumes_with_a_plate(x, y, low, length, radius):
    parts = [box((0, 0, 0), (4, 4, 2)), rod(x, y, low, low + length, radius)]
    common = volume(parts, "common")
    own = pi * radius**2 * length
    assert volume(parts, "union") + common == pytest.approx(32.0 + own, rel=1e-9)
    assert volume(parts, "difference") + common == pytest.approx(32.0, rel=1e-9)


def test_three_boxes_share_a_corner():
    parts = [box((0, 0, 0), (1, 1, 1)), box((1, 0, 0), (2, 1, 1)), box((0, 1, 0), (2, 2, 1))]
    assert volume(parts, "union") == pytest.approx(4.0)
    everything = sm.intersect(parts, coincident="merge")
    assert len(everything.faces) == 18 - 3 + 1  # three are shared; one is cut in two by the others
    assert sum(face.area for face in everything.faces) == pytest.approx(6.0 + 6.0 + 10.0 - 3.0)


def test_coincident_patches_are_refused_with_the_place():
    parts = [box((0, 0, 0), (2, 2, 1)), box((0.5, 0.5, 1), (1.5, 1.5, 2))]
    with pytest.raises(SurfaceError, match=r"coincide on a patch through \(.*, 1\): coincident="):
        sm.intersect(parts)
    with pytest.raises(SurfaceError, match="coincident='join': one of refuse, merge"):
        sm.intersect(parts, coincident="join")


def test_a_merged_patch_is_of_both_and_its_mesh_is_shared():
    parts = [box((0, 0, 0), (2, 2, 1)), box((0.5, 0.5, 1), (1.5, 1.5, 2))]
    model = sm.intersect(parts, coincident="merge")
    tags = [set(tag.faces) for tag in model.tags if "+" not in tag.name and "-" not in tag.name]
    (both,) = tags[0] & tags[1]
    assert model.faces[both].area == pytest.approx(1.0)
    mesh = sm.mesh(model, 0.3)
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert (mesh.connectivity.uses == 3).sum() >= 12  # along the border of what is shared


SHEETS = {
    "planes that overlap": (("u", "v", "0"), ("u + 1", "v + 0.5", "0"), 12.0 + 4.0),
    "a plane turned in itself": (
        ("u", "v", "0"), ("0.8*u - 0.6*v", "0.6*u + 0.8*v", "0"), 16.0 + 8.0 / 3.0
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SHEETS)
def test_sheets_that_overlap_share_a_patch(name):
    one, other, area = SHEETS[name]
    span = {"u": (-2, 2), "v": (-2, 2)}
    sheets = [
        sm.ParametricSurface(*one, **span, name="a"),
        sm.ParametricSurface(*other, **span, name="b"),
    ]
    model = sm.intersect(sheets, coincident="merge")
    assert not model.broken_invariant()
    if name.startswith("planes"):
        area = 32.0 - 3.0 * 3.5
    assert sum(face.area for face in model.faces) == pytest.approx(area, rel=1e-9)
    assert [face.name for face in model.faces].count("a + b") == 1
    assert sm.check(sm.mesh(model, 0.4)).clean


def test_a_saddle_overlaps_itself():
    sheets = [
        sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=(-1, 1), name="a"),
        sm.ParametricSurface("u", "v", "u*v", u=(-0.5, 1.5), v=(-0.5, 1.5), name="b"),
    ]
    model = sm.intersect(sheets, coincident="merge")
    assert not model.broken_invariant() and len(model.faces) == 3
    whole = sm.intersect([sheets[0], sm.ParametricSurface("u", "v", "9", u=(0, 1), v=(0, 1))])
    one = sum(face.area for face in model.faces if "a" in face.name)
    assert one == pytest.approx(whole.faces[0].area, rel=1e-9)


def test_a_sphere_is_itself_however_it_is_turned():
    def ball(x, y, z, name):
        return sm.ParametricSurface(x, y, z, u=TURN, v=("-pi/2", "pi/2"), name=name)

    upright = ball("cos(u)*cos(v)", "sin(u)*cos(v)", "sin(v)", "a")
    turned = ball("sin(v)", "cos(u)*cos(v)", "sin(u)*cos(v)", "b")
    for other in (ball("cos(u)*cos(v)", "sin(u)*cos(v)", "sin(v)", "b"), turned):
        model = sm.intersect([upright, other], keep="union", coincident="merge")
        assert model.volume == pytest.approx(4.0 * pi / 3.0, rel=1e-9)
        assert len(model.faces) == 1
