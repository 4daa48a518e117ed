"""Patches that cannot meet themselves, against pairs of triangles one by one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.space import edge_table, graph_patches, meeting_triangles
from surfmesh.quality.measures.self_intersection import meeting_pairs
from surfmesh.result.surface_mesh import SurfaceMesh

seeds = st.integers(0, 2**31)


def grid(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2) places from 0 to 1, and triangles that are counter-clockwise over them."""
    t, s = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, columns + 1), indexing="ij")
    a = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    b, c = a + 1, a + columns + 1
    triangles = np.concatenate([np.stack([a, b, c + 1], 1), np.stack([a, c + 1, c], 1)])
    return np.stack([s, t], axis=2).reshape(-1, 2), triangles.astype(np.int32)


def sheet(kind: str, rows: int, columns: int, rng: np.random.Generator) -> np.ndarray:
    """(n, 3) points of a grid: a wave, a roll, a ramp that winds about an axis."""
    s, t = grid(rows, columns)[0].T
    if kind == "wave":
        steep = rng.choice([0.0, 0.2, 1.0])
        return np.stack([s, t, steep * np.sin(5 * s + rng.normal()) * np.cos(4 * t)], axis=1)
    turns = 2 * np.pi * rng.uniform(0.2, 2.2)
    if kind == "roll":
        radius = 0.4 + rng.choice([0.0, 0.1, -0.3]) * s
        return np.stack([radius * np.cos(turns * s), radius * np.sin(turns * s), t], axis=1)
    radius = 0.2 + 0.3 * t
    rise = rng.choice([0.0, 0.3]) * s
    return np.stack([radius * np.cos(turns * s), radius * np.sin(turns * s), rise], axis=1)


def planted(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Sheets, one or two, with holes, cuts, corners moved and rounded, turned in space."""
    rng = np.random.default_rng(seed)
    points, triangles = np.empty((0, 3)), np.empty((0, 3), np.int32)
    for _ in range(rng.integers(1, 3)):
        rows, columns = rng.integers(3, 12, 2)
        own = sheet(rng.choice(["wave", "roll", "ramp"]), rows, columns, rng)
        own = own + rng.choice([0.0, 0.05, 1.0]) * rng.normal(size=3)
        there = grid(rows, columns)[1]
        if rng.random() < 0.5:
            there = there[rng.random(len(there)) < rng.choice([0.7, 0.97])]
        triangles = np.concatenate([triangles, there + len(points)]).astype(np.int32)
        points = np.concatenate([points, own])
    for _ in range(rng.integers(0, 4)):
        points[rng.integers(len(points))] += rng.choice([0.03, 0.3]) * rng.normal(size=3)
    if rng.random() < 0.3:
        points[rng.integers(len(points))] = points[rng.integers(len(points))]
    if rng.random() < 0.5:
        points = np.round(points * 12) / 12  # places, lines and planes in common
    elif rng.random() < 0.5:
        points = points @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if rng.random() < 0.3:
        flipped = rng.random(len(triangles)) < 0.1
        triangles[flipped] = triangles[flipped][:, ::-1]
    return np.ascontiguousarray(points), np.ascontiguousarray(triangles)


@settings(max_examples=150, deadline=None)
@given(seeds)
def test_no_pair_of_a_patch_meets(seed):
    points, triangles = planted(seed)
    pairs = meeting_triangles(points, triangles, 10**6)
    patches, support = graph_patches(points, triangles, edge_table(triangles)[1])
    own, other = patches[pairs].T
    assert not np.any((own == other) & (own >= 0))
    with_patches = meeting_triangles(points, triangles, 10**6, patches, support)
    assert {tuple(p) for p in with_patches.tolist()} == {tuple(p) for p in pairs.tolist()}


def sheets_are_one_patch(points, triangles):
    patches, _ = graph_patches(points, triangles, edge_table(triangles)[1])
    return len(set(patches.tolist())) == 1 and patches[0] >= 0


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("side", [1, -1])
def test_a_graph_over_a_plane_is_one_patch(axis, side):
    (s, t), triangles = grid(9, 9)[0].T, grid(9, 9)[1]
    wave = np.roll(np.stack([s, t, 0.1 * np.sin(6 * s * t)], axis=1), axis, axis=1)
    assert sheets_are_one_patch(wave, triangles[:, ::side].copy())
    with_holes = triangles[(np.arange(len(triangles)) % 162 != 40)]
    assert sheets_are_one_patch(wave, with_holes)


@pytest.mark.parametrize("turns, whole", [(0.9, True), (1.1, False)])
def test_a_ramp_that_lies_over_itself_is_no_patch(turns, whole):
    """All its normals are alike; only its rim tells."""
    (s, t), triangles = grid(4, 60)[0].T, grid(4, 60)[1]
    angle, radius = 2 * np.pi * turns * s, 1.0 - 0.5 * t
    ramp = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.2 * s], axis=1)
    patches, _ = graph_patches(ramp, triangles, edge_table(triangles)[1])
    assert (len(set(patches.tolist())) == 1) is whole
    ramp[:, 2] = 0.0  # the same flat: triangles of the second turn lie on those of the first
    mesh = SurfaceMesh(points=ramp, triangles=triangles)
    assert (len(meeting_pairs(mesh)) == 0) is whole


@pytest.mark.parametrize("first", ["steep", "flat"])
def test_an_open_graph_is_one_patch_however_steep(first):
    """Whatever the first triangle faces: the sum of all normals says how to look."""
    (s, t), triangles = grid(20, 20)[0].T, grid(20, 20)[1]
    peak = np.stack([s, t, 30.0 * np.exp(-60.0 * ((s - 0.5) ** 2 + (t - 0.5) ** 2))], axis=1)
    corners = peak[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    tilt = normal[:, 2] / np.linalg.norm(normal, axis=1)
    assert tilt.min() < 0.02
    order = np.argsort(tilt if first == "steep" else -tilt)
    assert sheets_are_one_patch(peak, np.ascontiguousarray(triangles[order]))
    folded = peak.copy()
    folded[:, 0] += 0.2 * peak[:, 2] * (s - 0.5)  # it hangs over
    assert not sheets_are_one_patch(folded, triangles)


def test_a_disc_within_a_disc_is_no_patch_of_both():
    """Their rims do not cross, and one winds round the other."""
    (s, t), triangles = grid(6, 6)[0].T, grid(6, 6)[1]
    large, small = np.stack([s, t, 0 * s], 1), np.stack([0.2 + s / 3, 0.2 + t / 3, 0 * s], 1)
    points = np.concatenate([large, small])
    both = np.concatenate([triangles, triangles + len(large)])
    patches, _ = graph_patches(points, both, edge_table(both)[1])
    assert set(patches[: len(triangles)]).isdisjoint(patches[len(triangles) :])
    mesh = SurfaceMesh(points=points, triangles=both)
    assert len(meeting_pairs(mesh)) == len(meeting_triangles(points, both, 10**6)) > 0


def test_half_edges_that_lie_are_left_out():
    points, triangles = planted(3)
    count = 3 * len(triangles)
    lies = np.random.default_rng(0).integers(-2, count + 2, (count, 2)).astype(np.int32)
    pairs = meeting_triangles(points, triangles, 10**6)
    patches, _ = graph_patches(points, triangles, lies)
    assert not np.any((patches[pairs[:, 0]] == patches[pairs[:, 1]]) & (patches[pairs[:, 0]] >= 0))


def test_arguments_are_checked():
    points, triangles = planted(1)
    with pytest.raises(ValueError, match="patches"):
        meeting_triangles(points, triangles, 10, np.zeros(2, np.int32))
    with pytest.raises(ValueError, match="patches"):
        meeting_triangles(points, triangles, 10, np.full(len(triangles), -2, np.int32))
    patches, support = graph_patches(points, triangles, edge_table(triangles)[1])
    with pytest.raises(ValueError, match="fewer rows than there are patches"):
        meeting_triangles(points, triangles, 10, patches, support[:0])
    with pytest.raises(ValueError, match="support without patches"):
        meeting_triangles(points, triangles, 10, support=support)
    with pytest.raises(ValueError, match="out of range"):
        graph_patches(points[:2], triangles, np.empty((0, 2), np.int32))
