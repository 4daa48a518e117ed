"""Planar domains meshed: regions, gaps, what lies outside, lines at random."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import DomainError
from surfmesh.quality.measures.shape import alpha

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
    assert mesh.broken_invariant() is None
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


def test_narrow_gaps_are_seen():
    walls = [[(0.1, 0.5), (0.9, 0.5)], [(0.1, 0.51), (0.9, 0.51)]]
    domain = sm.PlanarDomain(SQUARE, constraints=walls)
    mesh = sm.mesh(domain, 0.1)
    assert_right(mesh, domain)
    assert alpha(mesh).min() > 0.4


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


@settings(max_examples=25)
@given(seed=st.integers(0, 2**31), lines=st.integers(1, 25), scale=st.sampled_from([1e-6, 1, 1e6]))
def test_random_lines_in_a_square(seed, lines, scale):
    ends = scale * np.random.default_rng(seed).uniform(-0.1, 1.1, (lines, 2, 2))
    domain = sm.PlanarDomain(scale * np.array(SQUARE), constraints=list(ends), crossings="split")
    mesh = sm.mesh(domain, sm.Sizing(size=0.15 * scale, min_size=1e-4 * scale, growth=1.5))
    assert_right(mesh, domain, area=scale * scale)
