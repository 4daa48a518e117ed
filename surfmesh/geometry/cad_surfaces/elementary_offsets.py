"""Offsets of elementary surfaces that are elementary themselves, with the same parameters.

With s = 1, or -1 in a left-handed frame, where r_u x r_v is turned round, and the distance d:

    plane      origin + d x x y
    cylinder   radius R + s d
    cone       radius R + s d cos a, origin - s d sin a z      where R + v sin a > 0
    sphere     radius R + s d                                  where |v| <= pi / 2
    torus      tube r + s d                                    where R + r cos v > 0
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np

from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface

QUARTER_TURN = 0.5 * pi + 1e-9  # the latitude of a pole, with the rounding of a face's box


def elementary_offset(basis: FaceSurface, distance: float) -> FaceSurface | None:
    """The surface at a distance along r_u x r_v.

    None where it is none of these, or turned inside out.
    """
    if not isinstance(basis, Plane | Cylinder | Cone | Sphere | Torus):
        return None
    hand = float(np.sign(np.cross(basis.x, basis.y) @ basis.z))
    by = hand * distance
    if isinstance(basis, Plane):
        return replace(basis, origin=basis.origin + distance * np.cross(basis.x, basis.y))
    if isinstance(basis, Cone):
        return _offset_cone(basis, by)
    if isinstance(basis, Torus):
        is_ring = basis.radius > basis.tube and basis.tube + by > 0.0
        return replace(basis, tube=basis.tube + by) if is_ring else None
    if isinstance(basis, Sphere) and np.abs(basis.domain[1]).max() > QUARTER_TURN:
        return None
    return replace(basis, radius=basis.radius + by) if basis.radius + by > 0.0 else None


def _offset_cone(basis: Cone, by: float) -> Cone | None:
    """With the same generators, moved; None where the face, or its offset, passes the apex."""
    moved = replace(
        basis,
        origin=basis.origin - by * sin(basis.angle) * basis.z,
        radius=basis.radius + by * cos(basis.angle),
    )
    ends = np.array(basis.domain[1]) * sin(basis.angle)
    is_one_sided = (basis.radius + ends > 0.0).all() and (moved.radius + ends > 0.0).all()
    return moved if is_one_sided else None
