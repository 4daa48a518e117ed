"""``angle``: no two triangles that share an edge are bent by more against each other."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.defaults import FINEST_BY_ANGLE
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import (
    angle_size,
    normal_deviation_size,
    principal_angle_sizes,
)
from surfmesh.sizing.rules.rule import CurvatureRule, CurveSamples


@dataclass(frozen=True)
class AngleRule(CurvatureRule):
    angle: float
    """Degrees."""
    finest: float = field(default=0.0, compare=False)
    """Nothing smaller is asked for on surfaces, model units."""

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["AngleRule"]:
        if sizing.angle is not None:
            yield cls(sizing.angle, FINEST_BY_ANGLE * diagonal)

    def __str__(self) -> str:
        return f"angle {self.angle:g} degrees"

    @property
    def core(self) -> core_sizing.CurvatureRule:
        return core_sizing.AngleRule(self.angle, self.finest)

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        return np.maximum(angle_size(k1, k2, self.angle), self.finest)

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        sizes = np.stack(principal_angle_sizes(k1, k2, self.angle, ratio), axis=1)
        return np.maximum(sizes, self.finest)

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        return normal_deviation_size(curve.curvature, curve.curvature, self.angle)
