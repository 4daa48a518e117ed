"""``size``: a number, or a function of the place."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.model_sizing import LeastOf
from surfmesh.sizing.options.size_laws import checked_sizes
from surfmesh.sizing.options.sizing import SizeLaw, Sizing
from surfmesh.sizing.rules.rule import PlaceRule

LONGEST_TEXT = 80
"""Characters of a caller's function in a message."""


@dataclass(frozen=True)
class SizeRule(PlaceRule):
    size: float | SizeLaw

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["SizeRule"]:
        if isinstance(sizing.size, LeastOf):
            yield from map(cls, sizing.size.laws)
        elif sizing.size is not None:
            yield cls(sizing.size)

    def __str__(self) -> str:
        return f"size law {called(self.size)}" if callable(self.size) else f"size {self.size:g}"

    @property
    def core(self) -> core_sizing.PlaceRule:
        return super().core if callable(self.size) else core_sizing.ConstantSize(self.size)

    def sizes(self, points: np.ndarray) -> np.ndarray:
        if callable(self.size):
            return checked_sizes(self.size, points, "size")
        return np.broadcast_to(self.size, len(points))  # read only


def called(law: object) -> str:
    """What a caller's function is called in a message."""
    name = getattr(law, "__qualname__", "") or repr(law)
    return name if len(name) <= LONGEST_TEXT else name[: LONGEST_TEXT - 3] + "..."
