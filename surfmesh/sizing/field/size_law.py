"""The ungraded target sizes at points of one surface, with what a size field stores there."""

from collections.abc import Callable, Iterator
from copy import copy
from typing import NamedTuple

import numpy as np

from surfmesh._core import sizing as core
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.fundamental_forms import (
    FundamentalForms,
    curvatures,
    forms_from_derivatives,
)
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import ROUND, has_even_curvature, longest_along
from surfmesh.sizing.rules.principal_lattice import keeps_lattice
from surfmesh.sizing.rules.rim_rule import LoopRule, RimRule, Rims
from surfmesh.sizing.rules.rule import DirectedRule, Places, Rule
from surfmesh.sizing.rules.size_limits import SizeLimits
from surfmesh.sizing.rules.size_rules import SizeRules

_GRID = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, 17)] * 2), axis=-1).reshape(-1, 2)
"""Where the extent of a surface is looked at, on the unit square."""


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
    def isotropic(
        cls, size: np.ndarray, target_size: np.ndarray, root: np.ndarray, normal: np.ndarray,
        point: np.ndarray,
    ) -> "FieldNodes":  # fmt: skip
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

    @property
    def is_anisotropic(self) -> bool:
        return len(self.long) > 0


class Local(NamedTuple):
    """A surface at n places, as far as rules ask for it."""

    at: Places
    ru: np.ndarray  # (n, 3)
    rv: np.ndarray  # (n, 3)
    rates: np.ndarray  # (n, 2) of the chart, see there
    forms: FundamentalForms


class SizeLaw:
    """From the curvature and what is asked for."""

    def __init__(
        self, surface: Surface, chart: Chart, rules: SizeRules, limits: SizeLimits | None = None,
        rims: Rims | None = None,
    ) -> None:  # fmt: skip
        """limits: of edges and earlier rounds. rims: bound the size too, where there is a chord."""
        self.surface, self.chart, self.rules, self.limits = surface, chart, rules, limits
        self.sizing, self.clamp = rules.sizing, rules.clamp
        self.follows_curvature = rules.follows_curvature
        self.is_on_lattice = rules.is_on_lattice
        """Are sizes for a lattice that is laid along principal directions?"""
        self.directed: tuple[DirectedRule, ...] = ()
        """Rules that hold in some directions only: those of the rims."""
        chord = self.sizing.straight_chord  # arcs of quadratic triangles are measured on the mesh
        if rims is not None and chord is not None:
            self.directed = tuple(
                rims.rules(
                    chart, chord, self.sizing.gradient, self._by_surface,
                    narrow=self.sizing.is_anisotropic,
                )
            )  # fmt: skip

    @classmethod
    def of(
        cls, surface: Surface, sizing: Sizing, limits: SizeLimits | None = None,
        rims: Rims | None = None, chart: Chart | None = None,
    ) -> "SizeLaw":  # fmt: skip
        """With the defaults that follow from the extent of the surface, and its chart."""
        (u0, u1), (v0, v1) = surface.domain
        (points,) = surface.evaluate(np.array([u0, v0]) + _GRID * np.array([u1 - u0, v1 - v0]), 0)
        rules, chart = SizeRules.of(sizing, diagonal(points)), chart or Chart.of(surface)
        on_lattice = rules.on_lattice()
        if on_lattice is not None and keeps_lattice(surface, chart.extent, on_lattice):
            rules = on_lattice
        return cls(surface, chart, rules, limits, rims)

    def without_limits(self) -> "SizeLaw":
        """What the rules say by themselves."""
        own = copy(self)
        own.limits = None
        return own

    @property
    def loop_limits(self) -> SizeLimits | None:
        """Those along trimming loops."""
        return next((r.near_loops for r in self.directed if isinstance(r, LoopRule)), None)

    def _by_surface(self, uv: np.ndarray) -> np.ndarray:
        """Sizes (n,) that the curvature of the surface allows at uv (n, 2)."""
        _, *derivatives = self.surface.evaluate(uv, 2)
        forms = forms_from_derivatives(*derivatives)
        k = curvatures(forms)
        return np.where(forms.degenerate, self.clamp[1], self.rules.shorter(k.k1, k.k2))

    def after(self, rims: int) -> "SizeLaw":
        """What the rules say, and the first of the directed ones, without limits."""
        own = self.without_limits()
        own.directed = self.directed[:rims]
        return own

    def __call__(self, xy: np.ndarray) -> FieldNodes:
        """Nodes at xy (n, 2) of the chart."""
        nodes = FieldNodes(*self.in_core().nodes(np.ascontiguousarray(xy, float)))
        return nodes._replace(jacobian=nodes.jacobian.reshape(-1, 3, 2))

    def in_core(self) -> core.SurfaceLaw:
        """The same law as the core asks it. It lives as long as the caller keeps it."""
        rims = limits = None
        chord = self.sizing.straight_chord
        if self.directed and chord is not None:
            loops = [rule.near_loops for rule in self.directed if isinstance(rule, LoopRule)]
            sides = [rule.side for rule in self.directed if isinstance(rule, RimRule)]
            near_loops = loops[0].core if loops else None
            rims = chord, [side in sides for side in range(4)], near_loops
        if self.limits is not None:
            are_targets = self.limits.uv is None
            limits = self.limits.core, self._least(self.limits), are_targets
        asked = as_core_surface(self.surface), self.chart.core, self.rules.core, rims, limits
        if self.sizing.is_anisotropic:
            return core.StretchedLaw(*asked, has_even_curvature(self.surface))
        return core.SurfaceLaw(*asked)

    def local(self, xy: np.ndarray) -> "Local":
        """What the rules are asked with, at xy (n, 2) of the chart."""
        uv, rates = self.chart.to_uv_and_rates(xy)
        point, ru, rv, *second = self.surface.evaluate(uv, 2)
        return Local(Places(xy, uv, point), ru, rv, rates, forms_from_derivatives(ru, rv, *second))

    def demands(self, local: "Local") -> Iterator[tuple[Rule, np.ndarray]]:
        """Each rule with the sizes (n,) it allows, where these do not depend on the direction."""
        if self.follows_curvature:
            k = curvatures(local.forms)
            for rule, sizes in self.rules.at_curvature(k.k1, k.k2):
                # nothing is known at a pole or a cusp: gradation brings the neighbours' size
                yield rule, np.where(local.forms.degenerate, np.inf, sizes)
        yield from self.rules.at_points(local.at.points)
        for directed in self.directed:
            yield directed, directed.sizes(local.at)

    def longest_along(self, nodes: FieldNodes, size: np.ndarray) -> np.ndarray:
        """Largest ``long`` (n,) where principal directions change, of triangles that are ``size``
        (n,) wide."""
        k1, k2 = nodes.curvature.T
        bound = longest_along(nodes.direction_rates, k1, k2, size, self.sizing.chord or 0.0)
        return np.where(nodes.asked[:, 1] > ROUND * nodes.asked[:, 0], bound, np.inf)

    def _least(self, limits: SizeLimits) -> float:
        """No limit goes below it; sizes that edges have been cut with hold as they are."""
        if limits.as_cut:
            return 0.0
        return self.clamp[0] if limits.uv is None else self.sizing.min_size or 0.0


class TensorLaw:
    """Size tensors given over a plane, in the place of sizes that follow from a surface."""

    follows_curvature = is_on_lattice = False
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
