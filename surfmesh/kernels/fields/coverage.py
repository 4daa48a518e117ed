"""The metric area that a background gives to a rectangle: how many circles will cover it."""

import math

from surfmesh.kernels.jit import kernel

STACK = 4 * 64
"""Rows of room for a walk down trees of at most 60 levels."""

_GAUSS = 0.5 - 0.5 / math.sqrt(3.0)


@kernel
def metric_area_of_box(background, x1, y1, stack):
    """Integral of det A = 1 / det H over [x0, x1] x [y0, y1], (x0, y0) the background's corner.

    A is bilinear in a leaf, its determinant of degree two in x and in y: two by two points of
    Gauss are exact, also in a leaf that the rectangle cuts. ``stack``: (STACK, 5) float64 room.
    """
    box, grid, child = background.box, background.grid, background.child
    total = 0.0
    for root in range(grid[0] * grid[1]):
        stack[0, 0] = root
        stack[0, 1] = box[0] + (root % grid[0]) / box[2]
        stack[0, 2] = box[1] + (root // grid[0]) / box[3]
        stack[0, 3] = 1.0 / box[2]
        stack[0, 4] = 1.0 / box[3]
        top = 1
        while top > 0:
            top -= 1
            cell, x, y = int(stack[top, 0]), stack[top, 1], stack[top, 2]
            wide, high = stack[top, 3], stack[top, 4]
            if x >= x1 or y >= y1:
                continue
            first = child[cell]
            if first < 0:
                across, up = min(1.0, (x1 - x) / wide), min(1.0, (y1 - y) / high)
                total += wide * high * across * up * _mean(background, cell, across, up)
                continue
            for k in range(4):
                stack[top, 0] = first + k
                stack[top, 1] = x + 0.5 * wide * (k % 2)
                stack[top, 2] = y + 0.5 * high * (k // 2)
                stack[top, 3] = 0.5 * wide
                stack[top, 4] = 0.5 * high
                top += 1
    return total


@kernel
def _mean(background, cell, across, up):
    """Mean of det A over the lower left part of a leaf, ``across`` by ``up`` of it."""
    a, corner = background.metric_root, background.corner
    total = 0.0
    for k in range(4):
        s = across * (_GAUSS if k % 2 == 0 else 1.0 - _GAUSS)
        t = up * (_GAUSS if k < 2 else 1.0 - _GAUSS)
        a11 = a12 = a22 = 0.0
        for c in range(4):
            w = (s if c % 2 else 1.0 - s) * (t if c > 1 else 1.0 - t)
            n = corner[cell, c]
            a11 += w * a[n, 0]
            a12 += w * a[n, 1]
            a22 += w * a[n, 2]
        total += 0.25 * (a11 * a22 - a12 * a12)
    return total
