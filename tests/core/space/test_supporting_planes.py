"""Patches on one side of a flat one, against pairs of triangles one by one."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.space import edge_table, graph_patches, meeting_triangles

SIDES = 2  # squares along each edge of a cube's face, two triangles each


def cubes(filled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The surface of some cells of a grid (k, l, m): points on a grid of their own, triangles."""
    places: dict[tuple[int, ...], int] = {}
    triangles = []
    padded = np.pad(filled, 1)
    for cell in np.argwhere(padded):
        for axis in range(3):
            for side in (0, 1):
                beside = cell.copy()
                beside[axis] += 2 * side - 1
                if padded[tuple(beside)]:
                    continue
                u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
                if not side:
                    u, v = v, u
                first = SIDES * cell + SIDES * side * np.eye(3, dtype=int)[axis]
                for i, j in np.ndindex(SIDES, SIDES):
                    corners = [first + (i + s) * u + (j + t) * v
                               for s, t in ((0, 0), (1, 0), (1, 1), (0, 1))]  # fmt: skip
                    a, b, c, d = (places.setdefault(tuple(p), len(places)) for p in corners)
                    triangles += [(a, b, c), (a, c, d)]
    return np.array(list(places), float), np.array(triangles, np.int32)


def found(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Patches and what supports them; pairs that meet, the same as without either."""
    patches, support = graph_patches(points, triangles, edge_table(triangles)[1])
    pairs = meeting_triangles(points, triangles, 10**6)
    again = meeting_triangles(points, triangles, 10**6, patches, support)
    assert sorted(map(tuple, again.tolist())) == sorted(map(tuple, pairs.tolist()))
    return patches, support, pairs


def are_parted(patches: np.ndarray, support: np.ndarray, a: int, b: int) -> bool:
    """Does the patch of one triangle support that of another?"""
    return patches[a] in support[patches[b]] or patches[b] in support[patches[a]]


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**31))
def test_no_pair_of_patches_that_are_parted_meets(seed):
    rng = np.random.default_rng(seed)
    points, triangles = cubes(rng.random(rng.integers(1, 4, 3)) < 0.7)
    if not len(triangles):
        return
    steps = rng.choice([0.5, 1.0, 2.0], size=3)
    points = points * steps
    for _ in range(rng.integers(0, 4)):  # onto planes and places of others, and off them
        vertex, axis = rng.integers(len(points)), rng.integers(3)
        kind = rng.integers(4)
        if kind == 0:
            points[vertex, axis] = points[rng.integers(len(points)), axis]
        elif kind == 1:
            points[vertex, axis] += rng.choice([-1.5, -1e-17, 0.1, 0.5, 1.0])
        elif kind == 2:
            points[vertex] = points[rng.integers(len(points))]
        else:
            points[vertex, axis] = np.nextafter(points[vertex, axis], rng.choice([-9.0, 9.0]))
    if rng.random() < 0.3:  # others at the same places, or beside
        moved = points + rng.choice([0.0, 1.0, 0.5]) * np.eye(3)[rng.integers(3)]
        triangles = np.concatenate([triangles, triangles + len(points)]).astype(np.int32)
        points = np.concatenate([points, moved])
    if rng.random() < 0.3:
        triangles = triangles[rng.random(len(triangles)) < 0.9]
    if len(triangles):
        found(np.ascontiguousarray(points), np.ascontiguousarray(triangles))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("scale", [1.0, -1.0])
def test_the_faces_of_a_cube_support_each_other(axis, scale):
    points, triangles = cubes(np.ones((1, 1, 1), bool))
    points = np.ascontiguousarray(np.roll(scale * points, axis, axis=1))
    triangles = np.ascontiguousarray(triangles[:, :: int(scale)])
    patches, support, pairs = found(points, triangles)
    assert len(pairs) == 0 and len(support) == 6
    assert sorted(patches.tolist()) == sorted(8 * list(range(6)))
    assert (support >= 0).sum(axis=1).tolist() == 6 * [4]  # all but itself and what is opposite


def ledge() -> tuple[np.ndarray, np.ndarray, int, int]:
    """A cube upon a plate of nine; a triangle of its side, and one of what it stands on."""
    filled = np.zeros((3, 3, 2), bool)
    filled[:, :, 0] = filled[1, 1, 1] = True
    points, triangles = cubes(filled)
    centre = points[triangles].mean(axis=1)
    floor = np.flatnonzero((points[triangles][:, :, 2] == 4.0).all(axis=1))
    side = np.flatnonzero((points[triangles][:, :, 0] == 4.0).all(axis=1) & (centre[:, 2] > 4.0))
    return points, triangles, int(side[0]), int(floor[0])


def test_what_stands_on_a_plane_is_parted_from_it():
    points, triangles, side, floor = ledge()
    patches, support, pairs = found(points, triangles)
    assert len(pairs) == 0 and are_parted(patches, support, side, floor)
    assert support[patches[side], 2] == patches[floor] and support[patches[side], 5] >= 0


@pytest.mark.parametrize("height, meets", [(4.0, True), (np.nextafter(4.0, 0.0), True), (3.5, True),
                                           (np.nextafter(4.0, 9.0), False)])  # fmt: skip
def test_what_comes_back_to_the_plane_is_not(height, meets):
    """A corner far from the rim, over the floor: in the plane, just through it, above it."""
    points, triangles, side, floor = ledge()
    free = np.flatnonzero((points == [4.0, 5.0, 5.0]).all(axis=1))  # in the middle of the side
    points[free] = [2.5, 5.0, height]
    patches, support, pairs = found(points, triangles)
    assert (len(pairs) > 0) is meets
    if meets and patches[side] >= 0:
        assert not are_parted(patches, support, side, floor)


UP = (1.5, 0.2, 0.2)


@pytest.mark.parametrize("bend, parted", [([(2.0, 0.0, 0.0)], True), ([(3.0, 1.0, 0.0)], False),
                                          ([UP, (2.4, 0.3, 0.1)], True),
                                          ([UP, (2.4, 0.3, 0.0)], False),
                                          ([UP, (2.4, 0.3, -0.1)], False)])  # fmt: skip
def test_a_wall_that_leaves_the_rim(bend, parted):
    """Leaning over a floor: its foot along the first side, and on to places within or over it."""
    points = [(float(x), float(y), 0.0) for y in range(4) for x in range(4)]
    squares = [(4 * k + i, 4 * k + i + 1, 4 * k + i + 5, 4 * k + i + 4)
               for k in range(3) for i in range(3)]  # fmt: skip
    points += [p for p in bend if p not in points]
    rows = [[points.index(p) for p in bend[::-1]] + [1, 0]]  # against the side of the floor
    for rise in (0.5, 1.0):
        rows.append([len(points) + k for k in range(len(rows[0]))])
        points += [(x, y + rise / 2, z + rise) for x, y, z in (points[v] for v in rows[0])]
    for low, high in pairwise(rows):
        squares += [(low[k], low[k + 1], high[k + 1], high[k]) for k in range(len(low) - 1)]
    triangles = np.array([(q[0], *q[k : k + 2]) for q in squares for k in (1, 2)], np.int32)
    patches, support, pairs = found(np.array(points), triangles)
    assert sorted(set(patches.tolist())) == [0, 1]
    assert are_parted(patches, support, 0, len(triangles) - 1) is parted
    assert (len(pairs) == 0) is parted


def test_turned_in_space_each_face_is_a_patch_of_its_own():
    """Steps seen aslant hide parts of others: patches end at creases, and none is cut in halves."""
    points, triangles, side, floor = ledge()
    turned = np.ascontiguousarray(points @ np.linalg.qr([[1, 2, 3], [2, -1, 1], [0, 3, 5.0]])[0])
    patches, support, pairs = found(turned, triangles)
    assert len(pairs) == 0 and np.all(patches >= 0) and np.all(support == -1)
    assert patches.max() + 1 == 11 + 1  # faces, and the number of what hid part of itself
    assert patches[side] != patches[floor]
