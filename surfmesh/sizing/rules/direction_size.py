"""The edge length that a surface's curvature allows in a given direction."""

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.direction_rates import ROUND, direction_rates, longest_along
from surfmesh.sizing.rules.size_rules import SizeRules


def size_along(
    surface: Surface, uv: np.ndarray, directions: np.ndarray, rules: SizeRules
) -> np.ndarray:
    """Sizes (n,) at uv (n, 2) along tangent directions (n, 3), in the anisotropic metric.

    1 / h^2 = cos^2 / h1^2 + sin^2 / h2^2 with the angle to the first principal direction.
    Infinite at degenerate points.
    """
    _, ru, rv, *second = surface.evaluate(uv, 2)
    forms = forms_from_derivatives(ru, rv, *second)
    k = curvatures(forms)
    sizes = rules.principal(k.k1, k.k2)
    shorter, along_first = sizes.min(axis=1), sizes[:, 0] > sizes[:, 1]
    rates = direction_rates(surface, uv, along_first, shorter)
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
