"""Points of many coedges and edges at once: what each of them gives alone, in one call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from surfmesh.geometry.cad_surfaces.curves import points_on

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadCoedge, CadEdge


def uv_of(coedges: Sequence[CadCoedge], fraction: np.ndarray) -> np.ndarray:
    """``uv`` of n coedges at these fractions (k,) of their edges' ranges: (n, k, 2) float."""
    return _on_pcurves(coedges, np.asarray(fraction, float))


def walked(coedges: Sequence[CadCoedge], fraction: np.ndarray) -> np.ndarray:
    """``walk`` of n coedges at these fractions (k,), as the loop goes: (n, k, 2) float."""
    fraction = np.asarray(fraction, float)
    backwards = np.array([coedge.reversed for coedge in coedges], bool)[:, None]
    return _on_pcurves(coedges, np.where(backwards, 1.0 - fraction, fraction))


def _on_pcurves(coedges: Sequence[CadCoedge], fraction: np.ndarray) -> np.ndarray:
    ranges = np.array([(coedge.p0, coedge.p1) for coedge in coedges]).reshape(-1, 2, 1)
    first, last = ranges[:, 0], ranges[:, 1]
    return points_on([coedge.pcurve for coedge in coedges], first + fraction * (last - first))


def points_of(edges: Sequence[CadEdge], fraction: np.ndarray) -> np.ndarray:
    """``evaluate`` of n edges at these fractions (k,): (n, k, 3) float.

    Raises ValueError for a degenerate edge, which has no points.
    """
    curves = [edge.curve for edge in edges if edge.curve is not None]
    if len(curves) < len(edges):
        raise ValueError("a degenerate edge has no curve in space")
    ranges = np.array([(edge.t0, edge.t1) for edge in edges]).reshape(-1, 2, 1)
    first, last = ranges[:, 0], ranges[:, 1]
    return points_on(curves, first + np.asarray(fraction, float) * (last - first))
