"""``sources``: local sizes near points and lines, in balls and boxes, across gaps."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from surfmesh.sizing.options.size_laws import checked_sizes
from surfmesh.sizing.options.sizing import SizeLaw, Sizing
from surfmesh.sizing.rules.rule import PlaceRule
from surfmesh.sizing.rules.size_rule import called


@dataclass(frozen=True)
class SourceRule(PlaceRule):
    source: SizeLaw

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["SourceRule"]:
        yield from map(cls, sizing.sources)

    def __str__(self) -> str:
        return f"source {called(self.source)}"

    def sizes(self, points: np.ndarray) -> np.ndarray:
        return checked_sizes(self.source, points, "source")
