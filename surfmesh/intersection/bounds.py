"""How far surfaces and curves bend over cells: boxes that hold them, cones that hold normals.

The compiled core bounds them (``src/intersection/cell_bounds.hpp``): by interval arithmetic for
formulas, by control points for splines, in closed form for planes, cylinders, cones, spheres and
tori, by their parts for swept and offset surfaces. Others are sampled: see ``are_known``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from surfmesh._core import intersection
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface


class Boxes(NamedTuple):
    """Of cells or pieces: low, high (n, 3); each lies within ``sag`` (n, 3) of the hull of its
    ``corners`` (n, k, 3)."""

    low: np.ndarray
    high: np.ndarray
    corners: np.ndarray
    sag: np.ndarray


class Cones(NamedTuple):
    """Unit normals (n, 3), and angles (n,) from them, pi/2 where they may point anywhere."""

    axis: np.ndarray
    angle: np.ndarray


def are_known(surface: FaceSurface) -> bool:
    """Are there bounds, or only samples?"""
    low, high = np.array(surface.domain).T
    return surface.core.derivative_magnitudes(low[None], high[None]) is not None


def boxes_and_cones(surface: FaceSurface, lo: np.ndarray, hi: np.ndarray) -> tuple[Boxes, Cones]:
    """Boxes around a surface over cells with the corners lo, hi (n, 2), cones of its normals."""
    *boxes, axis, angle = intersection.bound_cells(surface.core, lo, hi)
    return Boxes(*boxes), Cones(axis, angle)


def curve_boxes(edge: CadEdge, lo: np.ndarray, hi: np.ndarray) -> tuple[Boxes, Cones]:
    """Boxes around an edge over the fractions lo to hi (n,), and cones of its directions.

    Of lines, conics, splines and curves on surfaces with bounds; others are sampled.
    """
    assert edge.curve is not None  # noqa: S101  not degenerate
    *boxes, axis, angle = intersection.bound_pieces(edge.curve.core, edge.t0, edge.t1, lo, hi)
    return Boxes(*boxes), Cones(axis, angle)


def overlap(one: Boxes, i: np.ndarray, other: Boxes, j: np.ndarray, normals: Cones) -> np.ndarray:
    """May cell i of the one and cell j of the other meet? (n,) bool.

    normals: of the other, along which slabs are compared too: cells that hardly bend are thin.
    """
    return intersection.overlap(one, i, other, j, normals.axis).astype(bool)


def cross_surely(one: Cones, i: np.ndarray, other: Cones, j: np.ndarray) -> np.ndarray:
    """Is no normal of cell i parallel to one of cell j? (n,) bool."""
    return intersection.cross_surely(one, i, other, j).astype(bool)


def pierces_surely(curve: Cones, i: np.ndarray, normal: Cones, j: np.ndarray) -> np.ndarray:
    """Is no direction of piece i at right angles to a normal of cell j? (n,) bool."""
    return intersection.pierces_surely(curve, i, normal, j).astype(bool)
