"""Barycentric places (n, 3) at which the report looks at triangles."""

import numpy as np

MIDDLES = np.array([(0.5, 0.5, 0.0), (0.0, 0.5, 0.5), (0.5, 0.0, 0.5)])
"""Of sides 0, 1 and 2."""

CENTROID = np.full((1, 3), 1 / 3)

_GRID = 6
DENSE = np.array(
    [(i, j, _GRID - i - j) for i in range(_GRID + 1) for j in range(_GRID + 1 - i)]
) / float(_GRID)
"""The sides in six, corners included: between the samples of a coarser grid were 3% more in
triangles across a direction that turns."""
