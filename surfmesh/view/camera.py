"""From where a mesh is looked at: one rule for every picture."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FROM = np.array([0.62, -1.0, 0.72])  # from the front right, above
FROM_ABOVE = np.array([0.0, -1e-3, 1.0])  # all but: y is upwards in the picture


class Camera(NamedTuple):
    """An orthographic view. Axes are unit vectors in model space."""

    centre: NDArray[np.float64]  # (3,) of the picture
    right: NDArray[np.float64]
    up: NDArray[np.float64]
    towards: NDArray[np.float64]  # from the mesh to the eye
    half_height: float  # of what is seen, model units
    distance: float  # of the eye from the centre, beyond the mesh


def framed(points: NDArray[np.float64], aspect: float, margin: float = 0.06) -> Camera:
    """The camera that just holds ``points`` in a picture ``aspect`` = width / height."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    towards = direction_of(points)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    across, along = points @ right, points @ up
    middle = 0.5 * np.array([across.min() + across.max(), along.min() + along.max()])
    half_width, half_height = 0.5 * np.ptp(across), 0.5 * np.ptp(along)
    depth = (points @ towards).mean()
    return Camera(
        centre=middle[0] * right + middle[1] * up + depth * towards,
        right=right,
        up=up,
        towards=towards,
        half_height=(1 + margin) * max(half_height, half_width / aspect, 1e-300),
        distance=4.0 * float(np.linalg.norm(extent)) or 1.0,
    )


def direction_of(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) unit vector towards the eye.

    A planar domain is looked at from above, and a surface that is almost flat more from there.
    """
    extent = np.ptp(points, axis=0)
    if extent[2] == 0.0:
        return FROM_ABOVE / np.linalg.norm(FROM_ABOVE)
    direction = FROM.copy()
    if extent[2] < 0.05 * extent[:2].max():
        direction[2] = 2.2
    return direction / np.linalg.norm(direction)
