"""The edge length that a surface's curvature allows in a given direction."""

from collections.abc import Sequence

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.direction_rates import (
    ROUND,
    direction_rates,
    has_even_curvature,
    longest_along,
)
from surfmesh.sizing.rules.size_rules import SizeRules


def size_along(
    surfaces: Sequence[Surface], uv: Sequence[np.ndarray], directions: np.ndarray, rules: SizeRules
) -> np.ndarray:
    """Sizes (n,) along tangent directions (n, 3), in the anisotropic metric.

    uv: of each surface (k, 2), the directions being those at all of them in one row.
    1 / h^2 = cos^2 / h1^2 + sin^2 / h2^2 with the angle to the first principal direction.
    Infinite at degenerate points.
    """
    derivatives = [surface.evaluate(own, 2)[1:] for surface, own in zip(surfaces, uv)]
    ru, rv, *second = map(np.concatenate, zip(*derivatives))
    forms = forms_from_derivatives(ru, rv, *second)
    k = curvatures(forms)
    sizes = rules.principal(k.k1, k.k2)
    shorter, along_first = sizes.min(axis=1), sizes[:, 0] > sizes[:, 1]
    rates = np.zeros((len(shorter), 2))
    ends = np.cumsum([len(own) for own in uv]).tolist()
    for surface, own, end in zip(surfaces, uv, ends):
        if not has_even_curvature(surface):
            rows = slice(end - len(own), end)
            rates[rows] = direction_rates(surface, own, along_first[rows], shorter[rows])
    bound = longest_along(rates, k.k1, k.k2, shorter, rules.sizing.chord or 0.0)
    stretched = sizes.max(axis=1) > ROUND * shorter
    sizes = np.where(stretched[:, None], np.minimum(sizes, bound[:, None]), sizes)
    cosines = [
        np.einsum("ij,ij->i", d[:, :1] * ru + d[:, 1:] * rv, directions) for d in (k.d1, k.d2)
    ]
    length = elementary_functions.hypot(*cosines)  # of the direction's part in the tangent plane
    inverse = elementary_functions.hypot(cosines[0] / sizes[:, 0], cosines[1] / sizes[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        size = length / inverse
    return np.where(forms.degenerate | ~np.isfinite(size), np.inf, size)
