"""What ``pack`` may be given beside a number or a callable: random radii, fields of tensors."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfmesh.errors import SizingError, shown
from surfmesh.geometry.number_range import RANGE
from surfmesh.sizing.options.positive import positive
from surfmesh.sizing.options.size_laws import as_numbers


def require_computable(name: str, length: float) -> None:
    """Raise ``SizingError`` for a length that has no square, or no inverse of it."""
    if not 1.0 / RANGE.square < length < RANGE.square:
        size = "large" if length > 1.0 else "small"
        raise SizingError(f"{name} {length:g} is too {size} to compute with; scale what is packed")


@dataclass(frozen=True)
class UniformRadius:
    """Radii drawn evenly from [lo, hi], whatever the place. The same seed, the same radii.

    Raises ``SizingError`` unless 0 < lo <= hi, both finite, and the seed is a number from 0.
    """

    lo: float
    hi: float
    seed: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "lo", positive("the least radius", self.lo))
        object.__setattr__(self, "hi", positive("the largest radius", self.hi))
        if self.lo > self.hi:
            raise SizingError(f"random radii need 0 < lo <= hi, not {self.lo:g} and {self.hi:g}")
        require_computable("radius", self.hi)
        if not isinstance(self.seed, (int, np.integer)) or self.seed < 0:
            raise SizingError(f"seed must be a whole number from 0, not {shown(self.seed)}")

    def stream(self) -> Callable[[int], np.ndarray]:
        """A function whose call with n gives the next n radii (n,)."""
        generator = np.random.default_rng(self.seed)
        return lambda n: generator.uniform(self.lo, self.hi, n)


@dataclass(frozen=True)
class TensorField:
    """Size tensors over the plane: ``tensors`` maps points (n, 2) to (n, 3), h11, h12, h22.

    The circle of a point p is the ellipse |H^-1 (x - p)| <= 1/2: H = 2 r Id is a circle of
    radius r. Symmetric matrices (n, 2, 2) are taken as well.
    """

    tensors: Callable[[np.ndarray], np.ndarray]

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) -> (n, 3). Raises ``SizingError`` for tensors that are not positive definite."""
        with np.errstate(all="ignore"):
            found = self.tensors(points.copy())
        h = as_numbers(found)
        if h is None:
            raise SizingError(
                f"a tensor field gives numbers, (n, 3) or (n, 2, 2), not {shown(found)}"
            )
        if h.shape == (len(points), 2, 2):
            h = np.stack([h[:, 0, 0], 0.5 * (h[:, 0, 1] + h[:, 1, 0]), h[:, 1, 1]], axis=1)
        if h.shape != (len(points), 3):
            raise SizingError(
                f"a tensor field gives (n, 3) or (n, 2, 2) for points (n, 2), not {h.shape}"
            )
        bad = ~((h[:, 0] > 0.0) & (h[:, 0] * h[:, 2] > h[:, 1] ** 2) & np.isfinite(h).all(axis=1))
        if bad.any():
            x, y = points[bad.argmax()]
            raise SizingError(f"the size tensor at ({x:g}, {y:g}) is not positive definite")
        return h
