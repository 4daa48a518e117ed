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
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.differential.sharp_bends import bends_sharply
from surfmesh.geometry.surface import Surface
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.result.surface_mesh import SurfaceMesh

ON_SURFACE = 0.1  # of the way to its image: a node nearer to the surface lies on it
STEPS = 12  # of the projection, at most


@dataclass(frozen=True)
class FoldedTriangle:
    """A triangle turned more than 60 degrees from its surface."""

    triangle: int
    face: int
    angle_deg: float  # between the two normals
    point: Point  # its centroid
    by_surface: bool  # which bends sharply there, or turns over: no size is small enough
    off: float  # how far the farthest of its corners lies off the surface, model units
    moved: float  # how far images of corners lie from them that are on the surface


class Folds(NamedTuple):
    """Which triangles are turned too far."""

    by_mesh: NDArray[np.bool_]  # (m,) on a smooth piece of surface
    by_surface: NDArray[np.bool_]  # (m,) because the surface is
    cosine: NDArray[np.float32]  # (m,)
    off_surface: NDArray[np.float64]  # (m,) deviation of the corners, where it turns the triangle
    misplaced: NDArray[np.float64]  # (m,) of corners from their images in (u, v), where that does
    nearest: float  # within which such corners lie on the surface
    radius: float  # below which a surface is said to bend sharply, model units

    found: int  # triangles that are turned too far, whoever does it

    @property
    def inverted(self) -> NDArray[np.bool_]:
        """(m,) those of ``by_mesh`` turned by more than a right angle."""
        return self.by_mesh & (self.cosine < INVERTED)


def folds(known: KnownSurfaces, cosine: NDArray[np.float32]) -> Folds:
    """``cosine``: (m,) of the angles between the normals of triangles and surface."""
    mesh, folded = known.mesh, cosine < FOLDED
    by_surface = np.zeros(len(cosine), bool)
    off_surface, misplaced = np.zeros(len(cosine)), np.zeros(len(cosine))
    nearest = 0.0
    radius = sharp_radius(None if mesh.sizing is None else mesh.sizing.chord, known.diagonal)
    bad = np.flatnonzero(folded)
    for face in np.unique(mesh.face_ids[bad]) if len(bad) else ():
        some = bad[mesh.face_ids[bad] == face]
        surface, uv = mesh.surfaces[face], known.uv(some)
        by_surface[some] = bends_sharply(surface, uv, radius)
        images = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
        from_image, deviation = _distances(surface, known.points(some), uv, images)
        turned = bool(mesh.turned_faces is not None and mesh.turned_faces[face])
        cosine_at_images = cosines_with_surface(surface, images, uv.mean(axis=1))
        flat = cosine_at_images * (-1.0 if turned else 1.0) >= FOLDED
        on = deviation <= ON_SURFACE * from_image
        off_surface[some] = np.where(flat, np.where(on, 0.0, deviation).max(axis=1), 0.0)
        misplaced[some] = np.where(flat, np.where(on, from_image, 0.0).max(axis=1), 0.0)
        nearest = max(nearest, float(deviation[on & flat[:, None]].max(initial=0.0)))
    by_mesh = folded & ~by_surface
    return Folds(by_mesh, by_surface, cosine, off_surface, misplaced, nearest, radius, len(bad))


def _distances(
    surface: Surface,
    corners: NDArray[np.float64],
    uv: NDArray[np.float64],
    images: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of corners (k, 3, 3) from their images, and from the surface; both (k, 3)."""
    from_image = np.linalg.norm(corners - images, axis=2)
    deviation = closest_point(surface, corners.reshape(-1, 3), uv.reshape(-1, 2), STEPS)[1]
    return from_image, np.minimum(deviation.reshape(-1, 3), from_image)


def most_folded(mesh: SurfaceMesh, found: Folds, count: int) -> tuple[FoldedTriangle, ...]:
    """The ``count`` triangles that are turned most: first those that the surface does not."""
    if not found.found:
        return ()
    bad = np.flatnonzero(found.by_mesh | found.by_surface)
    bad = bad[np.lexsort((found.cosine[bad], found.by_surface[bad]))][:count]
    angle = np.degrees(np.arccos(np.clip(found.cosine[bad].astype(float), -1.0, 1.0)))
    places = mesh.points[mesh.triangles[bad]].mean(axis=1)
    return tuple(
        FoldedTriangle(
            int(t), int(mesh.face_ids[t]), float(turn), as_point(place), bool(found.by_surface[t]),
            float(found.off_surface[t]), float(found.misplaced[t]),
        )
        for t, turn, place in zip(bad, angle, places)
    )  # fmt: skip
