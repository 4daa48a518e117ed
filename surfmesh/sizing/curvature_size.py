"""The edge length that a curvature allows.

A triangle with its corners on the quadric z = (k1 x^2 + k2 y^2) / 2 misses it by the linear
interpolation error of z. For an equilateral triangle of side h this error is

- at the centroid        h^2 |k1 + k2| / 12     (the same for every orientation),
- at an edge's middle    h^2 |kn| / 8           (kn the normal curvature along the edge),

and nowhere larger than the larger of the two, with kn at most max |k1|, |k2|, up to 4.2%
in between (``tests`` compare it with a dense search). On a sphere that is h^2 k / 6.
"""

import math

import numpy as np

DEVIATION_RESERVE = 0.62
"""Share of ``chord`` that a unit triangle may use: real triangles are up to 1.26 times as
large as the unit one (circumradius), and deviation grows with the square."""


def deviation_factor(k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """c with deviation = c h^2, for principal curvatures k1, k2 (n,), 1 / model unit."""
    return np.maximum(np.abs(k1 + k2) / 12.0, np.maximum(np.abs(k1), np.abs(k2)) / 8.0)


def chord_size(k1: np.ndarray, k2: np.ndarray, chord: float) -> np.ndarray:
    """Edge length (n,) at which triangles stay within ``chord`` of the surface.

    Never less than 2 ``chord``: a smaller triangle is within ``chord`` whatever the curvature.
    """
    factor = deviation_factor(k1, k2)
    with np.errstate(divide="ignore", over="ignore"):
        size = np.sqrt(DEVIATION_RESERVE * chord / factor)
    return np.maximum(size, 2.0 * chord)


def angle_size(k1: np.ndarray, k2: np.ndarray, angle: float) -> np.ndarray:
    """Edge length (n,) at which neighbouring normals differ by at most ``angle`` (degrees).

    The normal of a triangle is that of the surface at its centre, and the centres of two
    neighbouring equilateral triangles of side h are h / sqrt(3) apart.
    """
    largest = np.maximum(np.abs(k1), np.abs(k2))
    with np.errstate(divide="ignore", over="ignore"):
        return math.sqrt(3.0) * 0.75 * math.radians(angle) / largest
