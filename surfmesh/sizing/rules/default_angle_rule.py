"""The angle that holds where only a chord is asked for: a coarser mesh would fold.

By the normals of the surface; a triangle within ``chord`` of an apex need not follow it. It is no
promise of the angles between triangles.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.defaults import DEFAULT_ANGLE, LEAST_OF_CHORD
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import SEGMENT_RESERVE, normal_deviation_size
from surfmesh.sizing.rules.rule import CurvatureRule, CurveSamples

ROUND_RESERVE, STRETCHED_RESERVE = 0.93, 0.85
"""Fraction of the angle that normals a unit triangle apart may differ by: of isotropic sizes, and
of those that have directions, which cannot follow a surface that turns more."""


@dataclass(frozen=True)
class DefaultAngleRule(CurvatureRule):
    chord: float
    """Model units."""
    reserve: float = field(default=ROUND_RESERVE, compare=False)

    is_default: ClassVar[bool] = True

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["DefaultAngleRule"]:
        if sizing.angle is None and sizing.chord is not None:
            yield cls(sizing.chord, STRETCHED_RESERVE if sizing.is_anisotropic else ROUND_RESERVE)

    def __str__(self) -> str:
        return f"angle {DEFAULT_ANGLE:g} degrees"

    @property
    def core(self) -> core_sizing.CurvatureRule:
        return core_sizing.NormalDeviationRule(
            self.reserve * DEFAULT_ANGLE, LEAST_OF_CHORD * self.chord
        )

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        return self._sizes(k1, k2, self.reserve)

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        k = np.stack([k1, k2], axis=1)
        return self.sizes(k, k)

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        return self._sizes(curve.curvature, curve.curvature, SEGMENT_RESERVE)

    def _sizes(self, k1: np.ndarray, k2: np.ndarray, reserve: float) -> np.ndarray:
        sizes = normal_deviation_size(k1, k2, reserve * DEFAULT_ANGLE)
        return np.maximum(sizes, LEAST_OF_CHORD * self.chord)
