"""Triangles turned far from the surface's normals: by the mesher, by loose edges, by the surface.

A surface that bends with a smaller radius than sizes are made for, or turns over, has no mesh
without such triangles: they are counted apart, with their place. Edges that lie farther off a
face than the triangles beside them are high turn these as well, and so do nodes on the surface
whose images in (u, v) lie elsewhere, moved where a boundary crosses itself: these stay a fault,
and the reason is said.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.folds import FOLDED, INVERTED, cosines_with_surface, sharp_radius
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.differential.sharp_bends import bends_sharply
from surfmesh.result.surface_mesh import SurfaceMesh

ON_SURFACE = 0.1  # of the way to its image: a node nearer to the surface lies on it
STEPS = 12  # of the projection, at most


@dataclass(frozen=True)
class FoldedTriangle:
    """A triangle turned more than 60 degrees from its surface."""

    triangle: int
    face: int
    angle_deg: float  # between the two normals
    point: tuple[float, float, float]  # its centroid
    by_surface: bool  # which bends sharply there, or turns over: no size is small enough
    off: float  # how far the farthest of its corners lies off the surface, model units
    moved: float  # how far images of corners lie from them that are on the surface


class Folds(NamedTuple):
    """Which triangles are turned too far."""

    ours: NDArray[np.bool_]  # (m,) on a smooth piece of surface
    own: NDArray[np.bool_]  # (m,) because the surface is
    cosine: NDArray[np.float32]  # (m,)
    off: NDArray[np.float64]  # (m,) distance of the farthest corner, where it turns the triangle
    moved: NDArray[np.float64]  # (m,) of images from corners on the surface, where that does
    nearest: float  # within which such corners lie on the surface
    radius: float  # below which a surface is said to bend sharply, model units

    @property
    def inverted(self) -> NDArray[np.bool_]:
        """(m,) those of ``ours`` turned by more than a right angle."""
        return self.ours & (self.cosine < INVERTED)


def folds(mesh: SurfaceMesh, cosine: NDArray[np.float32]) -> Folds:
    """``cosine``: (m,) of the angles between the normals of triangles and surface."""
    ours = cosine < FOLDED
    own, off, moved = np.zeros(len(cosine), bool), np.zeros(len(cosine)), np.zeros(len(cosine))
    nearest = 0.0
    radius = sharp_radius(mesh.sizing and mesh.sizing.chord, diagonal(mesh.points))
    bad = np.flatnonzero(ours)
    for face in np.unique(mesh.face_ids[bad]):
        some = bad[mesh.face_ids[bad] == face]
        surface, uv = mesh.surfaces[face], mesh.uv_points[mesh.uv_triangles[some]]
        own[some] = bends_sharply(surface, uv, radius)
        images = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
        away, gap = _distances(surface, mesh.points[mesh.triangles[some]], uv, images)
        turned = bool(mesh.turned_faces is not None and mesh.turned_faces[face])
        cosine_at_images = cosines_with_surface(surface, images, uv.mean(axis=1))
        flat = cosine_at_images * (-1.0 if turned else 1.0) >= FOLDED
        on = gap <= ON_SURFACE * away
        off[some] = np.where(flat, np.where(on, 0.0, gap).max(axis=1), 0.0)
        moved[some] = np.where(flat, np.where(on, away, 0.0).max(axis=1), 0.0)
        nearest = max(nearest, float(gap[on & flat[:, None]].max(initial=0.0)))
    return Folds(ours & ~own, own, cosine, off, moved, nearest, radius)


def _distances(
    surface, corners: NDArray, uv: NDArray, images: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of corners (k, 3, 3) from their images, and from the surface; both (k, 3)."""
    away = np.linalg.norm(corners - images, axis=2)
    gap = closest_point(surface, corners.reshape(-1, 3), uv.reshape(-1, 2), STEPS)[1]
    return away, np.minimum(gap.reshape(-1, 3), away)


def most_folded(mesh: SurfaceMesh, found: Folds, count: int) -> tuple[FoldedTriangle, ...]:
    """The ``count`` triangles that are turned most: first those that the surface does not."""
    bad = np.flatnonzero(found.ours | found.own)
    bad = bad[np.lexsort((found.cosine[bad], found.own[bad]))][:count]
    angle = np.degrees(np.arccos(np.clip(found.cosine[bad].astype(float), -1.0, 1.0)))
    places = mesh.points[mesh.triangles[bad]].mean(axis=1)
    return tuple(
        FoldedTriangle(
            int(t), int(mesh.face_ids[t]), float(turn), tuple(place), bool(found.own[t]),
            float(found.off[t]), float(found.moved[t]),
        )
        for t, turn, place in zip(bad, angle, places.tolist())
    )  # fmt: skip
