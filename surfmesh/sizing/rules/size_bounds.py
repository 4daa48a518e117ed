"""What the wishes say at a given curvature: the sizes that size fields are made of."""

from dataclasses import dataclass

import numpy as np

from surfmesh.sizing.options.defaults import (
    DEFAULT_ANGLE,
    DEFAULT_MAX_SIZE,
    FINEST_BY_ANGLE,
    FINEST_SIZE,
    LEAST_OF_CHORD,
    LONGEST,
    with_default_chord,
)
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import (
    angle_size,
    chord_size,
    normal_deviation_size,
    principal_angle_sizes,
    principal_chord_sizes,
)


@dataclass(frozen=True)
class SizeBounds:
    """What the wishes say at a given curvature, on a surface of known extent."""

    sizing: Sizing
    """With the default chord where nothing else was wished."""

    clamp: tuple[float, float]
    """The smallest and the largest size, model units; the largest may be infinite."""

    longest: float
    """The largest along the longer axis of an anisotropic metric."""

    finest_turn: float = 0.0
    """``angle`` asks for nothing smaller, model units."""

    @classmethod
    def of(cls, sizing: Sizing, diagonal: float) -> "SizeBounds":
        """``diagonal``: of the surface's bounding box, model units."""
        sizing = with_default_chord(sizing, diagonal)
        coarsest = sizing.max_size or DEFAULT_MAX_SIZE * diagonal
        if callable(sizing.size) and not sizing.max_size:
            coarsest = np.inf  # the law alone decides
        if isinstance(sizing.size, float):
            coarsest = min(coarsest, sizing.size) if sizing.max_size else sizing.size
        finest = sizing.min_size or min(FINEST_SIZE * diagonal, coarsest)
        coarsest = max(coarsest, finest)
        longest = coarsest
        if sizing.is_anisotropic and not sizing.max_size and not isinstance(sizing.size, float):
            longest = max(coarsest, LONGEST * diagonal)
        return cls(sizing, (finest, coarsest), longest, FINEST_BY_ANGLE * diagonal)

    @property
    def follows_curvature(self) -> bool:
        return self.sizing.chord is not None or self.sizing.angle is not None

    def from_curvature(self, k1: np.ndarray, k2: np.ndarray | float) -> np.ndarray:
        """Clamped size (n,) for principal curvatures, before ``size`` and gradation."""
        sizes = curvature_sizes(self.sizing, k1, k2, self.finest_turn).values()
        return np.clip(np.minimum.reduce([*sizes]), *self.clamp)

    def shorter(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        """Clamped size (n,) in the direction that allows least."""
        if self.sizing.is_anisotropic:
            return self.principal(k1, k2).min(axis=1)
        return self.from_curvature(k1, k2)

    def principal(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float | None = None
    ) -> np.ndarray:
        """Clamped sizes (n, 2) along the directions of k1 and k2, before ``size`` and gradation.

        ratio: (n,) largest ratio of the two, instead of ``anisotropy``.
        """
        ratio = self.sizing.anisotropy if ratio is None else ratio
        every = principal_sizes(self.sizing, k1, k2, ratio, self.finest_turn).values()
        sizes = np.minimum.reduce([*every])
        wanted = sizes.min(axis=1)
        shorter = np.clip(wanted, *self.clamp)
        # where it is flat both ways no direction is known: the ratio falls to one
        with np.errstate(invalid="ignore"):
            curved = np.minimum(np.nan_to_num(shorter / wanted), 1.0) ** 2
        longest = np.minimum(shorter * np.maximum(ratio * curved, 1.0), self.longest)
        longest = np.maximum(longest, shorter)
        return np.clip(sizes, shorter[:, None], longest[:, None])


def curvature_sizes(
    sizing: Sizing, k1: np.ndarray, k2: np.ndarray | float, finest_turn: float = 0.0
) -> dict[str, np.ndarray]:
    """What each rule asks for (n,) at principal curvatures k1, k2 (n,), not clamped.

    By name: "chord", "angle", or "default": the rule of 45 degrees where only chord is asked for.
    Size fields, edges and explanations all follow it.
    """
    sizes = {}
    if sizing.chord is not None:
        sizes["chord"] = chord_size(k1, k2, sizing.chord)
    if sizing.angle is not None:
        sizes["angle"] = np.maximum(angle_size(k1, k2, sizing.angle), finest_turn)
    elif sizing.chord is not None:
        sizes["default"] = default_angle_size(k1, k2, sizing.chord)
    return sizes


def principal_sizes(
    sizing: Sizing, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float,
    finest_turn: float = 0.0,
) -> dict[str, np.ndarray]:  # fmt: skip
    """The same (n, 2) along the directions of k1 and k2, for a ``ratio`` of the two at most."""
    sizes = {}
    if sizing.chord is not None:
        sizes["chord"] = np.stack(principal_chord_sizes(k1, k2, sizing.chord, ratio), axis=1)
    if sizing.angle is not None:
        turned = np.stack(principal_angle_sizes(k1, k2, sizing.angle, ratio), axis=1)
        sizes["angle"] = np.maximum(turned, finest_turn)
    elif sizing.chord is not None:
        k = np.stack([k1, k2], axis=1)
        sizes["default"] = default_angle_size(k, k, sizing.chord)
    return sizes


def default_angle_size(k1: np.ndarray, k2: np.ndarray | float, chord: float) -> np.ndarray:
    """The default angle, as normals of the surface turn; a triangle within ``chord`` of an apex
    need not follow it."""
    return np.maximum(normal_deviation_size(k1, k2, DEFAULT_ANGLE), LEAST_OF_CHORD * chord)
