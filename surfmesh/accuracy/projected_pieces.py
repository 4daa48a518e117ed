"""Proved bounds of triangles on spheres, cylinders and cones, by their nearest points.

Here the piece of a triangle is what its points are moved to along the surface's normals, and not
what lies over it in (u, v): poles, apexes and seams are places as all others. With the distance
d(x) from the centre, or the axis, and the height z over the apex along the axis, x is moved by

    sphere  R - d        cylinder  R - d        cone  z sin a - d cos a

d is convex, and no less than e . x for any unit vector e (across the axis): both ends are found at
corners. Pieces tile as the triangles do where the surface's normals are less than a right angle
from theirs; docs/proof.md has the statement.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Sphere
from surfmesh.geometry.small_matrices import product
from surfmesh.geometry.surface import Surface

Array = NDArray[np.float64]

ROUNDING = 2.0**-44
"""Of the sizes that go in: more than that of any sum here."""

SQUARE = 1e-12
"""How far a frame may be from unit vectors at right angles; it counts in the bounds."""

NEWTON = 5
"""Steps to the innermost point of a side."""

NEAR = 0.1
"""Of the shortest side: how far a corner may be off its place r(u, v)."""


class Moved(NamedTuple):
    """How points of m triangles move to the surface."""

    away: Array  # (m,) by how much at most, model units
    slope: Array  # (m,) how fast that changes at most


class _Turned(NamedTuple):
    """A sphere, or a line turned about the axis, in its frame: |d cos - z sin - rest| away."""

    points: Array  # (m, 3, 3) from the centre, or the apex, along x, y, z
    axis: float  # 0: z counts as x and y do, a sphere; 1: it is the axis
    cosine: float
    sine: float
    rest: float
    rounding: float  # of lengths


def projected(surface: Surface, corners: Array, uv: Array, limits: Array) -> Moved | None:
    """Of triangles with corners (m, 3, 3) at uv (m, 3, 2); None where pieces may not tile.

    limits: (m,) how near it is worth to look.
    """
    shape = _shape(surface, corners)
    if shape is None or not _are_at_their_places(surface, corners, uv):
        return None
    across = shape.points * (1.0, 1.0, 1.0 - shape.axis)
    distance = np.linalg.norm(across, axis=2)
    normal = np.cross(
        shape.points[:, 1] - shape.points[:, 0], shape.points[:, 2] - shape.points[:, 0]
    )
    length = np.linalg.norm(normal, axis=1)
    if not (length > 0.0).all():
        return None
    normal /= length[:, None]
    flat = normal * (1.0, 1.0, 1.0 - shape.axis)
    flat_length = np.linalg.norm(flat, axis=1)
    if not (flat_length > 0.0).all():
        return None
    towards = np.einsum("mkc,mc->mk", across, flat / flat_length[:, None])
    side = np.sign(towards.sum(axis=1))
    towards *= side[:, None]
    if not (side == side[0]).all():
        return None
    normal *= side[:, None]
    cosine = _least_cosine(shape, distance, towards, normal, flat_length)
    if not (cosine > 0.0).all():
        return None
    height = shape.points[:, :, 2] * shape.sine + shape.rest
    outside = (distance * shape.cosine - height).max(axis=1)
    inside = (height - towards * shape.cosine).max(axis=1)
    far = np.flatnonzero(inside > limits - shape.rounding)
    inside[far] = _inside_by_sides(shape, across[far], height[far], inside[far])
    away = np.maximum(np.maximum(outside, inside), 0.0) + shape.rounding
    least = np.maximum(towards.min(axis=1) - shape.rounding, 0.0)
    with np.errstate(divide="ignore"):
        bent = np.where(least > 0.0, away * shape.cosine / least, np.inf)
    tilted = np.sqrt(np.maximum(1.0 - cosine * cosine, 0.0))
    return Moved(away, (bent + tilted) * (1.0 + ROUNDING) + ROUNDING)


def nearest(surface: Surface, points: Array) -> Array | None:
    """What points (..., 3) are moved to along the normals; None of other surfaces."""
    if not isinstance(surface, Sphere | Cylinder | Cone):
        return None
    local = _in_frame(surface, points)
    across = local * (1.0, 1.0, float(isinstance(surface, Sphere)))
    distance = np.linalg.norm(across, axis=-1, keepdims=True)
    unit = across / np.where(distance > 0.0, distance, 1.0)
    if not isinstance(surface, Cone):
        return np.asarray(points + (abs(surface.radius) - distance) * _in_space(surface, unit))
    cosine, sine = float(np.cos(surface.angle)), _sine(surface, local[..., 2:])
    height = local[..., 2:] + surface.radius / float(np.sin(surface.angle)) * cosine
    normal = cosine * unit - sine * np.array([0.0, 0.0, 1.0])
    return np.asarray(points + (height * sine - distance * cosine) * _in_space(surface, normal))


def _in_space(surface: Sphere | Cylinder | Cone, vectors: Array) -> Array:
    """Of the frame's coordinates (..., 3)."""
    x, y, z = (vectors[..., k, None] for k in range(3))
    return np.asarray(x * surface.x + y * surface.y + z * surface.z)


def slide_along(surface: Surface, ends: Array, away: Array) -> Array:
    """(k,) how fast points of segments with ends (k, 2, 3) move along these at most.

    away: (k,) how far they move. x + s nu runs along the unit vector e of the segment with

        1 - (nu . e)^2 + s cos a (rho' . e)        rho: from the axis, or centre; |rho'| <= 1 / d
    """
    if not isinstance(surface, Sphere | Cylinder | Cone):
        return np.full(len(ends), np.inf)
    local = _in_frame(surface, ends)
    across = local * (1.0, 1.0, float(isinstance(surface, Sphere)))
    distance = np.linalg.norm(across, axis=2)
    side = local[:, 1] - local[:, 0]
    length = np.linalg.norm(side, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = side / length[:, None]
        inner = np.maximum(distance.min(axis=1) - 0.5 * length, 0.0)
        outwards = across / distance[:, :, None]
        cosine, sine = 1.0, np.zeros(distance.shape)
        if isinstance(surface, Cone):
            cosine = float(np.cos(surface.angle))
            sine = _sine(surface, local[:, :, 2])
        along = cosine * np.einsum("kqc,kc->kq", outwards, unit) - sine * unit[:, 2:]
        rate = (along * along).max(axis=1) + away / inner
    return np.where(np.isfinite(rate), rate * (1.0 + 2.0**-20) + 2.0**-30, np.inf)


def _in_frame(surface: Sphere | Cylinder | Cone, points: Array) -> Array:
    """(..., 3) from the origin, along x, y, z."""
    away = points - surface.origin
    axes = (surface.x, surface.y, surface.z)
    return np.stack([(away * axis).sum(axis=-1) for axis in axes], axis=-1)


def _sine(cone: Cone, z: Array) -> Array:
    """Of the half angle, with the sign that it has on its half of the cone."""
    sine, cosine = float(np.sin(cone.angle)), float(np.cos(cone.angle))
    height = z + cone.radius / sine * cosine
    return np.where(sine * height < 0.0, -sine, sine)


def _shape(surface: Surface, corners: Array) -> _Turned | None:
    """In the frame of the surface; None of another surface."""
    if not isinstance(surface, Sphere | Cylinder | Cone):
        return None
    frame = np.stack([surface.x, surface.y, surface.z])
    off = float(np.abs(product(frame, frame.T) - np.eye(3)).max())
    points = product(corners - surface.origin, frame.T)
    radius = abs(surface.radius)
    sizes = (corners, surface.origin, points)
    size = radius + sum(float(np.abs(x).max(initial=0.0)) for x in sizes)
    if not off <= SQUARE:
        return None
    rounding = 8.0 * (ROUNDING + off) * size
    if not isinstance(surface, Cone):
        return _Turned(points, float(isinstance(surface, Cylinder)), 1.0, 0.0, radius, rounding)
    sine, cosine = float(np.sin(surface.angle)), float(np.cos(surface.angle))
    if not (abs(sine) > SQUARE and cosine > SQUARE):
        return None
    apex = -surface.radius / sine * cosine
    points[:, :, 2] -= apex
    if sine * points[:, :, 2].sum() < 0.0:  # the other half of the cone
        sine = -sine
    return _Turned(points, 1.0, cosine, sine, 0.0, rounding + 8.0 * ROUNDING * abs(apex))


def _inside_by_sides(shape: _Turned, across: Array, height: Array, inside: Array) -> Array:
    """(m,) how far triangles reach inside, by the innermost points of their sides too."""
    for k in range(3):
        j = (k + 1) % 3
        ends = across[:, k], across[:, j], height[:, k], height[:, j]
        along = np.einsum("mkc,mc->mk", across, _towards_nearest(shape, *ends))
        inside = np.minimum(inside, (height - along * shape.cosine).max(axis=1))
    return inside


def _towards_nearest(shape: _Turned, a: Array, b: Array, low: Array, high: Array) -> Array:
    """(m, 3) unit vectors e at about the innermost points of sides from a to b (m, 3).

    low, high: (m,) of the heights there. By Newton's method: any e gives a bound.
    """
    side, t = b - a, np.full(len(a), 0.5)
    for _ in range(NEWTON):
        at = a + t[:, None] * side
        d = np.maximum(np.linalg.norm(at, axis=1), shape.rounding)
        rate = np.einsum("mc,mc->m", at, side) / d
        bent = shape.cosine * (np.einsum("mc,mc->m", side, side) - rate * rate) / d
        step = (shape.cosine * rate - (high - low)) / np.maximum(bent, shape.rounding)
        t = np.clip(t - step, 0.0, 1.0)
    at = a + t[:, None] * side
    return at / np.maximum(np.linalg.norm(at, axis=1), shape.rounding)[:, None]


def _least_cosine(
    shape: _Turned, distance: Array, towards: Array, normal: Array, flat_length: Array
) -> Array:
    """(m,) of the angle between the normals of a triangle and of the surface; below 0 if unknown.

    Seen along the axis the directions over a triangle lie between those of its corners; that of the
    apex itself is any.
    """
    at_apex = distance <= shape.rounding
    beside = np.where(at_apex, np.inf, towards / np.where(at_apex, 1.0, distance))
    least = np.minimum(beside.min(axis=1), 1.0) - 8.0 * ROUNDING
    known = (at_apex.sum(axis=1) <= 1) & (least > 0.0)
    if not shape.axis:
        flat_length = np.ones_like(flat_length)
    cosine = shape.cosine * flat_length * least - shape.sine * shape.axis * normal[:, 2]
    return np.where(known, cosine - _tilt(shape), -1.0)


def _tilt(shape: _Turned) -> Array:
    """(m,) by how much a normal may be off."""
    p = shape.points
    sides = p[:, (1, 2, 0)] - p
    longest = (sides**2).sum(axis=2).max(axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    off = 16.0 * ROUNDING * longest + 8.0 * shape.rounding * np.sqrt(longest)
    return off / area + 8.0 * ROUNDING


def _are_at_their_places(surface: Surface, corners: Array, uv: Array) -> bool:
    """Are corners near r(u, v), and no triangle reaches half round the axis?"""
    (places,) = surface.evaluate(uv.reshape(-1, 2), 0)
    off = np.linalg.norm(places.reshape(-1, 3, 3) - corners, axis=2).max(axis=1)
    sides = np.linalg.norm(corners[:, (1, 2, 0)] - corners, axis=2).min(axis=1)
    round_axis = np.ptp(uv[:, :, 0], axis=1)
    return bool((off <= NEAR * sides).all() and (round_axis < np.pi).all())
