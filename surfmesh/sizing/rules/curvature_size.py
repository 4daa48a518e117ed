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

from surfmesh._core import patch
from surfmesh.geometry.number_range import RANGE

DEVIATION_RESERVE = 0.62
"""Share of ``chord`` that a unit triangle may use: real triangles are up to 1.26 times as
large as the unit one (circumradius), and deviation grows with the square."""

ROUND_RESERVE, BENT_RESERVE = patch.ROUND_RESERVE, patch.BENT_RESERVE  # 0.78, 0.94
"""Share of ``angle`` that two unit triangles may be bent by: on a sphere, where all edges are alike
and some triangles are larger; and for what depends on the direction, as few edges lie worst."""

STRETCHED_RESERVE, STRAIGHT_RESERVE = 0.7, 0.75
"""The same for anisotropic sizes, where triangles that lie too far are split: where the surface
is curved both ways, and where one way only. There edges alone decide, and few of those that run
that way are more than 1.15 times as long as wanted."""


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


def dihedral_factor(k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
    """c with angle = c h (radians) between two triangles of side h that share an edge.

    Across an edge along t, with n at right angles to it, the slope of linear interpolation of
    a quadric jumps by h (3 k_nn - k_tt) / (2 sqrt(3)): the far corners rise by k_nn, the edge
    itself sags by k_tt. This is its largest value over all directions of the edge.
    """
    return (0.5 * np.abs(k1 + k2) + np.abs(k1 - k2)) / math.sqrt(3.0)


def angle_size(k1: np.ndarray, k2: np.ndarray, angle: float) -> np.ndarray:
    """Edge length (n,) at which dihedral angles are at most ``angle`` (degrees).

    As ``dihedral_factor`` has it, with a reserve.
    """
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):  # both may be infinite
        mean, bent = np.where(k1 == -k2, 0.0, k1 + k2), np.where(k1 == k2, 0.0, k1 - k2)
        bend = 0.5 * np.abs(mean) / ROUND_RESERVE + np.abs(bent) / BENT_RESERVE
        return math.sqrt(3.0) * math.radians(angle) / bend


def normal_deviation_size(k1: np.ndarray, k2: np.ndarray, angle: float) -> np.ndarray:
    """Edge length (n,) at which the normals of neighbours differ by at most ``angle`` (degrees).

    The normal of the surface, that is: a rule against folds, no bound on the triangles. The
    centres of two neighbouring equilateral triangles of side h are h / sqrt(3) apart.
    """
    largest = np.maximum(np.abs(k1), np.abs(k2))
    with np.errstate(divide="ignore", over="ignore"):
        return math.sqrt(3.0) * 0.75 * math.radians(angle) / largest


def principal_chord_sizes(
    k1: np.ndarray, k2: np.ndarray, chord: float, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Edge lengths (n,) along the directions of k1 and k2 at which triangles stay within ``chord``.

    With h_i^2 |k_i| = a in both directions the errors above are, for triangles that are
    equilateral in this metric, (1 + b) a / 12 at the centroid and a / 8 in the middle of an
    edge. b is the signed ratio of the h_i^2 k_i: 1 or -1, or between where one size is bound by
    ``ratio`` times the other. For a ratio of 1 it is the rule of ``chord_size``. The tensor with
    these sizes is a function of the shape operator without regard to the order of k1 and k2, and so
    as smooth as that at umbilics.
    """
    first, second = np.abs(k1), np.abs(k2)
    balance = _balance(k1, k2, ratio)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        reserve = STRAIGHT_RESERVE + (STRETCHED_RESERVE - STRAIGHT_RESERVE) * np.abs(balance)
        bound = reserve * chord / np.maximum(0.125, (1.0 + balance) / 12.0)
        sizes = np.sqrt(bound / first), np.sqrt(bound / second)
    return np.maximum(sizes[0], 2.0 * chord), np.maximum(sizes[1], 2.0 * chord)


def principal_angle_sizes(
    k1: np.ndarray, k2: np.ndarray, angle: float, ratio: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Edge lengths (n,) along k1 and k2 at which dihedral angles are at most ``angle`` (degrees).

    With h_i^2 |k_i| = a as above the slope jumps by a (3 - b) / (2 sqrt(3) h_i) across an edge
    at right angles to direction i, the shorter h_i decides. Sizes that keep h_i |k_i| alike
    would not do: the sag of a long edge tilts the narrow triangles beside it.
    """
    first, second = np.abs(k1), np.abs(k2)
    large = np.maximum(first, second)
    balance = _balance(k1, k2, ratio)
    # (3 - b) / 2, the parts with a reserve each
    bend = 0.5 * (1.0 + balance) / ROUND_RESERVE + (1.0 - balance) / BENT_RESERVE
    wanted = math.sqrt(3.0) * math.radians(angle) / bend
    with np.errstate(divide="ignore", over="ignore"):
        return wanted / np.sqrt(large * first), wanted / np.sqrt(large * second)


def _balance(k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float) -> np.ndarray:
    """b (n,): signed ratio of h_i^2 k_i, -1 to 1, where sizes differ by up to ``ratio``."""
    first, second = np.abs(k1), np.abs(k2)
    small = np.where(first < second, k1, k2) * np.where(first < second, np.sign(k2), np.sign(k1))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        share = small / np.maximum(first, second)
        return np.clip(np.nan_to_num(np.minimum(ratio, RANGE.square) ** 2 * share), -1.0, 1.0)
