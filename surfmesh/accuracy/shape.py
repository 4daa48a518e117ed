"""The shape of triangles by their edge vectors, in the plane or in space."""

import numpy as np
from numpy.typing import NDArray


def mean_ratio(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) alpha = 4 sqrt(3) area / sum of squared edges, with edges u and v (k, 2 or 3) from one
    corner: 1 is equilateral, 0 has no area. In the plane that of a clockwise triangle is negative.
    """
    if u.shape[1] == 2:
        twice_area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    else:
        twice_area = np.linalg.norm(np.cross(u, v), axis=1)
    total = (u * u + v * v + (u - v) ** 2).sum(axis=1)
    return 2.0 * np.sqrt(3.0) * twice_area / np.where(total > 0.0, total, 1.0)
