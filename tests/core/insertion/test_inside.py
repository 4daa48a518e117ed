"""What lies inside: patches between segments, and the regions of a planar domain."""

import numpy as np
import pytest
from naive.triangulation import plane_triangulation

from surfmesh._core.insertion import Recovery, inside_regions, label_patches
from surfmesh._core.triangulation import DEAD


def grid(n=5):
    """A triangulation of n x n points, its middle lines fixed."""
    x, y = np.meshgrid(np.arange(n), np.arange(n) + 0.0)
    t = plane_triangulation(np.stack([x + 0.1 * y, y], axis=-1).reshape(-1, 2))
    end = t.tri[np.arange(len(t.tri)) // 3 * 3 + (np.arange(len(t.tri)) + 1) % 3]
    real = (t.tri >= 0) & (end >= 0)
    for axis in (0, 1):
        line = np.stack(np.divmod(np.arange(n * n), n))[axis] == n // 2
        t.fixed[real & line[t.tri] & line[end]] = 1
    return t


def test_patches_end_at_segments():
    t = grid()
    label, count = label_patches(t.adj, t.fixed, t.region)
    ghost = (t.tri.reshape(-1, 3) < 0).any(axis=1)
    assert count == 1  # the hull is no segment: all is joined around the lines
    hull = ghost[t.adj // 3] != np.repeat(ghost, 3)
    t.fixed[hull] = 1
    label, count = label_patches(t.adj, t.fixed, t.region)
    assert count == 5
    assert sorted(np.bincount(label[~ghost], minlength=5).tolist()) == [0, 8, 8, 8, 8]
    assert len(np.unique(label[ghost])) == 1
    assert np.array_equal(
        np.unique(label, return_index=True)[1], np.sort(np.unique(label, return_index=True)[1])
    )  # numbered in the order of their first triangles
    inner = t.fixed == 0
    assert (label[t.adj[inner] // 3] == np.repeat(label, 3)[inner]).all()


def test_dead_slots_have_no_patch():
    t = grid()
    assert t.remove_vertex(int(np.flatnonzero(t.tri == 6)[0])) >= 0
    label, count = label_patches(t.adj, t.fixed, t.region)
    assert ((label < 0) == (t.region == DEAD)).all() and (t.region == DEAD).sum() == 2
    assert count == 1


def test_wrong_patches_are_refused():
    t = grid()
    with pytest.raises(ValueError, match="fixed has"):
        label_patches(t.adj, t.fixed[3:], t.region)
    adj = t.adj.copy()
    adj[7] = len(adj)
    with pytest.raises(ValueError, match="adj has an index"):
        label_patches(adj, t.fixed, t.region)


def regions(sides, loop_segments, is_hole, infinite=0):
    status, region, inside = inside_regions(
        np.array(sides, np.int32),
        np.array(loop_segments, np.int32).reshape(-1, 2),
        np.array(is_hole, np.uint8),
        infinite,
    )
    return status, region, inside.tolist()


def test_regions_lie_in_more_outer_loops_than_holes():
    """A hole (2) in a square (1), and an island (3) in it; a line from the rim that ends freely."""
    sides = [(1, 0), (2, 1), (3, 2), (1, 1)]
    loops = [(0, 0), (1, 1), (2, 2)]
    assert regions(sides, loops, [0, 1, 0]) == (Recovery.FINISHED, -1, [0, 1, 0, 1])
    assert regions(sides, loops, [0, 0, 0]) == (Recovery.FINISHED, -1, [0, 1, 1, 1])


@pytest.mark.parametrize("loops", [1, 63, 64, 65, 200])
def test_many_loops_one_in_the_other(loops):
    sides = [(k + 1, k) for k in range(loops)]
    pairs = [(k, k) for k in range(loops)]
    found = regions(sides, pairs, np.arange(loops) % 2)
    assert found == (Recovery.FINISHED, -1, [0, *((np.arange(loops) + 1) % 2).tolist()])


def test_a_loop_that_runs_along_a_segment_twice_does_not_separate():
    assert regions([(0, 0)], [(0, 0), (0, 0)], [0]) == (Recovery.FINISHED, -1, [0])


def test_contradictions_are_named():
    assert regions([(1, 0), (3, 1)], [(0, 0)], [0])[:2] == (Recovery.UNREACHABLE_REGION, 2)
    apart = regions([(1, 0), (1, 0)], [(0, 0)], [0])
    assert apart == (Recovery.DIFFERENT_LOOPS, 1, [])
    both_sides = regions([(0, 0)], [(0, 0)], [0])
    assert both_sides == (Recovery.DIFFERENT_LOOPS, 0, [])


def test_wrong_numbers_are_refused():
    for sides, loops, holes, infinite, name in [
        ([(-1, 0)], [(0, 0)], [0], 0, "sides"),
        ([(1, 0)], [(1, 0)], [0], 0, "loop_segments"),
        ([(1, 0)], [(0, 1)], [0], 0, "loop_segments"),
        ([(1, 0)], [(0, 0)], [0], -1, "infinite"),
    ]:
        with pytest.raises(ValueError, match=name):
            regions(sides, loops, holes, infinite)
