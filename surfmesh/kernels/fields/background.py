"""Look-up in the background: size tensors on a forest of quadtrees over the (x, y) box.

The box is cut into nx by ny root cells, each the root of a quadtree. A leaf knows its four
corner nodes:

        2 --- 3         children in the same order:  2 3
        |     |                                      0 1
        0 --- 1

A node stores A = H^-1 = M^(1/2), not H: at a pole the wanted length in (u, v) is infinite,
while A goes to zero linearly and is interpolated without error. Where sizes are anisotropic it
also stores W, the symmetric tensor in space for which |W d| is the length of a step d in wanted
lengths: W = Id / h - (1 / h - 1 / long) t t^T, with ``long`` wanted along the tangent t.
"""

import math
from typing import NamedTuple

import numpy as np

import surfmesh._core.fields as core
from surfmesh.kernels.jit import kernel

_ISOTROPIC = np.empty((0, 6))


class Background(NamedTuple):
    box: np.ndarray  # (5,) x0, y0, root cells per unit x and y, largest size (unit length)
    grid: np.ndarray  # (2,) int64: nx, ny
    child: np.ndarray  # (cells,) int32: first of four children, or -1 for a leaf
    corner: np.ndarray  # (cells, 4) int32 nodes
    metric_root: np.ndarray  # (nodes, 4) float64: A = H^-1, and 1 / h
    # (nodes, 6) float64: W, the inverse sizes in space; empty where they are isotropic, Id / h
    metric_root_3d: np.ndarray = _ISOTROPIC


def for_kernels(background: core.Background) -> Background:
    """The arrays of the core's background, as the kernels take them."""
    arrays = (getattr(background, name) for name in Background._fields)
    return Background(*(np.array(array) for array in arrays))


@kernel
def _leaf(background, x, y):
    """Corner nodes and bilinear weights of the leaf at (x, y), or at the box's nearest point."""
    nx = background.grid[0]
    ny = background.grid[1]
    fx = min(max((x - background.box[0]) * background.box[2], 0.0), float(nx))
    fy = min(max((y - background.box[1]) * background.box[3], 0.0), float(ny))
    i = min(int(fx), nx - 1)
    j = min(int(fy), ny - 1)
    fx -= i
    fy -= j
    cell = j * nx + i
    first = background.child[cell]
    while first >= 0:
        fx *= 2.0
        fy *= 2.0
        if fx >= 1.0:
            fx -= 1.0
            first += 1
        if fy >= 1.0:
            fy -= 1.0
            first += 2
        cell = first
        first = background.child[cell]
    corner = background.corner
    w3 = fx * fy
    w1 = fx - w3
    w2 = fy - w3
    w0 = 1.0 - fx - w2
    return corner[cell, 0], corner[cell, 1], corner[cell, 2], corner[cell, 3], w0, w1, w2, w3


@kernel
def metric_root_at(background, x, y):
    """A = H^-1 at (x, y), bilinear in the leaf; outside the box that of the nearest point."""
    n0, n1, n2, n3, w0, w1, w2, w3 = _leaf(background, x, y)
    a = background.metric_root
    return (
        w0 * a[n0, 0] + w1 * a[n1, 0] + w2 * a[n2, 0] + w3 * a[n3, 0],
        w0 * a[n0, 1] + w1 * a[n1, 1] + w2 * a[n2, 1] + w3 * a[n3, 1],
        w0 * a[n0, 2] + w1 * a[n1, 2] + w2 * a[n2, 2] + w3 * a[n3, 2],
    )


@kernel
def invert(a11, a12, a22, largest):
    """H = A^-1 with its eigenvalues capped at ``largest`` (those of A floored at 1/largest)."""
    det = a11 * a22 - a12 * a12
    trace = a11 + a22
    floor = 1.0 / largest
    if det <= floor * trace:  # the smaller eigenvalue may lie below the floor
        mean = 0.5 * trace
        spread = math.sqrt(max(0.25 * (a11 - a22) ** 2 + a12 * a12, 0.0))
        low = mean - spread
        if low < floor:
            high = max(mean + spread, floor)
            if spread > 0.0:  # A = low Id + (high - low) P, P the projector on the larger
                s = 1.0 / (2.0 * spread)
                p11 = (a11 - low) * s
                p12 = a12 * s
                p22 = (a22 - low) * s
            else:
                p11, p12, p22 = 1.0, 0.0, 0.0
            a11 = floor + (high - floor) * p11
            a12 = (high - floor) * p12
            a22 = floor + (high - floor) * p22
            det = a11 * a22 - a12 * a12
    return a22 / det, -a12 / det, a11 / det


@kernel
def size_at(background, x, y):
    """The size tensor H at (x, y)."""
    a11, a12, a22 = metric_root_at(background, x, y)
    return invert(a11, a12, a22, background.box[4])


@kernel
def sizes_at(background, xy, out):
    """H at many points: xy (n, 2) -> out (n, 3)."""
    for k in range(len(xy)):
        out[k, 0], out[k, 1], out[k, 2] = size_at(background, xy[k, 0], xy[k, 1])


@kernel
def metric_roots_at(background, xy, out):
    """A = H^-1 at many points: xy (n, 2) -> out (n, 3)."""
    for k in range(len(xy)):
        out[k, 0], out[k, 1], out[k, 2] = metric_root_at(background, xy[k, 0], xy[k, 1])


@kernel
def metric_root_3d_at(background, x, y):
    """W at (x, y): xx, xy, xz, yy, yz, zz; bilinear in the leaf."""
    n0, n1, n2, n3, w0, w1, w2, w3 = _leaf(background, x, y)
    a = background.metric_root_3d
    return (
        w0 * a[n0, 0] + w1 * a[n1, 0] + w2 * a[n2, 0] + w3 * a[n3, 0],
        w0 * a[n0, 1] + w1 * a[n1, 1] + w2 * a[n2, 1] + w3 * a[n3, 1],
        w0 * a[n0, 2] + w1 * a[n1, 2] + w2 * a[n2, 2] + w3 * a[n3, 2],
        w0 * a[n0, 3] + w1 * a[n1, 3] + w2 * a[n2, 3] + w3 * a[n3, 3],
        w0 * a[n0, 4] + w1 * a[n1, 4] + w2 * a[n2, 4] + w3 * a[n3, 4],
        w0 * a[n0, 5] + w1 * a[n1, 5] + w2 * a[n2, 5] + w3 * a[n3, 5],
    )


@kernel
def metric_roots_3d_at(background, xy, out):
    """W at many points: xy (n, 2) -> out (n, 6)."""
    for k in range(len(xy)):
        w = metric_root_3d_at(background, xy[k, 0], xy[k, 1])
        for i in range(6):
            out[k, i] = w[i]


@kernel
def scalar_size_at(background, x, y):
    """The wanted edge length h in 3D at (x, y), the shorter of two, from the interpolated 1 / h."""
    n0, n1, n2, n3, w0, w1, w2, w3 = _leaf(background, x, y)
    a = background.metric_root
    return 1.0 / (w0 * a[n0, 3] + w1 * a[n1, 3] + w2 * a[n2, 3] + w3 * a[n3, 3])


@kernel
def scalar_sizes_at(background, xy, out):
    """h at many points: xy (n, 2) -> out (n,)."""
    for k in range(len(xy)):
        out[k] = scalar_size_at(background, xy[k, 0], xy[k, 1])
