"""``chord`` of quadratic triangles: no curved one lies farther from the surface.

Where the curvature does not change, six nodes on the surface leave an error of fourth order,
k^3 h^4, which this rule knows. Where it changes there is one of third order too, which no curvature
tells: what it asks for is measured on the mesh and asked for in the next round
(``meshing/finishing/curved_requests``).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.chord_rule import ChordRule
from surfmesh.sizing.rules.curvature_size import quadratic_chord_size
from surfmesh.sizing.rules.rule import CurvatureRule, CurveSamples

CURVE_RESERVE = 0.8
"""Fraction of ``chord`` that an arc may use."""


@dataclass(frozen=True)
class QuadraticChordRule(CurvatureRule):
    chord: float
    """Model units."""

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["QuadraticChordRule"]:
        if sizing.is_curved and sizing.chord is not None:
            yield cls(sizing.chord)

    def __str__(self) -> str:
        return f"chord {self.chord:g} of quadratic triangles"

    @property
    def core(self) -> core_sizing.CurvatureRule:
        return core_sizing.QuadraticChordRule(self.chord)

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        return quadratic_chord_size(k1, k2, self.chord)

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        sizes = self.sizes(k1, k2)  # they do not depend on the direction
        return np.stack([sizes, sizes], axis=1)

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        """The parabola through both ends and the middle of an arc of radius R and half angle a
        misses it by R (1 - cos a)^2 / 8, about h^4 k^3 / 512."""
        with np.errstate(divide="ignore", over="ignore"):
            own = np.sqrt(np.sqrt(512.0 * CURVE_RESERVE * self.chord / curve.curvature**3))
        corners = ChordRule(self.chord).at_corners(curve)
        return np.minimum(np.maximum(own, 2.0 * self.chord), corners)
