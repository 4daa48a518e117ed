"""Does a lattice of triangles lie alike everywhere: the twin of src/sizing/principal_lattice.hpp.

Of a packing grown from one place the edges keep their direction where the metric of its sizes is
flat and principal directions are parallel in it: on cylinders, and on minimal surfaces that chord
alone decides the sizes of. With e1, e2 = h d1, h d2, steps of one size along the directions,
that is where steps commute: [e1, e2] = a e1 + b e2 = 0. On the way along an edge the lattice turns
against them by as much as sqrt(a^2 + b^2) at most (do Carmo, Riemannian Geometry, ch. 2: the
connection of a frame).
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.fundamental_forms import PrincipalCurvatures, curvatures, forms
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.size_rules import SizeRules

GRID = 9  # places along u and along v
STEP = 1e-4  # of the domain, of differences

LARGEST_TURN = 0.07
"""Radians: over half the diagonal of the surface. It costs 1 % of the chord on cylinders."""

LARGEST_TURN_STRETCHED, LEAST_ROWS_STRETCHED = 0.6, 16.0
"""The same of stretched triangles on saddles."""

LEAST_ROWS = 24.0
"""Triangles across, both ways: rims have rows of their own."""

ALIKE = 0.05
"""Ratios of curvatures that differ by less are one."""

TURNING, BOWL = -0.6, 0.3
"""Ratios of curvatures below which the best direction depends on them, and from which there is
none to speak of."""


def keeps_lattice(surface: Surface, extent: NDArray[np.float64], rules: SizeRules) -> bool:
    """extent: (2,) of the surface's chart. rules: for such a lattice."""
    if rules.sizing.has_law or not rules.follows_curvature:
        return False
    is_stretched = rules.sizing.is_anisotropic
    (u0, u1), (v0, v1) = surface.domain
    low, wide = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
    fraction = (np.arange(GRID) + 0.5) / GRID
    middle = np.stack(np.meshgrid(fraction, fraction), axis=-1).reshape(-1, 2)
    offsets = STEP * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    places = low + (middle + offsets[:, None]) * wide
    found = forms(surface, places.reshape(-1, 2))
    k = curvatures(found)
    larger = np.maximum(np.abs(k.k1), np.abs(k.k2))
    if found.degenerate.any() or not (larger > 0.0).all() or not np.isfinite(larger).all():
        return False
    if is_stretched:
        return _keeps_stretched(extent, rules, k, wide)
    ratio = k.gaussian / larger**2
    is_one = ratio.max() - ratio.min() <= ALIKE
    if ratio.max() > BOWL or not (is_one or ratio.min() >= TURNING):
        return False
    size = rules.from_curvature(k.k1, k.k2).reshape(5, -1)
    if size.max() >= rules.clamp[1] or extent.min() < LEAST_ROWS * size.max():
        return False
    steps = [size[:, :, None] * _one_way(d.reshape(5, -1, 2) / wide) for d in (k.d1, k.d2)]
    turn, growth = _turn_and_growth([size, size], steps)
    farthest = 0.5 * float(np.hypot(*extent))
    return growth <= rules.sizing.gradient and turn * farthest <= LARGEST_TURN


def _keeps_stretched(
    extent: NDArray[np.float64], rules: SizeRules, k: PrincipalCurvatures, wide: NDArray[np.float64]
) -> bool:
    """The same of sizes along the principal directions: on saddles that no ratio of them bounds."""
    bound = rules.sizing.anisotropy**2
    first, second = k.k1, -k.k2
    if not ((bound * first > second) & (bound * second > first)).all():
        return False
    both = [row.reshape(5, -1) for row in rules.principal(k.k1, k.k2).T]
    largest = max(row.max() for row in both)
    if largest >= rules.clamp[1] or extent.min() < LEAST_ROWS_STRETCHED * largest:
        return False
    directions = [_one_way(d.reshape(5, -1, 2) / wide) for d in (k.d1, k.d2)]
    steps = [h[:, :, None] * d for h, d in zip(both, directions)]
    turn, growth = _turn_and_growth(both, steps)
    farthest = 0.5 * float(np.hypot(*extent))
    return growth <= rules.sizing.gradient and turn * farthest <= LARGEST_TURN_STRETCHED


def _one_way(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Directions (5, n, 2) as at the first of five places."""
    along = np.einsum("mni,ni->mn", directions, directions[0])
    return np.where(along < 0.0, -1.0, 1.0)[:, :, None] * directions


def _turn_and_growth(
    sizes: list[NDArray[np.float64]], steps: list[NDArray[np.float64]]
) -> tuple[float, float]:
    """Largest angle that a lattice turns by on a unit of length; largest growth of sizes on it.

    sizes: (5, n) along both directions, at places and beside them; steps: (5, n, 2) along these, in
    fractions.
    """
    first, second = steps[0][0], steps[1][0]

    def change(field: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of a field (5, n, c) on a step (n, 2)."""
        rates = np.stack([field[1] - field[2], field[3] - field[4]], axis=-1) / (2.0 * STEP)
        return np.einsum("nci,ni->nc", rates, step)

    bracket = change(steps[1], first) - change(steps[0], second)
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    a = (bracket[:, 0] * second[:, 1] - bracket[:, 1] * second[:, 0]) / area
    b = (first[:, 0] * bracket[:, 1] - first[:, 1] * bracket[:, 0]) / area
    lengths = sizes[0][0], sizes[1][0]
    growth = 0.0
    for size in sizes:
        grown = [
            change(size[:, :, None], step)[:, 0] / length
            for step, length in zip((first, second), lengths)
        ]
        growth = max(growth, float(np.hypot(*grown).max()))
    return float(np.hypot(a / lengths[0], b / lengths[1]).max()), growth
