"""Outlines from maps: points almost equal are merged, lines finer than wanted are thinned."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm

SQUARE = np.array([(0, 0), (4, 0), (4, 3), (0, 3)], float)


def coast(points=1500, seed=5, radius=5000.0):
    rng = np.random.default_rng(seed)
    t, k = np.linspace(0, 2 * np.pi, points, endpoint=False), np.arange(2, 120)[:, None]
    waves = rng.normal(size=k.shape) / k**1.25 * np.cos(k * t + rng.uniform(0, 6.3, k.shape))
    r = radius * (1 + 0.19 * waves.sum(axis=0))
    return np.column_stack([r * np.cos(t), r * np.sin(t)])


def shoelace(loop):
    x, y = loop.T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_points_almost_equal_are_merged_with_a_word(scale):
    outline = scale * coast()
    outline[700] = outline[699] + [scale * 1e-7, 0]
    domain = sm.PlanarDomain(outline)
    assert len(domain.graph.points) == len(outline) - 1
    assert "outer loop 0, point 700" in domain.warnings[0]
    assert "1 point lies within" in domain.warnings[0]
    assert domain.area == pytest.approx(shoelace(outline), rel=1e-9)


def test_equal_points_are_not_worth_a_word():
    doubled = np.repeat(coast(), 2, axis=0)
    assert sm.PlanarDomain(doubled).warnings == ()


def test_a_point_beside_a_line_of_another_part_lies_on_it():
    right = SQUARE + [4, 0]
    right = np.insert(right, 4, [4 + 1e-10, 1.5], axis=0)
    domain = sm.PlanarDomain([SQUARE, right], name="two parts")
    assert domain.regions == 2
    assert domain.area == pytest.approx(24)
    report = sm.check(sm.mesh(domain, 0.5))
    assert report.clean and report.triangles < 400


def test_a_distance_of_merging_may_be_stated():
    outline = np.insert(SQUARE, 1, [1e-3, 0], axis=0)
    assert len(sm.PlanarDomain(outline).graph.points) == 5
    wider = sm.PlanarDomain(outline, merge=0.01)
    assert len(wider.graph.points) == 4 and "merge=0.01" in wider.warnings[0]


def test_a_dense_line_is_not_merged_into_one_point():
    t = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    ring = sm.PlanarDomain(np.column_stack([np.cos(t), np.sin(t)]), merge=0.01)
    assert 300 < len(ring.graph.points) < 1000
    assert ring.area == pytest.approx(np.pi, rel=0.02)


@pytest.mark.parametrize("name", ["merge", "simplify"])
@pytest.mark.parametrize("value", [0, -1.0, np.nan, np.inf, "far"])
def test_distances_are_positive(name, value):
    with pytest.raises(sm.errors.DomainError, match=name):
        sm.PlanarDomain(SQUARE, **{name: value})


def test_an_outline_finer_than_the_sizes_is_said_and_can_be_thinned():
    outline = coast()
    sizing = sm.Sizing(max_size=400, min_size=200)
    domain = sm.PlanarDomain(outline)
    assert "simplify=True" in sm.check(sm.mesh(domain, sizing)).warnings[-1]
    thin = sm.check(sm.mesh(domain, sizing, simplify=True))
    assert thin.clean and thin.alpha_min > 0.5 and thin.quasi_unit_share > 0.97
    assert thin.area == pytest.approx(shoelace(outline), rel=2e-3)
    assert "thinned from 1,500" in thin.warnings[0]


def test_nothing_is_said_where_nothing_is_thinned():
    assert sm.PlanarDomain(SQUARE, simplify=1e-3).warnings == ()
    assert sm.PlanarDomain(SQUARE).simplified(1e-3).warnings == ()


@given(st.integers(0, 10_000), st.integers(20, 400), st.floats(1e-4, 0.05), st.booleans())
@settings(max_examples=25, deadline=None)
def test_thinned_lines_stay_near_and_keep_their_regions(seed, count, fraction, holed):
    import shapely

    outline = coast(count, seed)
    assert shapely.Polygon(outline).is_valid
    holes = [0.2 * coast(count, seed + 1)] if holed else []
    walls = [np.array([outline[0], outline[0] * 1.5])]
    domain = sm.PlanarDomain(outline, holes, walls, outline[count // 2][None])
    distance = fraction * 5000
    try:
        thin = domain.simplified(distance)
    except sm.errors.DomainError as error:
        assert "smaller distance" in str(error)
        return
    assert thin.graph.broken_invariant() is None
    assert thin.regions == domain.regions
    assert len(thin.graph.points) <= len(domain.graph.points)
    graphs = (domain.graph, thin.graph)
    lines = [shapely.MultiLineString(list(g.points[g.segments])) for g in graphs]
    assert shapely.hausdorff_distance(*lines, densify=0.5) <= distance * (1 + 1e-9)
    kept = np.linalg.norm(thin.graph.points - outline[count // 2], axis=1).min()
    assert kept == 0.0


def test_corners_junctions_and_ends_stay():
    fine = np.linspace(0, 1, 20)[:, None]
    sides = zip(SQUARE, np.roll(SQUARE, -1, axis=0))
    square = np.concatenate([a + fine[:-1] * (b - a) for a, b in sides])
    wall = np.array([1.0, 0]) + fine * [0, 2.0]
    domain = sm.PlanarDomain(square, constraints=[wall], points=[(4, 1.5)], simplify=0.01)
    expected = {(0, 0), (4, 0), (4, 3), (0, 3), (1, 0), (1, 2), (4, 1.5)}
    assert set(map(tuple, domain.graph.points.round(9).tolist())) == expected


def test_small_rings_do_not_vanish():
    t = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.column_stack([2 + 0.01 * np.cos(t), 1 + 0.01 * np.sin(t)])
    domain = sm.PlanarDomain(SQUARE, holes=[ring], simplify=0.1)
    assert len(domain.graph.points) == 4 + 3
    assert sm.check(sm.mesh(domain, 1.0)).euler == 0


def test_what_would_be_passed_over_is_refused():
    t = np.linspace(0, np.pi, 50)
    dome = np.column_stack([np.cos(t), np.sin(t)])
    domain = sm.PlanarDomain(dome, points=[(0, 0.97)])
    with pytest.raises(sm.errors.DomainError, match="smaller distance"):
        domain.simplified(0.9)


def test_a_hole_outside_has_no_effect_and_is_said():
    domain = sm.PlanarDomain(SQUARE, holes=[SQUARE + 10])
    assert "hole 0 lies outside all outer loops" in sm.mesh(domain, 1.0).warnings[0]


def test_files_may_state_both(tmp_path):
    path = tmp_path / "square.toml"
    path.write_text(
        'name = "s"\nouter = [[0, 0], [1e-3, 0], [2, 1e-2], [4, 0], [4, 3], [0, 3]]\n'
        "merge = 0.01\nsimplify = 0.02\n"
    )
    assert len(sm.load(path).graph.points) == 4
