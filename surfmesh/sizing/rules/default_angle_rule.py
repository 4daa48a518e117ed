"""The angle that holds where only a chord is asked for: a coarser mesh would fold.

By the normals of the surface; a triangle within ``chord`` of an apex need not follow it. It is no
promise of the angles between triangles.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.defaults import DEFAULT_ANGLE, LEAST_OF_CHORD
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import normal_deviation_size
from surfmesh.sizing.rules.rule import CurvatureRule, CurveSamples


@dataclass(frozen=True)
class DefaultAngleRule(CurvatureRule):
    chord: float
    """Model units."""

    is_default: ClassVar[bool] = True

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["DefaultAngleRule"]:
        if sizing.angle is None and sizing.chord is not None:
            yield cls(sizing.chord)

    def __str__(self) -> str:
        return f"angle {DEFAULT_ANGLE:g} degrees"

    @property
    def core(self) -> core_sizing.CurvatureRule:
        return core_sizing.NormalDeviationRule(DEFAULT_ANGLE, LEAST_OF_CHORD * self.chord)

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        sizes = normal_deviation_size(k1, k2, DEFAULT_ANGLE)
        return np.maximum(sizes, LEAST_OF_CHORD * self.chord)

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        k = np.stack([k1, k2], axis=1)
        return self.sizes(k, k)

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        return self.sizes(curve.curvature, curve.curvature)
