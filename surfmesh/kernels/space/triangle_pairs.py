"""Do two triangles in space meet where they should not? Judged exactly.

Corners at the same place are one vertex, whatever their numbers. Triangles that share

- no vertex meet when they have any point in common;
- one vertex     when they have another point in common;
- two vertices   when they lie in one plane on the same side of their edge: a fold;
- three          always.

Most pairs of neighbours are told apart by a plane between them, found and judged in floating
point with a margin for rounding. Only the others are looked at exactly. A triangle without
area meets nothing: it is a fault of its own, and its neighbours hold its edges.
"""

import numpy as np

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.space.space_predicates import orient_space
from surfmesh.kernels.triangulation.predicates import UNDERFLOW, orient

MARGIN = 16.0 * 2.0**-53  # of the sum of |w_i d_i|: what rounding can do to w . (p - q)


@kernel
def _beside(p, origin, at, wx, wy, wz):
    """Side of a plane through p[origin] with the normal w: 1, -1, or 0 when too near to tell."""
    x = wx * (p[at, 0] - p[origin, 0])
    y = wy * (p[at, 1] - p[origin, 1])
    z = wz * (p[at, 2] - p[origin, 2])
    along = x + y + z
    margin = MARGIN * (abs(x) + abs(y) + abs(z)) + UNDERFLOW
    if along > margin:
        return 1
    return -1 if along < -margin else 0


@kernel
def _direction(p, a, b):
    """Unit vector from p[a] to p[b]; zero where they coincide."""
    x, y, z = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
    length = np.sqrt(x * x + y * y + z * z)
    if not length > 0.0:
        return 0.0, 0.0, 0.0
    return x / length, y / length, z / length


@kernel
def _parted_at_vertex(p, a, b, c, d, e):
    """Is there surely a plane through a with bc on one side and de on the other?

      b   d         tried: the plane half-way between the two nearest of the rays from a,
       \\ : \\        then between the two middles
    c - a - e
        :
    """
    bx, by, bz = _direction(p, a, b)
    cx, cy, cz = _direction(p, a, c)
    dx, dy, dz = _direction(p, a, d)
    ex, ey, ez = _direction(p, a, e)
    bd, be = bx * dx + by * dy + bz * dz, bx * ex + by * ey + bz * ez
    cd, ce = cx * dx + cy * dy + cz * dz, cx * ex + cy * ey + cz * ez
    nearest = max(bd, be, cd, ce)
    for attempt in range(2):
        if attempt == 1:
            wx, wy, wz = bx + cx - dx - ex, by + cy - dy - ey, bz + cz - dz - ez
        elif nearest == bd:
            wx, wy, wz = bx - dx, by - dy, bz - dz
        elif nearest == be:
            wx, wy, wz = bx - ex, by - ey, bz - ez
        elif nearest == cd:
            wx, wy, wz = cx - dx, cy - dy, cz - dz
        else:
            wx, wy, wz = cx - ex, cy - ey, cz - ez
        side = _beside(p, a, b, wx, wy, wz)
        if (
            side != 0
            and _beside(p, a, c, wx, wy, wz) == side
            and _beside(p, a, d, wx, wy, wz) == -side
            and _beside(p, a, e, wx, wy, wz) == -side
        ):
            return True
    return False


@kernel
def _all_beside(p, i, j, wx, wy, wz):
    """Are all corners of triangle j surely farther along w than all of triangle i?"""
    for a in range(i, i + 3):
        for b in range(j, j + 3):
            if _beside(p, a, b, wx, wy, wz) <= 0:
                return False
    return True


@kernel
def _parted_by(p, i, j):
    """Is triangle j surely beyond a side of triangle i in its plane, or off its plane?"""
    x1, y1, z1 = p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1], p[i + 1, 2] - p[i, 2]
    x2, y2, z2 = p[i + 2, 0] - p[i, 0], p[i + 2, 1] - p[i, 1], p[i + 2, 2] - p[i, 2]
    nx, ny, nz = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
    for k in range(3):
        a, b = i + k, i + (k + 1) % 3
        ex, ey, ez = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
        if _all_beside(p, i, j, ey * nz - ez * ny, ez * nx - ex * nz, ex * ny - ey * nx):
            return True
    return _all_beside(p, i, j, nx, ny, nz) or _all_beside(p, i, j, -nx, -ny, -nz)


@kernel
def _flattest(p, i):
    """The axis along which triangle i is seen best, or -1 when it has no area; exact."""
    x1, y1, z1 = p[i + 1, 0] - p[i, 0], p[i + 1, 1] - p[i, 1], p[i + 1, 2] - p[i, 2]
    x2, y2, z2 = p[i + 2, 0] - p[i, 0], p[i + 2, 1] - p[i, 1], p[i + 2, 2] - p[i, 2]
    nx, ny, nz = abs(y1 * z2 - z1 * y2), abs(z1 * x2 - x1 * z2), abs(x1 * y2 - y1 * x2)
    best = 0 if nx >= ny and nx >= nz else 1 if ny >= nz else 2
    for k in range(3):
        axis = (best + k) % 3
        if _orient_2d(p, i, i + 1, i + 2, axis) != 0.0:
            return axis
    return -1


@kernel
def _orient_2d(p, a, b, c, axis):
    """Orientation of abc seen along an axis; exact sign."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    return orient(p[a, i], p[a, j], p[b, i], p[b, j], p[c, i], p[c, j])


@kernel
def _segments_meet(p, a, b, c, d, axis):
    """Have ab and cd, ends included, a point in common? All in one plane, seen along an axis."""
    abc, abd = _orient_2d(p, a, b, c, axis), _orient_2d(p, a, b, d, axis)
    cda, cdb = _orient_2d(p, c, d, a, axis), _orient_2d(p, c, d, b, axis)
    if abc == 0.0 and abd == 0.0 and cda == 0.0 and cdb == 0.0:  # on one line
        for k in range(3):
            low, high = min(p[c, k], p[d, k]), max(p[c, k], p[d, k])
            if max(p[a, k], p[b, k]) < low or min(p[a, k], p[b, k]) > high:
                return False
        return True
    # by signs, as products of small areas underflow
    return not (
        (abc > 0.0 and abd > 0.0) or (abc < 0.0 and abd < 0.0)
        or (cda > 0.0 and cdb > 0.0) or (cda < 0.0 and cdb < 0.0)
    )  # fmt: skip


@kernel
def _holds(p, i, a, axis):
    """Is a, in the plane of triangle i, within it or on its border? Seen along an axis."""
    s, t = _orient_2d(p, i, i + 1, a, axis), _orient_2d(p, i + 1, i + 2, a, axis)
    r = _orient_2d(p, i + 2, i, a, axis)
    return (s >= 0.0 and t >= 0.0 and r >= 0.0) or (s <= 0.0 and t <= 0.0 and r <= 0.0)


@kernel
def _pierces(p, a, b, i, axis, expansion):
    """Has the segment ab, ends included, a point in common with triangle i, border included?"""
    at_a = orient_space(p, i, i + 1, i + 2, a, expansion)
    at_b = orient_space(p, i, i + 1, i + 2, b, expansion)
    if (at_a > 0.0 and at_b > 0.0) or (at_a < 0.0 and at_b < 0.0):
        return False
    if at_a == 0.0 and at_b == 0.0:
        if _holds(p, i, a, axis) or _holds(p, i, b, axis):
            return True
        for k in range(3):
            if _segments_meet(p, a, b, i + k, i + (k + 1) % 3, axis):
                return True
        return False
    s = orient_space(p, a, b, i, i + 1, expansion)
    t = orient_space(p, a, b, i + 1, i + 2, expansion)
    r = orient_space(p, a, b, i + 2, i, expansion)
    return (s >= 0.0 and t >= 0.0 and r >= 0.0) or (s <= 0.0 and t <= 0.0 and r <= 0.0)


@kernel
def _same_place(p, a, b):
    return p[a, 0] == p[b, 0] and p[a, 1] == p[b, 1] and p[a, 2] == p[b, 2]


@kernel
def triangles_meet(p, i, j, expansion):
    """Do two triangles meet where they should not? See the module's docstring.

    Parameters
    ----------
    p: (3 m, 3) float64, finite: the corners of all triangles
    i, j: rows of the first corners; i + 1, i + 2, j + 1, j + 2 follow
    expansion: (WORKSPACE,) float64, to work in
    """
    shared, a, d = 0, 0, 0  # the last corners that coincide
    first_a, first_d = 0, 0
    for k in range(3):
        for n in range(3):
            if _same_place(p, i + k, j + n):
                shared += 1
                first_a, first_d = a, d
                a, d = k, n
                break
    if shared == 0:
        if _parted_by(p, i, j) or _parted_by(p, j, i):
            return False
    elif shared == 1:
        b, c = i + (a + 1) % 3, i + (a + 2) % 3
        e, f = j + (d + 1) % 3, j + (d + 2) % 3
        if _parted_at_vertex(p, i + a, b, c, e, f):
            return False
    axis_i, axis_j = _flattest(p, i), _flattest(p, j)
    if axis_i < 0 or axis_j < 0:
        return False
    if shared == 0:
        for k in range(3):
            if _pierces(p, i + k, i + (k + 1) % 3, j, axis_j, expansion):
                return True
            if _pierces(p, j + k, j + (k + 1) % 3, i, axis_i, expansion):
                return True
        return False
    if shared == 1:
        # where they part beyond a, one of them ends at the side that is opposite a
        return _pierces(p, b, c, j, axis_j, expansion) or _pierces(p, e, f, i, axis_i, expansion)
    if shared == 2:
        third_i, third_j = i + 3 - first_a - a, j + 3 - first_d - d
        start, end = i + first_a, i + a
        here = _orient_2d(p, start, end, third_i, axis_i)
        there = _orient_2d(p, start, end, third_j, axis_i)
        if (here > 0.0) != (there > 0.0) or there == 0.0:
            return False  # in one plane they would lie on opposite sides
        return orient_space(p, start, end, third_i, third_j, expansion) == 0.0
    return True
