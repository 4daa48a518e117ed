"""What a size rule is: the edge length that it allows at a place, and words for it.

The size field takes the least of all rules, ``explain`` names the one that is least: both ask the
same objects. A rule follows the curvature or the place. To add one, write a class of either kind
in a file of its own and list it in ``size_rules.RULES``.
"""

from collections.abc import Iterator
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.sizing import Sizing


class CurveSamples(NamedTuple):
    """Points of curves in space, in order, one curve after the other, and what rules need to know
    of them there."""

    points: np.ndarray  # (n, 3)
    curvature: np.ndarray  # (n,) 1 / model unit; 0 where it is straight or not known
    first: np.ndarray  # (c + 1,) where each curve begins, and n
    tolerance: np.ndarray  # (n,) model units: so near the surfaces lie that meet there


class Rule:
    """What one option asks for: its text, with numbers, is ``str`` of it.

    Rules that ask for the same are equal: so ``explain`` finds out whose they are.
    """

    is_default: ClassVar[bool] = False
    """Nobody asks for it by name."""

    @property
    def stated_as(self) -> "Rule":
        """The rule of an option that it follows from."""
        return self

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["Rule"]:
        """The rules of this kind that ``sizing`` asks for on a surface of this diagonal."""
        raise NotImplementedError


class CurvatureRule(Rule):
    """Sizes that follow from the curvature; infinite where it allows any."""

    @property
    def core(self) -> core_sizing.CurvatureRule:
        """What the core asks: this object itself, for blocks of places, where it has no other."""
        return core_sizing.CallbackCurvatureRule(self)

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        """(n,) in every direction, at principal curvatures k1, k2 (n,), 1 / model unit."""
        raise NotImplementedError

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        """(n, 2) along the directions of k1 and k2, for a ``ratio`` of the two at most."""
        raise NotImplementedError

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        """(n,) along curves that are bent themselves, by whatever surfaces meet there."""
        raise NotImplementedError


class PlaceRule(Rule):
    """Sizes that depend on the place alone, and hold in every direction."""

    @property
    def core(self) -> core_sizing.PlaceRule:
        """What the core asks: this object itself, for blocks of places, where it has no other."""
        return core_sizing.CallbackPlaceRule(self)

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """(n,) at points (n, 3); infinite where nothing is asked for.

        Raises ``SizingError`` when a caller's function gives no sizes.
        """
        raise NotImplementedError


class Places(NamedTuple):
    """Points of one surface, as its size field sees them."""

    xy: np.ndarray  # (n, 2) in the surface's chart
    uv: np.ndarray  # (n, 2)
    points: np.ndarray  # (n, 3)


class DirectedLimits(Protocol):
    """Largest sizes near places that depend on the direction."""

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """The least of all directions (n,) at points (n, 3)."""

    def along(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Sizes (k, n) at points (n, 3) in k unit directions (k, n, 3)."""

    def tightest(self, points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The smallest size (n,) in any direction of the tangent planes at points (n, 3) with unit
        normals (n, 3), and a unit direction (n, 3) it holds in."""

    def chosen(self, rows: np.ndarray) -> "DirectedLimits":
        """For some of the points alone."""


class DirectedRule(Rule):
    """Sizes that hold in some directions only, at some places."""

    def limits(self, at: Places) -> tuple[np.ndarray, DirectedLimits]:
        """Rows (k,) of the places it has something to say to, and what."""
        raise NotImplementedError

    def sizes(self, at: Places) -> np.ndarray:
        """The least of all directions (n,), infinite elsewhere."""
        sizes = np.full(len(at.points), np.inf)
        rows, limits = self.limits(at)
        if len(rows):
            sizes[rows] = limits(at.points[rows])
        return sizes
