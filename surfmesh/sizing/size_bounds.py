"""What the wishes say at a given curvature: the sizes that size fields are made of."""

from dataclasses import dataclass

import numpy as np

from surfmesh.sizing.curvature_size import (
    angle_size,
    chord_size,
    fold_size,
    principal_angle_sizes,
    principal_chord_sizes,
)
from surfmesh.sizing.sizing import Sizing

DEFAULT_CHORD = 1e-3
DEFAULT_MAX_SIZE = 0.1
"""Wishes that are not stated, relative to the diagonal of the bounding box."""

LONGEST = 1.0
"""Likewise for the longer of two sizes of an anisotropic metric."""

FINEST_SIZE = 1e-5
"""No size is smaller, relative to the diagonal, unless ``min_size`` says so: at an apex the
curvature is infinite."""

FINEST_TURN = 2e-4
"""``angle`` asks for no smaller size, relative to the diagonal: triangles about an apex turn by
as much at any size."""

DEFAULT_ANGLE = 45.0
"""Degrees; kept wherever the size follows the curvature at all."""

LEAST_OF_CHORD = 0.5
"""The default angle asks for nothing smaller than this share of ``chord``: an apex is no fold."""


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
        if sizing.chord is None and sizing.angle is None and sizing.size is None:
            sizing = sizing.replaced(chord=DEFAULT_CHORD * diagonal)
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
        return cls(sizing, (finest, coarsest), longest, FINEST_TURN * diagonal)

    @property
    def follows_curvature(self) -> bool:
        return self.sizing.chord is not None or self.sizing.angle is not None

    def from_curvature(self, k1: np.ndarray, k2: np.ndarray | float) -> np.ndarray:
        """Clamped size (n,) for principal curvatures, before ``size`` and gradation."""
        size = np.full(len(k1), np.inf)
        if self.sizing.chord is not None:
            size = np.minimum(size, chord_size(k1, k2, self.sizing.chord))
        if self.sizing.angle is not None:
            turned = angle_size(k1, k2, self.sizing.angle)
            size = np.minimum(size, np.maximum(turned, self.finest_turn))
        else:  # a triangle within chord of an apex need not follow it
            unfolded = fold_size(k1, k2, DEFAULT_ANGLE)
            size = np.minimum(size, np.maximum(unfolded, LEAST_OF_CHORD * self.sizing.chord))
        return np.clip(size, *self.clamp)

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
        k = np.stack([k1, k2], axis=1)
        sizes = np.full(k.shape, np.inf)
        ratio = self.sizing.anisotropy if ratio is None else ratio
        if self.sizing.chord is not None:
            sizes = np.stack(principal_chord_sizes(k1, k2, self.sizing.chord, ratio), axis=1)
        if self.sizing.angle is not None:
            turned = np.stack(principal_angle_sizes(k1, k2, self.sizing.angle, ratio), axis=1)
            sizes = np.minimum(sizes, np.maximum(turned, self.finest_turn))
        else:
            unfolded = fold_size(k, k, DEFAULT_ANGLE)
            sizes = np.minimum(sizes, np.maximum(unfolded, LEAST_OF_CHORD * self.sizing.chord))
        wanted = sizes.min(axis=1)
        shorter = np.clip(wanted, *self.clamp)
        # where it is flat both ways no direction is known: the ratio falls to one
        with np.errstate(invalid="ignore"):
            curved = np.minimum(np.nan_to_num(shorter / wanted), 1.0) ** 2
        longest = np.minimum(shorter * np.maximum(ratio * curved, 1.0), self.longest)
        longest = np.maximum(longest, shorter)
        return np.clip(sizes, shorter[:, None], longest[:, None])
