"""What the user asks for: one frozen set of options."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from surfmesh.errors import SizingError

SizeLaw = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, kw_only=True)
class Sizing:
    """The wanted mesh. All lengths are in model units, all wishes hold at once.

    With nothing given the size follows from the surface: a chord error of a thousandth of its
    diagonal, at most a tenth of the diagonal. Raises ``SizingError`` for a wish that is not a
    positive number, or that contradicts another.
    """

    chord: float | None = None
    """Largest distance between mesh and surface, model units."""

    angle: float | None = None
    """Largest angle between the normals of two triangles of one face that share an edge, degrees:
    measured on the mesh, and made finer until it holds. Left out are the places where the surface
    itself bends, creases and apexes. When only ``chord`` is given sizes follow a rule of 45
    degrees, as a coarser mesh would fold; that is no promise."""

    size: float | SizeLaw | None = None
    """Wanted edge length: a number, or a callable of points (n, 3) -> (n,)."""

    min_size: float | None = None
    """No wanted edge length is smaller than this (accuracy yields to it)."""

    max_size: float | None = None
    """No wanted edge length is larger than this."""

    growth: float = 1.2
    """Largest ratio of neighbouring sizes, along any edge of the mesh; above 1."""

    anisotropy: float = 1.0
    """Largest ratio of the sizes along the two principal directions; 1 is isotropic.

    Above 1 edges may be longer along the direction of low curvature. ``size``, ``min_size`` and
    ``max_size`` hold in every direction; without ``max_size`` the longer one may reach the
    diagonal."""

    sources: tuple = ()
    """Local sizes."""

    def __post_init__(self) -> None:
        for name in ("chord", "angle", "min_size", "max_size"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, _positive(name, value))
        if self.size is not None and not callable(self.size):
            object.__setattr__(self, "size", _positive("size", self.size))
        object.__setattr__(self, "growth", _positive("growth", self.growth))
        object.__setattr__(self, "anisotropy", _positive("anisotropy", self.anisotropy))
        if self.growth <= 1.0:
            raise SizingError(f"growth must be above 1, not {self.growth:g}")
        if self.anisotropy < 1.0:
            raise SizingError(f"anisotropy must be at least 1, not {self.anisotropy:g}")
        if self.sources:
            raise SizingError("sources are not supported yet")
        if self.angle is not None and self.angle > 90.0:
            raise SizingError(f"angle must be at most 90 degrees, not {self.angle:g}")
        if self.min_size and self.max_size and self.min_size > self.max_size:
            raise SizingError(
                f"min_size {self.min_size:g} is larger than max_size {self.max_size:g}"
            )
        if isinstance(self.size, float):
            if self.min_size and self.size < self.min_size:
                raise SizingError(f"size {self.size:g} is below min_size {self.min_size:g}")
            if self.max_size and self.size > self.max_size:
                raise SizingError(f"size {self.size:g} is above max_size {self.max_size:g}")

    @property
    def is_anisotropic(self) -> bool:
        """Do the sizes depend on the direction?"""
        return self.anisotropy > 1.0 and (self.chord is not None or self.angle is not None)

    @property
    def gradient(self) -> float:
        """Largest slope of the size along the surface that keeps to ``growth``.

        Two touching circles of sizes h and g h lie (1 + g) h / 2 apart.
        """
        return 2.0 * (self.growth - 1.0) / (self.growth + 1.0)

    def replaced(self, **changes: object) -> "Sizing":
        """A copy with some wishes changed."""
        return replace(self, **changes)

    @classmethod
    def of(cls, wish: "Sizing | float | dict | None") -> "Sizing":
        """Sizing from what a user may pass: itself, a bare number, a mapping, or nothing."""
        if wish is None:
            return cls()
        if isinstance(wish, cls):
            return wish
        if isinstance(wish, dict):
            known = {f.name for f in fields(cls)}
            for name in wish:
                if name not in known:
                    raise SizingError(f"unknown size option {name!r}; known: {sorted(known)}")
            return cls(**wish)
        if isinstance(wish, (int, float)) or callable(wish):
            return cls(size=wish)
        raise SizingError(f"sizes are a number, a Sizing or a mapping, not {type(wish).__name__}")


def _positive(name: str, value: object) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SizingError(f"{name} must be a positive number, not {value!r}") from None
    if not (number > 0.0 and math.isfinite(number)):
        raise SizingError(f"{name} must be a positive number, not {value!r}")
    return number
