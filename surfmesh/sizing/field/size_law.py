"""The ungraded target sizes at points of one surface, with what a size field stores there."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.fundamental_forms import (
    FundamentalForms,
    curvatures,
    forms_from_derivatives,
)
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.metric_roots import DIAGONAL, outer, symmetric_root
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import ROUND, direction_rates, longest_along
from surfmesh.sizing.rules.rim_size import Rims, RimSizes
from surfmesh.sizing.rules.size_bounds import SizeBounds
from surfmesh.sizing.rules.size_limits import SizeLimits

ALIKE = 1.01
"""Ratio up to which they are one size: on flat places ``along`` is round-off."""


class FieldNodes(NamedTuple):
    """What is known at n nodes of a size field; lengths are in model units.

    The last seven are empty where sizes are isotropic. Where they are not, ``size`` holds at
    right angles to ``along`` and is the shorter one, before gradation.
    """

    size: np.ndarray  # (n,) wanted edge length
    target_size: np.ndarray  # (n,) the same before sources and gradation have lowered it
    root: np.ndarray  # (n, 3) I^(1/2) in the scaled plane
    normal: np.ndarray  # (n, 3) unit, zero at degenerate points
    point: np.ndarray  # (n, 3)
    long: np.ndarray  # (n,) wanted length along ``along``
    long_target_size: np.ndarray  # (n,)
    along: np.ndarray  # (n, 3) unit tangent
    jacobian: np.ndarray  # (n, 3, 2) r_x, r_y
    asked: np.ndarray  # (n, 2) size and long before gradation
    curvature: np.ndarray  # (n, 2) principal curvatures
    direction_rates: np.ndarray  # (n, 2) at which ``along`` fans out and bends, see there

    @classmethod
    def isotropic(cls, size, target_size, root, normal, point) -> "FieldNodes":
        no, pairs = np.empty(0), np.empty((0, 2))
        jacobian = np.empty((0, 3, 2))
        return cls(
            size,
            target_size,
            root,
            normal,
            point,
            no,
            no,
            np.empty((0, 3)),
            jacobian,
            pairs,
            pairs,
            pairs,
        )

    @classmethod
    def none(cls) -> "FieldNodes":
        no, vectors = np.empty(0), np.empty((0, 3))
        return cls.isotropic(no, no, vectors, vectors, vectors)

    @property
    def is_anisotropic(self) -> bool:
        return len(self.long) > 0

    def joined_with(self, others: "FieldNodes") -> "FieldNodes":
        """These nodes, then the others."""
        return FieldNodes(*(np.concatenate(pair) for pair in zip(self, others)))

    @property
    def is_round(self) -> np.ndarray:
        """Where (n,) uint8 one size was asked for: gradation may stretch it, but only ``along``."""
        size, long = self.asked.T
        return (long <= ALIKE * size).astype(np.uint8)

    def in_order(self) -> "FieldNodes":
        """The same metric with the longer size along ``along``: gradation may have turned them."""
        if not self.is_anisotropic:
            return self
        other = self.long < self.size
        along = self.along.copy()
        along[other] = np.cross(self.normal, self.along)[other]
        size, long = np.minimum(self.size, self.long), np.maximum(self.size, self.long)
        return self._replace(size=size, long=long, along=along)

    def inverse_sizes(self) -> np.ndarray:
        """A = H^-1 = M^(1/2) (n, 3) in the scaled plane."""
        if not self.is_anisotropic:
            return self.root / self.size[:, None]
        # M = I / h^2 - (1 / h^2 - 1 / long^2) p p^T, with p = J^T along
        e = self.root[:, 0] ** 2 + self.root[:, 1] ** 2
        f = self.root[:, 1] * (self.root[:, 0] + self.root[:, 2])
        g = self.root[:, 1] ** 2 + self.root[:, 2] ** 2
        p, q = np.einsum("nij,ni->jn", self.jacobian, self.along)
        scale, less = self.size**-2.0, self.size**-2.0 - self.long**-2.0
        # det M without cancellation, as det I = det(root)^2
        det = (self.root[:, 0] * self.root[:, 2] - self.root[:, 1] ** 2) / (self.size * self.long)
        e, f, g = scale * e - less * p * p, scale * f - less * p * q, scale * g - less * q * q
        return symmetric_root(e, f, g, np.maximum(det, 0.0))

    def metric_roots_3d(self) -> np.ndarray:
        """W = Id / h - (1 / h - 1 / long) t t^T (n, 6), t = along: xx, xy, xz, yy, yz, zz.

        Across the surface the shorter size holds, so that W does not change where the surface
        bends about its straighter direction alone. Empty where sizes are isotropic.
        """
        if not self.is_anisotropic:
            return np.empty((0, 6))
        less = 1.0 / self.size - 1.0 / self.long
        w = outer(-less[:, None] * self.along, self.along)
        w[:, DIAGONAL] += 1.0 / self.size[:, None]
        return w


def root_of_form(forms: FundamentalForms, rates: np.ndarray) -> np.ndarray:
    """I^(1/2) (n, 3) in the scaled plane, whose axes run at ``rates`` (n, 2)."""
    du, dv = rates.T
    e, f, g = forms.E * du * du, forms.F * du * dv, forms.G * dv * dv
    return symmetric_root(e, f, g, np.sqrt(np.maximum(e * g - f * f, 0.0)))


class SizeLaw:
    """From the curvature and the user's wishes."""

    def __init__(
        self, surface: Surface, sizing: Sizing, limits: SizeLimits | None, rims: Rims | None = None
    ) -> None:
        """rims: bound the size too, where ``chord`` is asked for."""
        self.surface, self.chart = surface, Chart.of(surface)
        (u0, u1), (v0, v1) = surface.domain
        grid = np.linspace(0.0, 1.0, 17)
        t = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
        (points,) = surface.evaluate(np.array([u0, v0]) + t * np.array([u1 - u0, v1 - v0]), 0)
        self.diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
        self.bounds = SizeBounds.of(sizing, self.diagonal)
        self.sizing, self.clamp = self.bounds.sizing, self.bounds.clamp
        self.follows_curvature = self.bounds.follows_curvature
        self.limits = limits
        self.rims = None if self.sizing.chord is None else rims
        self.loop_limits: SizeLimits | None = None
        if self.rims is not None:
            self.loop_limits = self.rims.on_loops(
                self.sizing.chord, self.sizing.gradient, self._by_surface,
                narrow=self.sizing.is_anisotropic,
            )  # fmt: skip

    def _by_surface(self, uv: np.ndarray) -> np.ndarray:
        """Sizes (n,) that the curvature of the surface allows at uv (n, 2)."""
        _, *derivatives = self.surface.evaluate(uv, 2)
        forms = forms_from_derivatives(*derivatives)
        k = curvatures(forms)
        return np.where(forms.degenerate, self.clamp[1], self.bounds.shorter(k.k1, k.k2))

    def from_curvature(self, k: np.ndarray) -> np.ndarray:
        """Largest size (n,) where the surface is curved by at most k (n,), 1 / model unit."""
        # curved one way only chord allows most, curved both ways alike angle does
        other = np.zeros(len(k)) if self.sizing.angle is None else k
        if self.sizing.is_anisotropic:
            return self.bounds.principal(k, other).min(axis=1)
        return self.bounds.from_curvature(k, other)

    def __call__(self, xy: np.ndarray) -> FieldNodes:
        """Nodes at xy (n, 2) of the scaled plane."""
        uv, rates = self.chart.to_uv_and_rates(xy)
        point, ru, rv, *second = self.surface.evaluate(uv, 2)
        forms = forms_from_derivatives(ru, rv, *second)
        root = root_of_form(forms, rates)
        if self.sizing.is_anisotropic:
            return self._anisotropic(xy, uv, point, ru, rv, rates, forms, root)
        size = np.full(len(uv), self.clamp[1])
        if self.follows_curvature:
            k = curvatures(forms)
            size = self.bounds.from_curvature(k.k1, k.k2)
            # nothing is known at a pole or a cusp: gradation brings the neighbours' size
            size[forms.degenerate] = self.clamp[1]
        if self.sizing.has_law:
            size = np.clip(np.minimum(size, self.sizing.law_sizes(point)), *self.clamp)
        for rows, _, allowed in self.rims_at(xy, uv, point):
            size[rows] = np.minimum(size[rows], np.maximum(allowed, self.clamp[0]))
        target_size = size
        if self.limits is not None:
            size = np.minimum(size, self._limited(point))
            if self.limits.uv is None:
                target_size = size
        return FieldNodes.isotropic(size, target_size, root, forms.normal, point)

    def _anisotropic(
        self, xy: np.ndarray, uv: np.ndarray, point: np.ndarray, ru: np.ndarray, rv: np.ndarray,
        rates: np.ndarray, forms: FundamentalForms, root: np.ndarray,
    ) -> FieldNodes:  # fmt: skip
        """Two sizes along the principal directions."""
        k = curvatures(forms)
        sizes = self.bounds.principal(k.k1, k.k2)
        first = (sizes[:, 0] > sizes[:, 1])[:, None]
        direction = np.where(first, k.d1, k.d2)
        along = direction[:, :1] * ru + direction[:, 1:] * rv
        along[forms.degenerate] = [1.0, 0.0, 0.0]
        sizes[forms.degenerate] = self.clamp[1]
        along /= np.linalg.norm(along, axis=1)[:, None]
        if self.sizing.has_law:  # holds in every direction
            wished = np.maximum(self.sizing.law_sizes(point), self.clamp[0])
            sizes = np.minimum(sizes, wished[:, None])
        size, long = sizes.min(axis=1), sizes.max(axis=1)
        for rows, rim, allowed in self.rims_at(xy, uv, point):
            binding = np.flatnonzero(allowed < long[rows])
            rim = rim.chosen(binding) if isinstance(rim, RimSizes) else rim
            rows = rows[binding]
            if isinstance(rim, RimSizes):
                rows, rim = self._fitted(rim, rows, forms.normal, along, size, long)
            along[rows], size[rows], long[rows] = self._limited_both(
                rim, self.clamp[0], point[rows], forms.normal[rows], along[rows], size[rows],
                long[rows],
            )  # fmt: skip
        target_size, long_target_size = size, long
        if self.limits is not None:
            along, size, long = self._limited_both(
                self.limits, self._least(), point, forms.normal, along, size, long
            )
            if self.limits.uv is None:
                target_size, long_target_size = size, long
        jacobian = np.stack([ru * rates[:, :1], rv * rates[:, 1:]], axis=2)
        return FieldNodes(
            size, target_size, root, forms.normal, point, long, long_target_size, along, jacobian,
            np.stack([size, long], axis=1), np.stack([k.k1, k.k2], axis=1),
            direction_rates(self.surface, uv, k, first[:, 0], size),
        )  # fmt: skip

    def _fitted(
        self, rim: RimSizes, rows: np.ndarray, normal: np.ndarray, along: np.ndarray,
        size: np.ndarray, long: np.ndarray,
    ) -> tuple[np.ndarray, RimSizes]:  # fmt: skip
        """Lower ``size`` or ``long`` (n,), in place, until the metric keeps to the rim at ``rows``.

        Whichever is lowered by less: a rim that runs slantwise says little of the long direction.
        Returns the rows (k,) where the metric is round and has no direction yet, and their rims.
        """
        flat = long[rows] <= ROUND * size[rows]
        slant = np.flatnonzero(~flat)
        at = rows[slant]
        onward = np.einsum("ij,ij->i", rim.tangent[slant], along[at]) ** 2
        wanted = np.maximum(rim.sizes[slant], self.clamp[0]) ** -2.0
        short_part, long_part = (1.0 - onward) / size[at] ** 2, onward / long[at] ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            factors = [
                np.sqrt(np.maximum(part / (wanted - other), 0.0))
                for part, other in ((short_part, long_part), (long_part, short_part))
            ]
        narrower, shorter = (np.where(np.isfinite(f), f, 0.0) for f in factors)
        narrower[wanted <= long_part] = shorter[wanted <= short_part] = 0.0
        beyond = short_part + long_part < wanted
        by_width = beyond & (narrower >= shorter)
        by_length = beyond & ~by_width
        size[at[by_width]] *= narrower[by_width]
        long[at[by_length]] = np.maximum(
            long[at[by_length]] * shorter[by_length], size[at[by_length]]
        )
        return rows[flat], rim.chosen(np.flatnonzero(flat))

    def longest_along(self, nodes: FieldNodes, size: np.ndarray) -> np.ndarray:
        """Largest ``long`` (n,) where directions turn, of triangles that are ``size`` (n,) wide."""
        k1, k2 = nodes.curvature.T
        bound = longest_along(nodes.direction_rates, k1, k2, size, self.sizing.chord or 0.0)
        return np.where(nodes.asked[:, 1] > ROUND * nodes.asked[:, 0], bound, np.inf)

    def regained(self, nodes: FieldNodes, ratio: np.ndarray) -> np.ndarray:
        """Sizes (n,) across ``along`` where no more than a ``ratio`` (n,) is made use of.

        What a long edge takes of the chord where both curvatures are alike is free again.
        """
        k1, k2 = nodes.curvature.T
        asked = self.bounds.principal(k1, k2).min(axis=1)
        size = self.bounds.principal(k1, k2, ratio).min(axis=1)
        untouched = nodes.asked[:, 0] >= asked  # by laws and limits
        return np.where(untouched, np.maximum(nodes.asked[:, 0], size), nodes.asked[:, 0])

    def _least(self) -> float:
        """No limit goes below it; sizes that edges have been cut with hold as they are."""
        if self.limits.as_cut:
            return 0.0
        return self.clamp[0] if self.limits.uv is None else self.sizing.min_size or 0.0

    def _limited(self, points: np.ndarray) -> np.ndarray:
        """What sources and earlier rounds allow at points (n, 3)."""
        return np.maximum(self.limits(points), self._least())

    def rims_at(
        self, xy: np.ndarray, uv: np.ndarray, point: np.ndarray
    ) -> Iterator[tuple[np.ndarray, RimSizes | SizeLimits, np.ndarray]]:
        """Rows (k,) of nodes that rims have something to say to, what it is, and the least of
        it (k,) in any direction: nodes on each open side, and all, if there are loops."""
        if self.rims is not None:
            for rows, rim in self.rims.on_sides(self.chart, self.sizing.chord, xy, uv):
                yield rows, rim, rim.sizes
        if self.loop_limits is not None:
            yield np.arange(len(xy)), self.loop_limits, self.loop_limits(point)

    def _limited_both(
        self, limits: SizeLimits | RimSizes, least: float, point: np.ndarray, normal: np.ndarray,
        along: np.ndarray, size: np.ndarray, long: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
        """The direction, and the sizes across and along it, lowered to the limits.

        Where the shorter one is lowered the shape of the metric is kept. Where the metric is
        round, or nearly so, the direction is that of the limits.
        """
        directions = np.stack([np.cross(normal, along), along])
        across, onward = np.maximum(limits.along(point, directions), least)
        factor = np.minimum(across, size) / size
        long_found = np.minimum(factor * long, onward)
        size_found = np.minimum(factor * size, long_found)
        flat = np.flatnonzero((long <= ROUND * size) & (normal != 0.0).any(axis=1))
        if len(flat):
            own = limits.chosen(flat) if isinstance(limits, RimSizes) else limits
            tight, direction = own.tightest(point[flat], normal[flat])
            turned = np.cross(normal[flat], direction)
            onward = np.maximum(own.along(point[flat], turned[None])[0], least)
            tight = np.maximum(tight, least)
            size_found[flat] = np.minimum(size[flat], tight)
            long_found[flat] = np.clip(
                np.minimum(size[flat], onward),
                size_found[flat], self.sizing.anisotropy * size_found[flat],
            )  # fmt: skip
            along = along.copy()
            along[flat] = turned
        return along, size_found, long_found


class TensorLaw:
    """Size tensors given over a plane, in the place of sizes that follow from a surface."""

    follows_curvature = False
    limits = loop_limits = None

    def __init__(
        self, surface: Surface, sizing: Sizing, tensors: Callable[[np.ndarray], np.ndarray]
    ) -> None:
        self.surface, self.chart = surface, Chart.of(surface)
        self.sizing, self.tensors = sizing, tensors

    def __call__(self, xy: np.ndarray) -> FieldNodes:
        """Nodes with sizes of one, and H^-1 for the root of the first form."""
        uv = self.chart.to_uv(xy)
        h = self.tensors(uv)
        det = h[:, 0] * h[:, 2] - h[:, 1] ** 2
        inverse = np.stack([h[:, 2], -h[:, 1], h[:, 0]], axis=1) / det[:, None]
        normal = np.tile([0.0, 0.0, 1.0], (len(uv), 1))
        size = np.ones(len(uv))
        return FieldNodes.isotropic(size, size, inverse, normal, self.surface.evaluate(uv, 0)[0])
