"""Section 2: the reference packs the same circles and triangles as the fast code."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.random_packing import RandomPacking
from naive.relaxed_packing import RelaxedPacking

import surfmesh as sm
from surfmesh.circle_packing import FREE_GROWTH
from surfmesh.geometry.planar.planar_domain import PlanarRegion
from surfmesh.reference.field_packing import Limits
from surfmesh.reference.size_tensors import SizeTensor, common_step, length, orient
from surfmesh.sizing.field.size_field import plane_field

BOX = (-1.5, -1.0, 1.5, 1.0)


def assert_same(front, packing, shift=0j):
    front.advance()
    centres = np.array(front.points) + shift
    scale = abs(centres).max()
    assert len(centres) == len(packing.centres)
    assert np.allclose(centres, packing.centres @ [1, 1j], rtol=0, atol=1e-9 * scale)
    assert np.allclose(front.sizes, packing.tensors, rtol=1e-9, atol=1e-9 * scale)
    assert rotated(front.triangles[t] for t in done(front)) == rotated(packing.triangles.tolist())
    fronts = ((a, b) for a, b in zip(packing.front.tolist(), np.roll(packing.front, -1).tolist()))
    assert dict(fronts) == front.next


def done(front):
    """The numbers of the triangles inside the front."""
    return front.patch(front.left[edge] for edge in front.next.items())


def rotated(triangles):
    """A set of triangles, each from its least corner on."""
    firsts = ((t, tuple(t).index(min(t))) for t in triangles)
    return {(t[k], t[(k + 1) % 3], t[(k + 2) % 3]) for t, k in firsts}


def assert_same_random(lo, hi, seed, **limits):
    law = sm.UniformRadius(lo, hi, seed=seed)
    radii = iter(law.stream()(2000).tolist())
    limit = Limits(circles=limits.get("count", math.inf), distance=limits.get("distance", math.inf))
    assert_same(RandomPacking(radii, limit), sm.pack(law, **limits))


@pytest.mark.parametrize("hi, seed", [(1.0, 0), (2.0, 1), (10.0, 2), (100.0, 3), (1000.0, 4)])
def test_radii_drawn_at_random(hi, seed):
    assert_same_random(1.0, hi, seed, count=150)


def test_a_polygon_closed_in_part():
    """Once a supporting circle had left the front in the middle of its own step."""
    assert_same_random(1.0, 1000.0, 3, count=200)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**31), st.floats(1.0, 200.0))
def test_any_radii_drawn_at_random(seed, hi):
    assert_same_random(1.0, hi, seed, count=50)


def test_a_packing_ends_at_a_distance():
    assert_same_random(1.0, 3.0, 5, distance=15.0)


def uniform(p):
    return np.full(len(p), 0.137)


def graded(p):
    return 0.04 + 0.2 * np.hypot(p[:, 0] - 0.3, p[:, 1] + 0.2)


def stretched(p):
    """Longer along one direction, which turns, than across."""
    c, s = np.cos(p[:, 0]), np.sin(p[:, 0])
    across, along = 0.15 + 0.05 * p[:, 1] ** 2, np.full(len(p), 0.4)
    rows = across * c * c + along * s * s, (across - along) * c * s, across * s * s + along * c * c
    return np.stack(rows, axis=1)


def tensors_of(law):
    return lambda p: np.stack([2.0 * law(p), np.zeros(len(p)), 2.0 * law(p)], axis=1)


LAWS = {
    "uniform": (uniform, tensors_of(uniform)),
    "graded": (graded, tensors_of(graded)),
    "stretched": (sm.TensorField(stretched), stretched),
}


@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.11, 0.05)])
@pytest.mark.parametrize("law", LAWS)
def test_sizes_read_from_a_field(law, origin):
    """The field is surfmesh's own, laid over the box; its plane starts at a corner."""
    radius, tensors = LAWS[law]
    x0, y0, x1, y1 = BOX
    field = plane_field(PlanarRegion("box", ((x0, x1), (y0, y1))), tensors, FREE_GROWTH)

    def size(p):
        return SizeTensor(*field.tensors(np.array([[p.real, p.imag]]))[0].tolist())

    corner = complex(x0, y0)
    limits = Limits(complex(*origin) - corner, box=(0j, complex(x1, y1) - corner))
    assert_same(RelaxedPacking(size, limits), sm.pack(radius, origin, box=BOX), corner)


near = st.floats(-1.0, 1.0).map(lambda x: round(x, 6))


@settings(max_examples=50, deadline=None)
@given(st.tuples(near, near), st.floats(0.2, 2.0), st.floats(0.2, 2.0), st.floats(0.2, 2.0))
def test_a_circle_that_touches_three(turn, ra, rb, rc):
    """Apollonius: tangent to all three, from outside."""
    direction = complex(*turn)
    if abs(direction) < 0.1:
        return
    packing = RandomPacking(iter([ra, rb, rc]), Limits())
    packing.points = [p * direction / abs(direction) + complex(*turn) for p in packing.points]
    centre, r = packing.touch_three(0, 1, 2)
    for v in range(3):
        assert length(centre - packing.points[v]) == pytest.approx(r + packing.radius(v))
    centre, r = packing.touch_two(1, 0, rc)
    assert r == rc
    for v in range(2):
        assert length(centre - packing.points[v]) == pytest.approx(r + packing.radius(v))


def test_orientation_is_exact():
    tiny = 2.0**-52
    assert orient(0j, 1 + 1j, 0.5 + (0.5 + tiny) * 1j) > 0
    assert orient(0j, complex(0.1, 0.3), complex(0.2, 0.6)) == 0
    assert isinstance(orient(0j, 1 + 0j, 1j), Fraction)


def test_parallel_lines_have_no_common_step():
    assert common_step(1 + 1j, 1.0, 2 + 2j, 3.0, 0.0) is None
    assert common_step(1 + 0j, 2.0, 1j, 3.0, 1e-9) == 2 + 3j
