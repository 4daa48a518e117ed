"""Fans of triangles at vertices, against corners joined one by one."""

import numpy as np
import pytest

from surfmesh._core.quality import JoinedTriangles
from surfmesh._core.space import edge_table


def fans_one_by_one(triangles, vertices, pairs):
    """Corners at each vertex, joined across each pair of half-edges until nothing changes."""
    label = {(t, v): t for t, corners in enumerate(triangles.tolist()) for v in corners}
    changed = True
    while changed:
        changed = False
        for e, f in pairs.tolist():
            if f < 0:
                continue
            for v in {triangles[e // 3, e % 3], triangles[e // 3, (e + 1) % 3]}:
                one, other = label[e // 3, v], label[f // 3, v]
                if one != other:
                    label[e // 3, v] = label[f // 3, v] = min(one, other)
                    changed = True
    return [len({root for (_, v), root in label.items() if v == at}) for at in range(vertices)]


def around(middle, rim):
    """Triangles between a vertex and neighbours on a closed rim."""
    return [(middle, a, b) for a, b in zip(rim, (*rim[1:], rim[0]))]


CASES = {
    "open": [(0, 1, 2), (0, 2, 3), (0, 3, 4)],
    "closed": around(0, (1, 2, 3, 4, 5)),
    "two that touch": around(0, (1, 2, 3)) + around(0, (4, 5, 6)),
    "closed and open": around(0, (1, 2, 3)) + [(0, 4, 5)],
    "turned over": [(0, 1, 2), (0, 3, 2), (0, 3, 4)],
    "no triangle at some": [(2, 4, 5)],
}


def fans(triangles, count):
    """By the core, and one by one: as edges of two triangles join them."""
    edges, pairs, uses = edge_table(triangles)
    faces, no_chains = np.zeros(len(triangles), np.int32), np.empty((0, 2), np.int32)
    mesh = JoinedTriangles(np.zeros((count, 3)), triangles, faces, 1, edges, pairs, uses)
    found = mesh.topology(no_chains)[3]
    return found.tolist(), fans_one_by_one(triangles, count, pairs[uses == 2])


@pytest.mark.parametrize("name", CASES)
def test_fans_are_those_of_joined_corners(name):
    triangles = np.array(CASES[name], np.int32)
    found, slow = fans(triangles, int(triangles.max()) + 1)
    assert found == slow


def test_fans_of_random_triangles():
    draw = np.random.default_rng(7)
    for count in (4, 6, 9):
        triangles = np.array([draw.permutation(count)[:3] for _ in range(8)], np.int32)
        found, slow = fans(triangles, count)
        assert found == slow
