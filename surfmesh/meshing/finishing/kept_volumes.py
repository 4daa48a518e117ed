"""One more step of all vertices of curved faces, so that solids have their exact volumes.

    volume (steps)  =  exact      by Newton's method: each solid pushes its faces by one length,
                                  a face between two solids moves by the difference of both.
Planes stay.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.small_matrices import least_squares, product
from surfmesh.meshing.finishing.vertex_sites import Sites, Steps
from surfmesh.result.surface_mesh import SurfaceMesh

ROUNDS = 6  # of Newton's method


class Solid(NamedTuple):
    """What a solid's boundary is, and encloses."""

    sign: NDArray[np.float64]  # (m,) 1: the triangle faces its outside, -1: its inside, 0: neither
    volume: float  # exact


class Volumes:
    """Of solids, and the steps of one length each that push their curved faces outwards."""

    def __init__(
        self, mesh: SurfaceMesh, sites: Sites, steps: Steps, solids: list[Solid],
    ) -> None:  # fmt: skip
        self.triangles, self.sites, self.steps, self.solids = mesh.triangles, sites, steps, solids
        self.lengths = [_outward(mesh, sites, solid) for solid in solids]

    def push(
        self, points: NDArray[np.float64], above: NDArray[np.float64], below: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Lengths (s,) that the solids push their faces by, lest any lacks anything in first order:
        in proportion to the room (s,) that sites have above and below."""
        missing = self._missing(points)
        ways = []
        for lengths, lacks in zip(self.lengths, missing.tolist()):
            room = np.where(lengths * lacks > 0.0, above, below)
            ways.append(lengths * np.maximum(room, 0.0))
        pushes = self._pushes(points, [self.steps.of(way) for way in ways], missing)
        return np.asarray(product(pushes, np.array(ways)))

    def pushed(
        self, points: NDArray[np.float64], is_free: NDArray[np.bool_]
    ) -> NDArray[np.float64]:
        """Points (n, 3) of which those that are free have moved until no solid lacks anything, all
        by the same length."""
        ways = [is_free[:, None] * self.steps.of(lengths) for lengths in self.lengths]
        for _ in range(ROUNDS if ways else 0):
            pushes = self._pushes(points, ways, self._missing(points))
            points = points + np.einsum("k,kij->ij", pushes, np.array(ways))
        return points

    def _missing(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """What each solid lacks (k,)."""
        within = [volume_within(points, self.triangles, solid.sign) for solid in self.solids]
        return np.array([solid.volume for solid in self.solids]) - within

    def _pushes(
        self, points: NDArray[np.float64], ways: list[NDArray[np.float64]],
        missing: NDArray[np.float64],
    ) -> NDArray[np.float64]:  # fmt: skip
        """How far (k,) to go along each of the steps (n, 3)."""
        area = vector_areas(points, self.triangles)
        gained = np.array([
            [_swept(area, way, self.triangles, solid.sign) for way in ways]
            for solid in self.solids
        ])  # fmt: skip
        found: NDArray[np.float64] = least_squares(gained, missing, 1e-9)
        return found


def _outward(mesh: SurfaceMesh, sites: Sites, solid: Solid) -> NDArray[np.float64]:
    """(s,) lengths 1 along normals that leave the solid, -1 along those that enter it; 0 on planes
    and off the solid."""
    sign = solid.sign
    if mesh.turned_faces is not None:
        sign = np.where(mesh.turned_faces[mesh.face_ids], -sign, sign)
    lengths = np.zeros(len(sites.vertex))
    for k in range(3):  # seams of one-sided surfaces turn the normal over
        lengths[sites.of_corner[:, k]] = np.where(sites.slope[:, k] < 0.0, -sign, sign)
    lengths[sites.is_plane] = 0.0
    return lengths


def vector_areas(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """(m, 3) along their normals."""
    a, b, c = (points[corner] for corner in triangles.T)
    found: NDArray[np.float64] = 0.5 * np.cross(b - a, c - a)
    return found


def volume_within(
    points: NDArray[np.float64], triangles: NDArray[np.int32], sign: NDArray[np.float64]
) -> float:
    """Between the triangles and a corner, those outward counting positive."""
    own = np.flatnonzero(sign)
    apex = points[triangles[own[0], 0]]
    a, b, c = (points[corner] - apex for corner in triangles[own].T)
    return float((sign[own] * np.einsum("ij,ij->i", a, np.cross(b, c))).sum()) / 6.0


def _swept(
    area: NDArray[np.float64], way: NDArray[np.float64], triangles: NDArray[np.int32],
    sign: NDArray[np.float64],
) -> float:  # fmt: skip
    """The volume that is gained for each unit of a step."""
    return float((sign * np.einsum("ij,ikj->i", area, way[triangles])).sum()) / 3.0
