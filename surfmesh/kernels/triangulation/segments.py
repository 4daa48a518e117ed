"""How two segments of the plane meet, decided exactly; and distances to many segments.

The segment of a point is degenerate: both its ends are that point.
"""

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.triangulation.predicates import orient

CROSSING = 16
"""Flag of two segments that cross properly, no end of one being near the other.

The others, of a pair ab, cd:   1 a near cd   2 b near cd   4 c near ab   8 d near ab
"""

BLOCK = 16
"""Segments that share a bounding box in ``distances``, and boxes that share a larger one."""


@kernel
def _near(points, p, a, b, tolerance):
    """Is p on the segment ab, exactly or within the tolerance, without being one of its ends?"""
    if p == a or p == b or a == b:
        return False
    px, py = points[p, 0], points[p, 1]
    ax, ay, bx, by = points[a, 0], points[a, 1], points[b, 0], points[b, 1]
    if (
        px < min(ax, bx) - tolerance
        or px > max(ax, bx) + tolerance
        or py < min(ay, by) - tolerance
        or py > max(ay, by) + tolerance
    ):
        return False
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    if tolerance > 0.0 and length2 > 0.0:
        t = min(max(((px - ax) * dx + (py - ay) * dy) / length2, 0.0), 1.0)
        x, y = px - ax - t * dx, py - ay - t * dy
        if x * x + y * y <= tolerance * tolerance:
            return True
    return (
        orient(ax, ay, bx, by, px, py) == 0.0
        and min(ax, bx) <= px <= max(ax, bx)
        and min(ay, by) <= py <= max(ay, by)
    )


@kernel
def meetings(points, segments, pairs, tolerance, flags, places):
    """Fill the flags of each pair of segments, and the place of each proper crossing.

              c                      places[k] = a + t (b - a),  t = [cda] / ([cda] - [cdb])
              |                      with [pqr] twice the signed area of pqr
        a ----+---- b
              |                      points: (n, 2), segments: (s, 2), pairs: (k, 2)
              d                      flags: (k,) filled, places: (k, 2) filled where they cross

    With a tolerance of zero all flags are exact.
    """
    for k in range(len(pairs)):
        a, b = segments[pairs[k, 0], 0], segments[pairs[k, 0], 1]
        c, d = segments[pairs[k, 1], 0], segments[pairs[k, 1], 1]
        flag = 0
        if _near(points, a, c, d, tolerance):
            flag |= 1
        if a != b and _near(points, b, c, d, tolerance):
            flag |= 2
        if _near(points, c, a, b, tolerance):
            flag |= 4
        if c != d and _near(points, d, a, b, tolerance):
            flag |= 8
        if flag == 0 and a != c and a != d and b != c and b != d and a != b and c != d:
            ax, ay, bx, by = points[a, 0], points[a, 1], points[b, 0], points[b, 1]
            cx, cy, dx, dy = points[c, 0], points[c, 1], points[d, 0], points[d, 1]
            cda, cdb = orient(cx, cy, dx, dy, ax, ay), orient(cx, cy, dx, dy, bx, by)
            if (cda > 0.0 and cdb < 0.0) or (cda < 0.0 and cdb > 0.0):
                abc, abd = orient(ax, ay, bx, by, cx, cy), orient(ax, ay, bx, by, dx, dy)
                if (abc > 0.0 and abd < 0.0) or (abc < 0.0 and abd > 0.0):
                    flag = CROSSING
                    t = cda / (cda - cdb)
                    places[k, 0] = ax + t * (bx - ax)
                    places[k, 1] = ay + t * (by - ay)
        flags[k] = flag


@kernel
def squared_distance(segments, s, x, y, z):
    ax, ay, az = segments[s, 0], segments[s, 1], segments[s, 2]
    dx, dy, dz = segments[s, 3] - ax, segments[s, 4] - ay, segments[s, 5] - az
    x, y, z = x - ax, y - ay, z - az
    length2 = dx * dx + dy * dy + dz * dz
    if length2 > 0.0:
        t = min(max((x * dx + y * dy + z * dz) / length2, 0.0), 1.0)
        x, y, z = x - t * dx, y - t * dy, z - t * dz
    return x * x + y * y + z * z


@kernel
def squared_distance_to_box(boxes, k, x, y, z):
    dx = max(boxes[k, 0] - x, x - boxes[k, 3], 0.0)
    dy = max(boxes[k, 1] - y, y - boxes[k, 4], 0.0)
    dz = max(boxes[k, 2] - z, z - boxes[k, 5], 0.0)
    return dx * dx + dy * dy + dz * dz


@kernel
def distances(points, segments, boxes, groups, out):
    """Distance of each point to the nearest segment.

    points: (n, 3). segments: (s, 6), rows (start, end). boxes: (ceil(s / BLOCK), 6), rows
    (low, high) that bound BLOCK segments in a row. groups: the same for BLOCK boxes in a row.
    out: (n,) filled.
    """
    nearest = 0  # neighbouring points often have the same nearest segment
    for k in range(len(points)):
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        best = squared_distance(segments, nearest, x, y, z)
        for group in range(len(groups)):
            if squared_distance_to_box(groups, group, x, y, z) >= best:
                continue
            for block in range(BLOCK * group, min(BLOCK * (group + 1), len(boxes))):
                if squared_distance_to_box(boxes, block, x, y, z) >= best:
                    continue
                for s in range(BLOCK * block, min(BLOCK * (block + 1), len(segments))):
                    found = squared_distance(segments, s, x, y, z)
                    if found < best:
                        best, nearest = found, s
        out[k] = best**0.5
