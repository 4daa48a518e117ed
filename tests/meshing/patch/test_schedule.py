"""The optimiser: what it may do to a triangulated domain, and what it must not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.metric import alpha, star_energy
from naive.triangulation import check_domain, corners, half_edges, live_triangles

from surfmesh.api import load
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.kernels import NIL
from surfmesh.kernels.optimisation.optimisation import _newton_step, swap_for_degree, swap_for_shape
from surfmesh.kernels.optimisation.surface_frames import (
    chord,
    edge_length,
    empty_frames,
    triangle_deviation,
    triangle_shape,
)
from surfmesh.kernels.triangulation.triangulation import empty_triangulation
from surfmesh.meshing.boundary.boundary_loops import boundary_loops
from surfmesh.meshing.boundary.boundary_recovery import recovered
from surfmesh.meshing.patch.packing import packed
from surfmesh.meshing.patch.schedule import optimise
from surfmesh.meshing.patch.state import LONGEST, SHORTEST, PatchState
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.options.sizing import Sizing


def state_of(name="two_peaks", **asked):
    surface = load(name)
    sides = find_sides(surface)
    sizing = Sizing(**(asked or dict(chord=0.03, max_size=0.9, growth=1.3)))
    field = size_field(surface, sizing, sides)
    width, height = field.chart.extent
    t = packed(field.background, (0, 0, width, height), (width / 2, height / 2), 2000).t
    loops = boundary_loops(surface, sides, field)
    domain = recovered(t, loops, field, surface)
    return PatchState(domain, surface, field.chart, field), domain


def shapes(state):
    t = state.t
    return np.array([triangle_shape(state.frames, *row) for row in corners(t)[live_triangles(t)]])


STEPS = ["swap", "smooth", "swap_for_degree", "smooth", "swap", "collapse", "split"]


@pytest.mark.parametrize("name, euler", [("two_peaks", 1), ("pierced_saddle", 0), ("sphere", 1)])
def test_every_step_keeps_the_invariants(name, euler):
    """Positive in the plane, the same domain, the same border, frozen vertices where they were."""
    asked = {"pierced_saddle": dict(size=0.12), "sphere": dict(size=0.2)}.get(name, {})
    state, domain = state_of(name, **asked)
    t = state.t
    border = {e for e, h in half_edges(t).items() if t.adj[h] == NIL}
    nodes = t.xy[domain.node].copy()
    fixed = int(t.fixed.sum())
    assert check_domain(t, euler) is None
    for _ in range(2):
        for step in STEPS:
            getattr(state, step)()
            assert check_domain(t, euler) is None, step
            assert (t.xy[domain.node] == nodes).all(), step
            assert {e for e, h in half_edges(t).items() if t.adj[h] == NIL} == border, step
            assert int(t.fixed.sum()) == fixed
    optimise(state)
    assert check_domain(t, euler) is None
    assert (t.xy[domain.node] == nodes).all()


def test_run_betters_two_peaks():
    state, _ = state_of()
    before = shapes(state)
    changes = optimise(state)
    after = shapes(state)
    assert changes.swaps > 0 and changes.passes > 0
    assert after.mean() > 0.955 > before.mean() + 0.01
    assert after.min() > before.min()
    assert len(changes.folded) < 0.01 * len(after)
    assert len(changes.far) < 0.01 * len(after)  # what is left is for another round


def test_a_second_run_has_little_left_to_do():
    state, _ = state_of()
    optimise(state)
    mean = shapes(state).mean()
    t = state.t
    live = len(live_triangles(t))
    optimise(state)
    assert shapes(state).mean() > mean - 1e-3
    assert abs(len(live_triangles(t)) - live) < 0.02 * live


def test_swaps_for_shape_only_better_the_worse_of_two():
    state, _ = state_of()
    before = np.sort(shapes(state))
    t, s = state.t, state.frames
    swaps = swap_for_shape(t, s, state.shape, state.dirty, state.active, 0.82, 50)
    after = np.sort(shapes(state))
    assert swaps > 0
    assert after[0] >= before[0] and after.mean() > before.mean()
    assert not state.dirty[: t.count[0]].any()
    kept = [state.shape[k] for k in live_triangles(t)]
    np.testing.assert_allclose(np.sort(kept), after, atol=1e-12)
    state.dirty[:] = 1
    assert swap_for_shape(t, s, state.shape, state.dirty, state.active, 0.82, 50) == 0


def counted_degrees(t):
    return np.bincount(corners(t)[live_triangles(t)].ravel(), minlength=len(t.xy))


def test_degrees_are_kept_up_to_date():
    state, _ = state_of()
    state.swap()
    state.find_stars()
    t, n = state.t, int(state.t.count[0])
    before = counted_degrees(t)
    assert (state.degree[:n] == before[:n]).all()
    irregular = ((before[:n] - 6) ** 2)[state.frozen[:n] == 0].sum()
    swaps = swap_for_degree(
        t, state.frames, state.frozen, state.degree, state.dirty,
        state.active, 0.4,
    )  # fmt: skip
    after = counted_degrees(t)
    assert (state.degree[:n] == after[:n]).all()
    now = ((after[:n] - 6) ** 2)[state.frozen[:n] == 0].sum()
    assert swaps > 0 and now <= irregular - 2 * swaps
    assert check_domain(t, 1) is None


def test_frozen_vertices_are_those_on_the_border_or_a_fixed_edge():
    state, domain = state_of("pierced_saddle", size=0.15)
    state.find_stars()
    frozen = np.flatnonzero(state.frozen[: state.t.count[0]])
    assert set(frozen.tolist()) == set(domain.node.tolist())
    star = state.star[: state.t.count[0]]
    assert (state.t.tri[star] == np.arange(len(star))).all()


def test_collapse_and_split_bring_lengths_into_range():
    """From sizes that are half, then twice, of what the packing was made for."""
    for factor, step in ((2.0, "collapse"), (0.5, "split")):
        state, _ = state_of()
        t, s = state.t, state.frames
        s.scale[:] *= factor
        state.set_frames(np.arange(int(t.count[0]), dtype=np.int32))
        live = len(live_triangles(t))
        for _ in range(8):
            getattr(state, step)()
            state.swap()
            state.smooth()
        assert check_domain(t, 1) is None
        inner = {
            (a, b)
            for (a, b), e in half_edges(t).items()
            if t.adj[e] != NIL and not (state.frozen[a] or state.frozen[b])
        }
        lengths = np.array([edge_length(s, a, b) for a, b in inner])
        if step == "collapse":
            assert len(live_triangles(t)) < 0.5 * live
            assert (lengths > SHORTEST).mean() > 0.9
        else:
            assert len(live_triangles(t)) > 2 * live or int(t.count[0]) == len(t.xy)
            assert int(t.count[0]) == len(t.xy) or (lengths < LONGEST).mean() > 0.95


# one star in the plane


def flat_star(ring, sizes, centre=(0.0, 0.0), size=1.0):
    """A vertex 0 with its star, embedded in the plane z = 0."""
    n = len(ring)
    t = empty_triangulation(n + 8)
    t = t._replace(fixed=np.zeros(len(t.tri), np.uint8))
    t.count[:] = n + 1, n
    t.xy[0], t.xy[1 : n + 1] = centre, ring
    s = empty_frames(n + 8)
    for k in range(n):
        t.tri[3 * k : 3 * k + 3] = 0, k + 1, (k + 1) % n + 1
        t.adj[3 * k : 3 * k + 3] = 3 * ((k - 1) % n) + 2, NIL, 3 * ((k + 1) % n)
    s.size[: n + 1] = size, *sizes
    s.point[: n + 1] = np.column_stack([t.xy[: n + 1], np.zeros(n + 1)])
    s.normal[: n + 1] = 0.0, 0.0, 1.0
    for v in range(n + 1):
        s.tangent_map[v] = np.eye(2, 3) / s.size[v]
        t.size[v] = s.size[v], 0.0, s.size[v]
    return t, s


def random_ring(seed, n, jitter):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(-jitter, jitter, n)) / n
    r = 1 + rng.uniform(-jitter, jitter, n)
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1), rng.uniform(0.8, 1.25, n)


@settings(max_examples=60)
@given(st.integers(0, 2**31), st.integers(4, 9), st.sampled_from([0.3, 2.0, 4.0]))
def test_newton_steps_lower_the_energy(seed, n, stiffness):
    ring, sizes = random_ring(seed, n, 0.25)
    centre = np.random.default_rng(seed).uniform(-0.15, 0.15, 2)
    t, s = flat_star(ring, sizes, centre)
    x, y, worst = _newton_step(t, s, 0, 0, stiffness)
    turned = [alpha(centre, ring[k], ring[(k + 1) % n]) for k in range(n)]
    assert worst == pytest.approx(min(*turned, 1.0))

    def energy(place):
        return star_energy(place, ring, 1.0, sizes, stiffness)

    eps = 1e-6
    gradient = np.array(
        [(energy(centre + eps * d) - energy(centre - eps * d)) / (2 * eps) for d in np.eye(2)]
    )
    step = np.array([x, y])
    assert np.linalg.norm(step) <= 0.3 + 1e-12
    assert gradient @ step <= 1e-7
    assert energy(centre + step) <= energy(centre) + 1e-9


def test_newton_stays_at_the_minimum_and_converges_to_it():
    ring, sizes = random_ring(3, 6, 0.2)
    place = np.array([0.1, -0.1])
    for _ in range(12):
        t, s = flat_star(ring, sizes, place)
        x, y, _ = _newton_step(t, s, 0, 0, 2.0)
        place = place + (x, y)
    assert np.hypot(x, y) < 1e-4
    around = [star_energy(place + 0.01 * d, ring, 1.0, sizes, 2.0) for d in np.eye(2)]
    assert star_energy(place, ring, 1.0, sizes, 2.0) < min(around)
    hexagon = np.stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)], 1)
    x, y, worst = _newton_step(*flat_star(hexagon, np.ones(6)), 0, 0, 2.0)
    assert np.hypot(x, y) < 1e-12 and worst == pytest.approx(1.0)


def test_an_inverted_star_is_not_moved():
    ring, sizes = random_ring(1, 6, 0.1)
    assert _newton_step(*flat_star(ring, sizes, (1.5, 0.0)), 0, 0, 2.0) == (0.0, 0.0, -1.0)


# measures on the embedding


def test_embedding_of_a_sphere_against_numpy():
    state, _ = state_of("sphere", size=0.15)
    t, s = state.t, state.frames
    rows = corners(t)[live_triangles(t)]
    regular = rows[(np.abs(s.point[rows][:, :, 2]) < 0.95).all(axis=1)]
    for a, b, c in regular[::29]:
        p = s.point[[a, b, c]]
        assert edge_length(s, a, b) == pytest.approx(
            np.linalg.norm(p[1] - p[0]) / (0.5 * (s.size[a] + s.size[b]))
        )
        normal = np.cross(p[1] - p[0], p[2] - p[0])
        total = sum(np.sum((p[i] - p[i - 1]) ** 2) for i in range(3))
        expected = 2 * np.sqrt(3) * np.linalg.norm(normal) / total
        assert triangle_shape(s, a, b, c) == pytest.approx(expected)
        assert triangle_shape(s, a, c, b) == pytest.approx(-expected)
        # the chord in the unit tangent plane: its length is that of the tangential part
        d = p[1] - p[0]
        tangential = d - (d @ p[0]) * p[0]
        assert np.hypot(*chord(s, a, b)) == pytest.approx(
            np.linalg.norm(tangential) / s.size[a], rel=1e-6
        )
        centre_radius = abs(normal @ p[0]) / np.linalg.norm(normal)
        assert triangle_deviation(s, a, b, c) == pytest.approx(1 - centre_radius, rel=0.1)
        assert np.abs(s.normal[a] - p[0]).max() < 1e-9
