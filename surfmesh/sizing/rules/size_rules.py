"""All rules that hold on one surface, and the bounds that their least size is kept within.

ChordRule, AngleRule, ...  -> sizes by curvature --.
SizeRule, SourceRule, ...  -> sizes by place ------+-- least -> within ``bounds``
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.defaults import with_default_chord
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.angle_rule import AngleRule
from surfmesh.sizing.rules.chord_rule import ChordRule
from surfmesh.sizing.rules.default_angle_rule import DefaultAngleRule
from surfmesh.sizing.rules.quadratic_chord_rule import QuadraticChordRule
from surfmesh.sizing.rules.rule import CurvatureRule, PlaceRule, Rule
from surfmesh.sizing.rules.size_rule import SizeRule
from surfmesh.sizing.rules.source_rule import SourceRule

RULES: tuple[type[Rule], ...] = (
    ChordRule, QuadraticChordRule, AngleRule, DefaultAngleRule, SizeRule, SourceRule,
)  # fmt: skip
"""Every kind of rule, in the order in which they are heard."""

NO_EXTENT = 0.0
"""A diagonal for rules on no surface in particular."""

PYTHONS_OWN = core_sizing.CallbackCurvatureRule, core_sizing.CallbackPlaceRule


@dataclass(frozen=True)
class Bound:
    """What the least of all rules is kept within."""

    words: str
    size: float
    is_floor: bool = False
    is_default: bool = False

    def __str__(self) -> str:
        return self.words


@dataclass(frozen=True)
class SizeRules:
    """What one ``Sizing`` asks for on a surface of known extent."""

    sizing: Sizing
    """With the default chord where nothing else was asked for."""
    by_curvature: tuple[CurvatureRule, ...]
    by_place: tuple[PlaceRule, ...]
    allowed: core_sizing.SizeBounds
    """What follows from the bounds and from a ``size``."""
    clamp: tuple[float, float]
    """The smallest and the largest size, model units; the largest may be infinite."""

    @classmethod
    def of(cls, sizing: Sizing, diagonal: float) -> "SizeRules":
        """``diagonal``: of the surface's bounding box, model units."""
        sizing = with_default_chord(sizing, diagonal)
        rules = [rule for kind in RULES for rule in kind.asked_for(sizing, diagonal)]
        allowed = core_sizing.size_bounds(core_bounds(sizing), diagonal)
        by_curvature = tuple(rule for rule in rules if isinstance(rule, CurvatureRule))
        by_place = tuple(rule for rule in rules if isinstance(rule, PlaceRule))
        clamp = allowed.smallest, allowed.largest
        return cls(sizing, by_curvature, by_place, allowed, clamp)

    @property
    def bounds(self) -> tuple[Bound, ...]:
        """Stated ones and defaults."""
        return *stated_bounds(self.sizing), *default_bounds(self.sizing, self.allowed)

    @property
    def longest(self) -> float:
        """The largest along the longer axis of an anisotropic metric."""
        return self.allowed.longest

    def on_lattice(self) -> "SizeRules | None":
        """For triangles that form a lattice along principal directions; None where there is none.

        Balanced vertices need a band whose width depends on all edges, and stretched triangles are
        sized by their direction as it is.
        """
        sizing = self.sizing
        if sizing.straight_chord is None or sizing.is_balanced:
            return None
        if sizing.is_anisotropic and not sizing.is_evened:
            return None
        rules = tuple(
            replace(rule, on_lattice=True) if isinstance(rule, ChordRule) else rule
            for rule in self.by_curvature
        )
        return replace(self, by_curvature=rules)

    @property
    def is_on_lattice(self) -> bool:
        return any(isinstance(rule, ChordRule) and rule.on_lattice for rule in self.by_curvature)

    @property
    def core(self) -> core_sizing.SizeRules:
        """The same rules as the core has them."""
        return core_sizing.SizeRules(
            [rule.core for rule in self.by_curvature], [rule.core for rule in self.by_place],
            self.clamp, self.longest, self.sizing.anisotropy,
        )  # fmt: skip

    @property
    def follows_curvature(self) -> bool:
        return bool(self.by_curvature)

    def at_curvature(
        self, k1: np.ndarray, k2: np.ndarray
    ) -> Iterator[tuple[CurvatureRule, np.ndarray]]:
        """Each rule with its sizes (n,) at principal curvatures k1, k2 (n,)."""
        for rule in self.by_curvature:
            yield rule, rule.sizes(k1, k2)

    def at_points(self, points: np.ndarray) -> Iterator[tuple[PlaceRule, np.ndarray]]:
        """Each rule with its sizes (n,) at points (n, 3)."""
        for rule in self.by_place:
            yield rule, rule.sizes(points)

    def from_curvature(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        """Size (n,) by the curvature alone, within the bounds."""
        sizes = [size for _, size in self.at_curvature(k1, k2)]
        least = sizes[0] if len(sizes) == 1 else np.minimum.reduce(sizes)
        return np.minimum(np.maximum(least, self.clamp[0]), self.clamp[1])

    def from_place(self, points: np.ndarray) -> np.ndarray:
        """Size (n,) by the place alone, not within the bounds; infinite for none."""
        size = np.full(len(points), np.inf)
        for _, own in self.at_points(points):
            np.minimum(size, own, out=size)
        return size

    def shorter(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        """Size (n,) in the direction that the curvature allows least in, within the bounds."""
        if self.sizing.is_anisotropic:
            return self.principal(k1, k2).min(axis=1)
        return self.from_curvature(k1, k2)

    def principal(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float | None = None
    ) -> np.ndarray:
        """Sizes (n, 2) along the directions of k1 and k2 by curvature, within the bounds.

        ratio: (n,) largest ratio of the two, instead of ``anisotropy``.
        """
        ratio = self.sizing.anisotropy if ratio is None else ratio
        every = [rule.principal_sizes(k1, k2, ratio) for rule in self.by_curvature]
        sizes = np.minimum.reduce(every)
        wanted = sizes.min(axis=1)
        shorter = np.clip(wanted, *self.clamp)
        # where it is flat both ways no direction is known: the ratio falls to one
        with np.errstate(invalid="ignore"):
            curved = np.minimum(np.nan_to_num(shorter / wanted), 1.0) ** 2
        longest = np.minimum(shorter * np.maximum(ratio * curved, 1.0), self.longest)
        longest = np.maximum(longest, shorter)
        return np.clip(sizes, shorter[:, None], longest[:, None])


def stated_bounds(sizing: Sizing) -> Iterator[Bound]:
    """``max_size`` and ``min_size``, where they are asked for."""
    if sizing.max_size is not None:
        yield Bound(f"max_size {sizing.max_size:g}", sizing.max_size)
    if sizing.min_size is not None:
        yield Bound(f"min_size {sizing.min_size:g}", sizing.min_size, is_floor=True)


def default_bounds(sizing: Sizing, allowed: core_sizing.SizeBounds) -> Iterator[Bound]:
    """Those that hold on a surface because nothing else is asked for."""
    if allowed.default_largest is not None:
        yield Bound("a tenth of the diagonal", allowed.default_largest, is_default=True)
    if sizing.min_size is None:
        words = "no size is smaller, unless min_size says so"
        yield Bound(words, allowed.smallest, is_floor=True, is_default=True)


def core_bounds(sizing: Sizing) -> core_sizing.StatedBounds:
    """What ``sizing`` says of the smallest and the largest size, as the core hears it."""
    return core_sizing.StatedBounds(
        min_size=sizing.min_size, max_size=sizing.max_size,
        size=sizing.size if isinstance(sizing.size, float) else None,
        has_size=sizing.size is not None, is_anisotropic=sizing.is_anisotropic,
    )  # fmt: skip


def asked_rules(sizing: Sizing) -> core_sizing.AskedRules | None:
    """What the core asks on surfaces that it measures itself; None where some rule is Python's
    alone, where sizes depend on the direction, and where a default chord depends on the extent."""
    if sizing.is_anisotropic or not (sizing.chord or sizing.angle or sizing.size):
        return None
    rules = SizeRules.of(sizing, NO_EXTENT)
    of_lattice = rules.on_lattice()
    by_curvature = [rule.core for rule in rules.by_curvature]
    on_lattice = [rule.core for rule in of_lattice.by_curvature] if of_lattice else []
    by_place = [rule.core for rule in rules.by_place]
    if any(isinstance(rule, PYTHONS_OWN) for rule in (*by_curvature, *by_place)):
        return None
    return core_sizing.AskedRules(by_curvature, on_lattice, by_place, core_bounds(sizing))


def stated_rules(sizing: Sizing) -> Iterator[Rule | Bound]:
    """What ``sizing`` asks for by name: no defaults, on no surface in particular."""
    for kind in RULES:
        yield from (rule for rule in kind.asked_for(sizing, NO_EXTENT) if not rule.is_default)
    yield from stated_bounds(sizing)
