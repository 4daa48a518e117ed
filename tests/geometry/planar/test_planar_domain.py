"""Domains from arrays, shapely and SVG: what is inside, how far things are, what is refused."""

import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import plane_graph

import surfmesh as sm
from surfmesh.errors import DomainError
from surfmesh.geometry.surface import Surface

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)

REFUSED = {
    "nothing": ([], "there is no outer loop"),
    "two points": ([[0, 0], [1, 1]], "outer loop 0 has 2 distinct points"),
    "repeated": ([[0, 0], [1, 1], [0, 0], [1, 1]], "outer loop 0 has 2 distinct points"),
    "collinear": ([[0, 0], [1, 1], [2, 2]], "outer loop 0 encloses no area"),
    "nan": ([SQUARE, [[0, 0], [1, np.nan], [1, 1]]], "outer loop 1, point 1 is not finite"),
    "infinite": ([[0, 0], [1, np.inf], [1, 1]], "outer loop 0, point 1 is not finite"),
    "huge": (1e300 * SQUARE, "outer loop 0: the point .* is too far away"),
    "text": ("square", "an array .* or several are needed, not 'square'"),
    "number": (3, "an array .* or several are needed, not 3"),
    "none": (None, "an array .* or several are needed, not None"),
    "names": ([["a", "b"]], r"outer loop 0 is not an array \(k, 2\) of numbers"),
    "complex": (SQUARE * 1j, r"outer loop 0 is not an array \(k, 2\) of numbers"),
    "ragged": ([[[0, 0], [1, 0], [1]]], r"outer loop 0 is not an array \(k, 2\) of numbers"),
    "space": ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], r"outer loop 0 has shape \(3, 3\)"),
    "deep": (np.zeros((2, 2, 2, 2)), r"outer loop 0 has shape \(2, 2, 2\)"),
    "empty": ([SQUARE, []], "outer loop 1 holds no points"),
    "bow tie": (SQUARE[[0, 2, 1, 3]], "outer loop 0, segment . crosses outer loop 0, segment ."),
    "shapely": (shapely.box(0, 0, 1, 1), "from_shapely"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    outer, reason = REFUSED[case]
    with pytest.raises(DomainError, match=reason) as error:
        sm.PlanarDomain(outer)
    assert isinstance(error.value, ValueError)


def test_other_arguments_are_refused_by_name():
    for arguments, reason in (
        (dict(holes=[[[0, 0], [1, 0]]]), "hole 0 has 2 distinct points"),
        (dict(constraints=[[[0, 0], [np.nan, 0]]]), "constraint 0, point 1 is not finite"),
        (dict(points=[(0, 0, 0)]), r"the array of points has shape \(1, 3\)"),
        (dict(points=3), "points are an array"),
        (dict(crossings="ignore"), 'crossings is "refuse" or "split"'),
    ):
        with pytest.raises(DomainError, match=reason):
            sm.PlanarDomain(SQUARE, **arguments)


def test_a_domain_is_a_surface_of_the_plane():
    domain = sm.PlanarDomain(3 * SQUARE - 1, [SQUARE], name="frame")
    assert isinstance(domain, Surface)
    assert (domain.name, domain.domain, domain.loops) == ("frame", ((-1, 2), (-1, 2)), ())
    r, r_u, r_v, r_uu, r_uv, r_vv = domain.evaluate([[0.5, 2.0]], 2)
    assert (r.tolist(), r_u.tolist(), r_v.tolist()) == ([[0.5, 2, 0]], [[1, 0, 0]], [[0, 1, 0]])
    assert not np.any([r_uu, r_uv, r_vv])
    lower, upper = domain.derivative_bounds(np.zeros((3, 2)), np.ones((3, 2)))
    exact = np.stack([np.concatenate([r_u, r_v, r_uu, r_uv, r_vv])] * 3)
    assert np.array_equal(lower, exact) and np.array_equal(upper, exact)


def test_it_does_not_change_and_travels():
    domain = sm.PlanarDomain(SQUARE, points=[(0.5, 0.5)], sizing_defaults={"size": 0.1})
    with pytest.raises(AttributeError, match="does not change"):
        domain.name = "other"
    with pytest.raises(ValueError, match="read-only"):
        domain.outer[0][0] = 7
    domain.distance([[0.0, 0.0]])
    twin = pickle.loads(pickle.dumps(domain))
    assert np.array_equal(twin.graph.segments, domain.graph.segments)
    assert twin.sizing_defaults == {"size": 0.1} and twin.area == 1.0


def test_what_was_given_is_not_changed():
    given = SQUARE.copy()
    sm.PlanarDomain(given)
    given[0] = -1.0
    assert given.flags.writeable


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("closed", [False, True])
def test_islands_in_holes(direction, closed):
    def loop(factor):
        points = (factor * (SQUARE - 0.5))[::direction]
        return np.concatenate([points, points[:1]]) if closed else points

    domain = sm.PlanarDomain([loop(8), loop(4)], [loop(6), loop(2)])
    assert (domain.area, domain.regions, domain.warnings) == (64 - 36 + 16 - 4, 2, ())
    assert len(domain.outer[0]) == 4
    nested = sm.PlanarDomain.from_loops([loop(2), loop(8), loop(4), loop(6)])
    assert (nested.area, nested.regions) == (domain.area, 2)
    assert [hole[:, 0].max() for hole in nested.holes] == [1, 3]


def test_equal_loops_cancel_by_even_odd():
    with_twin = sm.PlanarDomain.from_loops([4 * SQUARE, 1 + SQUARE, 1 + SQUARE])
    assert with_twin.area == 16.0


def test_shapes_of_input():
    """One loop or several, as arrays, tuples, lists."""
    loop = [(0, 0), (1, 0), (1, 1)]
    for outer in (loop, [loop], tuple(loop), np.array(loop), np.array([loop]), iter([loop])):
        assert sm.PlanarDomain(outer).area == 0.5
    domain = sm.PlanarDomain(SQUARE, (), [(0, 0), (1, 1)], (0.5, 0.25))
    assert len(domain.constraints) == 1 and domain.points.tolist() == [[0.5, 0.25]]


def test_a_bow_tie_has_two_parts_when_split():
    domain = sm.PlanarDomain(SQUARE[[0, 2, 1, 3]], crossings="split")
    assert domain.area == pytest.approx(0.5) and domain.regions == 2


def test_idle_holes_are_warned_of():
    domain = sm.PlanarDomain(SQUARE, [0.25 + 0.5 * SQUARE, 3 + SQUARE])
    assert domain.warnings == ("hole 1 lies outside all outer loops and has no effect",)
    assert "far from the origin" in sm.PlanarDomain(SQUARE + 1e9).warnings[0]


def test_constraints_outside_change_nothing_inside():
    domain = sm.PlanarDomain(SQUARE, constraints=[[[2, 0], [3, 0]]])
    assert domain.area == 1.0 and domain.domain[0] == (0, 3)


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_distance(seed):
    random = np.random.default_rng(seed)
    lines = random.uniform(-2, 3, (60, 2, 2))
    domain = sm.PlanarDomain(SQUARE, [], lines, random.uniform(-2, 3, (9, 2)), crossings="split")
    probes = random.uniform(-3, 4, (20, 2))
    starts = np.concatenate([SQUARE, lines[:, 0], domain.points])
    ends = np.concatenate([np.roll(SQUARE, -1, axis=0), lines[:, 1], domain.points])
    expected = [plane_graph.distance(p, starts, ends) for p in probes]
    assert domain.distance(probes) == pytest.approx(expected, abs=1e-11)
    lifted = np.column_stack([probes, np.full(20, 2.0)])
    assert domain.distance(lifted) == pytest.approx(np.hypot(expected, 2.0), abs=1e-11)


def test_from_shapely():
    pierced = shapely.box(0, 0, 4, 4).difference(shapely.box(1, 1, 2, 2))
    parts = shapely.MultiPolygon([pierced, shapely.box(5, 0, 6, 1)])
    assert sm.PlanarDomain.from_shapely(parts).area == 16.0
    everything = shapely.GeometryCollection(
        [parts, shapely.MultiLineString([[(0, 3), (4, 3)], [(2, 3), (2, 4)]]), shapely.Point(3, 1)]
    )
    more = shapely.LineString([(2.5, 0), (2.5, 1)])
    domain = sm.PlanarDomain.from_shapely(everything, constraints=more, points=[(1, 3.5)])
    assert len(domain.constraints) == 3 and domain.points.tolist() == [[3, 1], [1, 3.5]]
    assert (domain.area, domain.regions) == (16.0, 4)
    with pytest.raises(DomainError, match="holds no polygon"):
        sm.PlanarDomain.from_shapely(more)
    with pytest.raises(DomainError, match="a shapely geometry is needed, not ndarray"):
        sm.PlanarDomain.from_shapely(SQUARE)


SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="40mm" viewBox="0 0 160 80">
<g transform="translate(10 20)"><rect width="100" height="50"/></g>
<circle cx="60" cy="45" r="{radius}"/>
<path d="M 20 30 L 30 30 M 20 60 C 20 50 30 50 30 60 Q 40 70 35 60"/>
</svg>"""


@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 1e-5])
def test_from_svg(tolerance, tmp_path):
    path = tmp_path / "plate.svg"
    path.write_text(SVG.format(radius=20))
    domain = sm.PlanarDomain.from_svg(path, tolerance)
    assert domain.name == "plate" and len(domain.constraints) == 2
    # user units, y upwards
    assert np.array(domain.domain) == pytest.approx(np.array([(10, 110), (-70, -20)]))
    outer, hole = domain.outer[0], domain.holes[0]
    corners = {tuple(corner) for corner in np.round(outer, 9)}
    assert corners == {(10, -70), (10, -20), (110, -70), (110, -20)}
    radius = np.hypot(*(hole - (60, -45)).T)
    assert radius == pytest.approx(20.0)
    middle = 0.5 * (hole + np.roll(hole, -1, axis=0))
    sagitta = 20 - np.hypot(*(middle - (60, -45)).T)
    assert 0.2 * tolerance < sagitta.max() <= tolerance
    text = sm.PlanarDomain.from_svg(SVG.format(radius=20), tolerance)
    assert text.area == domain.area


def test_svg_tolerance_follows_the_drawing():
    def pieces(radius):
        return len(sm.PlanarDomain.from_svg(SVG.format(radius=radius)).holes[0])

    assert pieces(20) > pieces(5) >= 8


def test_svg_that_is_refused(tmp_path):
    for text, reason in (
        ("<svg", "not an SVG drawing"),
        ('<svg xmlns="http://www.w3.org/2000/svg"/>', "holds no closed path"),
        (str(tmp_path / "absent.svg"), "no such file"),
    ):
        with pytest.raises(DomainError, match=reason):
            sm.PlanarDomain.from_svg(text)
    with pytest.raises(DomainError, match="tolerance must be a positive number, not -1"):
        sm.PlanarDomain.from_svg(SVG.format(radius=20), -1)
    with pytest.raises(DomainError, match="far too small"):
        sm.PlanarDomain.from_svg(SVG.format(radius=20), 1e-30)
