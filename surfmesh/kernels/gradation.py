"""Gradation and accuracy of a size field on patches of nine nodes.

A cell of the background under construction is a patch, nodes numbered row by row:

        6 - 7 - 8
        |   |   |       corners 0 2 6 8 are the cell's own;
        3 - 4 - 5       the other five test it, and serve its children when it is split
        |   |   |
        0 - 1 - 2
"""

import math

from surfmesh.kernels.jit import kernel


@kernel
def _limit(h, r, slope, a, b, changed, sweep):
    """Let neither of h[a], h[b] exceed the other by more than slope times their distance.

    Returns the relative change, and notes in ``changed`` which node it was.
    """
    if h[a] == h[b]:
        return 0.0
    d = math.sqrt((r[a, 0] - r[b, 0]) ** 2 + (r[a, 1] - r[b, 1]) ** 2 + (r[a, 2] - r[b, 2]) ** 2)
    if h[a] > h[b] + slope * d:
        change = h[a] - h[b] - slope * d
        h[a] = h[b] + slope * d
        changed[a] = sweep
        return change / h[a]
    if h[b] > h[a] + slope * d:
        change = h[b] - h[a] - slope * d
        h[b] = h[a] + slope * d
        changed[b] = sweep
        return change / h[b]
    return 0.0


@kernel
def grade(patch, joined, r, slope, h, changed, first, sweeps):
    """Lower the sizes h (nodes,) until no two neighbours differ by more than the slope allows.

    patch (cells, 9) nodes; joined (k, 2) pairs of nodes that are neighbours across a joint of
    two sides; r (nodes, 3) points. ``changed`` (nodes,) int32 holds the number of the last
    sweep that lowered a node; sweeps are numbered from ``first`` on and pass over patches that
    the sweep before has left alone. Sizes spread from small to large, so a few sweeps do when
    the patches with the smallest sizes come first. Stops when the largest relative change is
    below 0.1%.
    Returns the number for the next sweep, negative when ``sweeps`` did not suffice.
    """
    n = len(patch)
    for sweep in range(first, first + sweeps):
        largest = 0.0
        for k in range(n):
            p = patch[k]
            latest = 0
            for i in range(9):
                latest = max(latest, changed[p[i]])
            if latest < sweep - 1:
                continue
            for i in range(9):  # right, up and the two diagonals of each node of the 3 x 3
                right = i % 3 < 2
                if right:
                    largest = max(largest, _limit(h, r, slope, p[i], p[i + 1], changed, sweep))
                if i < 6:
                    largest = max(largest, _limit(h, r, slope, p[i], p[i + 3], changed, sweep))
                    if right:
                        largest = max(largest, _limit(h, r, slope, p[i], p[i + 4], changed, sweep))
                        largest = max(
                            largest, _limit(h, r, slope, p[i + 1], p[i + 3], changed, sweep)
                        )
        for k in range(len(joined)):
            a, b = joined[k, 0], joined[k, 1]
            largest = max(largest, _limit(h, r, slope, a, b, changed, sweep))
        if largest < 1e-3:
            return sweep + 2  # nothing is newer than the sweep before the next
    return -(first + sweeps)


@kernel
def _relative_error(x11, x12, x22, a11, a12, a22, floor):
    """Frobenius norm of A^-1 (X - A), with the eigenvalues of A kept above ``floor``."""
    d11, d12, d22 = x11 - a11, x12 - a12, x22 - a22
    a11 += floor
    a22 += floor
    det = a11 * a22 - a12 * a12
    e11 = a22 * d11 - a12 * d12
    e12 = a22 * d12 - a12 * d22
    e21 = a11 * d12 - a12 * d11
    e22 = a11 * d22 - a12 * d12
    return math.sqrt(e11 * e11 + e12 * e12 + e21 * e21 + e22 * e22) / det


@kernel
def patch_errors(patch, root, h, step, largest, error, extent):
    """How far the field in each patch is from bilinear, and how many edges wide the patch is.

    root (nodes, 3) is I^(1/2), so A = root / h; step (cells, 2) the patch's width and height.
    error (cells,): largest relative error at the five test nodes; extent (cells,): width or
    height in metric length, whichever is larger.
    """
    floor = 1.0 / largest
    for k in range(len(patch)):
        p = patch[k]
        worst = 0.0
        for m in range(5):
            i = 4 if m == 4 else 2 * m + 1
            n = p[i]
            x11 = x12 = x22 = 0.0
            for c in range(4):  # bilinear weight of corner c at node i
                column, row = 2 * (c % 2), 2 * (c // 2)
                w = 0.25 * (2 - abs(i % 3 - column)) * (2 - abs(i // 3 - row))
                q = p[3 * row + column]
                x11 += w * root[q, 0] / h[q]
                x12 += w * root[q, 1] / h[q]
                x22 += w * root[q, 2] / h[q]
            a11, a12, a22 = root[n, 0] / h[n], root[n, 1] / h[n], root[n, 2] / h[n]
            worst = max(worst, _relative_error(x11, x12, x22, a11, a12, a22, floor))
        error[k] = worst
        wide = 0.0
        for i in range(9):
            n = p[i]
            s = step[k, 0] / h[n]
            wide = max(wide, s * math.sqrt(root[n, 0] ** 2 + root[n, 1] ** 2))
            s = step[k, 1] / h[n]
            wide = max(wide, s * math.sqrt(root[n, 1] ** 2 + root[n, 2] ** 2))
        extent[k] = wide
