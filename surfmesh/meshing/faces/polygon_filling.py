"""A polygon in space closed by triangles between its corners, of least total area.

Dynamic programming over the diagonals (G. Barequet and M. Sharir, Filling gaps in the boundary
of a polyhedron, Computer Aided Geometric Design 12, 1995): the best filling of the corners
i .. k is a triangle (i, m, k) and the best fillings of i .. m and m .. k.
"""

import numpy as np

MOST_CORNERS = 500
"""The work grows with the cube of their number."""


def filled(points: np.ndarray) -> np.ndarray:
    """Triangles (n - 2, 3) that close the polygon points (n, 3), n >= 3, turning as it does."""
    count = len(points)
    area = np.zeros((count, count))
    apex = np.zeros((count, count), np.int64)
    for span in range(2, count):
        first = np.arange(count - span)
        last = first + span
        middle = first[:, None] + np.arange(1, span)
        a, b, c = points[first][:, None], points[middle], points[last][:, None]
        own = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=2)
        total = own + area[first[:, None], middle] + area[middle, last[:, None]]
        best = total.argmin(axis=1)
        area[first, last] = total[first, best]
        apex[first, last] = first + 1 + best
    triangles, stack = [], [(0, count - 1)]
    while stack:
        i, k = stack.pop()
        if k - i > 1:
            m = int(apex[i, k])
            triangles.append((i, m, k))
            stack += [(i, m), (m, k)]
    return np.array(triangles, np.int32).reshape(-1, 3)
