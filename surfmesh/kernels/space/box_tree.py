"""Pairs of triangles whose boxes overlap, by a balanced binary tree of boxes.

Triangles are sorted along a space-filling curve; the tree over that order is implicit, a heap:

                 0                 children of node k: 2k + 1, 2k + 2
              /     \\
            1         2            the leaves are the last 2^depth nodes, each holds LEAF
           / \\       / \\           triangles in their order; the last leaves may be empty
          3   4     5   6
"""

import numpy as np

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.space.triangle_pairs import triangles_meet

LEAF = 4  # triangles in a leaf: a test of four boxes costs what a level of the tree does


@kernel
def _spread(x):
    """The 20 bits of x, two zeros after each."""
    x = (x | (x << 32)) & 0x1F00000000FFFF
    x = (x | (x << 16)) & 0x1F0000FF0000FF
    x = (x | (x << 8)) & 0x100F00F00F00F00F
    x = (x | (x << 4)) & 0x10C30C30C30C30C3
    return (x | (x << 2)) & 0x1249249249249249


@kernel
def curve_places(points, triangles, low, scale, places):
    """Place of each triangle's centroid along the Z-order curve through a box.

    Parameters
    ----------
    points: (n, 3) float64, finite; triangles: (m, 3) int32
    low: (3,) float64, corner of the box; scale: 2^20 over its longest side, a little less
    places: (m,) int64, filled
    """
    for t in range(len(triangles)):
        place = np.int64(0)
        for k in range(3):
            middle = 0.0
            for i in range(3):
                middle += (points[triangles[t, i], k] - low[k]) * scale
            place |= _spread(np.int64(middle / 3.0)) << k
        places[t] = place


@kernel
def fill_boxes(corners, boxes, tree):
    """Boxes (x0, y0, z0, x1, y1, z1) around triangles, and around what lies below each node.

    Parameters
    ----------
    corners: (3 m, 3) float64, of the triangles in their order
    boxes: (m, 6) float64, filled
    tree: (2^(depth + 1) - 1, 6) float64, filled; what is empty has no inside
    """
    count, leaves = len(boxes), (len(tree) + 1) // 2
    for t in range(count):
        for k in range(3):
            a, b, c = corners[3 * t, k], corners[3 * t + 1, k], corners[3 * t + 2, k]
            boxes[t, k], boxes[t, 3 + k] = min(a, b, c), max(a, b, c)
    for node in range(len(tree) - 1, -1, -1):
        for k in range(3):
            low, high = np.inf, -np.inf
            if node >= leaves - 1:
                first = (node - leaves + 1) * LEAF
                for t in range(first, min(first + LEAF, count)):
                    low, high = min(low, boxes[t, k]), max(high, boxes[t, 3 + k])
            else:
                left, right = 2 * node + 1, 2 * node + 2
                low = min(tree[left, k], tree[right, k])
                high = max(tree[left, 3 + k], tree[right, 3 + k])
            tree[node, k], tree[node, 3 + k] = low, high


@kernel
def _overlap(a, i, b, j):
    """Have two boxes, borders included, a point in common?"""
    return (
        a[i, 0] <= b[j, 3] and b[j, 0] <= a[i, 3]
        and a[i, 1] <= b[j, 4] and b[j, 1] <= a[i, 4]
        and a[i, 2] <= b[j, 5] and b[j, 2] <= a[i, 5]
    )  # fmt: skip


@kernel
def find_meeting(corners, boxes, tree, start, expansion, pairs):
    """Pairs of triangles that meet where they should not (``triangle_pairs``).

    Parameters
    ----------
    corners, boxes, tree: as in ``fill_boxes``
    start: the triangle to begin with, 0 at first
    expansion: (96,) float64, to work in
    pairs: (k, 2) int32, filled with places in the order, the lower first

    Returns how many were found, and the triangle to go on with: all are done when it is m,
    otherwise ``pairs`` may be too small for what that triangle meets.
    """
    count, leaves = len(boxes), (len(tree) + 1) // 2
    depth = 0
    while (1 << depth) < leaves:
        depth += 1
    found = 0
    for t in range(start, count):
        before = found
        own = leaves + t // LEAF  # by one more than its node, as are all of these
        node, above = 1, depth  # levels down to the leaves
        while True:
            # what ends before the own leaf has met this triangle already
            near = node >= own >> above and _overlap(boxes, t, tree, node - 1)
            if near and above > 0:
                node, above = 2 * node, above - 1
                continue
            if near:
                first = (node - leaves) * LEAF
                for other in range(max(first, t + 1), min(first + LEAF, count)):
                    if _overlap(boxes, t, boxes, other) and triangles_meet(
                        corners, 3 * t, 3 * other, expansion
                    ):
                        if found == len(pairs):
                            return before, t
                        pairs[found, 0], pairs[found, 1] = t, other
                        found += 1
            while node % 2 == 1 and node > 1:  # done with a right child: up
                node, above = node // 2, above + 1
            if node == 1:
                break
            node += 1
    return found, count
