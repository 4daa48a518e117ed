"""``chord``: no triangle lies farther from the surface, no segment farther from its curve."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import (
    STRAIGHT_RESERVE,
    chord_size,
    evened_chord_sizes,
    lattice_chord_size,
    principal_chord_sizes,
    saddle_lattice_sizes,
    share_of_width,
)
from surfmesh.sizing.rules.rule import CurvatureRule, CurveSamples

CURVE_RESERVE = 0.9
"""Fraction of ``chord`` that a segment of an edge may use where sizes are isotropic. Edges are cut,
none of their segments is longer than asked for; the rest is for curvature that grows along one.
Stretched triangles beside an edge use as much of it as they do elsewhere."""

CORNER_RESERVE = 0.52
"""The same where a segment passes the corner of a polygonal curve: it may pass more than one."""

LEAST_LEFT = 0.25
"""Fraction of ``chord`` that it has in any case, however far edges lie from their surfaces."""

KINK = 0.02
"""Radians: smaller angles between the pieces of a curve are no corners."""


@dataclass(frozen=True)
class ChordRule(CurvatureRule):
    chord: float
    """Model units."""
    is_anisotropic: bool = field(default=False, compare=False)
    is_width: bool = field(default=False, compare=False)
    """It is that of the whole band around the surface that a triangle needs: vertices move to the
    middle of it."""
    on_lattice: bool = field(default=False, compare=False)
    """Edges lie where they deviate least: see ``keeps_lattice``."""
    is_evened: bool = field(default=False, compare=False)
    """Corners of stretched triangles move until these lie nearer."""

    @classmethod
    def asked_for(cls, sizing: Sizing, diagonal: float) -> Iterator["ChordRule"]:
        if sizing.straight_chord is not None:
            yield cls(
                sizing.straight_chord, sizing.is_anisotropic, sizing.is_balanced,
                is_evened=sizing.is_evened,
            )  # fmt: skip

    def __str__(self) -> str:
        return f"chord {self.chord:g}"

    @property
    def core(self) -> core_sizing.CurvatureRule:
        return core_sizing.ChordRule(self.chord, self.is_width, self.on_lattice, self.is_evened)

    def sizes(self, k1: np.ndarray, k2: np.ndarray) -> np.ndarray:
        size = lattice_chord_size if self.on_lattice else chord_size
        return self._factor(k1, k2, 1.0) * size(k1, k2, self.chord)

    def principal_sizes(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray:
        factor = self._factor(k1, k2, ratio)
        if not self.is_evened:
            both = principal_chord_sizes(k1, k2, self.chord, ratio)
        elif self.on_lattice:
            both = saddle_lattice_sizes(k1, k2, self.chord, ratio)
        else:
            both = evened_chord_sizes(k1, k2, self.chord, ratio)
        return np.stack([factor * size for size in both], axis=1)

    def _factor(
        self, k1: np.ndarray, k2: np.ndarray, ratio: np.ndarray | float
    ) -> np.ndarray | float:
        """On the sizes: they go with the root of the chord."""
        return np.sqrt(share_of_width(k1, k2, ratio)) if self.is_width else 1.0

    def sizes_on_curve(self, curve: CurveSamples) -> np.ndarray:
        is_cut_short = self.is_anisotropic and not self.is_evened
        reserve = STRAIGHT_RESERVE if is_cut_short else CURVE_RESERVE
        left = np.maximum(reserve * self.chord - curve.tolerance, LEAST_LEFT * self.chord)
        with np.errstate(divide="ignore", over="ignore"):
            own = np.sqrt(8.0 * left / curve.curvature)
        return np.minimum(np.maximum(own, 2.0 * self.chord), self.at_corners(curve))

    def at_corners(self, curve: CurveSamples) -> np.ndarray:
        """Sizes (n,) that cut the corners of polygonal curves by ``chord``; infinite elsewhere.

        A corner is an angle between samples that the curvature there knows nothing of. A segment h
        across one of angle a passes it at h/2 tan(a/2), about h a / 4.
        """
        step = np.diff(curve.points, axis=0)
        length = np.linalg.norm(step, axis=1)
        step /= np.maximum(length, np.finfo(float).tiny)[:, None]
        angle = elementary_functions.acos(
            np.clip(np.einsum("ij,ij->i", step[1:], step[:-1]), -1.0, 1.0)
        )
        k = curve.curvature
        known = np.maximum.reduce([k[:-2], k[1:-1], k[2:]])
        corner = angle > np.maximum(KINK, known * (length[1:] + length[:-1]))
        sizes = np.full(len(curve.points), np.inf)
        sizes[1:-1][corner] = 4.0 * CORNER_RESERVE * self.chord / angle[corner]
        sizes[curve.first[:-1]] = sizes[curve.first[1:] - 1] = np.inf  # from one curve to the next
        return sizes
