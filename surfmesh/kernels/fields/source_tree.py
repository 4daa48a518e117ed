"""A background from points of known size, over a plane whose metric is constant.

The size at x is the smallest of h_k + slope |x - x_k| over the sources k, and the largest size
allowed. Where a source can decide within a cell is told by one distance: with u_k = h_k +
slope |c - x_k| for the centre c of the cell, r the radius of its circumcircle and m the least
u_k, source k is below all others nowhere in the cell when

    u_k - slope r  >  m + slope r

So a cell hands on to its children the few sources that are left, and the sizes at the nodes
of the leaves are exact: no more is looked at than can matter.

Three passes: cells are split where the size changes, then where a neighbour is more than one
level coarser, then the nodes are numbered and their sizes found.

        2 --- 3         corners and children of a cell, as in kernels.fields.background;
        |     |         places are in units of the smallest cell, 2^-DEEPEST of a root cell
        0 --- 1
"""

import math
from typing import NamedTuple

import numpy as np

from surfmesh.kernels.jit import inlined_kernel, kernel

FINISHED, FULL = 0, 1

DEEPEST = 24
"""Most splits of a root cell: a place fits into 31 bits with MOST_IN_A_ROW root cells."""

MOST_IN_A_ROW = 64

EVEN = 0.04
"""Relative spread of the size over a cell that is not worth a split."""

ALLOWED = 0.045
"""Relative error of interpolation that a leaf may be expected to have; see ``_is_coarse``."""

NEAR_SOURCE = 0.06
"""Relative rise of the size from a source within a cell to the corners of the cell that is
allowed: with a growth of 1.2 such cells are half a size wide."""

FINEST_AT_SOURCE, FINEST = 0.25, 0.5
"""Cells narrower than this many sizes are not split, however steep the growth."""

SPLIT_STACK = 4 * (DEEPEST + 1) + 4


class Sources(NamedTuple):
    place: np.ndarray  # (n, 2) float64 x, y
    size: np.ndarray  # (n,) float64
    metric: np.ndarray  # (3,) E, F, G of the plane
    law: np.ndarray  # (2,) slope, largest size


class SourceTree(NamedTuple):
    """Room for the tree; what is filled is told by ``count``."""

    root: np.ndarray  # (6,) float64: x0, y0, width and height of a root cell, x1, y1
    grid: np.ndarray  # (2,) int64 root cells along x and y
    child: np.ndarray  # (cells,) int32: first of four children, or -1
    place: np.ndarray  # (cells, 3) int32 lower left corner, depth
    corner: np.ndarray  # (cells, 4) int32 nodes
    metric_root: np.ndarray  # (nodes, 4) float64: I^(1/2) / h, 1 / h
    key: np.ndarray  # (a power of two,) int64 nodes by place
    node: np.ndarray  # as key, int32
    stack: np.ndarray  # (SPLIT_STACK, 3) int64: cell, first and last of its sources in listed
    listed: np.ndarray  # (at least n,) int32 sources
    reach: np.ndarray  # as listed, float64
    count: np.ndarray  # (2,) int64: cells, nodes


@kernel
def grow_tree(sources, tree):
    """Fill ``tree``. Returns FINISHED, or FULL when anything needs more room."""
    cells = tree.grid[0] * tree.grid[1]
    if cells > len(tree.child):
        return FULL
    unit = 1 << DEEPEST
    for k in range(cells):
        tree.child[k] = -1
        tree.place[k, 0] = (k % tree.grid[0]) * unit
        tree.place[k, 1] = (k // tree.grid[0]) * unit
        tree.place[k, 2] = 0
    tree.count[0] = cells
    if _walk(sources, tree, True) != FINISHED or _balance(tree) != FINISHED:
        return FULL
    if not _clear_nodes(tree):
        return FULL
    return _walk(sources, tree, False)


@kernel
def _walk(sources, tree, splitting):
    """Visit all cells, each with the sources that matter in it.

    ``splitting``: leaves are split where they have to be; otherwise they are given their nodes.
    """
    considered = 0
    for k in range(len(sources.size)):
        if sources.size[k] < sources.law[1]:
            if considered == len(tree.listed):
                return FULL
            tree.listed[considered] = k
            considered += 1
    for root in range(tree.grid[0] * tree.grid[1]):
        tree.stack[0, 0] = root
        tree.stack[0, 1] = 0
        tree.stack[0, 2] = considered
        top = 1
        while top > 0:
            top -= 1
            cell = tree.stack[top, 0]
            first, last, at_middle = _chosen(
                sources, tree, cell, tree.stack[top, 1], tree.stack[top, 2]
            )
            if first < 0:
                return FULL
            if splitting and _is_coarse(sources, tree, cell, first, last, at_middle):
                if not _split(tree, cell):
                    return FULL
            child = tree.child[cell]
            if child < 0:
                if not splitting:
                    _make_nodes(sources, tree, cell, first, last)
                continue
            for k in range(4):
                tree.stack[top, 0] = child + k
                tree.stack[top, 1] = first
                tree.stack[top, 2] = last
                top += 1
    return FINISHED


@inlined_kernel
def _steps(tree, cell):
    """Width and height of a cell."""
    scale = 1.0 / (1 << tree.place[cell, 2])
    return tree.root[2] * scale, tree.root[3] * scale


@inlined_kernel
def _position(tree, i, j):
    """x, y of a place."""
    unit = 1.0 / (1 << DEEPEST)
    return tree.root[0] + i * unit * tree.root[2], tree.root[1] + j * unit * tree.root[3]


@inlined_kernel
def _middle(tree, cell):
    """x, y of a cell's centre."""
    x, y = _position(tree, tree.place[cell, 0], tree.place[cell, 1])
    wide, high = _steps(tree, cell)
    return x + 0.5 * wide, y + 0.5 * high


@inlined_kernel
def _length(metric, dx, dy):
    square = metric[0] * dx * dx + 2.0 * metric[1] * dx * dy + metric[2] * dy * dy
    return math.sqrt(max(square, 0.0))


@inlined_kernel
def _radius(metric, wide, high):
    """From the centre of a cell to its farthest corner."""
    square = metric[0] * wide * wide + 2.0 * abs(metric[1]) * wide * high + metric[2] * high * high
    return 0.5 * math.sqrt(square)


@inlined_kernel
def _chosen(sources, tree, cell, first, last):
    """The sources from listed[first:last] that matter in a cell, and the size at its centre.

    They are put behind ``last``, or stay where they are when all of them matter. Returns their
    first and last, -1 for want of room, and three numbers: the size at the centre, infinite
    without sources; the distance from there to the source that decides; and at most how far
    the unit vectors from there to the sources are apart.

    Sources in about the same direction rise alike: by Dunkl's and Williams's inequality the
    unit vectors to k and j differ by no more than 2 |x_k - x_j| / (d_k + d_j), and u_k - u_j
    changes by slope times that towards the corners.
    """
    if 2 * last - first > len(tree.listed):
        return -1, 0, (0.0, 0.0, 0.0)
    metric, slope = sources.metric, sources.law[0]
    x, y = _middle(tree, cell)
    least, nearest, distance = math.inf, 0, 0.0
    for k in range(first, last):
        s = tree.listed[k]
        d = _length(metric, sources.place[s, 0] - x, sources.place[s, 1] - y)
        u = sources.size[s] + slope * d
        tree.reach[last + k - first] = u
        if u < least:
            least, nearest, distance = u, s, d
    wide, high = _steps(tree, cell)
    radius = _radius(metric, wide, high)
    rise = slope * radius
    limit = min(least + 2.0 * rise, sources.law[1] + rise) * (1.0 + 1e-12)
    turn = 0.0
    px, py = sources.place[nearest, 0], sources.place[nearest, 1]
    kept = last
    for k in range(first, last):
        u = tree.reach[last + k - first]
        if u > limit:
            continue
        s = tree.listed[k]
        apart = _length(metric, sources.place[s, 0] - px, sources.place[s, 1] - py)
        far = (u - sources.size[s]) + slope * (distance - 2.0 * radius)
        if (u - least) * far > 2.0 * rise * slope * apart * (1.0 + 1e-9) and far > 0.0:
            continue
        if apart > 0.0:
            turn = max(turn, 2.0 * slope * apart / (far + 2.0 * rise))
        tree.listed[kept] = s
        kept += 1
    at_middle = (least, distance, min(turn, 2.0))
    if kept - last == last - first:
        return first, last, at_middle
    return last, kept, at_middle


@inlined_kernel
def _is_coarse(sources, tree, cell, first, last, at_middle):
    """Is the size in this cell too uneven for the values at its corners?

    With w the width, h the size and d the distance at the centre, and rise = slope r, bilinear
    interpolation is expected to miss, relative to h, by

        0.18 turn rise / h      where two sources of different direction are equal: a ridge
        0.5 (rise / h)^2        along the rise, as 1 / h is what is interpolated
        0.18 rise / h  w / d    across it: circles about the source
    """
    if first == last or tree.place[cell, 2] >= DEEPEST:
        return False
    metric, largest = sources.metric, sources.law[1]
    wide, high = _steps(tree, cell)
    x, y = _middle(tree, cell)
    if x - 0.5 * wide > tree.root[4] or y - 0.5 * high > tree.root[5]:  # beyond the box
        return False
    rise = sources.law[0] * _radius(metric, wide, high)
    smallest = sources.size[tree.listed[first]]
    for k in range(first + 1, last):
        smallest = min(smallest, sources.size[tree.listed[k]])
    middle, distance, turn = at_middle
    low = max(middle - rise, smallest)
    if min(middle + rise, largest) <= low * (1.0 + EVEN):
        return False
    width = max(math.sqrt(metric[0]) * wide, math.sqrt(metric[2]) * high)
    error = 0.18 * turn + 0.5 * rise / middle
    error += 0.18 * (width / distance if width < 2.0 * distance else 2.0)
    if width > FINEST * middle and rise * error > ALLOWED * middle:
        return True
    half_wide, half_high = 0.5000001 * wide, 0.5000001 * high  # on the side counts as within
    for k in range(first, last):
        s = tree.listed[k]
        size = sources.size[s]
        if width > FINEST_AT_SOURCE * size and rise > NEAR_SOURCE * size:
            place = sources.place
            if abs(place[s, 0] - x) <= half_wide and abs(place[s, 1] - y) <= half_high:
                return True
    return False


@inlined_kernel
def _split(tree, cell):
    """Give a cell four children; says whether there was room."""
    first = tree.count[0]
    if first + 4 > len(tree.child):
        return False
    tree.count[0] = first + 4
    tree.child[cell] = first
    depth = tree.place[cell, 2] + 1
    half = 1 << (DEEPEST - depth)
    for k in range(4):
        tree.child[first + k] = -1
        tree.place[first + k, 0] = tree.place[cell, 0] + (k % 2) * half
        tree.place[first + k, 1] = tree.place[cell, 1] + (k // 2) * half
        tree.place[first + k, 2] = depth
    return True


@inlined_kernel
def _leaf_at(tree, i, j):
    """The leaf that contains a place, its lower left corner included; -1 outside."""
    if i < 0 or j < 0:
        return -1
    column, row = i >> DEEPEST, j >> DEEPEST
    if column >= tree.grid[0] or row >= tree.grid[1]:
        return -1
    cell = row * tree.grid[0] + column
    bit = DEEPEST
    while tree.child[cell] >= 0:
        bit -= 1
        cell = tree.child[cell] + ((i >> bit) & 1) + 2 * ((j >> bit) & 1)
    return cell


@kernel
def _balance(tree):
    """Split leaves until none lies beside one that is two levels finer.

    A new leaf stands at the end of the list and is looked at in its turn.
    """
    cell = 0
    while cell < tree.count[0]:
        if tree.child[cell] < 0 and tree.place[cell, 2] > 1:
            i, j = tree.place[cell, 0], tree.place[cell, 1]
            size = 1 << (DEEPEST - tree.place[cell, 2])
            for side in range(4):
                a = i - 1 if side == 0 else i + size if side == 1 else i
                b = j - 1 if side == 2 else j + size if side == 3 else j
                other = _leaf_at(tree, a, b)
                while other >= 0 and tree.place[other, 2] < tree.place[cell, 2] - 1:
                    if not _split(tree, other):
                        return FULL
                    other = _leaf_at(tree, a, b)
        cell += 1
    return FINISHED


@kernel
def _clear_nodes(tree):
    """An empty table of nodes; says whether all nodes will find room.

    A split makes five nodes at most.
    """
    roots = tree.grid[0] * tree.grid[1]
    most = (tree.grid[0] + 1) * (tree.grid[1] + 1) + 5 * ((tree.count[0] - roots) // 4)
    if most > len(tree.metric_root) or 2 * most > len(tree.key):
        return False
    tree.count[1] = 0
    tree.key[:] = -1
    return True


@inlined_kernel
def _make_nodes(sources, tree, cell, first, last):
    """The corner nodes of a leaf, with their sizes from listed[first:last] when they are new."""
    size = 1 << (DEEPEST - tree.place[cell, 2])
    for k in range(4):
        i = np.int64(tree.place[cell, 0]) + (k % 2) * size
        j = np.int64(tree.place[cell, 1]) + (k // 2) * size
        key = (i << 32) | j
        slot = _slot(tree, key)
        if tree.key[slot] < 0:
            tree.key[slot] = key
            tree.node[slot] = tree.count[1]
            tree.count[1] += 1
            x, y = _position(tree, i, j)
            size_there = _size_at(sources, tree, first, last, x, y)
            _store(tree, tree.node[slot], sources.metric, size_there)
        tree.corner[cell, k] = tree.node[slot]


@inlined_kernel
def _slot(tree, key):
    """Where a key stands in the table of nodes, or the free slot that it will have."""
    mask = len(tree.key) - 1
    # places of coarse cells are multiples of high powers of two: high bits have to come down
    mixed = (key ^ (key >> 32)) * 0x9E3779B97F4A7C1
    mixed = (mixed ^ (mixed >> 32)) * 0x9E3779B97F4A7C1
    slot = (mixed ^ (mixed >> 32)) & mask
    while tree.key[slot] >= 0 and tree.key[slot] != key:
        slot = (slot + 1) & mask
    return slot


@inlined_kernel
def _size_at(sources, tree, first, last, x, y):
    size = sources.law[1]
    for k in range(first, last):
        s = tree.listed[k]
        d = _length(sources.metric, sources.place[s, 0] - x, sources.place[s, 1] - y)
        size = min(size, sources.size[s] + sources.law[0] * d)
    return size


@inlined_kernel
def _store(tree, node, metric, size):
    """I^(1/2) / h and 1 / h; the root is (I + s Id) / t, s^2 = det I, t^2 = trace I + 2 s."""
    s = math.sqrt(max(metric[0] * metric[2] - metric[1] * metric[1], 0.0))
    t = math.sqrt(metric[0] + metric[2] + 2.0 * s)
    tree.metric_root[node, 0] = (metric[0] + s) / (t * size)
    tree.metric_root[node, 1] = metric[1] / (t * size)
    tree.metric_root[node, 2] = (metric[2] + s) / (t * size)
    tree.metric_root[node, 3] = 1.0 / size
