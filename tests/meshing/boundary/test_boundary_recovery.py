"""Loops inserted into a packing: every node a vertex, every segment a fixed edge, exact areas."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.background import constant_background, random_background
from naive.exact import polygon_area, triangles_area
from naive.polygons import spike, square, star
from naive.triangulation import (
    check_domain,
    corners,
    half_edges,
    live_triangles,
)
from naive.watchdog import watched
from stages import recovered

from surfmesh._core.insertion import CROWDED
from surfmesh.errors import SurfaceError
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.patch.packing import packed

SURFACE = SimpleNamespace(name="test")


def loops_of(*polygons):
    """Polygons (k, 2), outer ones counter-clockwise and holes clockwise, as they are."""
    segments, first = [], 0
    for polygon in polygons:
        ring = first + np.arange(len(polygon))
        segments.append(np.stack([ring, np.roll(ring, -1)], axis=1))
        first += len(polygon)
    return BoundaryLoops(
        np.concatenate([np.asarray(p, float) for p in polygons]),
        np.concatenate(segments).astype(np.int32),
        np.arange(first),
    )


class PlainField:
    """The size field of a plane that is not scaled."""

    chart = SimpleNamespace(to_plane=lambda uv: uv)
    is_anisotropic = False

    def __init__(self, background):
        self.background = background

    def tensors(self, xy):
        return self.background.sizes(xy)


def packing_for(background):
    return packed(background, (0.0, 0.0, 1.0, 1.0), (0.5, 0.5), 2000, 20_000)


def domain_of(background, *polygons):
    loops = loops_of(*polygons)
    return loops, recovered(packing_for(background).t, loops, PlainField(background), SURFACE)


def assert_recovered(loops, domain, *polygons):
    t, node = domain.t, domain.node
    assert check_domain(t, euler=2 - len(polygons)) is None
    assert (t.xy[node] == loops.uv).all()
    edges = half_edges(t)
    border = {(a, b) for (a, b), e in edges.items() if t.adj[e] < 0}
    assert border == {tuple(pair) for pair in node[loops.segments].tolist()}
    assert all(t.fixed[edges[edge]] for edge in border)
    rows = corners(t)[live_triangles(t)].tolist()
    assert triangles_area(t.xy, rows) == sum(polygon_area(p) for p in polygons)


SHAPES = {
    "square": [square(20)],
    "long segments": [square(1)],
    "short segments": [square(400)],
    "few long among short": [np.concatenate([square(50)[:50], square(1)[1:]])],
    "hole": [square(20), square(8, 0.3, 0.6)[::-1]],
    "two holes, one long-sided": [
        square(20), square(1, 0.1, 0.4)[::-1], star(5, 0.5, 0.1, (0.7, 0.7), 0.2)[::-1],
    ],
    "holes near the rim": [square(20), square(5, 0.001, 0.3)[::-1]],
    "star": [star(7, 0.4)],
    "sharp star": [star(12, 0.05)],
    "notch of 1 degree": [spike(1.0)],
    "notch of 0.01 degree": [spike(0.01)],
    "thorn of 1 degree": [np.array([(0.0, 0.5), (1.0, 0.5 - np.tan(np.radians(1))), (1.0, 0.5)])],
    "comb": [
        np.array([(0, 0), (1, 0)] + [(1 - k / 40, 0.1 if k % 2 else 0.9) for k in range(40)])
    ],
}  # fmt: skip


@pytest.mark.parametrize("h", [0.02, 0.1, 0.9])
@pytest.mark.parametrize("shape", SHAPES)
def test_shapes(shape, h):
    assert_recovered(*domain_of(constant_background(h, 1.0, 1.0), *SHAPES[shape]), *SHAPES[shape])


@pytest.mark.parametrize("shape", ["square", "hole", "sharp star", "notch of 1 degree"])
@pytest.mark.parametrize("stretch", [10.0, 1000.0])
def test_stretched_metric(shape, stretch):
    tensor = np.array([[0.05 * stretch**0.5, 0.01], [0.01, 0.05 / stretch**0.5]])
    background = constant_background(tensor, 1.0, 1.0)
    assert_recovered(*domain_of(background, *SHAPES[shape]), *SHAPES[shape])


@settings(max_examples=25)
@given(st.integers(0, 2**31), st.integers(3, 60), st.sampled_from([1.0, 10.0, 100.0]))
def test_random_star_shapes(seed, n, ratio):
    """Random radii at sorted random angles: simple by construction, corners of any angle."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(0, 0.9, n)) / n
    r = 0.49 * 10.0 ** rng.uniform(-1, 0, n)
    polygon = 0.5 + np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)

    def broken():
        background = random_background(seed, 3, ratio, 2.0, size=0.08)
        assert_recovered(*domain_of(background, polygon), polygon)

    domain_of(constant_background(0.3, 1.0, 1.0), square(3))  # compiled before the fork
    if polygon_area(polygon) > 0:
        assert watched(broken) is None


@settings(max_examples=15)
@given(st.integers(0, 2**31), st.integers(2, 40))
def test_collinear_vertices_on_slanted_sides(seed, cuts):
    rng = np.random.default_rng(seed)
    a, b, c = rng.uniform(0, 1, (3, 2))
    if polygon_area([a, b, c]) < 0:
        b, c = c, b
    t = np.sort(rng.uniform(0, 1, cuts))[:, None]
    polygon = np.concatenate([a + t * (b - a), b + t * (c - b), c + t * (a - c)])
    if polygon_area(polygon) < 0.05:
        return
    assert_recovered(*domain_of(constant_background(0.07, 1.0, 1.0), polygon), polygon)


def test_nodes_on_vertices_and_segments_along_edges_of_the_packing():
    """The square's corners are circles' centres of the packing, its sides run through others."""
    background = constant_background(0.05, 1.0, 1.0)
    t = packing_for(background).t
    xy = t.xy[: t.vertices]
    inner = [0.5 + s * np.array(d) for d, s in zip([(-1, -1), (1, -1), (1, 1), (-1, 1)], [0.3] * 4)]
    polygon = np.array([xy[np.argmin(np.linalg.norm(xy - p, axis=1))] for p in inner])
    loops = loops_of(polygon)
    domain = recovered(t, loops, PlainField(background), SURFACE)
    assert_recovered(loops, domain, polygon)


def test_interior_vertices_keep_their_distance_from_the_boundary():
    _, domain = domain_of(constant_background(0.05, 1.0, 1.0), square(20))
    t = domain.t
    inner = np.setdiff1d(np.arange(t.vertices), domain.node)
    away = np.minimum(t.xy[inner], 1 - t.xy[inner]).min(axis=1)
    assert away.min() > CROWDED * 0.05 * (1 - 1e-9)


BROKEN = {
    "bow tie": (([(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)],), "crosses itself on"),
    "two loops cross": ((square(10, 0.05, 0.7), square(3, 0.5, 0.95)[::-1]), "crosses itself on"),
    "the same node twice": (
        ([(0.1, 0.1), (0.9, 0.1), (0.5, 0.5), (0.9, 0.9), (0.1, 0.9), (0.5, 0.5)],),
        r"touches itself at \(u, v\) = \(0.5, 0.5\)",
    ),
    "a corner on a side": (
        ([(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.5, 0.1), (0.1, 0.9)],), "touches itself on",
    ),
    "a spike without width": (
        ([(0.1, 0.1), (0.9, 0.1), (0.9, 0.5), (0.3, 0.5), (0.9, 0.5), (0.1, 0.9)],), "touches",
    ),
    "the wrong way round": ((square(10)[::-1],), "do not enclose a domain"),
    "a hole alone": ((square(4, 0.3, 0.6)[::-1],), "do not enclose a domain"),
}  # fmt: skip


@pytest.mark.parametrize("h", [0.03, 0.3])
@pytest.mark.parametrize("case", BROKEN)
def test_named_errors(case, h):
    polygons, message = BROKEN[case]
    with pytest.raises(SurfaceError, match=message):
        domain_of(constant_background(h, 1.0, 1.0), *polygons)
