"""Planar domains meshed: segments are edges, regions and holes are right, hostile input."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import DomainError
from surfmesh.quality.shape import alpha

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def square(low, high):
    return [(low, low), (high, low), (high, high), (low, high)]


def assert_follows(mesh, domain):
    """Every segment of the domain within the mesh is a chain of edges, ends exactly on it."""
    points = mesh.points[:, :2]
    size = max(high - low for low, high in domain.domain)
    edges = set(map(tuple, mesh.edges.tolist()))
    for a, b in domain.graph.points[domain.graph.segments]:
        along = (b - a) / np.linalg.norm(b - a)
        offset = points - a
        t = offset @ along
        off = np.abs(offset[:, 0] * along[1] - offset[:, 1] * along[0])
        slack = 1e-14 * size
        on = np.flatnonzero((off <= slack) & (t >= -slack) & (t <= np.linalg.norm(b - a) + slack))
        if len(on) < 2:
            continue  # outside
        on = on[np.argsort(t[on])]
        assert (points[on[0]] == a).all() and (points[on[-1]] == b).all()
        for i, j in zip(on[:-1].tolist(), on[1:].tolist()):
            assert (min(i, j), max(i, j)) in edges


def assert_right(mesh, domain, area=None, regions=None):
    assert mesh.check() is None
    a, b, c = (mesh.points[corner] for corner in mesh.triangles.T)
    signed = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (signed > 0.0).all()
    assert signed.sum() == pytest.approx(domain.area if area is None else area, rel=1e-9)
    assert len(np.unique(mesh.face_ids)) == (domain.regions if regions is None else regions)
    assert_follows(mesh, domain)


@pytest.mark.parametrize("optimise", [True, False])
def test_island_in_a_hole_with_walls_and_points(optimise):
    domain = sm.PlanarDomain(
        [square(0, 10), square(4, 6)],
        holes=[square(3, 7)],
        constraints=[[(0, 1.5), (10, 1.5)], [(5, 1.5), (5, 3)], [(1, 8), (2, 9), (3, 8)]],
        points=[(8.5, 8.5), (5.0, 5.0)],
    )
    mesh = sm.mesh(domain, 0.4, optimise=optimise)
    assert_right(mesh, domain, area=100 - 16 + 4, regions=3)
    for place in domain.points:
        assert (mesh.points[:, :2] == place).all(axis=1).any()
    report = sm.check(mesh)
    assert report.clean and report.components == 2
    if optimise:
        assert report.alpha_mean > 0.95 and report.alpha_min > 0.5


def test_regions_keep_their_numbers_when_sizes_change():
    domain = sm.PlanarDomain(SQUARE, constraints=[[(0, 0.3), (1, 0.3)], [(0.5, 0.3), (0.5, 1)]])
    found = set()
    for size in (0.3, 0.1, 0.03):
        mesh = sm.mesh(domain, size)
        x, y, _ = mesh.points[mesh.triangles].mean(axis=1).T
        parts = [y < 0.3, (y > 0.3) & (x < 0.5), (y > 0.3) & (x > 0.5)]
        found.add(tuple(tuple(np.unique(mesh.face_ids[part])) for part in parts))
    assert len(found) == 1
    assert sorted(found.pop()) == [(0,), (1,), (2,)]


def test_loops_in_either_direction_give_the_same_mesh():
    hole = square(0.4, 0.6)
    one = sm.mesh(sm.PlanarDomain(SQUARE, holes=[hole]), 0.08)
    other = sm.mesh(sm.PlanarDomain(SQUARE[::-1], holes=[hole[::-1]]), 0.08)
    assert one.points.shape == other.points.shape
    assert (np.sort(one.points, axis=0) == np.sort(other.points, axis=0)).all()


def test_the_same_domain_gives_the_same_mesh_to_the_last_bit():
    first, again = (sm.mesh(sm.load("letter_a")) for _ in range(2))
    assert (first.points == again.points).all() and (first.triangles == again.triangles).all()


@pytest.mark.parametrize("degrees", [1.0, 5.0, 20.0])
def test_sharp_corners(degrees):
    tip = np.radians(degrees)
    wedge = [(0.0, 0.0), (1.0, 0.0), (np.cos(tip), np.sin(tip))]
    domain = sm.PlanarDomain(wedge)
    assert_right(sm.mesh(domain, 0.05), domain)
    spike = sm.PlanarDomain(square(-1, 1), constraints=[wedge[:2], [wedge[0], wedge[2]]])
    assert_right(sm.mesh(spike, 0.1), spike)


def test_segments_a_millionth_of_the_domain_long():
    loop = [
        (0, 0),
        (0.5, 0),
        (0.5, 1e-6),
        (0.5 + 1e-6, 1e-6),
        (0.5 + 1e-6, 0),
        (1, 0),
        (1, 1),
        (0, 1),
    ]
    domain = sm.PlanarDomain(loop)
    mesh = sm.mesh(domain, 0.1)
    assert_right(mesh, domain)
    assert alpha(mesh).min() > 0.2
    assert len(mesh.triangles) < 20_000
    floored = sm.mesh(domain, sm.Sizing(size=0.1, min_size=0.01))
    assert_right(floored, domain)
    assert len(floored.triangles) < len(mesh.triangles)


def test_narrow_gaps_are_seen():
    walls = [[(0.1, 0.5), (0.9, 0.5)], [(0.1, 0.51), (0.9, 0.51)]]
    domain = sm.PlanarDomain(SQUARE, constraints=walls)
    mesh = sm.mesh(domain, 0.1)
    assert_right(mesh, domain)
    assert alpha(mesh).min() > 0.4


def test_collinear_and_duplicate_points():
    loop = [
        (0, 0),
        (0, 0),
        (0.3, 0),
        (0.5, 0),
        (0.500000000000001, 0),
        (1, 0),
        (1, 1),
        (1, 1),
        (0, 1),
    ]
    domain = sm.PlanarDomain(loop, constraints=[[(0.2, 0), (0.8, 0)], [(0.1, 0.1), (0.1, 0.1)]])
    assert_right(sm.mesh(domain, 0.1), domain, area=1.0, regions=1)


def test_crossing_lines_are_refused_or_split():
    crossing = [[(0, 0.2), (1, 0.8)], [(0, 0.8), (1, 0.2)]]
    with pytest.raises(DomainError, match=r"constraint 0.*crosses constraint 1"):
        sm.PlanarDomain(SQUARE, constraints=crossing)
    domain = sm.PlanarDomain(SQUARE, constraints=crossing, crossings="split")
    assert_right(sm.mesh(domain, 0.1), domain, area=1.0, regions=4)


def test_lines_that_leave_the_domain_are_cut_off():
    domain = sm.PlanarDomain(
        SQUARE, constraints=[[(-1, 0.5), (2, 0.5)], [(2, 2), (3, 3)]], crossings="split"
    )
    mesh = sm.mesh(domain, 0.1)
    assert_right(mesh, domain, area=1.0, regions=2)
    assert (mesh.points[:, :2] >= 0).all() and (mesh.points[:, :2] <= 1).all()


def test_a_domain_without_inside_is_refused():
    domain = sm.PlanarDomain(square(0, 1), holes=[square(-1, 2)])
    with pytest.raises(DomainError, match="no part"):
        sm.mesh(domain, 0.1)


def test_thirty_thousand_segments():
    t = np.linspace(0.0, 2.0 * np.pi, 30_000, endpoint=False)
    r = 1.0 + 0.2 * np.cos(9 * t)
    domain = sm.PlanarDomain(np.stack([r * np.cos(t), r * np.sin(t)], axis=1))
    mesh = sm.mesh(domain, sm.Sizing(size=0.05, growth=1.5), optimise=False)
    assert mesh.check() is None
    assert len(mesh.boundary_edges) >= 30_000
    assert sm.check(mesh).area == pytest.approx(domain.area, rel=1e-9)


@settings(max_examples=25)
@given(seed=st.integers(0, 2**31), lines=st.integers(1, 25), scale=st.sampled_from([1e-6, 1, 1e6]))
def test_random_lines_in_a_square(seed, lines, scale):
    ends = scale * np.random.default_rng(seed).uniform(-0.1, 1.1, (lines, 2, 2))
    domain = sm.PlanarDomain(scale * np.array(SQUARE), constraints=list(ends), crossings="split")
    mesh = sm.mesh(domain, sm.Sizing(size=0.15 * scale, min_size=1e-4 * scale, growth=1.5))
    assert_right(mesh, domain, area=scale * scale)
